//! Why a text is not the quantity that was asked for.

use super::dimension::{Dimension, Exponents};
use thiserror::Error;

/// Why a text is not the quantity that was asked for. Messages name the text, what it is and what it should be.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum QuantityError {
    /// No number at the front.
    #[error("`{text}` is not a number")]
    NotANumber {
        /// As typed.
        text: String,
    },
    /// A comma where a point belongs.
    #[error("`{text}` has a comma")]
    DecimalComma {
        /// As typed.
        text: String,
        /// With a point.
        instead: String,
    },
    /// Overflow.
    #[error("`{text}` is not finite")]
    NotFinite {
        /// As typed.
        text: String,
    },
    /// A unit that is not in the table.
    #[error("unknown unit `{unit}` in `{text}`")]
    UnknownUnit {
        /// As typed.
        text: String,
        /// The unknown part.
        unit: String,
        /// What is probably meant.
        nearest: Option<&'static str>,
    },
    /// A product after a quotient.
    #[error("the unit of `{text}` can be read in two ways")]
    Ambiguous {
        /// As typed.
        text: String,
    },
    /// Something that is no unit.
    #[error("`{text}` cannot be read as a number with a unit from `{rest}` on")]
    Unreadable {
        /// As typed.
        text: String,
        /// The part that is not understood.
        rest: String,
    },
    /// A unit of something else.
    #[error("`{text}` is {found}, expected {expected}")]
    WrongDimension {
        /// As typed.
        text: String,
        /// What it is.
        found: String,
        /// What was asked for.
        expected: &'static Dimension,
        /// Advice.
        hint: Option<&'static str>,
    },
    /// Beyond a bound.
    #[error("`{text}` is out of range: it must be {bound}")]
    OutOfRange {
        /// As typed.
        text: String,
        /// For instance `greater than 0 N/m`.
        bound: String,
    },
}

impl QuantityError {
    /// Stable name of the failure, for [`crate::description::finding::Finding::code`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::NotANumber { .. } | Self::DecimalComma { .. } | Self::NotFinite { .. } => "bad_number",
            Self::UnknownUnit { .. } => "unknown_unit",
            Self::Ambiguous { .. } | Self::Unreadable { .. } => "bad_unit",
            Self::WrongDimension { .. } => "wrong_dimension",
            Self::OutOfRange { .. } => "out_of_range",
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::DecimalComma { instead, .. } => Some(format!("write `{instead}`")),
            Self::UnknownUnit { nearest: Some(unit), .. } => Some(format!("did you mean `{unit}`?")),
            Self::Ambiguous { .. } => Some("write `kg/(m s)` or `kg s/m`, not `kg/m s`".to_string()),
            Self::UnknownUnit { nearest: None, .. } | Self::Unreadable { .. } => {
                Some("write a unit like `kN/m`, `N s/m`, `kg m^2`".to_string())
            }
            Self::WrongDimension { hint, .. } => hint.map(str::to_string),
            Self::NotANumber { .. } => Some("write a number with an optional unit, like `58 kN/m`".to_string()),
            Self::NotFinite { .. } | Self::OutOfRange { .. } => None,
        }
    }
}

/// Advice for the usual mistakes between two dimensions.
pub(super) fn usual_mistake(found: Exponents, expected: &Dimension) -> Option<&'static str> {
    let wanted = expected.exponents;
    let as_force = found.times_power(Exponents::of([1, 0, -2, 0]), 1);
    let as_angle = |n| found.times_power(Exponents::of([0, 0, 0, 1]), n);
    if wanted == Exponents::of([1, 0, -2, 0]) && found == Exponents::of([0, 1, 0, 0]) {
        Some("`g` is the gram; write `gn` for standard gravity")
    } else if found.mass == 1 && as_force == Some(wanted) {
        Some("`kg` and `lb` are masses; write `kgf` or `lbf` for forces")
    } else if wanted.time < 0 && as_angle(1) == Some(wanted) {
        Some("write `rad/s`, `rev/s` or `rpm`")
    } else if wanted.time < 0 && as_angle(-1) == Some(wanted) {
        Some("write `Hz` or `1/s`")
    } else {
        None
    }
}

/// A text in a message: one line, not too long.
pub(super) fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut short: String = text.trim().chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.trim().chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}
