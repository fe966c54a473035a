//! Capabilities that an integration needs beside the residual: consistent points and explicit rates.

use crate::{At, EvalError, Matrix, Plant, Seeds};

/// A constraint that does not hold, in mechanical words.
#[derive(Clone, Debug, PartialEq)]
pub struct Off {
    /// Name of the constraint row: `closure along x`.
    pub row: String,
    /// By how much it is violated.
    pub by: f64,
    /// Unit of that.
    pub unit: String,
}

impl std::fmt::Display for Off {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` is off by {:.6e} {}", self.row, self.by, self.unit)
    }
}

/// Why a point could not be brought onto the constraints.
#[derive(Clone, Debug, PartialEq)]
pub enum ProjectionError {
    /// The coordinates cannot satisfy these rows.
    Open {
        /// Rows that stay violated, worst first.
        rows: Vec<Off>,
    },
    /// The velocities cannot satisfy these rows.
    Velocity {
        /// Rows that stay violated, worst first.
        rows: Vec<Off>,
    },
    /// The constraints could not be evaluated.
    Evaluation(EvalError),
}

/// Brings points onto the constraints.
pub trait Projection: Plant {
    /// Moves coordinates, then velocities, onto the constraints at `time`, as little as possible in units of their nominal values.
    ///
    /// `y` has all unknowns; only coordinates and velocities change, and none of those that are `held` (empty: none is).
    /// Without constraints nothing changes.
    ///
    /// # Errors
    /// Rows that stay violated.
    fn project(&mut self, time: f64, y: &mut [f64], u: &[f64], held: &[bool]) -> Result<(), ProjectionError>;

    /// How independent the constraints are at a point: 0 in a singular position, where one of them follows from the others and more motions
    /// are possible than elsewhere. Only its change along a motion has a meaning. 1 without constraints.
    fn independence(&mut self, _time: f64, _y: &[f64], _u: &[f64]) -> f64 {
        1.0
    }
}

/// The explicit form, for methods that cannot take a residual.
pub trait Explicit: Plant {
    /// Computes from the differential entries of `y` its algebraic entries (multipliers) and all rates.
    ///
    /// `y` and `yd` have all unknowns; the algebraic entries of `y` and the rates of differential entries are overwritten. They are
    /// also the start of an iteration where rows of elements are implicit.
    ///
    /// # Errors
    /// Where the point cannot be evaluated.
    fn solve_rates(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError>;

    /// Differentiates what [`Explicit::solve_rates`] computes, along directions of the differential unknowns and of the inputs.
    ///
    /// `at` is a point that it has completed. Of the seeds, rates and algebraic unknowns are not read. `solved` (unknowns × directions)
    /// receives derivatives of rates, for algebraic unknowns those of their values.
    ///
    /// # Errors
    /// Where the point cannot be evaluated or its equations have no unique solution.
    fn rates_along(&mut self, at: At<'_>, seeds: &Seeds, solved: &mut Matrix) -> Result<(), EvalError>;
}

/// A plant that can be integrated in time.
pub trait Integrable: Plant + Projection + Explicit {}

impl<T: Plant + Projection + Explicit> Integrable for T {}
