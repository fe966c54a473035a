//! CVODE: multistep methods of variable order and step for explicit systems.
//!
//! ẏ = f(t, y). Σ αᵢ yₙ₋ᵢ + h Σ βᵢ ẏₙ₋ᵢ = 0 through the last points, Adams–Moulton of orders 1 to 12 for motions without stiffness or backward
//! differentiation of orders 1 to 5 for stiff ones. A step is accepted where the estimated local error, in the norm
//! ‖e‖ = √(Σ (eᵢ/(rtol |yᵢ| + atolᵢ))² / n), is below one. Samples are values of the polynomial of the last step, brought onto the manifold.
//!
//! Backward differentiation is projected after each step. Adams formulas are not: their memory would not bear it. They drift within the
//! tolerances, and where a sample is found a whole tolerance off the manifold, the integration starts anew on it.
//!
//! Source: A. C. Hindmarsh, R. Serban, C. J. Balos, D. J. Gardner, D. R. Reynolds, C. S. Woodward, *User Documentation for CVODE*, LLNL,
//! section “Mathematical considerations”; E. Eich, *Convergence results for a coordinate projection method applied to mechanical systems
//! with algebraic constraints*, SIAM J. Numer. Anal. 30, 1993, 1467–1482.

use crate::raw::cvode::{Family, Memory, System};
use crate::raw::integrator::{Request, Statistics};
use problem::contract::{acceptable, check_times, coincide, finite};
use problem::{
    EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, LinearSolver, Matrix, OdeMethod, OdeProblem, Sink,
};

/// CVODE with one of its two families of formulas, backward differentiation with matrices or by [`problem::LinearSolver::Gmres`].
///
/// Keeps its integrator between problems of the same size.
pub struct Cvode {
    family: Family,
    name: &'static str,
    work: Option<Work>,
    /// Matrix as the problem writes it, then copied to CVODE.
    jacobian: Matrix,
}

/// Everything that depends on the size of the problem.
struct Work {
    memory: Memory,
    /// A sample on the manifold.
    sample: Vec<f64>,
    /// Its rates.
    rates: Vec<f64>,
}

impl Cvode {
    /// Adams–Moulton formulas.
    pub fn adams() -> Self {
        Self { family: Family::Adams, name: "cvode_adams", work: None, jacobian: Matrix::default() }
    }

    /// Backward differentiation formulas.
    pub fn bdf() -> Self {
        Self { family: Family::Bdf, name: "cvode", work: None, jacobian: Matrix::default() }
    }
}

impl OdeMethod for Cvode {
    fn name(&self) -> &'static str {
        self.name
    }

    /// Integrates until the last time, an event, or a failure.
    ///
    /// The point of an event is not handed to the sink. After a failure `y` is that at the end of the last step that succeeded, which may lie
    /// behind the last sample.
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
        let family = self.family;
        let linear = options.linear_solver;
        let work = self.work.take().filter(|work| work.fits(size, linear)).unwrap_or_else(|| Work::new(size, family, linear));
        let work = self.work.insert(work);
        if self.jacobian.columns() != size {
            self.jacobian = Matrix::zeros(size, size);
        }
        let bridge = Bridge { problem, jacobian: &mut self.jacobian, residuals: 0, jacobians: 0, products: 0 };
        let absolute = bridge.problem.absolute_tolerance();
        assert_eq!(absolute.len(), size, "one tolerance per unknown");
        for (tolerance, absolute) in work.memory.tolerance_mut().iter_mut().zip(absolute) {
            *tolerance = absolute * options.absolute_tolerance_factor;
        }
        let mut run = Run { family, bridge, work, options, time: times[0], started: false, before: Statistics::default() };
        let ending = run.visit(times, y, sink).err().unwrap_or(IntegrationEnding::Finished);
        run.outcome(ending)
    }
}

impl Work {
    fn new(size: usize, family: Family, linear: LinearSolver) -> Self {
        Self { memory: Memory::new(size.max(1), family, linear), sample: vec![0.0; size], rates: vec![0.0; size] }
    }

    fn fits(&self, size: usize, linear: LinearSolver) -> bool {
        self.sample.len() == size && self.memory.linear().is_none_or(|own| own == linear)
    }
}

/// One integration under way.
struct Run<'a> {
    family: Family,
    bridge: Bridge<'a>,
    work: &'a mut Work,
    options: &'a IntegrationOptions,
    /// Time reached.
    time: f64,
    /// Whether CVODE has begun.
    started: bool,
    /// Work before its last start.
    before: Statistics,
}

impl Run<'_> {
    /// Visits all times, or returns what ended the integration before. `y` follows.
    fn visit(&mut self, times: &[f64], y: &mut [f64], sink: Sink<'_>) -> Result<(), IntegrationEnding> {
        let stop_time = times[times.len() - 1];
        let mut running = false;
        for &time in times {
            // the start itself, and whatever cannot be told from it
            if !y.is_empty() && !coincide(times[0], time) {
                if !running && !self.start(y, stop_time) {
                    return Err(IntegrationEnding::Refused);
                }
                running = self.advance(time, y)?;
            }
            self.time = time;
            self.bridge.evaluate(time, y, &mut self.work.rates).map_err(IntegrationEnding::Evaluation)?;
            if sink(time, y, &self.work.rates) == Flow::Stop {
                return Err(IntegrationEnding::Stopped);
            }
        }
        Ok(())
    }

    fn start(&mut self, y: &[f64], stop_time: f64) -> bool {
        let request = Request {
            time: self.time,
            stop_time,
            relative_tolerance: self.options.relative_tolerance,
            first_step: self.options.first_step.unwrap_or(0.0),
            max_step: self.options.max_step,
            max_steps: self.options.max_steps.max(1),
            events: self.bridge.problem.event_count(),
        };
        self.before = self.counted();
        self.started = true;
        self.work.memory.start(y, &request)
    }

    /// Work so far.
    fn counted(&self) -> Statistics {
        let since = if self.started { self.work.memory.statistics() } else { Statistics::default() };
        self.before.sum(since)
    }

    /// Integrates to `time` and brings the point onto the manifold. False where the next piece has to start anew.
    fn advance(&mut self, time: f64, y: &mut [f64]) -> Result<bool, IntegrationEnding> {
        let (reached, result) = self.work.memory.advance(&mut self.bridge, time);
        // before the first step the arrays of CVODE may hold a rejected attempt
        if result.is_ok() || self.work.memory.statistics().steps > 0 {
            self.time = reached;
            y.copy_from_slice(self.work.memory.state());
        }
        match result {
            Ok(()) => self.land(y).map(|drifted| !drifted).map_err(IntegrationEnding::Evaluation),
            Err(event @ IntegrationEnding::Event { .. }) => {
                self.land(y).map_err(IntegrationEnding::Evaluation)?;
                Err(event)
            }
            Err(failure) => Err(failure),
        }
    }

    /// Brings a point onto the manifold. True where Adams formulas have drifted by more than their tolerance.
    fn land(&mut self, y: &mut [f64]) -> Result<bool, EvalError> {
        let sample = &mut self.work.sample;
        sample.copy_from_slice(y);
        self.bridge.problem.project(self.time, sample)?;
        finite(sample)?;
        let (relative, absolute) = (self.options.relative_tolerance, self.work.memory.tolerance_mut());
        let off = |((to, from), absolute): ((&f64, &f64), &f64)| ((to - from) / (relative * from.abs() + absolute)).powi(2);
        let moved = sample.iter().zip(&*y).zip(&*absolute).map(off).sum::<f64>() / y.len() as f64;
        y.copy_from_slice(sample);
        Ok(self.family == Family::Adams && moved > 1.0)
    }

    fn outcome(self, ending: IntegrationEnding) -> IntegrationOutcome {
        let counted = self.counted();
        IntegrationOutcome {
            ending,
            time: self.time,
            steps: counted.steps,
            rejected: counted.rejected,
            convergence_failures: counted.convergence_failures,
            residuals: self.bridge.residuals,
            jacobians: self.bridge.jacobians,
            products: self.bridge.products,
            iterations: counted.iterations,
        }
    }
}

/// The problem as CVODE calls it back.
struct Bridge<'a> {
    problem: &'a mut dyn OdeProblem,
    jacobian: &'a mut Matrix,
    residuals: usize,
    jacobians: usize,
    products: usize,
}

impl Bridge<'_> {
    fn evaluate(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.residuals += 1;
        self.problem.rates(time, y, yd)?;
        finite(yd)
    }
}

impl System for Bridge<'_> {
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(time, y, yd)
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

    fn correction(&mut self, time: f64, y: &[f64], correction: &mut [f64]) -> Result<(), EvalError> {
        correction.copy_from_slice(y);
        self.problem.project(time, correction)?;
        correction.iter_mut().zip(y).for_each(|(c, y)| *c -= y);
        finite(correction)
    }

    fn events(&mut self, time: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.problem.events(time, y, values)?;
        finite(values)
    }
}
