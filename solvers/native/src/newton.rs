//! Newton's method with a backtracking line search, for small square systems with exact Jacobians.
//!
//! x ← x + λ p with J p = −f. The full step λ = 1 is tried first; λ is halved until ‖D f(x + λ p)‖² ≤ (1 − 2 α λ) ‖D f(x)‖² with
//! α = 10⁻⁴ (Armijo), and where f cannot be evaluated. D holds the reciprocals of `equation_scale`. A step that would cross a
//! bound ends at nine tenths of the way.
//!
//! Halving, not interpolation: where f grows steeply along p, a fitted parabola jumps over the useful λ to one a tenth as long, and
//! the iteration crawls (Brown's almost-linear system from its published start shows it).
//!
//! The simplified method keeps the matrix from one iteration to the next as long as full steps reduce the residual fivefold: linear convergence
//! for the price of residuals alone (C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations*, SIAM 1995, section 5.4.1).
//!
//! Source: J. E. Dennis, R. B. Schnabel, *Numerical Methods for Unconstrained Optimization and Nonlinear Equations*, SIAM 1996,
//! section 6.3.1; the treatment of bounds follows KINSOL.

use crate::elimination::Elimination;
use crate::factorization::Factorization;
use problem::contract::finite;
use problem::{AlgebraicEnding, AlgebraicMethod, AlgebraicOptions, AlgebraicOutcome, AlgebraicProblem, Bound, Effort, EvalError, Matrix};

/// Share of the predicted decrease that a step must bring (α).
const ARMIJO: f64 = 1e-4;
/// Part of the way to a bound that a step may go.
const BOUND_SHARE: f64 = 0.9;
/// Share of the residual that a step with a kept matrix may leave.
const FAST: f64 = 0.2;
/// Longest step, in units of the scaled distance of the start from the origin.
const MAX_STEP: f64 = 1e3;

/// Damped Newton method.
///
/// Allocates in the first solve of a size only, so a sweep runs without.
#[derive(Debug, Default)]
pub struct Newton {
    matrices: Matrices,
    work: Option<Work>,
}

/// How long a matrix serves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Matrices {
    /// One iteration.
    #[default]
    Fresh,
    /// As long as it leads on fast.
    Kept,
}

/// Everything that depends on the size of the problem.
#[derive(Debug)]
struct Work {
    f: Vec<f64>,
    jacobian: Matrix,
    elimination: Elimination,
    factors: Factorization,
    step: Vec<f64>,
    trial: Vec<f64>,
    trial_f: Vec<f64>,
}

impl Newton {
    /// The method, without work arrays yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The simplified method, which keeps a matrix while that leads on fast.
    pub fn simplified() -> Self {
        Self { matrices: Matrices::Kept, work: None }
    }
}

impl AlgebraicMethod for Newton {
    fn name(&self) -> &'static str {
        match self.matrices {
            Matrices::Fresh => "newton",
            Matrices::Kept => "newton_simplified",
        }
    }

    /// Improves `x` until the largest |fᵢ| / `equation_scale`ᵢ is below the tolerance.
    ///
    /// A start that violates a bound ends at once with [`AlgebraicEnding::NoDecrease`].
    ///
    /// # Panics
    /// Where lengths disagree or a scale is not a positive number.
    fn solve(&mut self, problem: &mut dyn AlgebraicProblem, x: &mut [f64], options: &AlgebraicOptions) -> AlgebraicOutcome {
        let size = problem.size();
        check(problem, x);
        if self.work.as_ref().is_none_or(|work| work.elimination.size() != size) {
            self.work = None;
        }
        let work = self.work.get_or_insert_with(|| Work::new(size));
        let mut effort = Effort::default();
        let (ending, residual) = work.run(problem, x, options, self.matrices, &mut effort);
        AlgebraicOutcome { ending, effort, residual }
    }
}

impl Work {
    fn new(size: usize) -> Self {
        let zeros = || vec![0.0; size];
        Self {
            f: zeros(),
            jacobian: Matrix::zeros(size, size),
            elimination: Elimination::new(size),
            factors: Factorization::new(size),
            step: zeros(),
            trial: zeros(),
            trial_f: zeros(),
        }
    }

    /// Iterates; returns how it ended and the largest scaled residual at the `x` it leaves.
    fn run(
        &mut self,
        problem: &mut dyn AlgebraicProblem,
        x: &mut [f64],
        options: &AlgebraicOptions,
        matrices: Matrices,
        effort: &mut Effort,
    ) -> (AlgebraicEnding, f64) {
        let max_step = MAX_STEP * scaled_square(x, problem.unknown_scale()).max(x.len() as f64).sqrt();
        let admissible = problem.bounds().iter().zip(&*x).all(|(&bound, &x)| admits(bound, x));
        let mut residual = f64::INFINITY;
        loop {
            if let Err(error) = self.linearize(problem, x, effort) {
                return (AlgebraicEnding::Evaluation(error), residual);
            }
            residual = largest(&self.f, problem.equation_scale());
            if !admissible {
                return (AlgebraicEnding::NoDecrease, residual);
            }
            if residual <= options.residual_tolerance {
                return (AlgebraicEnding::Converged, residual);
            }
            effort.iterations += 1;
            let (rows, columns) = (problem.equation_scale(), problem.unknown_scale());
            if self.elimination.solve(&self.jacobian, &self.f, rows, columns, &mut self.step).is_err() {
                return (AlgebraicEnding::Singular, residual);
            }
            self.step.iter_mut().for_each(|step| *step = -*step);
            let mut moved = match self.search(problem, x, options.step_tolerance, max_step, effort) {
                Ok(moved) => moved,
                Err(ending) => return (ending, residual),
            };
            x.copy_from_slice(&self.trial);
            residual = largest(&self.trial_f, problem.equation_scale());
            if matrices == Matrices::Kept && residual > options.residual_tolerance {
                (residual, moved) = self.coast(problem, x, (residual, moved), options, effort);
            }
            if residual <= options.residual_tolerance {
                return (AlgebraicEnding::Converged, residual);
            }
            if moved <= options.step_tolerance {
                return (AlgebraicEnding::Stalled, residual);
            }
            if effort.iterations >= options.max_iterations {
                return (AlgebraicEnding::MaxIterations, residual);
            }
        }
    }

    /// Goes on with the last matrix as long as each full step leaves a fifth of the residual at most; returns residual and last change.
    fn coast(
        &mut self,
        problem: &mut dyn AlgebraicProblem,
        x: &mut [f64],
        (mut residual, mut moved): (f64, f64),
        options: &AlgebraicOptions,
        effort: &mut Effort,
    ) -> (f64, f64) {
        let jacobian = &self.jacobian;
        let rows = problem.equation_scale();
        if self.factors.factorize(problem.unknown_scale(), |i, j| jacobian[(i, j)] / rows[i]).is_err() {
            return (residual, moved);
        }
        while residual > options.residual_tolerance && effort.iterations < options.max_iterations {
            for ((step, f), row) in self.step.iter_mut().zip(&self.trial_f).zip(problem.equation_scale()) {
                *step = -f / row;
            }
            self.factors.solve(&mut self.step);
            if room(problem.bounds(), x, &self.step, 1.0) < 1.0 {
                break;
            }
            self.trial.iter_mut().zip(&*x).zip(&self.step).for_each(|((trial, x), step)| *trial = x + step);
            (effort.residuals, effort.iterations) = (effort.residuals + 1, effort.iterations + 1);
            let evaluated = problem.residual(&self.trial, &mut self.f).and_then(|()| finite(&self.f));
            let after = evaluated.map_or(f64::INFINITY, |()| largest(&self.f, problem.equation_scale()));
            if after > FAST * residual {
                break;
            }
            moved = relative_length(&self.step, x, problem.unknown_scale());
            residual = after;
            x.copy_from_slice(&self.trial);
            self.trial_f.copy_from_slice(&self.f);
        }
        (residual, moved)
    }

    /// Fills f and J at `x`.
    fn linearize(&mut self, problem: &mut dyn AlgebraicProblem, x: &[f64], effort: &mut Effort) -> Result<(), EvalError> {
        effort.jacobians += 1;
        problem.jacobian(x, &mut self.f, &mut self.jacobian)?;
        finite(&self.f)?;
        // an empty system has no columns
        self.jacobian.as_slice().chunks_exact(x.len().max(1)).try_for_each(finite)
    }

    /// Finds an acceptable point on the way along the step and leaves it in `trial`, `trial_f`.
    ///
    /// Returns the largest change relative to the unknowns.
    fn search(
        &mut self,
        problem: &mut dyn AlgebraicProblem,
        x: &[f64],
        step_tolerance: f64,
        max_step: f64,
        effort: &mut Effort,
    ) -> Result<f64, AlgebraicEnding> {
        let before = scaled_square(&self.f, problem.equation_scale());
        let length = relative_length(&self.step, x, problem.unknown_scale());
        let within = max_step / scaled_square(&self.step, problem.unknown_scale()).sqrt();
        let mut share = room(problem.bounds(), x, &self.step, within.min(1.0));
        let mut failed = None;
        // the full step is tried however short it is: the last one before convergence is
        let mut first = share == 1.0;
        while first || share * length > step_tolerance {
            first = false;
            for ((trial, x), step) in self.trial.iter_mut().zip(x).zip(&self.step) {
                *trial = x + share * step;
            }
            effort.residuals += 1;
            match problem.residual(&self.trial, &mut self.trial_f).and_then(|()| finite(&self.trial_f)) {
                Ok(()) => {
                    failed = None;
                    let after = scaled_square(&self.trial_f, problem.equation_scale());
                    // for tiny shares the first test alone would pass where rounding leaves no change at all
                    if after <= (1.0 - 2.0 * ARMIJO * share) * before && after < before {
                        return Ok(share * length);
                    }
                }
                Err(error @ EvalError::Recoverable { .. }) => failed = Some(error),
                Err(error @ EvalError::Fatal { .. }) => return Err(AlgebraicEnding::Evaluation(error)),
            }
            share *= 0.5;
        }
        Err(failed.map_or(AlgebraicEnding::NoDecrease, AlgebraicEnding::Evaluation))
    }
}

/// Holds the problem to its contract.
fn check(problem: &dyn AlgebraicProblem, x: &[f64]) {
    let size = problem.size();
    assert_eq!(x.len(), size, "one start value per unknown");
    assert!(problem.bounds().is_empty() || problem.bounds().len() == size, "no bounds or one per unknown");
    for scale in [problem.unknown_scale(), problem.equation_scale()] {
        assert_eq!(scale.len(), size, "one scale per unknown and per equation");
        assert!(scale.iter().all(|&scale| scale > 0.0 && scale.is_finite()), "scales are positive numbers");
    }
}

/// Largest |valueᵢ| / scaleᵢ.
fn largest(values: &[f64], scale: &[f64]) -> f64 {
    values.iter().zip(scale).fold(0.0, |largest, (value, scale)| f64::max(largest, value.abs() / scale))
}

/// Σ (valueᵢ / scaleᵢ)².
fn scaled_square(values: &[f64], scale: &[f64]) -> f64 {
    values.iter().zip(scale).map(|(value, scale)| (value / scale) * (value / scale)).sum()
}

/// Largest |stepᵢ| / (|xᵢ| + scaleᵢ).
fn relative_length(step: &[f64], x: &[f64], scale: &[f64]) -> f64 {
    step.iter().zip(x).zip(scale).fold(0.0, |largest, ((step, x), scale)| f64::max(largest, step.abs() / (x.abs() + scale)))
}

/// Share of the step that violates no bound, at most `share`.
fn room(bounds: &[Bound], x: &[f64], step: &[f64], share: f64) -> f64 {
    bounds
        .iter()
        .zip(x)
        .zip(step)
        .filter(|((bound, x), step)| !admits(**bound, **x + share * **step))
        .fold(share, |room, ((_, x), step)| room.min(BOUND_SHARE * x.abs() / step.abs()))
}

/// Whether a value respects its bound.
fn admits(bound: Bound, x: f64) -> bool {
    match bound {
        Bound::Free => true,
        Bound::NonNegative => x >= 0.0,
        Bound::NonPositive => x <= 0.0,
        Bound::Positive => x > 0.0,
        Bound::Negative => x < 0.0,
    }
}
