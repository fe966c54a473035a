//! IDA: variable-order, variable-step BDF for implicit systems.
//!
//! 0 = F(t, y, ẏ). In every step ẏ is the derivative of a polynomial through the last points (orders 1 to 5, fixed leading
//! coefficient), and Newton's method solves for y with the matrix ∂F/∂y + c ∂F/∂ẏ, c = α/h. A step is accepted where the
//! estimated local error, in the norm ‖e‖ = √(Σ (eᵢ/(rtol |yᵢ| + atolᵢ))² / n), is below one. Samples are values of the
//! polynomial of the last step, so they cost nothing and do not shorten steps.
//!
//! IDA knows scales of unknowns (their tolerances) but none of equations: the LU factorization pivots on rows as they are. A
//! problem of index 2 whose multipliers are in newtons next to lengths in meters should scale its rows and unknowns itself.
//! Suppressed unknowns are left out of the error test only; the iteration converges in all of them. Generous tolerances for
//! multipliers save nothing: it then stops early, and what it leaves costs steps (on the pendulum of the tests, twice as many).
//!
//! GMRES is preconditioned from the left by the LU factors of the matrix of an earlier step. Without, IDA would measure residuals by the weights
//! of the unknowns that happen to have the same place, and ends too early: whipple and Andrews' mechanism then fail.
//!
//! Source: A. C. Hindmarsh, R. Serban, C. J. Balos, D. J. Gardner, D. R. Reynolds, C. S. Woodward, *User Documentation for IDA*,
//! LLNL, section “Mathematical considerations”; K. E. Brenan, S. L. Campbell, L. R. Petzold, *Numerical Solution of Initial-Value
//! Problems in Differential-Algebraic Equations*, SIAM 1996, section 5.2.

use crate::raw::ida::{Memory, System};
use crate::raw::integrator::Request;
use crate::raw::linear::Factors;
use problem::contract::{acceptable, check_times, coincide, finite};
use problem::{
    AlgebraicErrors, DaeMethod, DaeProblem, EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, LinearSolver,
    Matrix, Sink,
};

/// IDA with exact dense matrices, or without matrices by [`problem::LinearSolver::Gmres`].
///
/// Keeps its integrator between problems of the same size.
#[derive(Default)]
pub struct Ida {
    work: Option<Work>,
}

/// Everything that depends on the size of the problem.
struct Work {
    memory: Memory,
    /// Matrix as the problem writes it, then copied to IDA or factorized.
    jacobian: Matrix,
    /// The preconditioner of GMRES.
    preconditioner: Option<Factors>,
}

impl DaeMethod for Ida {
    fn name(&self) -> &'static str {
        "ida"
    }

    /// Integrates until the last time, an event, or a failure.
    ///
    /// The point of an event is not handed to the sink. After a failure `y` and `yd` are those at the end of the last step that
    /// succeeded, which may lie behind the last sample.
    ///
    /// # Panics
    /// Where lengths disagree, times decrease or there is none; where the problem or the sink panics, with their panic.
    fn integrate(
        &mut self,
        problem: &mut dyn DaeProblem,
        times: &[f64],
        (y, yd): (&mut [f64], &mut [f64]),
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        let size = problem.size();
        assert!(y.len() == size && yd.len() == size, "one start value and one rate per unknown");
        check_times(times);
        if !acceptable(options) {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        // the start itself, and whatever cannot be told from it
        let at_start = times.iter().take_while(|&&time| size == 0 || coincide(times[0], time)).count();
        for &time in &times[..at_start] {
            if sink(time, y, yd) == Flow::Stop {
                return IntegrationOutcome::nothing_done(IntegrationEnding::Stopped, time);
            }
        }
        let later = &times[at_start..];
        if later.is_empty() {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Finished, times[at_start - 1]);
        }
        let work = self
            .work
            .take()
            .filter(|work| work.fits(size, options.linear_solver))
            .unwrap_or_else(|| Work::new(size, options.linear_solver));
        let work = self.work.insert(work);
        if !work.start(problem, times, (y, yd), options) {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        work.run(problem, times[0], later, (y, yd), sink)
    }
}

impl Work {
    fn new(size: usize, linear: LinearSolver) -> Self {
        let preconditioner = (linear == LinearSolver::Gmres).then(|| Factors::new(size));
        Self { memory: Memory::new(size, linear), jacobian: Matrix::zeros(size, size), preconditioner }
    }

    fn fits(&self, size: usize, linear: LinearSolver) -> bool {
        self.memory.size() == size && self.memory.linear() == linear
    }

    /// Hands start, tolerances and kinds of unknowns to IDA. False where it does not accept the tolerances.
    fn start(&mut self, problem: &dyn DaeProblem, times: &[f64], start: (&[f64], &[f64]), options: &IntegrationOptions) -> bool {
        let (y, yd) = self.memory.state_mut();
        y.copy_from_slice(start.0);
        yd.copy_from_slice(start.1);
        load(self.memory.tolerance_mut(), problem.absolute_tolerance(), |tolerance| tolerance * options.absolute_tolerance_factor);
        load(self.memory.differential_mut(), problem.differential(), |differential| if differential { 1.0 } else { 0.0 });
        let request = Request {
            time: times[0],
            stop_time: times[times.len() - 1],
            relative_tolerance: options.relative_tolerance,
            first_step: options.first_step.unwrap_or(0.0),
            max_step: options.max_step,
            max_steps: options.max_steps.max(1),
            events: problem.event_count(),
        };
        self.memory.start(&request, options.algebraic == AlgebraicErrors::Suppressed)
    }

    fn run(
        &mut self,
        problem: &mut dyn DaeProblem,
        start: f64,
        later: &[f64],
        (y, yd): (&mut [f64], &mut [f64]),
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        let (jacobian, preconditioner) = (&mut self.jacobian, self.preconditioner.as_mut());
        let mut bridge = Bridge { problem, jacobian, preconditioner, residuals: 0, jacobians: 0, products: 0 };
        let mut ending = IntegrationEnding::Finished;
        let mut reached = start;
        for &time in later {
            let (at, result) = self.memory.advance(&mut bridge, time);
            // before the first step IDA's arrays may hold a rejected attempt
            if result.is_ok() || self.memory.statistics().steps > 0 {
                reached = at;
                let state = self.memory.state();
                y.copy_from_slice(state.0);
                yd.copy_from_slice(state.1);
            }
            if let Err(failure) = result {
                ending = failure;
                break;
            }
            if sink(time, y, yd) == Flow::Stop {
                ending = IntegrationEnding::Stopped;
                break;
            }
        }
        let counted = self.memory.statistics();
        IntegrationOutcome {
            ending,
            time: reached,
            steps: counted.steps,
            rejected: counted.rejected,
            convergence_failures: counted.convergence_failures,
            residuals: bridge.residuals,
            jacobians: bridge.jacobians,
            products: bridge.products,
            iterations: counted.iterations,
        }
    }
}

/// The problem as IDA calls it back.
struct Bridge<'a> {
    problem: &'a mut dyn DaeProblem,
    jacobian: &'a mut Matrix,
    preconditioner: Option<&'a mut Factors>,
    residuals: usize,
    jacobians: usize,
    products: usize,
}

impl Bridge<'_> {
    /// Evaluates the matrix.
    fn renew(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64]) -> Result<(), EvalError> {
        self.jacobians += 1;
        self.problem.jacobian(time, c, y, yd, self.jacobian)?;
        self.jacobian.as_slice().chunks_exact(y.len()).try_for_each(finite)
    }
}

impl System for Bridge<'_> {
    fn residual(&mut self, time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        self.residuals += 1;
        self.problem.residual(time, y, yd, residual)?;
        finite(residual)
    }

    fn jacobian(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError> {
        self.renew(time, c, y, yd)?;
        jacobian.copy_from_slice(self.jacobian.as_slice());
        Ok(())
    }

    fn product(&mut self, at: (f64, f64), state: (&[f64], &[f64]), v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        self.products += 1;
        self.problem.product(at, state, v, product)?;
        finite(product)
    }

    fn prepare(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64]) -> Result<bool, EvalError> {
        self.renew(time, c, y, yd)?;
        Ok(self.preconditioner.as_mut().is_some_and(|factors| factors.factorize(self.jacobian.as_slice())))
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        z.copy_from_slice(r);
        if let Some(factors) = &mut self.preconditioner {
            factors.solve(z);
        }
    }

    fn events(&mut self, time: f64, y: &[f64], yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.problem.events(time, y, yd, values)?;
        finite(values)
    }
}

/// Writes one figure per unknown.
fn load<T: Copy>(target: &mut [f64], source: &[T], figure: impl Fn(T) -> f64) {
    assert_eq!(target.len(), source.len(), "one tolerance and one kind per unknown");
    for (target, &source) in target.iter_mut().zip(source) {
        *target = figure(source);
    }
}
