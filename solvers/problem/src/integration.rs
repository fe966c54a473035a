//! Initial value problems and the methods that integrate them.
//!
//! Two problem forms: implicit `0 = F(t, y, ẏ)` for methods that take a residual ([`DaeMethod`]), explicit `ẏ = f(t, y)` for the
//! others ([`OdeMethod`]). Both report the same [`IntegrationOutcome`].

use crate::{EvalError, Matrix};

/// A system `0 = F(t, y, ẏ)`, its inputs included, ready for integration.
pub trait DaeProblem {
    /// Number of unknowns and of equations.
    fn size(&self) -> usize;
    /// Whether the rate of each unknown appears in F.
    fn differential(&self) -> &[bool];
    /// Absolute tolerance of each unknown.
    fn absolute_tolerance(&self) -> &[f64];
    /// Writes F(t, y, ẏ).
    fn residual(&mut self, time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂F/∂y + c ∂F/∂ẏ.
    fn jacobian(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError>;
    /// Writes (∂F/∂y + c ∂F/∂ẏ) v, for linear solvers that need no matrix. Left out, it forms the matrix.
    fn product(&mut self, (time, c): (f64, f64), (y, yd): (&[f64], &[f64]), v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        let mut jacobian = Matrix::zeros(v.len(), v.len());
        self.jacobian(time, c, y, yd, &mut jacobian)?;
        jacobian.times(v, product);
        Ok(())
    }
    /// Number of event functions.
    fn event_count(&self) -> usize {
        0
    }
    /// Writes the event functions; a sign change of one of them stops the integration there.
    fn events(&mut self, _time: f64, _y: &[f64], _yd: &[f64], _values: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }
}

/// A system `ẏ = f(t, y)`, possibly on a manifold that the exact solution never leaves.
pub trait OdeProblem {
    /// Number of states.
    fn size(&self) -> usize;
    /// Absolute tolerance of each state.
    fn absolute_tolerance(&self) -> &[f64];
    /// Writes f(t, y).
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂f/∂y.
    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError>;
    /// Writes ∂f/∂y v, for linear solvers that need no matrix. Left out, it forms the matrix.
    fn product(&mut self, time: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        let mut jacobian = Matrix::zeros(v.len(), v.len());
        self.jacobian(time, y, &mut jacobian)?;
        jacobian.times(v, product);
        Ok(())
    }
    /// Brings y back onto the manifold after an accepted step; does nothing where there is none.
    fn project(&mut self, _time: f64, _y: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }
    /// Number of event functions.
    fn event_count(&self) -> usize {
        0
    }
    /// Writes the event functions; a sign change of one of them stops the integration there.
    fn events(&mut self, _time: f64, _y: &[f64], _values: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }
}

/// What every integrator understands.
#[derive(Clone, Copy, Debug)]
pub struct IntegrationOptions {
    /// Relative tolerance of the local error.
    pub relative_tolerance: f64,
    /// Multiplies all absolute tolerances of the problem.
    pub absolute_tolerance_factor: f64,
    /// First step, s; `None` leaves it to the method.
    pub first_step: Option<f64>,
    /// Longest step, s; infinite where there is no bound.
    pub max_step: f64,
    /// Length of the steps of methods whose steps are all alike, s; the others do not read it.
    pub fixed_step: f64,
    /// Largest number of steps between two sampling times.
    pub max_steps: usize,
    /// Whether algebraic unknowns are part of the error test.
    pub algebraic: AlgebraicErrors,
    /// Where matrices come from: obeyed by who makes the problem.
    pub derivatives: Derivatives,
    /// What solves the linear equations of a step; methods that know only one do not read it.
    pub linear_solver: LinearSolver,
}

impl Default for IntegrationOptions {
    fn default() -> Self {
        Self {
            relative_tolerance: 1e-6,
            absolute_tolerance_factor: 1.0,
            first_step: None,
            max_step: f64::INFINITY,
            fixed_step: 1e-3,
            max_steps: 100_000,
            algebraic: AlgebraicErrors::Suppressed,
            derivatives: Derivatives::Exact,
            linear_solver: LinearSolver::Direct,
        }
    }
}

/// Whether the local error of algebraic unknowns limits the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlgebraicErrors {
    /// It does: index-1 systems.
    Tested,
    /// It does not: multipliers of index-2 systems converge with a lower order than the motion.
    Suppressed,
}

/// Where the matrices of a problem come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivatives {
    /// Exact derivatives of the engine.
    Exact,
    /// Difference quotients of residuals or rates, one per column.
    Differences,
}

impl Derivatives {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Differences => "differences",
        }
    }
}

/// What solves the linear equations of an implicit method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearSolver {
    /// LU factors of the dense matrix.
    Direct,
    /// The generalized minimal residual method: products of the matrix with vectors, each one directional derivative. For the implicit form,
    /// whose equations have other units than its unknowns, preconditioned by the LU factors of an earlier matrix.
    Gmres,
}

impl LinearSolver {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Gmres => "gmres",
        }
    }
}

/// What a method should do after a sample was handed out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// End here; nothing computed is lost.
    Stop,
}

/// How an integration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegrationEnding {
    /// The last sampling time was reached.
    Finished,
    /// An event function changed its sign.
    Event {
        /// Its index.
        event: usize,
        /// Whether it rose.
        rising: bool,
    },
    /// The receiver of the samples asked for it.
    Stopped,
    /// More steps between two sampling times than allowed.
    TooManySteps,
    /// The error test failed again and again, down to the smallest step.
    ErrorTest,
    /// The nonlinear equations of a step did not converge, down to the smallest step.
    Convergence,
    /// The matrix of the nonlinear equations is singular, down to the smallest step.
    Singular,
    /// The start is inconsistent or the tolerances cannot be met.
    Refused,
    /// The system could not be evaluated.
    Evaluation(EvalError),
}

/// What an integrator reports beside the samples.
#[derive(Clone, Copy, Debug)]
pub struct IntegrationOutcome {
    /// How it ended.
    pub ending: IntegrationEnding,
    /// Time reached, s.
    pub time: f64,
    /// Steps taken.
    pub steps: usize,
    /// Steps rejected by the error test.
    pub rejected: usize,
    /// Failures of the nonlinear iteration.
    pub convergence_failures: usize,
    /// Evaluations of F or f, those for difference quotients included.
    pub residuals: usize,
    /// Jacobian evaluations.
    pub jacobians: usize,
    /// Products of the Jacobian with a vector, for linear solvers without matrix.
    pub products: usize,
    /// Nonlinear iterations (linear solves).
    pub iterations: usize,
}

impl IntegrationOutcome {
    /// The outcome of an integration that has not begun.
    pub fn nothing_done(ending: IntegrationEnding, time: f64) -> Self {
        Self { ending, time, steps: 0, rejected: 0, convergence_failures: 0, residuals: 0, jacobians: 0, products: 0, iterations: 0 }
    }
}

/// Receives a sample: time, y and ẏ.
pub type Sink<'a> = &'a mut dyn FnMut(f64, &[f64], &[f64]) -> Flow;

/// A method for implicit systems. One per task: it owns its work arrays.
pub trait DaeMethod: Send {
    /// Name on the command line.
    fn name(&self) -> &'static str;
    /// Integrates from `times[0]`, where `y` and `yd` must be consistent, through all `times` (increasing).
    ///
    /// Each time, the first included, is handed to `sink`. At the end `y` and `yd` are those of the time reached (of the event,
    /// where one ended it), which the outcome states.
    fn integrate(
        &mut self,
        problem: &mut dyn DaeProblem,
        times: &[f64],
        state: (&mut [f64], &mut [f64]),
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome;
}

/// A method for explicit systems. One per task: it owns its work arrays.
pub trait OdeMethod: Send {
    /// Name on the command line.
    fn name(&self) -> &'static str;
    /// Integrates from `times[0]` through all `times` (increasing), as [`DaeMethod::integrate`] does.
    fn integrate(
        &mut self,
        problem: &mut dyn OdeProblem,
        times: &[f64],
        y: &mut [f64],
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome;
}
