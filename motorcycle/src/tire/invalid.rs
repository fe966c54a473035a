//! Why parameters do not make a tire.

/// A fault in the parameters of a tire.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidTireData {
    /// An infinite value or one that is not a number.
    #[error("`{parameter}` must be finite, but is {value}")]
    NotFinite {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A value that must be positive.
    #[error("`{parameter}` must be positive, but is {value}")]
    NotPositive {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A value that must not be negative.
    #[error("`{parameter}` must not be negative, but is {value}")]
    Negative {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A polynomial without coefficients.
    #[error("`{parameter}` needs at least one coefficient of its polynomial of load")]
    NoCoefficients {
        /// Name of the parameter.
        parameter: &'static str,
    },
    /// Shape factors with which the side force falls off and turns round while slip and camber grow.
    #[error("the lateral shape factors {cornering} (slip) and {camber} (camber) must add up to less than 2, or the side force folds over")]
    FoldsOver {
        /// Shape factor of the slip part.
        cornering: f64,
        /// Shape factor of the camber part.
        camber: f64,
    },
    /// A curvature factor that lets the force turn round at large slip.
    #[error("the curvature factor `{parameter}` must not exceed 1, but is {value}")]
    CurvatureAboveOne {
        /// Name of the parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Refuses what is not finite.
pub(super) fn finite(parameters: &[(&'static str, f64)]) -> Result<(), InvalidTireData> {
    match parameters.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(parameter, value)) => Err(InvalidTireData::NotFinite { parameter, value }),
        None => Ok(()),
    }
}

/// Refuses what is not positive.
pub(super) fn positive(parameters: &[(&'static str, f64)]) -> Result<(), InvalidTireData> {
    finite(parameters)?;
    match parameters.iter().find(|(_, value)| *value <= 0.0) {
        Some(&(parameter, value)) => Err(InvalidTireData::NotPositive { parameter, value }),
        None => Ok(()),
    }
}

/// Refuses what is negative.
pub(super) fn not_negative(parameters: &[(&'static str, f64)]) -> Result<(), InvalidTireData> {
    finite(parameters)?;
    match parameters.iter().find(|(_, value)| *value < 0.0) {
        Some(&(parameter, value)) => Err(InvalidTireData::Negative { parameter, value }),
        None => Ok(()),
    }
}

/// Refuses curvature factors above 1.
pub(super) fn curvature(parameters: &[(&'static str, f64)]) -> Result<(), InvalidTireData> {
    finite(parameters)?;
    match parameters.iter().find(|(_, value)| *value > 1.0) {
        Some(&(parameter, value)) => Err(InvalidTireData::CurvatureAboveOne { parameter, value }),
        None => Ok(()),
    }
}

/// Refuses lateral shape factors that are not positive or add up to 2.
pub(super) fn lateral_shape(cornering: f64, camber: f64) -> Result<(), InvalidTireData> {
    if cornering + camber < 2.0 { Ok(()) } else { Err(InvalidTireData::FoldsOver { cornering, camber }) }
}
