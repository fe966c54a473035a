//! ERKStep and ARKStep of ARKODE: Runge–Kutta pairs for explicit systems, an explicit one of high order and a diagonally implicit one.
//!
//! ẏ = f(t, y). y₁ = y₀ + h Σ bᵢ kᵢ with kᵢ = f(t₀ + cᵢ h, y₀ + h Σ aᵢⱼ kⱼ), j < i or j ≤ i; a step is accepted where the difference to the
//! embedded solution, in the norm ‖e‖ = √(Σ (eᵢ/(rtol |yᵢ| + atolᵢ))² / n), is below one. Then `project` brings y₁ back onto the
//! manifold, and f is evaluated there, so that no step ends where the next one could not begin.
//!
//! Samples are ends of steps. ARKODE interpolates with polynomials of degree five at most, which at tight tolerances lose
//! two or three digits against steps of this order. Dense sampling therefore costs at least one step per sample. For the same reason
//! events are found by steps: where a sign changes, the root is bracketed by stepping again, not on a polynomial.
//!
//! Source: J. H. Verner, *Numerically optimal Runge–Kutta pairs with interpolants*, Numerical Algorithms 53, 2010, 383–396, the
//! pair of orders 8 and 7; C. A. Kennedy, M. H. Carpenter, *Diagonally implicit Runge–Kutta methods for stiff ODEs*, Appl. Numer. Math. 146,
//! 2019, 221–244, the L-stable pair ESDIRK5(4)7L\[2\]SA₂ of orders 5 and 4; D. R. Reynolds, D. J. Gardner, C. S. Woodward, R. Chinomona, *User Documentation for ARKODE*, LLNL,
//! section “Mathematical considerations”. Root: M. Dowell, P. Jarratt, *A modified regula falsi method for computing the root
//! of an equation*, BIT 11, 1971, 168–174 (“Illinois”).

use crate::raw::arkode::{Memory, Step, System, Table};
use problem::contract::{acceptable, check_times, coincide, crossed, finite, resolution, secant, without_unknowns};
use problem::{
    EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, LinearSolver, Matrix, OdeMethod, OdeProblem, Sink,
};
use std::mem::swap;

/// The explicit pair.
const VERNER: Table = Table::Explicit(c"ARKODE_VERNER_13_7_8");
/// The diagonally implicit pair.
const KENNEDY_CARPENTER: Table = Table::Implicit(c"ARKODE_ESDIRK547L2SA2_7_4_5");
/// How often a step is shortened before a point counts as impossible to evaluate; as many times as IDA tries.
const MAX_CUTS: usize = 10;
/// By how much, each time; IDA's figure.
const CUT: f64 = 0.25;
/// First step, in units of the time to go, where ARKODE could not evaluate what it needs for its own choice; IDA's figure.
const FIRST: f64 = 1e-3;

/// A Runge–Kutta method with projection after each step.
///
/// Keeps its integrator between problems of the same size.
pub struct RungeKutta {
    table: Table,
    name: &'static str,
    work: Option<Work>,
}

impl RungeKutta {
    /// Explicit, order 8.
    pub fn explicit() -> Self {
        Self { table: VERNER, name: "erk", work: None }
    }

    /// Diagonally implicit, order 5, L-stable, with exact matrices or by [`problem::LinearSolver::Gmres`].
    pub fn implicit() -> Self {
        Self { table: KENNEDY_CARPENTER, name: "dirk", work: None }
    }
}

/// Everything that depends on the size of the problem.
struct Work {
    memory: Memory,
    rates: Rates,
    /// Matrix as the problem writes it, then copied to ARKODE.
    jacobian: Matrix,
    /// The last point accepted.
    before: Point,
    /// The point to be accepted.
    after: Point,
    /// A point behind a root.
    beyond: Point,
}

/// A point of the trajectory with its event functions.
#[derive(Clone)]
struct Point {
    time: f64,
    y: Vec<f64>,
    events: Vec<f64>,
}

/// An end of the bracket around a root.
#[derive(PartialEq)]
enum End {
    Before,
    Beyond,
}

/// Rates at the end of the last step; the next step, and the sample there, need not evaluate them again.
struct Rates {
    time: f64,
    y: Vec<f64>,
    yd: Vec<f64>,
}

impl OdeMethod for RungeKutta {
    fn name(&self) -> &'static str {
        self.name
    }

    /// Integrates until the last time, an event, or a failure.
    ///
    /// The point of an event is not handed to the sink. After a failure `y` is that at the end of the last step that succeeded.
    /// Steps that were shortened because they could not be evaluated count as convergence failures.
    ///
    /// # Panics
    /// Where lengths disagree, times decrease or there is none; where the problem or the sink panics, with their panic.
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
        if !acceptable(options) {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        if size == 0 {
            return without_unknowns(times, sink);
        }
        let linear = options.linear_solver;
        let work = self.work.take().filter(|work| work.fits(size, linear)).unwrap_or_else(|| Work::new(size, self.table, linear));
        let work = self.work.insert(work);
        if !work.start(problem, times[0], y, options) {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        let bridge = Bridge { problem, rates: &mut work.rates, jacobian: &mut work.jacobian, residuals: 0, jacobians: 0, products: 0 };
        let Work { memory, before, after, beyond, .. } = work;
        let mut run = Run { memory, bridge, before, after, beyond, max_steps: options.max_steps, steps: 0, cuts: 0 };
        let ending = run.visit(times, sink).err().unwrap_or(IntegrationEnding::Finished);
        run.outcome(ending, y)
    }
}

impl Work {
    fn fits(&self, size: usize, linear: LinearSolver) -> bool {
        self.memory.size() == size && self.memory.linear().is_none_or(|own| own == linear)
    }

    fn new(size: usize, table: Table, linear: LinearSolver) -> Self {
        let point = Point { time: 0.0, y: vec![0.0; size], events: Vec::new() };
        let rates = Rates { time: f64::NAN, y: vec![0.0; size], yd: vec![0.0; size] };
        Self {
            memory: Memory::new(size, table, linear),
            rates,
            jacobian: Matrix::zeros(size, size),
            before: point.clone(),
            after: point.clone(),
            beyond: point,
        }
    }

    /// Hands start and tolerances to ARKODE. False where it does not accept the tolerances.
    fn start(&mut self, problem: &dyn OdeProblem, time: f64, y: &[f64], options: &IntegrationOptions) -> bool {
        let absolute = problem.absolute_tolerance();
        assert_eq!(absolute.len(), y.len(), "one tolerance per unknown");
        for (tolerance, absolute) in self.memory.tolerance_mut().iter_mut().zip(absolute) {
            *tolerance = absolute * options.absolute_tolerance_factor;
        }
        // what is known of another problem says nothing about this one
        self.rates.time = f64::NAN;
        for point in [&mut self.before, &mut self.after, &mut self.beyond] {
            point.events.resize(problem.event_count(), 0.0);
        }
        self.before.time = time;
        self.before.y.copy_from_slice(y);
        self.memory.start(time, y, options.relative_tolerance, options.first_step.unwrap_or(0.0), options.max_step)
    }
}

/// One integration under way.
struct Run<'a> {
    memory: &'a mut Memory,
    bridge: Bridge<'a>,
    before: &'a mut Point,
    after: &'a mut Point,
    beyond: &'a mut Point,
    max_steps: usize,
    steps: usize,
    cuts: usize,
}

impl Run<'_> {
    /// Visits all times, or returns what ended the integration before.
    fn visit(&mut self, times: &[f64], sink: Sink<'_>) -> Result<(), IntegrationEnding> {
        let started = self.bridge.renew(self.before.time, &self.before.y).and_then(|()| self.bridge.events(self.before));
        started.map_err(IntegrationEnding::Evaluation)?;
        for &time in times {
            self.advance(time)?;
            if sink(time, &self.before.y, &self.bridge.rates.yd) == Flow::Stop {
                return Err(IntegrationEnding::Stopped);
            }
        }
        Ok(())
    }

    /// Steps until exactly `time`.
    fn advance(&mut self, time: f64) -> Result<(), IntegrationEnding> {
        let allowed = self.steps + self.max_steps.max(1);
        while !coincide(self.before.time, time) {
            if self.steps == allowed {
                return Err(IntegrationEnding::TooManySteps);
            }
            self.step(time)?;
            self.steps += 1;
            if crossed(&self.before.events, &self.after.events).is_some() {
                return Err(self.event()?);
            }
            swap(self.before, self.after);
        }
        self.before.time = time;
        Ok(())
    }

    /// Takes one step from `before` to `after` that does not pass `time`; shortens it where it cannot be evaluated.
    fn step(&mut self, time: f64) -> Result<(), IntegrationEnding> {
        let mut smallest = IntegrationEnding::ErrorTest;
        for _ in 0..=MAX_CUTS {
            match self.memory.step(&mut self.bridge, time) {
                // ARKODE would go on with steps that rounding swallows
                Step::Taken(reached) if reached <= self.before.time => return Err(smallest),
                Step::Taken(reached) => {
                    self.after.time = reached;
                    self.after.y.copy_from_slice(self.memory.state());
                    return self.bridge.events(self.after).map_err(IntegrationEnding::Evaluation);
                }
                Step::Unevaluated(error) => {
                    smallest = IntegrationEnding::Evaluation(error);
                    self.cuts += 1;
                    let tried = self.memory.current_step();
                    let step = if tried > 0.0 { CUT * tried } else { FIRST * (time - self.before.time) };
                    self.memory.resume(self.before.time, &self.before.y, step);
                }
                Step::Failed(ending) => return Err(ending),
            }
        }
        Err(smallest)
    }

    /// Narrows the bracket of `before` and `after` around the first root until rounding is all that separates them, and moves
    /// to its end, where the sign has changed.
    fn event(&mut self) -> Result<IntegrationEnding, IntegrationEnding> {
        swap(self.after, self.beyond);
        let (mut weight_before, mut weight_beyond) = (1.0, 1.0);
        let mut moved = None;
        loop {
            let width = self.beyond.time - self.before.time;
            let resolution = resolution(self.before.time, self.beyond.time);
            if width <= resolution {
                break;
            }
            // the earliest of the secants, not too close to either end, so that the bracket closes from both sides
            let share = secant(&self.before.events, &self.beyond.events, weight_before, weight_beyond);
            let step = (share * width).clamp(0.5 * resolution, width - 0.5 * resolution);
            self.memory.resume(self.before.time, &self.before.y, step);
            self.step(self.before.time + step)?;
            // an end that stays twice in a row loses half of its weight
            if crossed(&self.before.events, &self.after.events).is_some() {
                swap(self.beyond, self.after);
                weight_beyond = 1.0;
                weight_before *= if moved == Some(End::Beyond) { 0.5 } else { 1.0 };
                moved = Some(End::Beyond);
            } else {
                swap(self.before, self.after);
                weight_before = 1.0;
                weight_beyond *= if moved == Some(End::Before) { 0.5 } else { 1.0 };
                moved = Some(End::Before);
            }
        }
        let event = crossed(&self.before.events, &self.beyond.events).unwrap_or(0);
        let rising = self.before.events[event] < 0.0;
        swap(self.before, self.beyond);
        Ok(IntegrationEnding::Event { event, rising })
    }

    fn outcome(self, ending: IntegrationEnding, y: &mut [f64]) -> IntegrationOutcome {
        y.copy_from_slice(&self.before.y);
        let (iterations, failures) = self.memory.iterations();
        IntegrationOutcome {
            ending,
            time: self.before.time,
            steps: self.steps,
            rejected: self.memory.rejected(),
            convergence_failures: self.cuts + failures,
            residuals: self.bridge.residuals,
            jacobians: self.bridge.jacobians,
            products: self.bridge.products,
            iterations,
        }
    }
}

/// The problem as ARKODE calls it back.
struct Bridge<'a> {
    problem: &'a mut dyn OdeProblem,
    rates: &'a mut Rates,
    jacobian: &'a mut Matrix,
    residuals: usize,
    jacobians: usize,
    products: usize,
}

impl Bridge<'_> {
    /// Evaluates the rates at the end of a step and keeps them.
    fn renew(&mut self, time: f64, y: &[f64]) -> Result<(), EvalError> {
        self.residuals += 1;
        self.rates.time = f64::NAN;
        self.problem.rates(time, y, &mut self.rates.yd)?;
        finite(&self.rates.yd)?;
        self.rates.time = time;
        self.rates.y.copy_from_slice(y);
        Ok(())
    }

    /// Evaluates the event functions of a point.
    fn events(&mut self, point: &mut Point) -> Result<(), EvalError> {
        if !point.events.is_empty() {
            self.problem.events(point.time, &point.y, &mut point.events)?;
        }
        finite(&point.events)
    }
}

impl System for Bridge<'_> {
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        if time == self.rates.time && y == self.rates.y {
            yd.copy_from_slice(&self.rates.yd);
            return Ok(());
        }
        self.residuals += 1;
        self.problem.rates(time, y, yd)?;
        finite(yd)
    }

    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError> {
        self.jacobians += 1;
        self.problem.jacobian(time, y, self.jacobian)?;
        self.jacobian.as_slice().chunks_exact(y.len()).try_for_each(finite)?;
        jacobian.copy_from_slice(self.jacobian.as_slice());
        Ok(())
    }

    fn product(&mut self, time: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        self.products += 1;
        self.problem.product(time, y, v, product)?;
        finite(product)
    }

    fn accept(&mut self, time: f64, y: &mut [f64]) -> Result<(), EvalError> {
        self.problem.project(time, y)?;
        finite(y)?;
        self.renew(time, y)
    }
}
