//! Square nonlinear systems and the methods that solve them.

use crate::{EvalError, Matrix};
use std::ops::AddAssign;

/// Simple bound on one unknown, as KINSOL knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// No bound.
    Free,
    /// x ≥ 0.
    NonNegative,
    /// x ≤ 0.
    NonPositive,
    /// x > 0.
    Positive,
    /// x < 0.
    Negative,
}

/// A square system `0 = f(x)` with scales and an exact Jacobian.
pub trait AlgebraicProblem {
    /// Number of unknowns and of equations.
    fn size(&self) -> usize;
    /// Typical magnitude of each unknown.
    fn unknown_scale(&self) -> &[f64];
    /// Typical magnitude of each equation.
    fn equation_scale(&self) -> &[f64];
    /// Bounds; empty where there are none.
    fn bounds(&self) -> &[Bound] {
        &[]
    }
    /// Writes f(x).
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError>;
    /// Writes f(x) and the Jacobian ∂f/∂x.
    fn jacobian(&mut self, x: &[f64], f: &mut [f64], jacobian: &mut Matrix) -> Result<(), EvalError>;
    /// Writes ∂f/∂x v, for linear solvers that need no matrix. Left out, it forms the matrix.
    fn product(&mut self, x: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        let mut jacobian = Matrix::zeros(v.len(), v.len());
        self.jacobian(x, product, &mut jacobian)?;
        jacobian.times(v, product);
        Ok(())
    }
}

/// What every method for algebraic systems understands.
#[derive(Clone, Copy, Debug)]
pub struct AlgebraicOptions {
    /// Largest scaled residual that counts as solved.
    pub residual_tolerance: f64,
    /// Scaled step below which the iteration stalls.
    pub step_tolerance: f64,
    /// Largest number of iterations.
    pub max_iterations: usize,
}

impl Default for AlgebraicOptions {
    fn default() -> Self {
        Self { residual_tolerance: 1e-9, step_tolerance: 1e-11, max_iterations: 60 }
    }
}

/// How a method ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlgebraicEnding {
    /// The scaled residual is below the tolerance.
    Converged,
    /// The step became too small before the residual did: a local minimum or a fold.
    Stalled,
    /// Too many iterations.
    MaxIterations,
    /// The Jacobian is singular.
    Singular,
    /// The line search found no decrease, or a bound stood in the way.
    NoDecrease,
    /// The residual could not be evaluated.
    Evaluation(EvalError),
}

/// What a method has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Iterations taken.
    pub iterations: usize,
    /// Residual evaluations.
    pub residuals: usize,
    /// Jacobian evaluations.
    pub jacobians: usize,
    /// Products of the Jacobian with a vector, for linear solvers without matrix.
    pub products: usize,
}

impl AddAssign for Effort {
    fn add_assign(&mut self, more: Self) {
        self.iterations += more.iterations;
        self.residuals += more.residuals;
        self.jacobians += more.jacobians;
        self.products += more.products;
    }
}

/// What a method reports beside the solution.
#[derive(Clone, Copy, Debug)]
pub struct AlgebraicOutcome {
    /// How it ended.
    pub ending: AlgebraicEnding,
    /// What it took.
    pub effort: Effort,
    /// Largest scaled residual at the end.
    pub residual: f64,
}

impl AlgebraicOutcome {
    /// Whether the residual is below the tolerance.
    pub fn converged(&self) -> bool {
        self.ending == AlgebraicEnding::Converged
    }
}

/// A method for square nonlinear systems. One per task: it owns its work arrays.
pub trait AlgebraicMethod: Send {
    /// Name on the command line: `kinsol`, `newton`.
    fn name(&self) -> &'static str;
    /// Improves `x` in place until `f(x) = 0`; whatever the ending, `x` holds the best point found.
    fn solve(&mut self, problem: &mut dyn AlgebraicProblem, x: &mut [f64], options: &AlgebraicOptions) -> AlgebraicOutcome;
}
