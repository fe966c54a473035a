//! The methods of the package `diffsol` behind the vocabulary of `problem`.
//!
//! `diffsol_bdf`: backward differentiation of orders 1 to 5; `diffsol_esdirk34`: a diagonally implicit pair of orders 3 and 4, L-stable;
//! `diffsol_tsit45`: the explicit pair of Tsitouras of orders 5 and 4. All on the explicit form with exact matrices. Samples and events are read
//! from the interpolation of the package. Steps are not projected, since a method forgets its history where its point is moved: samples are
//! brought onto the manifold, and where a step ends too far off it, the next one starts anew on it: a whole tolerance for Runge–Kutta methods,
//! to which that costs one evaluation, a hundred for backward differentiation, which begins again with order 1 and whose errors add up to as much.
//!
//! Sources: M. Robinson, A. Allmont, *diffsol*, J. Open Source Software 2025 and its documentation; G. D. Byrne, A. C. Hindmarsh, ACM Trans.
//! Math. Software 1, 1975, 71–96 (BDF with fixed leading coefficient in backward differences: L. F. Shampine, M. W. Reichelt, SIAM J. Sci.
//! Comput. 18, 1997, 1–22); L. M. Skvortsov (ESDIRK34); Ch. Tsitouras, Comput. Math. Appl. 62, 2011, 770–775.

use crate::path::{Path, Reached, Roots, follow};
use crate::step_control::{CUT, MAX_CUTS, Tolerances};
use diffsol::error::OdeSolverError;
use diffsol::{DiffsolError, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, Vector, VectorCommon};
use problem::contract::{acceptable, check_times, finite, without_unknowns};
use problem::{EvalError, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Matrix, OdeMethod, OdeProblem, Sink};
use std::cell::RefCell;

type Solver = NalgebraLU<f64>;

/// Which of its methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Formulas {
    Bdf,
    Esdirk34,
    Tsit45,
}

/// A method of `diffsol`. It is made anew for every integration.
#[derive(Debug)]
pub struct Diffsol {
    formulas: Formulas,
    tolerances: Tolerances,
    roots: Roots,
}

impl Diffsol {
    /// Distance from the manifold, in tolerances, from which on a step starts anew on it.
    fn drift(&self) -> f64 {
        if self.formulas == Formulas::Bdf { 100.0 } else { 1.0 }
    }

    fn of(formulas: Formulas) -> Self {
        Self { formulas, tolerances: Tolerances::default(), roots: Roots::default() }
    }

    /// Backward differentiation of variable order.
    pub fn bdf() -> Self {
        Self::of(Formulas::Bdf)
    }

    /// Diagonally implicit Runge–Kutta.
    pub fn esdirk34() -> Self {
        Self::of(Formulas::Esdirk34)
    }

    /// Explicit Runge–Kutta.
    pub fn tsit45() -> Self {
        Self::of(Formulas::Tsit45)
    }
}

impl OdeMethod for Diffsol {
    fn name(&self) -> &'static str {
        match self.formulas {
            Formulas::Bdf => "diffsol_bdf",
            Formulas::Esdirk34 => "diffsol_esdirk34",
            Formulas::Tsit45 => "diffsol_tsit45",
        }
    }

    /// Integrates until the last time, an event, or a failure.
    ///
    /// The point of an event is not handed to the sink. After a failure `y` is that at the end of the last step that succeeded.
    ///
    /// # Panics
    /// Where lengths disagree, times decrease or there is none.
    fn integrate(
        &mut self,
        problem: &mut dyn OdeProblem,
        times: &[f64],
        y: &mut [f64],
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        let size = problem.size();
        assert_eq!(y.len(), size, "one start value per unknown");
        check_times(times);
        self.tolerances.set(problem.absolute_tolerance(), options);
        if !acceptable(options) || !self.tolerances.usable() {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        if size == 0 {
            return without_unknowns(times, sink);
        }
        let shared = RefCell::new(Shared { problem, matrix: Matrix::zeros(size, size), at: None, residuals: 0, jacobians: 0, error: None });
        let mut rates = vec![0.0; size];
        if let Err(error) = shared.borrow_mut().rates(times[0], y, &mut rates) {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Evaluation(error), times[0]);
        }
        let start = y.to_vec();
        let mut builder = OdeBuilder::<NalgebraMat<f64>>::new()
            .t0(times[0])
            .rtol(options.relative_tolerance)
            .atol(self.tolerances.absolute().to_vec())
            .rhs_implicit(
                |y: &[f64], _: &[f64], time: f64, yd: &mut [f64]| shared.borrow_mut().answer(time, y, yd),
                |y: &[f64], _: &[f64], time: f64, along: &[f64], yd: &mut [f64]| shared.borrow_mut().product(time, y, along, yd),
            )
            .init(|_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&start), size);
        if let Some(step) = options.first_step {
            builder = builder.h0(step);
        }
        let run = Following { drift: self.drift(), shared: &shared, tolerances: &self.tolerances, roots: &mut self.roots, options, times };
        let begun = builder.build().and_then(|made| match self.formulas {
            Formulas::Bdf => made.bdf::<Solver>().map(|solver| run.follow(solver, (y, &mut rates), sink)),
            Formulas::Esdirk34 => made.esdirk34::<Solver>().map(|solver| run.follow(solver, (y, &mut rates), sink)),
            Formulas::Tsit45 => made.tsit45().map(|solver| run.follow(solver, (y, &mut rates), sink)),
        });
        let error = shared.borrow().error.map(|(_, error)| error);
        begun.unwrap_or_else(|_| {
            let ending = error.map_or(IntegrationEnding::Refused, IntegrationEnding::Evaluation);
            IntegrationOutcome::nothing_done(ending, times[0])
        })
    }
}

/// The problem as `diffsol` calls it back.
struct Shared<'a> {
    problem: &'a mut dyn OdeProblem,
    matrix: Matrix,
    /// Where the matrix belongs to.
    at: Option<(f64, Vec<f64>)>,
    residuals: usize,
    jacobians: usize,
    /// Where and why an evaluation failed that no step has passed since.
    error: Option<(f64, EvalError)>,
}

impl Shared<'_> {
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.residuals += 1;
        // points that are no numbers follow from an error before
        finite(y).map_err(|error| self.error.get_or_insert((time, error)).1)?;
        self.problem.rates(time, y, yd).and_then(|()| finite(yd)).map_err(|error| self.error.insert((time, error)).1)
    }

    /// What cannot be evaluated is no number: the package rejects the step.
    fn answer(&mut self, time: f64, y: &[f64], yd: &mut [f64]) {
        if self.rates(time, y, yd).is_err() {
            yd.fill(f64::NAN);
        }
    }

    /// ∂f/∂y in a direction; one matrix serves all directions of a point.
    fn product(&mut self, time: f64, y: &[f64], along: &[f64], yd: &mut [f64]) {
        if !self.at.as_ref().is_some_and(|(t, at)| *t == time && at == y) {
            self.jacobians += 1;
            self.at = None;
            match finite(y).and_then(|()| self.problem.jacobian(time, y, &mut self.matrix)) {
                Ok(()) => self.at = Some((time, y.to_vec())),
                Err(error) => {
                    self.error.get_or_insert((time, error));
                    return yd.fill(f64::NAN);
                }
            }
        }
        yd.fill(0.0);
        for (j, share) in along.iter().enumerate().filter(|(_, share)| **share != 0.0) {
            yd.iter_mut().zip(self.matrix.column(j)).for_each(|(y, entry)| *y += share * entry);
        }
    }
}

/// All that an integration needs beside the solver.
struct Following<'a, 'p> {
    drift: f64,
    shared: &'a RefCell<Shared<'p>>,
    tolerances: &'a Tolerances,
    roots: &'a mut Roots,
    options: &'a IntegrationOptions,
    times: &'a [f64],
}

impl Following<'_, '_> {
    fn follow<'e, E, S>(self, solver: S, (y, yd): (&mut [f64], &mut [f64]), sink: Sink<'_>) -> IntegrationOutcome
    where
        E: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'e,
        S: OdeSolverMethod<'e, E>,
    {
        let start = self.times[0];
        let mut run = Run {
            buffer: solver.state().y.clone(),
            solver,
            shared: self.shared,
            tolerances: self.tolerances,
            max_step: self.options.max_step,
            drift: self.drift,
            stop: None,
            span: (start, start),
            landed: y.to_vec(),
            drifted: false,
            equations: std::marker::PhantomData,
        };
        let Reached { ending, time, steps } = follow(&mut run, self.times, (y, yd), self.options.max_steps, self.roots, sink);
        let (counted, shared) = (run.solver.get_statistics(), self.shared.borrow());
        IntegrationOutcome {
            ending,
            time,
            steps,
            rejected: counted.number_of_error_test_failures,
            convergence_failures: counted.number_of_nonlinear_solver_fails,
            residuals: shared.residuals,
            jacobians: shared.jacobians,
            products: 0,
            iterations: counted.number_of_nonlinear_solver_iterations,
        }
    }
}

/// One integration under way.
struct Run<'a, 'p, E, S> {
    solver: S,
    shared: &'a RefCell<Shared<'p>>,
    tolerances: &'a Tolerances,
    max_step: f64,
    drift: f64,
    /// The time that the solver was told not to pass.
    stop: Option<f64>,
    span: (f64, f64),
    buffer: NalgebraVec<f64>,
    /// The end of the last step on the manifold.
    landed: Vec<f64>,
    /// Whether that is too far away.
    drifted: bool,
    equations: std::marker::PhantomData<E>,
}

impl<'e, E, S> Run<'_, '_, E, S>
where
    E: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'e,
    S: OdeSolverMethod<'e, E>,
{
    /// Starts anew at the end of the last step, on the manifold, with a step of length h.
    fn restart(&mut self, h: f64) -> Result<(), EvalError> {
        let state = self.solver.state_mut();
        (*state.t, *state.h) = (self.span.1, h);
        state.y.inner_mut().as_mut_slice().copy_from_slice(&self.landed);
        self.shared.borrow_mut().rates(self.span.1, &self.landed, state.dy.inner_mut().as_mut_slice())
    }

    /// Tries a step; what failed and its length where it came to nothing.
    fn attempt(&mut self, limit: f64) -> Result<(), (IntegrationEnding, f64)> {
        let (begin, h) = (self.span.1, self.solver.state().h);
        let stop = limit.min(begin + self.max_step);
        if self.stop != Some(stop) {
            self.solver.set_stop_time(stop).map_err(|_| (IntegrationEnding::ErrorTest, h))?;
            self.stop = Some(stop);
        }
        let stepped = self.solver.step();
        let error = self.shared.borrow().error.map(|(_, error)| error);
        let state = self.solver.state();
        // a point that is no number passes the error test of the package
        let ending = match stepped {
            Ok(_) if state.t > begin && finite(state.y.inner().as_slice()).is_ok() => return Ok(()),
            Ok(_) => IntegrationEnding::ErrorTest,
            Err(error) => meaning(&error),
        };
        Err((error.map_or(ending, IntegrationEnding::Evaluation), h))
    }
}

impl<'e, E, S> Path for Run<'_, '_, E, S>
where
    E: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'e,
    S: OdeSolverMethod<'e, E>,
{
    fn step(&mut self, limit: f64) -> Result<(), IntegrationEnding> {
        if self.drifted {
            self.restart(self.solver.state().h).map_err(IntegrationEnding::Evaluation)?;
        }
        let (mut cuts, mut told) = (0, None);
        while let Err((ending, h)) = self.attempt(limit) {
            let recoverable = matches!(ending, IntegrationEnding::Evaluation(EvalError::Recoverable { .. }));
            // after an evaluation that failed, short steps are its consequence
            let ending = *told.get_or_insert(ending);
            cuts += 1;
            if !recoverable || cuts > MAX_CUTS || self.restart(CUT * h).is_err() {
                return Err(ending);
            }
        }
        let state = self.solver.state();
        let end = state.y.inner().as_slice();
        self.landed.copy_from_slice(end);
        self.span = (self.span.1, state.t);
        let mut shared = self.shared.borrow_mut();
        shared.error = shared.error.filter(|(failed, _)| *failed > state.t);
        shared.problem.project(state.t, &mut self.landed).map_err(IntegrationEnding::Evaluation)?;
        let moved = self.landed.iter().zip(end).map(|(to, from)| to - from).enumerate();
        self.drifted = self.tolerances.norm(end, moved) > self.drift;
        Ok(())
    }

    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn point(&mut self, time: f64, y: &mut [f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let mut shared = self.shared.borrow_mut();
        if time == self.span.1 {
            y.copy_from_slice(&self.landed);
        } else if self.solver.interpolate_inplace(time, &mut self.buffer).is_ok() {
            y.copy_from_slice(self.buffer.inner().as_slice());
            shared.problem.project(time, y)?;
        } else {
            return Err(EvalError::Fatal { equation: 0 });
        }
        shared.rates(time, y, yd)
    }

    fn event_count(&self) -> usize {
        self.shared.borrow().problem.event_count()
    }

    fn events(&mut self, time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.shared.borrow_mut().problem.events(time, y, values)?;
        finite(values)
    }
}

/// What an error of the package says about the integration.
fn meaning(error: &DiffsolError) -> IntegrationEnding {
    match error {
        DiffsolError::OdeSolverError(OdeSolverError::TooManyNonlinearSolverFailures { .. }) | DiffsolError::NonLinearSolverError(_) => {
            IntegrationEnding::Convergence
        }
        DiffsolError::LaError(_) => IntegrationEnding::Singular,
        _ => IntegrationEnding::ErrorTest,
    }
}
