//! Coefficients of the motorcycle Magic Formula, under the names of their publication.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of a motorcycle tire in the Magic Formula of Sharp, Evangelou and Limebeer.
///
/// `d = (N − nominal_load)/nominal_load` stands for the load, `a` for the lateral slip, γ for the camber in the descriptions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MagicFormulaMotorcycleParameters {
    /// Nominal load Fz0, N.
    pub nominal_load: f64,
    /// Crown radius of the tire, m: the length that scales trail and residual moment in this set of coefficients.
    pub crown_radius: f64,
    /// Force forward.
    pub longitudinal: LongitudinalCoefficients,
    /// Side force.
    pub lateral: LateralCoefficients,
    /// Aligning moment.
    pub aligning: AligningCoefficients,
    /// How camber changes the peak of the side force.
    #[serde(default)]
    pub camber_peak: CamberPeak,
    /// At which camber the slope By of the residual moment is taken.
    #[serde(default)]
    pub residual_slope: ResidualSlope,
}

/// How camber changes the peak of the side force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CamberPeak {
    /// `1/(1 + pDy3 γ²)`, as in the readings of the published motorcycle coefficients.
    #[default]
    Divide,
    /// `1 + pDy3 γ²`, as the book is reported to have it.
    Multiply,
}

/// At which camber the slope By in `Br = qBz9 + qBz10 By Cy` is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ResidualSlope {
    /// At the camber of the tire.
    #[default]
    AtCamber,
    /// At no camber.
    Upright,
}

/// A group of coefficients, all dimensionless, that knows its names.
macro_rules! coefficients {
    ($(#[$about:meta])* $group:ident { $($(#[$field_about:meta])* $field:ident,)* }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $group {
            $($(#[$field_about])* pub $field: f64,)*
        }

        impl $group {
            /// Names and values.
            pub(super) fn named(&self) -> Vec<(&'static str, f64)> {
                vec![$((stringify!($field), self.$field)),*]
            }
        }
    };
}

coefficients! {
    /// Coefficients of the force forward.
    LongitudinalCoefficients {
        /// Shape factor.
        Cx,
        /// Peak friction at nominal load.
        pDx1,
        /// Change of the peak friction with d.
        pDx2,
        /// Curvature factor at nominal load.
        pEx1,
        /// Change of the curvature with d.
        pEx2,
        /// Change of the curvature with d².
        pEx3,
        /// Difference of the curvature between driving and braking.
        pEx4,
        /// Slip stiffness per load at nominal load.
        pKx1,
        /// Change of the slip stiffness with d.
        pKx2,
        /// Exponent of the slip stiffness in d.
        pKx3,
        /// Slope of the fading with lateral slip.
        rBx1,
        /// Change of this slope with longitudinal slip.
        rBx2,
        /// Shape factor of the fading with lateral slip.
        Cx_alpha,
    }
}

coefficients! {
    /// Coefficients of the side force.
    LateralCoefficients {
        /// Shape factor of the slip part.
        Cy,
        /// Peak friction at nominal load.
        pDy1,
        /// Exponent of the peak friction in d.
        pDy2,
        /// Change of the peak friction with γ².
        pDy3,
        /// Curvature factor of the slip part.
        pEy1,
        /// Change of the curvature with γ².
        pEy2,
        /// Change of the curvature with γ, opposite for both signs of the slip.
        pEy4,
        /// Largest cornering stiffness over nominal load.
        pKy1,
        /// Shape factor of the cornering stiffness over load.
        pKy2,
        /// Load, in nominal loads, at which the cornering stiffness saturates.
        pKy3,
        /// Change of this load with γ².
        pKy4,
        /// Decrease of the cornering stiffness with γ².
        pKy5,
        /// Shape factor of the camber part.
        C_gamma,
        /// Camber stiffness per load at nominal load.
        pKy6,
        /// Change of the camber stiffness with d.
        pKy7,
        /// Curvature factor of the camber part.
        E_gamma,
        /// Slope of the fading with longitudinal slip.
        rBy1,
        /// Change of this slope with lateral slip.
        rBy2,
        /// Lateral slip about which it changes: the one term that tells left from right.
        rBy3,
        /// Shape factor of the fading with longitudinal slip.
        Cy_kappa,
    }
}

coefficients! {
    /// Coefficients of the aligning moment.
    AligningCoefficients {
        /// Shape factor of the trail.
        Ct,
        /// Slope of the trail.
        qBz1,
        /// Change of the slope with d.
        qBz2,
        /// Change of the slope with |γ|.
        qBz5,
        /// Change of the slope with γ².
        qBz6,
        /// Slope of the residual moment.
        qBz9,
        /// Slope of the residual moment per slope of the side force.
        qBz10,
        /// Trail at nominal load, in crown radii.
        qDz1,
        /// Change of the trail with d.
        qDz2,
        /// Change of the trail with |γ|.
        qDz3,
        /// Change of the trail with γ².
        qDz4,
        /// Residual moment per camber at nominal load.
        qDz8,
        /// Change of it with d.
        qDz9,
        /// Residual moment per γ|γ| at nominal load.
        qDz10,
        /// Change of it with d.
        qDz11,
        /// Curvature factor of the trail.
        qEz1,
        /// Change of the curvature with d.
        qEz2,
        /// Change of the curvature with d²; only one of the readings of the coefficients has it.
        #[serde(default)]
        qEz3,
        /// Change of the curvature with γ and slip.
        qEz5,
        /// Shift of the residual moment per camber.
        qHz3,
        /// Change of the shift with d.
        qHz4,
    }
}
