//! Linearly implicit methods with steps of one length: constant work per step, for simulators that keep up with the clock.
//!
//! ẏ = f(t, y), A = ∂f/∂y at the begin of the step, stages from one linear system each with the same matrix:
//!
//! ```text
//! (I − γ h A) kᵢ = f(t₀ + cᵢ h, y₀ + h Σ aᵢⱼ kⱼ) + Σ eᵢⱼ kⱼ        y₁ = y₀ + h Σ bᵢ kᵢ
//! ```
//!
//! `ros2`: two stages, γ = 1 − 1/√2, order 2 whatever A is, L-stable with the exact A. `linear_euler`: one stage, γ = 1, order 1, L-stable.
//! Per step one matrix, one factorization, as many evaluations and substitutions as stages; nothing is iterated and no step is repeated. Points
//! are brought back onto the manifold after each step. Samples and events between the ends of steps are read from cubic polynomials.
//! Tolerances play no part: the length of the step decides about the error.
//!
//! Source: J. G. Verwer, E. J. Spee, J. G. Blom, W. Hundsdorfer, *A second-order Rosenbrock method applied to photochemical dispersion problems*,
//! SIAM J. Sci. Comput. 20, 1999, 1456–1480; E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, Springer 1996, section IV.7.

use crate::factorization::Factorization;
use crate::path::{Path, Reached, Roots, follow};
use crate::segment::Segment;
use crate::step_control::fitted;
use problem::contract::{acceptable, check_times, finite};
use problem::{EvalError, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Matrix, OdeMethod, OdeProblem, Sink};

/// Coefficients of a method with two stages at most.
#[derive(Debug)]
struct Table {
    name: &'static str,
    gamma: f64,
    /// Weights of the stages; as many as there are.
    b: &'static [f64],
    /// Of the second stage: c, a, e.
    second: [f64; 3],
}

const ROS2: Table = Table { name: "ros2", gamma: 1.0 - std::f64::consts::FRAC_1_SQRT_2, b: &[1.5, 0.5], second: [1.0, 1.0, -2.0] };
const LINEAR_EULER: Table = Table { name: "linear_euler", gamma: 1.0, b: &[1.0], second: [0.0; 3] };

/// A linearly implicit method with steps of one length. Allocates in the first integration of a size only.
#[derive(Debug)]
pub struct Rosenbrock {
    table: &'static Table,
    work: Work,
}

/// Everything that depends on the size of the problem.
#[derive(Debug, Default)]
struct Work {
    roots: Roots,
    /// The last step: points and rates at its ends.
    segment: Segment,
    stage: Vec<f64>,
    k: [Vec<f64>; 2],
    ones: Vec<f64>,
    jacobian: Matrix,
    factors: Factorization,
    rates: Vec<f64>,
}

impl Rosenbrock {
    /// Two stages, order 2.
    pub fn second_order() -> Self {
        Self { table: &ROS2, work: Work::default() }
    }

    /// One stage, order 1: the linearly implicit method of Euler.
    pub fn euler() -> Self {
        Self { table: &LINEAR_EULER, work: Work::default() }
    }
}

impl Work {
    fn resize(&mut self, size: usize) {
        if self.ones.len() == size && self.jacobian.rows() == size {
            return;
        }
        let zeros = || vec![0.0; size];
        *self = Self {
            roots: Roots::default(),
            segment: Segment::new(size),
            stage: zeros(),
            k: [zeros(), zeros()],
            ones: vec![1.0; size],
            jacobian: Matrix::zeros(size, size),
            factors: Factorization::new(size),
            rates: zeros(),
        };
    }
}

impl OdeMethod for Rosenbrock {
    fn name(&self) -> &'static str {
        self.table.name
    }

    /// Integrates with steps of [`IntegrationOptions::fixed_step`] until the last time, an event, or a failure; the last step is as long as is left.
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
        let step = options.fixed_step.min(options.max_step);
        if !acceptable(options) || !step.is_finite() {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        let work = &mut self.work;
        work.resize(y.len());
        let (mut rates, mut roots) = (std::mem::take(&mut work.rates), std::mem::take(&mut work.roots));
        work.segment.start(times[0], y);
        let mut run = Run { problem, work, table: self.table, step, residuals: 1, jacobians: 0, solves: 0 };
        let begun = run.problem.rates(times[0], y, &mut rates).and_then(|()| finite(&rates));
        let reached = match begun {
            Ok(()) => {
                run.work.segment.rates_at_end().copy_from_slice(&rates);
                follow(&mut run, times, (y, &mut rates), options.max_steps, &mut roots, sink)
            }
            Err(error) => Reached { ending: IntegrationEnding::Evaluation(error), time: times[0], steps: 0 },
        };
        let outcome = IntegrationOutcome {
            ending: reached.ending,
            time: reached.time,
            steps: reached.steps,
            rejected: 0,
            convergence_failures: 0,
            residuals: run.residuals,
            jacobians: run.jacobians,
            products: 0,
            iterations: run.solves,
        };
        (self.work.rates, self.work.roots) = (rates, roots);
        outcome
    }
}

/// One integration under way.
struct Run<'a> {
    problem: &'a mut dyn OdeProblem,
    work: &'a mut Work,
    table: &'static Table,
    step: f64,
    residuals: usize,
    jacobians: usize,
    solves: usize,
}

impl Run<'_> {
    fn rates(problem: &mut dyn OdeProblem, counter: &mut usize, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        *counter += 1;
        problem.rates(time, y, yd)?;
        finite(yd)
    }

    /// Evaluates the stages and leaves the new point, on the manifold, in `stage`, its rates in `k[0]`.
    fn stages(&mut self, time: f64, h: f64, end: f64) -> Result<(), IntegrationEnding> {
        let evaluation = IntegrationEnding::Evaluation;
        let (Work { segment, stage, k, ones, jacobian, factors, .. }, table) = (&mut *self.work, self.table);
        let (y, rates) = segment.end();
        self.jacobians += 1;
        self.problem.jacobian(time, y, jacobian).map_err(evaluation)?;
        let shift = table.gamma * h;
        let matrix = |i: usize, j: usize| f64::from(u8::from(i == j)) - shift * jacobian[(i, j)];
        factors.factorize(ones, matrix).map_err(|_| IntegrationEnding::Singular)?;
        let [first, second] = k;
        first.copy_from_slice(rates);
        factors.solve(first);
        self.solves += table.b.len();
        if table.b.len() > 1 {
            let [c, a, e] = table.second;
            stage.iter_mut().zip(y).zip(&*first).for_each(|((s, y), k)| *s = y + h * a * k);
            Self::rates(self.problem, &mut self.residuals, time + c * h, stage, second).map_err(evaluation)?;
            second.iter_mut().zip(&*first).for_each(|(f, k)| *f += e * k);
            factors.solve(second);
        }
        stage.copy_from_slice(y);
        for (weight, k) in table.b.iter().zip([&*first, &*second]) {
            stage.iter_mut().zip(k).for_each(|(y, k)| *y += h * weight * k);
        }
        self.problem.project(end, stage).map_err(evaluation)?;
        finite(stage).map_err(evaluation)?;
        Self::rates(self.problem, &mut self.residuals, end, stage, first).map_err(evaluation)
    }
}

impl Path for Run<'_> {
    fn step(&mut self, limit: f64) -> Result<(), IntegrationEnding> {
        let (_, time) = self.work.segment.span();
        let (h, end) = fitted(time, self.step, limit);
        self.stages(time, h, end)?;
        let Work { segment, stage, k, .. } = &mut *self.work;
        segment.push(end, stage, &k[0]);
        Ok(())
    }

    fn span(&self) -> (f64, f64) {
        self.work.segment.span()
    }

    fn point(&mut self, time: f64, y: &mut [f64], yd: &mut [f64]) -> Result<(), EvalError> {
        if self.work.segment.read(time, y, yd) {
            return Ok(());
        }
        self.problem.project(time, y)?;
        Self::rates(self.problem, &mut self.residuals, time, y, yd)
    }

    fn event_count(&self) -> usize {
        self.problem.event_count()
    }

    fn events(&mut self, time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.problem.events(time, y, values)?;
        finite(values)
    }
}
