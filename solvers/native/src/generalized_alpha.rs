//! The generalized-α method of first order for implicit systems, with steps of variable length.
//!
//! 0 = F(t, y, ẏ) is solved at the end of each step, constraints included. Beside y and ẏ there is an auxiliary rate w:
//!
//! ```text
//! y₁ = y₀ + h ((1 − γ) w₀ + γ w₁)          α_m w₁ + (1 − α_m) w₀ = α_f ẏ₁ + (1 − α_f) ẏ₀
//! α_m = (3 − ρ)/(2 + 2 ρ)     α_f = 1/(1 + ρ)     γ = ½ + α_m − α_f
//! ```
//!
//! Second order for every ρ in [0, 1], the share of the fastest oscillations that survives a step: 1 keeps all (trapezoidal rule), 0 none.
//! Local error C h³ y⃛ with C = γ (1 + 2 Δ)/2 + α_f/2 − α_m (1 + 2 Δ)/2 − 1/6, Δ = α_f − α_m, from the second divided difference of ẏ.
//! w is a rate at t + Δ h, so its distance from ẏ follows the length of the step.
//!
//! Sources: K. E. Jansen, C. H. Whiting, G. M. Hulbert, *A generalized-α method for integrating the filtered Navier–Stokes equations*, Comput.
//! Methods Appl. Mech. Engrg. 190, 2000, 305–319; C. Kadapa, W. G. Dettmer, D. Perić, *On the advantages of using the first-order generalised-alpha
//! scheme for structural dynamic problems*, Computers & Structures 193, 2017, 226–238; constraints and w: M. Arnold, O. Brüls, *Convergence of the
//! generalized-α scheme for constrained mechanical systems*, Multibody Syst. Dyn. 18, 2007, 185–202.

use crate::factorization::Factorization;
use crate::path::{Path, Roots, follow};
use crate::segment::Segment;
use crate::step_control::{CUT, MAX_CUTS, Tolerances, factor, fitted};
use problem::contract::{acceptable, check_times, finite};
use problem::{AlgebraicErrors, DaeMethod, DaeProblem, EvalError, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Matrix, Sink};

/// Order of the local error in h.
const ORDER: f64 = 3.0;
/// Distance from the solution of a step, in units of the tolerance, at which Newton's method ends.
const CLOSE: f64 = 0.03;
/// The same where corrections shrink no more: rounding is all that is left. The figure of IDA.
const ROUNDING: f64 = 0.33;
/// Changes of length that are not worth a new matrix.
const SAME: (f64, f64) = (0.9, 1.5);
/// Most iterations of a step.
const MOST_ITERATIONS: usize = 10;
/// Share of one correction that the next may have, where a kept matrix serves.
const FAST: f64 = 0.3;
/// Change of α/h at which a matrix is kept no longer.
const KEPT: f64 = 0.25;

/// Generalized-α with a spectral radius at infinity. Allocates in the first integration of a size only.
#[derive(Debug)]
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    lengths: Lengths,
    work: Work,
}

/// Who decides how long steps are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lengths {
    /// The local error.
    Variable,
    /// The options.
    Fixed,
}

/// Everything that depends on the size of the problem.
#[derive(Debug, Default)]
struct Work {
    tolerances: Tolerances,
    roots: Roots,
    segment: Segment,
    /// Auxiliary rate at the end of the last step, and that of the step under way.
    w: Vec<f64>,
    next_w: Vec<f64>,
    y: Vec<f64>,
    yd: Vec<f64>,
    right: Vec<f64>,
    units: Vec<f64>,
    jacobian: Matrix,
    factors: Factorization,
}

impl GeneralizedAlpha {
    /// With the share `spectral_radius` of the fastest oscillations left by a step, from 0 to 1.
    ///
    /// # Panics
    /// The share is not from 0 to 1.
    pub fn new(spectral_radius: f64) -> Self {
        assert!((0.0..=1.0).contains(&spectral_radius), "a spectral radius is from 0 to 1");
        let alpha_m = (3.0 - spectral_radius) / (2.0 + 2.0 * spectral_radius);
        let alpha_f = 1.0 / (1.0 + spectral_radius);
        Self { alpha_m, alpha_f, gamma: 0.5 + alpha_m - alpha_f, lengths: Lengths::Variable, work: Work::default() }
    }

    /// The same with steps of [`IntegrationOptions::fixed_step`]; tolerances decide only how closely each is solved.
    pub fn with_fixed_steps(self) -> Self {
        Self { lengths: Lengths::Fixed, ..self }
    }

    /// C of the local error.
    fn error_constant(&self) -> f64 {
        let reach = 1.0 + 2.0 * (self.alpha_f - self.alpha_m);
        0.5 * (self.gamma * reach + self.alpha_f - self.alpha_m * reach) - 1.0 / 6.0
    }
}

impl Work {
    fn resize(&mut self, size: usize) {
        if self.w.len() == size && self.jacobian.rows() == size {
            return;
        }
        let zeros = || vec![0.0; size];
        *self = Self {
            segment: Segment::new(size),
            w: zeros(),
            next_w: zeros(),
            y: zeros(),
            yd: zeros(),
            right: zeros(),
            units: zeros(),
            jacobian: Matrix::zeros(size, size),
            factors: Factorization::new(size),
            ..Self::default()
        };
    }
}

impl DaeMethod for GeneralizedAlpha {
    fn name(&self) -> &'static str {
        "generalized_alpha"
    }

    /// Integrates until the last time, an event, or a failure.
    ///
    /// The point of an event is not handed to the sink. After a failure `y` and `yd` are those at the end of the last step that succeeded.
    ///
    /// # Panics
    /// Where lengths disagree, times decrease or there is none.
    fn integrate(
        &mut self,
        problem: &mut dyn DaeProblem,
        times: &[f64],
        (y, yd): (&mut [f64], &mut [f64]),
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        assert!(y.len() == problem.size() && yd.len() == y.len(), "one start value and one rate per unknown");
        check_times(times);
        let constant = self.error_constant();
        let Self { alpha_m, alpha_f, gamma, lengths, work } = self;
        work.resize(y.len());
        work.tolerances.set(problem.absolute_tolerance(), options);
        if !acceptable(options) || !work.tolerances.usable() {
            return IntegrationOutcome::nothing_done(IntegrationEnding::Refused, times[0]);
        }
        work.segment.start(times[0], y);
        work.segment.rates_at_end().copy_from_slice(yd);
        work.segment.without_rates(problem.differential().iter().map(|differential| !differential));
        work.w.copy_from_slice(yd);
        let mut roots = std::mem::take(&mut work.roots);
        let mut run = Run {
            problem,
            work,
            formulas: Formulas { alpha_m: *alpha_m, alpha_f: *alpha_f, gamma: *gamma, constant },
            tested: options.algebraic == AlgebraicErrors::Tested,
            max_step: options.max_step,
            lengths: *lengths,
            step: if *lengths == Lengths::Fixed { Some(options.fixed_step) } else { options.first_step },
            factorized: None,
            count: Count::default(),
        };
        let reached = follow(&mut run, times, (y, yd), options.max_steps, &mut roots, sink);
        let Count { rejected, failures, residuals, jacobians, iterations } = run.count;
        self.work.roots = roots;
        IntegrationOutcome {
            ending: reached.ending,
            time: reached.time,
            steps: reached.steps,
            rejected,
            convergence_failures: failures,
            residuals,
            jacobians,
            products: 0,
            iterations,
        }
    }
}

/// Coefficients.
#[derive(Clone, Copy)]
struct Formulas {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    constant: f64,
}

#[derive(Clone, Copy, Default)]
struct Count {
    rejected: usize,
    failures: usize,
    residuals: usize,
    jacobians: usize,
    iterations: usize,
}

/// One integration under way.
struct Run<'a> {
    problem: &'a mut dyn DaeProblem,
    work: &'a mut Work,
    formulas: Formulas,
    /// Whether algebraic unknowns are part of the error test.
    tested: bool,
    max_step: f64,
    lengths: Lengths,
    /// Length to be tried next.
    step: Option<f64>,
    /// The ∂ẏ/∂y that the factors belong to, where there are some.
    factorized: Option<f64>,
    count: Count,
}

/// Why an attempt came to nothing.
enum Miss {
    Evaluation(EvalError),
    Convergence,
    Singular,
}

impl Run<'_> {
    /// ẏ and w at the end of the step, from y there.
    fn rates(&mut self, h: f64, held_w: f64) {
        let Formulas { alpha_m, alpha_f, gamma, .. } = self.formulas;
        let Work { segment, w, next_w, y, yd, .. } = &mut *self.work;
        let (from, rates) = segment.end();
        for (i, &differential) in self.problem.differential().iter().enumerate() {
            if !differential {
                (yd[i], next_w[i]) = (0.0, 0.0);
                continue;
            }
            // the distance of w from ẏ follows the length of the step
            let before = rates[i] + held_w * (w[i] - rates[i]);
            next_w[i] = ((y[i] - from[i]) / h - (1.0 - gamma) * before) / gamma;
            yd[i] = (alpha_m * next_w[i] + (1.0 - alpha_m) * before - (1.0 - alpha_f) * rates[i]) / alpha_f;
        }
    }

    /// Starts the iteration on the parabola through the last rates.
    fn predict(&mut self, h: f64) {
        let Work { segment, y, .. } = &mut *self.work;
        let (span, (from, rates), (_, earlier)) = (segment.span(), segment.end(), segment.begin());
        let share = if span.1 > span.0 { 0.5 * h / (span.1 - span.0) } else { 0.0 };
        for (i, &differential) in self.problem.differential().iter().enumerate() {
            y[i] = from[i] + if differential { h * (rates[i] + share * (rates[i] - earlier[i])) } else { 0.0 };
        }
    }

    fn factorize(&mut self, time: f64, c: f64) -> Result<(), Miss> {
        self.count.jacobians += 1;
        let Work { jacobian, factors, units, y, yd, .. } = &mut *self.work;
        self.factorized = None;
        self.problem.jacobian(time, c, y, yd, jacobian).map_err(Miss::Evaluation)?;
        factors.factorize(units, |i, j| jacobian[(i, j)]).map_err(|_| Miss::Singular)?;
        self.factorized = Some(c);
        Ok(())
    }

    /// Solves F = 0 at the end of a step of length h. Whether a fresh matrix was used where that failed.
    fn solve(&mut self, h: f64, end: f64, held_w: f64) -> Result<(), (Miss, bool)> {
        let Formulas { alpha_m, alpha_f, gamma, .. } = self.formulas;
        let c = alpha_m / (alpha_f * gamma * h);
        self.predict(h);
        let Work { tolerances, segment, units, .. } = &mut *self.work;
        units.iter_mut().enumerate().for_each(|(i, unit)| *unit = tolerances.unit(i, segment.end().0[i]));
        self.rates(h, held_w);
        let mut fresh = false;
        if self.factorized.is_none_or(|kept| (kept / c - 1.0).abs() > KEPT) {
            self.factorize(end, c).map_err(|miss| (miss, true))?;
            fresh = true;
        }
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let Work { right, y, yd, units, factors, .. } = &mut *self.work;
            self.count.residuals += 1;
            self.problem.residual(end, y, yd, right).and_then(|()| finite(right)).map_err(|error| (Miss::Evaluation(error), true))?;
            factors.solve(right);
            self.count.iterations += 1;
            y.iter_mut().zip(&*right).for_each(|(y, step)| *y -= step);
            let size = right.iter().zip(&*units).map(|(step, unit)| (step / unit).powi(2)).sum::<f64>() / right.len() as f64;
            let size = size.sqrt();
            self.rates(h, held_w);
            let rate = size / before;
            // what is left is a geometric series
            let left = if before.is_finite() { size * rate / (1.0 - rate).max(0.1) } else { size };
            if left <= CLOSE || (size <= ROUNDING && before.is_finite() && rate > 0.5) {
                return Ok(());
            }
            if size.is_nan() || rate > 2.0 || (rate > FAST && !fresh) {
                break;
            }
            before = size;
        }
        Err((Miss::Convergence, fresh))
    }

    /// Norm of the local error of the step that was solved.
    fn error(&self, h: f64) -> f64 {
        let Work { segment, yd, tolerances, .. } = &*self.work;
        let (span, (from, rates), (_, earlier)) = (segment.span(), segment.end(), segment.begin());
        let last = span.1 - span.0;
        let constant = self.formulas.constant;
        let error = |i: usize| match last > 0.0 {
            true => 2.0 * constant * h.powi(3) / (h + last) * ((yd[i] - rates[i]) / h - (rates[i] - earlier[i]) / last),
            // nothing is known before the first step: its error against that of a straight line
            false => 0.5 * h * (yd[i] - rates[i]),
        };
        let counts = |i: &usize| self.problem.differential()[*i];
        let of_rates = tolerances.norm(from, (0..from.len()).filter(counts).map(|i| (i, error(i))));
        if !self.tested {
            return of_rates;
        }
        let change = |i: usize| 0.1 * (self.work.y[i] - from[i]);
        of_rates.max(tolerances.norm(from, (0..from.len()).filter(|i| !counts(i)).map(|i| (i, change(i)))))
    }
}

impl Path for Run<'_> {
    fn step(&mut self, limit: f64) -> Result<(), IntegrationEnding> {
        let (begin, from) = self.work.segment.span();
        let last = from - begin;
        let mut step = self.step.unwrap_or(1e-3 * (limit - from));
        let (mut cuts, mut rejected, mut smallest) = (0, false, IntegrationEnding::ErrorTest);
        loop {
            let (h, end) = fitted(from, step.min(self.max_step), limit);
            if end <= from {
                return Err(smallest);
            }
            match self.solve(h, end, if last > 0.0 { h / last } else { 1.0 }) {
                Ok(()) => {
                    let fixed = self.lengths == Lengths::Fixed;
                    let norm = if fixed { 0.0 } else { self.error(h) };
                    let growth = factor(norm, ORDER);
                    let growth = if (SAME.0..SAME.1).contains(&growth) && norm <= 1.0 { 1.0 } else { growth };
                    if norm <= 1.0 {
                        if !fixed {
                            self.step = Some(h * if rejected { growth.min(1.0) } else { growth });
                        }
                        let Work { segment, y, yd, w, next_w, .. } = &mut *self.work;
                        segment.push(end, y, yd);
                        std::mem::swap(w, next_w);
                        return Ok(());
                    }
                    (self.count.rejected, rejected, step) = (self.count.rejected + 1, true, h * growth.min(0.9));
                    smallest = IntegrationEnding::ErrorTest;
                }
                // a matrix of another point is renewed before the step is blamed
                Err((Miss::Convergence, false)) => self.factorized = None,
                Err((miss, _)) => {
                    (self.factorized, self.count.failures, cuts) = (None, self.count.failures + 1, cuts + 1);
                    smallest = match miss {
                        Miss::Evaluation(error) => IntegrationEnding::Evaluation(error),
                        Miss::Convergence => IntegrationEnding::Convergence,
                        Miss::Singular => IntegrationEnding::Singular,
                    };
                    if cuts > MAX_CUTS || matches!(smallest, IntegrationEnding::Evaluation(EvalError::Fatal { .. })) {
                        return Err(smallest);
                    }
                    (step, rejected) = (CUT * h, true);
                }
            }
        }
    }

    fn span(&self) -> (f64, f64) {
        self.work.segment.span()
    }

    fn point(&mut self, time: f64, y: &mut [f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.work.segment.read(time, y, yd);
        Ok(())
    }

    fn event_count(&self) -> usize {
        self.problem.event_count()
    }

    fn events(&mut self, time: f64, y: &[f64], yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        self.problem.events(time, y, yd, values)?;
        finite(values)
    }
}
