//! KINSOL: Newton's method with a line search or without, with matrices or products alone, Picard and fixed-point iterations with Anderson
//! acceleration.
//!
//! x ← x + λ p with J p = −f. The step is shortened from λ = 1 by quadratic and cubic interpolation until ½‖D f‖² has
//! decreased enough (α = 10⁻⁴) without stopping too early (β = 0.9); D holds the reciprocals of `equation_scale`.
//!
//! `kinsol_gmres` finds p from products J v, preconditioned from the right by the LU factors of a J that is renewed every ten iterations; its tolerance ‖f + J p‖ ≤ η ‖f‖ follows from how well the last step was
//! predicted (Eisenstat and Walker's first choice).
//!
//! `kinsol_picard` and `kinsol_fixed_point` iterate x ← x − J⁻¹ f(x) with the J of an earlier point (renewed every ten iterations, or that of
//! the start) and combine the last five changes so that the residual of their linear combination is least. They take no bounds.
//!
//! Source: S. C. Eisenstat, H. F. Walker, *Choosing the forcing terms in an inexact Newton method*, SIAM J. Sci. Comput. 17, 1996, 16–32; H. F. Walker, P. Ni, *Anderson acceleration for fixed-point iterations*, SIAM J. Numer. Anal. 49, 2011, 1715–1735; A. M. Collier, A. C. Hindmarsh, R. Serban, C. S. Woodward, *User Documentation for KINSOL*, LLNL, section
//! “Mathematical considerations”; J. E. Dennis, R. B. Schnabel, *Numerical Methods for Unconstrained Optimization and Nonlinear
//! Equations*, SIAM 1996, algorithm A6.3.1mod.

use crate::raw::kinsol::{Memory, Request, Stop, System};
use crate::raw::linear::Factors;
use problem::contract::finite;
use problem::{AlgebraicEnding, AlgebraicMethod, AlgebraicOptions, AlgebraicOutcome, AlgebraicProblem, Bound, Effort, EvalError, Matrix};

pub use crate::raw::kinsol::Strategy;

/// Longest step, in units of the scaled distance of the start from the origin; KINSOL's own default.
const MAX_STEP: f64 = 1e3;

/// Iterations for which a matrix of the Picard iteration serves; KINSOL 7.1.1 itself asks for one in each.
const RENEWED: usize = 10;

/// KINSOL with exact derivatives, renewed in every iteration.
///
/// Keeps its solver between problems of the same size, so a sweep creates it once.
#[derive(Default)]
pub struct Kinsol {
    strategy: Strategy,
    work: Option<Work>,
}

/// Everything that depends on the size of the problem.
struct Work {
    memory: Memory,
    /// Jacobian as the problem writes it, then copied to KINSOL.
    jacobian: Matrix,
    /// Residual that comes with the Jacobian.
    f: Vec<f64>,
    /// Best point seen.
    best: Vec<f64>,
    /// Factors of an earlier Jacobian: that of the start for the fixed-point iteration, the preconditioner of GMRES.
    factors: Option<Factors>,
}

impl Kinsol {
    /// KINSOL with the given way to make progress from far away.
    pub fn new(strategy: Strategy) -> Self {
        Self { strategy, work: None }
    }
}

impl AlgebraicMethod for Kinsol {
    fn name(&self) -> &'static str {
        match self.strategy {
            Strategy::LineSearch => "kinsol",
            Strategy::FullStep => "kinsol_newton",
            Strategy::Krylov => "kinsol_gmres",
            Strategy::Picard => "kinsol_picard",
            Strategy::FixedPoint => "kinsol_fixed_point",
        }
    }

    /// Improves `x` until the largest |fᵢ| / `equation_scale`ᵢ is below the tolerance.
    ///
    /// A start that violates a bound ends at once with [`AlgebraicEnding::NoDecrease`].
    ///
    /// # Panics
    /// Where lengths disagree or a scale is not a positive number; where the problem panics, with its panic.
    fn solve(&mut self, problem: &mut dyn AlgebraicProblem, x: &mut [f64], options: &AlgebraicOptions) -> AlgebraicOutcome {
        let size = problem.size();
        assert_eq!(x.len(), size, "one start value per unknown");
        if size == 0 {
            return AlgebraicOutcome { ending: AlgebraicEnding::Converged, effort: Effort::default(), residual: 0.0 };
        }
        let work = self.work.take().filter(|work| work.memory.size() == size).unwrap_or_else(|| Work::new(size, self.strategy));
        let work = self.work.insert(work);
        work.load(problem, x);
        if outside(problem.bounds(), x) {
            return work.residual_only(problem, x);
        }
        work.run(problem, x, options, self.strategy)
    }
}

impl Work {
    fn new(size: usize, strategy: Strategy) -> Self {
        let zeros = || vec![0.0; size];
        Self { memory: Memory::new(size, strategy), jacobian: Matrix::zeros(size, size), f: zeros(), best: zeros(), factors: None }
    }

    /// Hands start, scales and bounds to KINSOL.
    fn load(&mut self, problem: &dyn AlgebraicProblem, x: &[f64]) {
        self.memory.start_mut().copy_from_slice(x);
        reciprocals(self.memory.unknown_weight_mut(), problem.unknown_scale());
        reciprocals(self.memory.equation_weight_mut(), problem.equation_scale());
        let bounds = problem.bounds();
        assert!(bounds.is_empty() || bounds.len() == x.len(), "no bounds or one per unknown");
        for (i, code) in self.memory.constraints_mut().iter_mut().enumerate() {
            *code = bounds.get(i).map_or(0.0, |&bound| constraint(bound));
        }
    }

    fn run(
        &mut self,
        problem: &mut dyn AlgebraicProblem,
        x: &mut [f64],
        options: &AlgebraicOptions,
        strategy: Strategy,
    ) -> AlgebraicOutcome {
        let request = Request {
            // KINSOL takes zero for "its own default"
            // the fixed-point iteration is judged by distances and ends by what was evaluated
            residual_tolerance: if strategy == Strategy::FixedPoint { 1e-14 } else { options.residual_tolerance.max(f64::MIN_POSITIVE) },
            step_tolerance: options.step_tolerance.max(f64::MIN_POSITIVE),
            max_iterations: options.max_iterations.max(1),
            max_step: max_step(x, problem.unknown_scale()),
        };
        self.best.copy_from_slice(x);
        let mut effort = Effort::default();
        if strategy == Strategy::FixedPoint {
            let evaluated = problem.jacobian(x, &mut self.f, &mut self.jacobian).and_then(|()| finite(&self.f));
            if let Err(error) = evaluated {
                let ending = AlgebraicEnding::Evaluation(error);
                return AlgebraicOutcome { ending, effort: Effort { jacobians: 1, ..effort }, residual: f64::INFINITY };
            }
            effort.jacobians = 1;
            if !self.factors.get_or_insert_with(|| Factors::new(x.len())).factorize(self.jacobian.as_slice()) {
                let residual = largest(&self.f, problem.equation_scale());
                let ending = if residual <= options.residual_tolerance { AlgebraicEnding::Converged } else { AlgebraicEnding::Singular };
                return AlgebraicOutcome { ending, effort, residual };
            }
        }
        if strategy == Strategy::Krylov {
            self.factors.get_or_insert_with(|| Factors::new(x.len()));
        }
        let mut bridge = Bridge {
            problem,
            jacobian: &mut self.jacobian,
            f: &mut self.f,
            best: &mut self.best,
            best_residual: f64::INFINITY,
            factors: self.factors.as_mut(),
            tolerance: options.residual_tolerance,
            renewed: if strategy == Strategy::Picard { RENEWED } else { 1 },
            asked: 0,
            effort,
        };
        let report = self.memory.solve(&mut bridge, &request);
        let Bridge { best_residual, effort, .. } = bridge;
        x.copy_from_slice(&self.best);
        let ending = match report.stop {
            // judged by what was evaluated at x, whatever KINSOL says
            _ if best_residual <= options.residual_tolerance => AlgebraicEnding::Converged,
            Stop::Solved | Stop::Stalled => AlgebraicEnding::Stalled,
            Stop::MaxIterations => AlgebraicEnding::MaxIterations,
            Stop::Singular => AlgebraicEnding::Singular,
            Stop::NoDecrease => AlgebraicEnding::NoDecrease,
            // these tell a factorization that failed from an evaluation by no code
            Stop::Evaluation if matches!(strategy, Strategy::Picard | Strategy::Krylov) && report.error.is_none() => {
                AlgebraicEnding::Singular
            }
            Stop::Evaluation => report.error.map_or(AlgebraicEnding::NoDecrease, AlgebraicEnding::Evaluation),
        };
        AlgebraicOutcome { ending, effort: Effort { iterations: report.iterations, ..effort }, residual: best_residual }
    }

    /// The outcome at a start from which KINSOL would refuse to go.
    fn residual_only(&mut self, problem: &mut dyn AlgebraicProblem, x: &[f64]) -> AlgebraicOutcome {
        let evaluated = problem.residual(x, &mut self.f).and_then(|()| finite(&self.f));
        let residual = evaluated.map_or(f64::INFINITY, |()| largest(&self.f, problem.equation_scale()));
        AlgebraicOutcome { ending: AlgebraicEnding::NoDecrease, effort: Effort { residuals: 1, ..Effort::default() }, residual }
    }
}

/// The problem as KINSOL calls it back, with the best point that it has seen.
struct Bridge<'a> {
    problem: &'a mut dyn AlgebraicProblem,
    jacobian: &'a mut Matrix,
    f: &'a mut [f64],
    best: &'a mut [f64],
    best_residual: f64,
    factors: Option<&'a mut Factors>,
    tolerance: f64,
    /// Iterations for which a matrix serves, and how many were asked for.
    renewed: usize,
    asked: usize,
    effort: Effort,
}

impl Bridge<'_> {
    /// Evaluates the Jacobian.
    fn renew(&mut self, x: &[f64]) -> Result<(), EvalError> {
        self.effort.jacobians += 1;
        self.problem.jacobian(x, self.f, self.jacobian)?;
        finite(self.f)?;
        self.jacobian.as_slice().chunks_exact(x.len()).try_for_each(finite)
    }
}

impl System for Bridge<'_> {
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.effort.residuals += 1;
        self.problem.residual(x, f)?;
        finite(f)?;
        let residual = largest(f, self.problem.equation_scale());
        if residual < self.best_residual {
            self.best_residual = residual;
            self.best.copy_from_slice(x);
        }
        Ok(())
    }

    fn fixed_point(&mut self, x: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.residual(x, g)?;
        // where the residual is small enough the iteration may end, whatever the distance of its points
        if self.best_residual <= self.tolerance {
            g.copy_from_slice(x);
            return Ok(());
        }
        if let Some(factors) = &mut self.factors {
            factors.solve(g);
        }
        g.iter_mut().zip(x).for_each(|(g, x)| *g = x - *g);
        Ok(())
    }

    fn jacobian(&mut self, x: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError> {
        self.asked += 1;
        if (self.asked - 1).is_multiple_of(self.renewed) {
            self.renew(x)?;
        }
        jacobian.copy_from_slice(self.jacobian.as_slice());
        Ok(())
    }

    fn product(&mut self, x: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        self.effort.products += 1;
        self.problem.product(x, v, product)?;
        finite(product)
    }

    fn prepare(&mut self, x: &[f64]) -> Result<bool, EvalError> {
        self.renew(x)?;
        Ok(self.factors.as_mut().is_some_and(|factors| factors.factorize(self.jacobian.as_slice())))
    }

    fn precondition(&mut self, r: &mut [f64]) {
        if let Some(factors) = &mut self.factors {
            factors.solve(r);
        }
    }
}

/// Largest |fᵢ| / scaleᵢ.
fn largest(f: &[f64], scale: &[f64]) -> f64 {
    f.iter().zip(scale).fold(0.0, |largest, (f, scale)| f64::max(largest, f.abs() / scale))
}

/// KINSOL multiplies where the vocabulary divides.
fn reciprocals(weight: &mut [f64], scale: &[f64]) {
    assert_eq!(weight.len(), scale.len(), "one scale per unknown and per equation");
    for (weight, &scale) in weight.iter_mut().zip(scale) {
        assert!(scale > 0.0 && scale.is_finite(), "scales are positive numbers, not {scale}");
        *weight = 1.0 / scale;
    }
}

/// Longest step: a multiple of the scaled length of the start, or of one unit per unknown where that is longer.
fn max_step(x: &[f64], scale: &[f64]) -> f64 {
    let squares: f64 = x.iter().zip(scale).map(|(x, scale)| (x / scale).powi(2)).sum();
    MAX_STEP * squares.max(x.len() as f64).sqrt()
}

/// KINSOL's code of a bound.
fn constraint(bound: Bound) -> f64 {
    match bound {
        Bound::Free => 0.0,
        Bound::NonNegative => 1.0,
        Bound::NonPositive => -1.0,
        Bound::Positive => 2.0,
        Bound::Negative => -2.0,
    }
}

/// Whether an unknown violates its bound.
fn outside(bounds: &[Bound], x: &[f64]) -> bool {
    bounds.iter().zip(x).any(|(bound, &x)| match bound {
        Bound::Free => false,
        Bound::NonNegative => x < 0.0,
        Bound::NonPositive => x > 0.0,
        Bound::Positive => x <= 0.0,
        Bound::Negative => x >= 0.0,
    })
}
