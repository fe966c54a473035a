//! What may be wrong with a formula.

use crate::description::quantity::QuantityError;
use thiserror::Error;

/// A part of a formula in a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// As typed.
    pub text: String,
    /// What it is: `a length (m)`.
    pub is: String,
}

/// Why a formula has no value.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExpressionError {
    /// Something is missing or too much.
    #[error("expected {expected} at `{found}` in the formula `{text}`")]
    Syntax {
        /// What belongs there.
        expected: String,
        /// What stands there.
        found: String,
        /// The whole formula.
        text: String,
    },
    /// A number with a unit that cannot be read.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// A name without value.
    #[error("there is no parameter `{name}`")]
    UnknownName {
        /// The name.
        name: String,
        /// What is probably meant.
        hint: Option<String>,
    },
    /// Quantities of different kinds.
    #[error("`{}` is {}, `{}` is {}: they cannot be {verb}", left.text, left.is, right.text, right.is)]
    Unlike {
        /// `added`, `subtracted`, `compared`.
        verb: &'static str,
        /// The first one.
        left: Side,
        /// The other one.
        right: Side,
    },
    /// A quantity where a plain number belongs.
    #[error("{what} is a plain number, but `{}` is {}", side.text, side.is)]
    NotPlain {
        /// What is meant.
        what: &'static str,
        /// What stands there.
        side: Side,
    },
    /// A power or root that no unit has.
    #[error("a power or root in `{text}` has no unit")]
    Power {
        /// The whole formula.
        text: String,
    },
    /// Wrong number of arguments.
    #[error("`{function}` takes {expected}, but {found} stand there")]
    Arguments {
        /// Name of the function.
        function: &'static str,
        /// How many it takes.
        expected: String,
        /// How many there are.
        found: usize,
    },
    /// Division by zero, the root of a negative number.
    #[error("the formula `{text}` gives {value}")]
    NotFinite {
        /// The whole formula.
        text: String,
        /// What it gives.
        value: f64,
    },
}

impl ExpressionError {
    /// Stable name, for [`crate::description::finding::Finding::code`].
    pub fn code(&self) -> &'static str {
        match self {
            Self::Syntax { .. } | Self::Arguments { .. } => "bad_formula",
            Self::Quantity(error) => error.code(),
            Self::UnknownName { .. } => "unknown_parameter",
            Self::Unlike { .. } | Self::NotPlain { .. } | Self::Power { .. } => "wrong_dimension",
            Self::NotFinite { .. } => "bad_number",
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Syntax { text, .. } if text.matches('(').count() > text.matches(')').count() => {
                Some("a `)` is missing; between braces a comma ends an entry of YAML, unless the formula is in quotes".to_owned())
            }
            Self::Syntax { .. } => Some("a formula is written like `= 0.5 * spring_rate + 2 kN/m`".to_owned()),
            Self::Quantity(error) => error.hint(),
            Self::UnknownName { hint, .. } => hint.clone().or_else(|| Some("declare it under `parameters:`".to_owned())),
            Self::Unlike { .. } => Some("give the number its unit, or the parameter another one".to_owned()),
            _ => None,
        }
    }
}
