//! How an analysis ended at one point.

/// How an analysis ended at one point. Running into a physical limit is an ending, not an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The goal was reached.
    Reached,
    /// A physical limit declared by an element stands in the way.
    Limit {
        /// Stable name of the limit, for example `tire_saturated`.
        name: String,
        /// The signal that ran into it.
        signal: String,
        /// Its value where the path ended.
        value: f64,
        /// The declared threshold.
        threshold: f64,
    },
    /// No declared limit explains it; the sentence says which signals are involved.
    NotConverged {
        /// One sentence in signal names.
        because: String,
    },
}

impl Ending {
    /// `reached`, the name of the limit, or `not_converged`.
    pub fn name(&self) -> &str {
        match self {
            Self::Reached => "reached",
            Self::Limit { name, .. } => name,
            Self::NotConverged { .. } => "not_converged",
        }
    }
}
