//! The explicit Runge–Kutta pair of Dormand and Prince, with its own interpolation.
//!
//! ẏ = f(t, y). Seven stages, the last of which is the first of the next step; order 5, error estimate of order 4, continuous extension of
//! order 4, from which samples and events are read without shortening a step. Accepted points are brought back onto the manifold.
//!
//! Source: J. R. Dormand, P. J. Prince, *A family of embedded Runge–Kutta formulae*, J. Comput. Appl. Math. 6, 1980, 19–26; E. Hairer,
//! S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, Springer 1993, table II.5.2, section II.6 (6.12) and the code DOPRI5;
//! first step: section II.4, algorithm (4.14).

use crate::path::{Path, Reached, Roots, follow};
use crate::step_control::{CUT, Control, MAX_CUTS, Tolerances, factor, fitted};
use problem::contract::{acceptable, check_times, finite};
use problem::{EvalError, IntegrationEnding, IntegrationOptions, IntegrationOutcome, OdeMethod, OdeProblem, Sink};

/// Nodes of the stages after the first.
const C: [f64; 6] = [1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
/// Weights of earlier stages; the last row is that of the solution.
const A: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Solution minus embedded solution.
const E: [f64; 7] = [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
/// The last coefficient of the continuous extension.
const D: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];
/// First step, in units of the time to go, where what is needed for a better choice cannot be evaluated; the figure of IDA.
const FIRST: f64 = 1e-3;
/// Order of the local error in h.
const ORDER: f64 = 5.0;

/// Dormand–Prince 5(4). Allocates in the first integration of a size only.
#[derive(Debug, Default)]
pub struct DormandPrince {
    work: Work,
}

/// Adds h Σ wₛ kₛ.
#[inline]
fn add_weighted(sum: &mut [f64], h: f64, weights: &[f64], k: &[Vec<f64>]) {
    for (weight, k) in weights.iter().zip(k).filter(|(weight, _)| **weight != 0.0) {
        let scale = h * weight;
        sum.iter_mut().zip(k).for_each(|(x, k)| *x += scale * k);
    }
}

/// Everything that depends on the size of the problem.
#[derive(Debug, Default)]
struct Work {
    tolerances: Tolerances,
    roots: Roots,
    /// Point at the end of the last step.
    y: Vec<f64>,
    k: [Vec<f64>; 7],
    stage: Vec<f64>,
    /// The same on the manifold.
    landed: Vec<f64>,
    error: Vec<f64>,
    /// Coefficients of the continuous extension of the last step; the first is the point at its begin.
    dense: [Vec<f64>; 5],
    /// Whether the others are made: most steps have no sample inside.
    extended: bool,
    /// Rates of samples.
    rates: Vec<f64>,
}

impl Work {
    fn resize(&mut self, size: usize) {
        let all = [&mut self.y, &mut self.stage, &mut self.landed, &mut self.error, &mut self.rates]
            .into_iter()
            .chain(&mut self.k)
            .chain(&mut self.dense);
        all.for_each(|vector| vector.resize(size, 0.0));
    }
}

impl OdeMethod for DormandPrince {
    fn name(&self) -> &'static str {
        "dopri5"
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
        assert_eq!(y.len(), problem.size(), "one start value per unknown");
        check_times(times);
        let work = &mut self.work;
        work.resize(y.len());
        work.tolerances.set(problem.absolute_tolerance(), options);
        if !acceptable(options) || !work.tolerances.usable() {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        work.y.copy_from_slice(y);
        let (mut rates, mut roots) = (std::mem::take(&mut work.rates), std::mem::take(&mut work.roots));
        let mut run = Run {
            problem,
            work,
            max_step: options.max_step,
            begin: times[0],
            end: times[0],
            step: options.first_step,
            control: Control::new(ORDER),
            residuals: 0,
            rejected: 0,
            cuts: 0,
        };
        let reached = match run.rates_at_end() {
            Ok(()) => {
                rates.copy_from_slice(&run.work.k[6]);
                follow(&mut run, times, (y, &mut rates), options.max_steps, &mut roots, sink)
            }
            Err(error) => Reached { ending: IntegrationEnding::Evaluation(error), time: times[0], steps: 0 },
        };
        let outcome = IntegrationOutcome {
            ending: reached.ending,
            time: reached.time,
            steps: reached.steps,
            rejected: run.rejected,
            convergence_failures: run.cuts,
            residuals: run.residuals,
            jacobians: 0,
            products: 0,
            iterations: 0,
        };
        (self.work.rates, self.work.roots) = (rates, roots);
        outcome
    }
}

/// One integration under way. The rates at the end of the last step are the last of its stages.
struct Run<'a> {
    problem: &'a mut dyn OdeProblem,
    work: &'a mut Work,
    max_step: f64,
    begin: f64,
    end: f64,
    /// Length to be tried next.
    step: Option<f64>,
    control: Control,
    residuals: usize,
    rejected: usize,
    cuts: usize,
}

impl Run<'_> {
    fn rates_at_end(&mut self) -> Result<(), EvalError> {
        self.residuals += 1;
        self.problem.rates(self.end, &self.work.y, &mut self.work.k[6])?;
        finite(&self.work.k[6])
    }

    /// Half a tolerance over the sizes of rates and of their change along a trial step.
    fn first_step(&mut self, limit: f64) -> Result<f64, EvalError> {
        let Work { tolerances, y, k, stage, .. } = &mut *self.work;
        let size = |x: &[f64]| tolerances.norm(y, x.iter().copied().enumerate());
        let (of_y, of_rates) = (size(y), size(&k[6]));
        let trial = if of_y < 1e-5 || of_rates < 1e-5 { 1e-6 } else { 0.01 * of_y / of_rates }.min(limit - self.end);
        let (rates, others) = k.split_last_mut().expect("seven stages");
        stage.iter_mut().zip(&*y).zip(&*rates).for_each(|((s, y), k)| *s = y + trial * k);
        self.residuals += 1;
        self.problem.rates(self.end + trial, stage, &mut others[1])?;
        let change = tolerances.norm(y, others[1].iter().zip(&*rates).map(|(a, b)| a - b).enumerate()) / trial;
        let largest = of_rates.max(change);
        let second = if largest <= 1e-15 { (1e-3 * trial).max(1e-6) } else { (0.01 / largest).powf(1.0 / ORDER) };
        let step = second.min(100.0 * trial);
        Ok(if step.is_finite() && step > 0.0 { step } else { trial })
    }

    /// Evaluates the stages of a step of length h; the last point is left in `stage`. Returns the norm of the error.
    fn stages(&mut self, h: f64) -> Result<f64, EvalError> {
        let Work { tolerances, y, k, stage, error, .. } = &mut *self.work;
        for (s, (weights, node)) in A.iter().zip(C).enumerate() {
            let (known, next) = k.split_at_mut(s + 1);
            stage.copy_from_slice(y);
            add_weighted(stage, h, weights, known);
            self.residuals += 1;
            self.problem.rates(self.end + node * h, stage, &mut next[0])?;
            finite(&next[0])?;
        }
        error.fill(0.0);
        add_weighted(error, h, &E, k);
        Ok(tolerances.norm(y, error.iter().copied().enumerate()))
    }

    /// Makes the point in `stage`, brought onto the manifold, the end of the step; nothing but the extension changes where that fails.
    fn accept(&mut self, h: f64, end: f64) -> Result<(), EvalError> {
        let Work { y, stage, landed, dense, extended, .. } = &mut *self.work;
        dense[0].copy_from_slice(y);
        *extended = false;
        landed.copy_from_slice(stage);
        self.problem.project(end, landed)?;
        finite(landed)?;
        if landed != stage {
            // the extension belongs to the rates before
            self.extend(h);
            self.residuals += 1;
            let Work { landed, k, .. } = &mut *self.work;
            self.problem.rates(end, landed, &mut k[6])?;
            finite(&k[6])?;
        }
        let Work { y, landed, .. } = &mut *self.work;
        y.copy_from_slice(landed);
        (self.begin, self.end) = (self.end, end);
        Ok(())
    }

    /// Makes the continuous extension of the last step, of length h, from its stages.
    fn extend(&mut self, h: f64) {
        let Work { k, stage, dense, extended, .. } = &mut *self.work;
        if std::mem::replace(extended, true) {
            return;
        }
        let [begin, change, bend, twist, last] = dense;
        for i in 0..stage.len() {
            change[i] = stage[i] - begin[i];
            bend[i] = h * k[0][i] - change[i];
            twist[i] = change[i] - h * k[6][i] - bend[i];
        }
        last.fill(0.0);
        add_weighted(last, h, &D, k);
    }

    /// Tries a step; the norm of its error where that is too large.
    fn attempt(&mut self, h: f64, end: f64) -> Result<f64, EvalError> {
        let norm = self.stages(h)?;
        if norm <= 1.0 {
            self.accept(h, end)?;
        }
        Ok(norm)
    }
}

impl Path for Run<'_> {
    fn step(&mut self, limit: f64) -> Result<(), IntegrationEnding> {
        let evaluation = IntegrationEnding::Evaluation;
        let mut step = match self.step.map_or_else(|| self.first_step(limit), Ok) {
            Ok(step) => step,
            Err(error @ EvalError::Fatal { .. }) => return Err(evaluation(error)),
            Err(EvalError::Recoverable { .. }) => FIRST * (limit - self.end),
        };
        let (from, mut cuts, mut rejected, mut smallest) = (self.end, 0, false, IntegrationEnding::ErrorTest);
        // the last stage of the step before is the first of this one
        self.work.k.swap(0, 6);
        loop {
            let (h, end) = fitted(from, step.min(self.max_step), limit);
            let outcome = if end > from { self.attempt(h, end) } else { break };
            match outcome {
                Ok(norm) if norm <= 1.0 => {
                    let growth = self.control.growth(norm);
                    self.step = Some(h * if rejected { growth.min(1.0) } else { growth });
                    return Ok(());
                }
                Ok(norm) => {
                    (self.rejected, rejected) = (self.rejected + 1, true);
                    step = h * factor(norm, ORDER).min(0.9);
                    smallest = IntegrationEnding::ErrorTest;
                }
                Err(error) => {
                    (self.cuts, cuts, smallest) = (self.cuts + 1, cuts + 1, evaluation(error));
                    if cuts > MAX_CUTS || matches!(error, EvalError::Fatal { .. }) {
                        break;
                    }
                    (step, rejected) = (CUT * h, true);
                }
            }
        }
        self.work.k.swap(0, 6);
        Err(smallest)
    }

    fn span(&self) -> (f64, f64) {
        (self.begin, self.end)
    }

    fn point(&mut self, time: f64, y: &mut [f64], yd: &mut [f64]) -> Result<(), EvalError> {
        if time == self.end {
            y.copy_from_slice(&self.work.y);
            yd.copy_from_slice(&self.work.k[6]);
            return Ok(());
        }
        let h = self.end - self.begin;
        self.extend(h);
        let s = (time - self.begin) / h;
        let d = &self.work.dense;
        for (i, y) in y.iter_mut().enumerate() {
            *y = d[0][i] + s * (d[1][i] + (1.0 - s) * (d[2][i] + s * (d[3][i] + (1.0 - s) * d[4][i])));
        }
        self.problem.project(time, y)?;
        self.residuals += 1;
        self.problem.rates(time, y, yd)?;
        finite(yd)
    }

    fn event_count(&self) -> usize {
        self.problem.event_count()
    }

    fn events(&mut self, time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.problem.events(time, y, values)?;
        finite(values)
    }
}
