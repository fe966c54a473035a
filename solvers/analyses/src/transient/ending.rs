//! How a simulation ended, in signal and equation names.

use problem::{Equation, EvalError, Off, ProjectionError};
use thiserror::Error;

/// How a simulation ended. Whatever the ending, everything computed up to it is in the trajectory.
#[derive(Clone, Debug, PartialEq)]
pub enum TransientEnding {
    /// The last sampling time was reached.
    Reached,
    /// A condition was met that ends the simulation.
    Met {
        /// Its name.
        name: String,
        /// The signal it watches.
        signal: String,
        /// The threshold that was passed.
        threshold: f64,
    },
    /// The receiver of the samples asked for it.
    Stopped,
    /// The integration could not go on.
    Failed {
        /// Why.
        cause: Cause,
    },
}

impl TransientEnding {
    /// `reached`, `stopped`, `not_converged`, or the name of the condition that was met.
    pub fn name(&self) -> &str {
        match self {
            Self::Reached => "reached",
            Self::Met { name, .. } => name,
            Self::Stopped => "stopped",
            Self::Failed { .. } => "not_converged",
        }
    }

    /// Whether everything asked for was computed.
    pub fn reached(&self) -> bool {
        *self == Self::Reached
    }
}

/// A signal and how fast it changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// Name of the unknown.
    pub signal: String,
    /// Its rate.
    pub rate: f64,
    /// Unit of the unknown, per second.
    pub unit: String,
}

impl std::fmt::Display for Moving {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` (by {:.3e} {} per second)", self.signal, self.rate, self.unit)
    }
}

/// Why an integration could not go on.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Cause {
    /// The plant cannot be evaluated beyond the time reached.
    #[error("`{equation}` has no finite value beyond this point")]
    NotFinite {
        /// The equation.
        equation: String,
    },
    /// More steps between two samples than allowed.
    #[error("more than {allowed} steps to the next sample; {}", fastest(moving))]
    TooManySteps {
        /// Number of steps that were allowed.
        allowed: usize,
        /// Signals that change fastest in units of their tolerances.
        moving: Vec<Moving>,
    },
    /// The local error stays too large down to the smallest step.
    #[error("no step is small enough for the tolerances; {}", fastest(moving))]
    ErrorTest {
        /// Signals that change fastest in units of their tolerances.
        moving: Vec<Moving>,
    },
    /// The equations of a step have no solution nearby, down to the smallest step.
    #[error("the equations of the next step are not solved, down to the smallest step; there {}", violated(rows))]
    Convergence {
        /// Rows that were off most at the last try, worst first.
        rows: Vec<Off>,
    },
    /// The equations of a step do not determine it.
    #[error("the next step is not determined; there {} move together", together.join(", "))]
    Singular {
        /// Signals in the direction that no equation fixes.
        together: Vec<String>,
    },
    /// The method does not begin.
    #[error("the method cannot begin here; {}", violated(rows))]
    Refused {
        /// Rows that are off most at the time reached, worst first.
        rows: Vec<Off>,
    },
    /// A step led so far off the constraints that no way back was found.
    #[error("the motion leaves the constraints; {}", violated(rows))]
    Open {
        /// Rows that stay violated, worst first.
        rows: Vec<Off>,
    },
}

/// Why a simulation could not start.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TransientError {
    /// Sampling times that are no sequence.
    #[error("a simulation needs at least two sampling times, each later than the one before")]
    Times,
    /// A condition on a signal that is not there.
    #[error("a condition watches `{signal}`, which is no signal of this model")]
    UnknownSignal {
        /// The name.
        signal: String,
    },
    /// The start cannot be brought onto the constraints.
    #[error("the coordinates of the start cannot satisfy the constraints; {}", violated(rows))]
    Open {
        /// Rows that stay violated, worst first.
        rows: Vec<Off>,
    },
    /// The velocities of the start cannot be brought onto the constraints.
    #[error("the velocities of the start cannot satisfy the constraints; {}", violated(rows))]
    Velocity {
        /// Rows that stay violated, worst first.
        rows: Vec<Off>,
    },
    /// The plant cannot be evaluated at the start.
    #[error("`{equation}` has no finite value at the start")]
    NotFinite {
        /// The equation.
        equation: String,
    },
}

impl TransientError {
    /// A failed projection of the start.
    pub(super) fn projection(error: ProjectionError, equations: &[Equation]) -> Self {
        match error {
            ProjectionError::Open { rows } => Self::Open { rows },
            ProjectionError::Velocity { rows } => Self::Velocity { rows },
            ProjectionError::Evaluation(e) => Self::NotFinite { equation: equation(e, equations) },
        }
    }
}

/// Name of the equation that failed.
pub(super) fn equation(error: EvalError, equations: &[Equation]) -> String {
    let (EvalError::Recoverable { equation } | EvalError::Fatal { equation }) = error;
    equations.get(equation).map_or_else(|| format!("equation {equation}"), |e| e.name.clone())
}

fn violated(rows: &[Off]) -> String {
    match rows {
        [] => "every equation is satisfied".to_owned(),
        rows => rows.iter().map(Off::to_string).collect::<Vec<_>>().join(", "),
    }
}

fn fastest(moving: &[Moving]) -> String {
    match moving {
        [] => "nothing moves".to_owned(),
        moving => format!("fastest are {}", moving.iter().map(Moving::to_string).collect::<Vec<_>>().join(", ")),
    }
}
