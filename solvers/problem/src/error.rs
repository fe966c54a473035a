//! Failure of one evaluation.

/// Why one evaluation of a residual failed. One to one with the SUNDIALS callback contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvalError {
    /// The point is outside what can be evaluated; a smaller step may help. Carries the index of the equation.
    Recoverable {
        /// Row of the residual that is not finite.
        equation: usize,
    },
    /// No step helps. Carries the index of the equation.
    Fatal {
        /// Row of the residual that failed.
        equation: usize,
    },
}

impl std::fmt::Display for EvalError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Recoverable { equation } => write!(f, "equation {equation} is not finite here"),
            Self::Fatal { equation } => write!(f, "equation {equation} cannot be evaluated"),
        }
    }
}

impl std::error::Error for EvalError {}
