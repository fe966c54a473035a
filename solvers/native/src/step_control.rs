//! The norm of local errors and the length of the next step.
//!
//! ‖e‖ = √(Σ (eᵢ/(rtol |yᵢ| + atolᵢ))² / n); a step is accepted where it is below one. Next length: h · min(5, max(1/5, 0.9 ‖e‖^(−1/(q+1)))).
//!
//! [`Control`] looks at the step before too.
//!
//! Source: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, Springer 1993, section II.4 and the code DOPRI5, whose figures
//! [`Control`] has; K. Gustafsson, *Control theoretic techniques for stepsize selection in explicit Runge–Kutta methods*, ACM TOMS 17, 1991, 533–554.

use problem::IntegrationOptions;

/// Share of the optimal length that is taken.
const SAFETY: f64 = 0.9;
/// Weight of the error of the step before.
const BETA: f64 = 0.04;
/// Smallest error that it is taken for, and that of the step before the first.
const LEAST: f64 = 1e-4;
/// Largest growth where the step before is looked at.
const GROWTH: f64 = 10.0;
/// Bounds of the change of length from one step to the next.
const CHANGE: (f64, f64) = (0.2, 5.0);
/// How often a step is shortened before a point counts as impossible to evaluate; as many times as IDA tries.
pub(crate) const MAX_CUTS: usize = 10;
/// By how much, each time; the figure of IDA.
pub(crate) const CUT: f64 = 0.25;

/// Tolerances of one integration.
#[derive(Debug, Default)]
pub(crate) struct Tolerances {
    relative: f64,
    absolute: Vec<f64>,
}

impl Tolerances {
    pub(crate) fn set(&mut self, absolute: &[f64], options: &IntegrationOptions) {
        self.relative = options.relative_tolerance;
        self.absolute.clear();
        self.absolute.extend(absolute.iter().map(|tolerance| tolerance * options.absolute_tolerance_factor));
    }

    /// Absolute tolerances.
    pub(crate) fn absolute(&self) -> &[f64] {
        &self.absolute
    }

    /// Whether every entry is held to something.
    pub(crate) fn usable(&self) -> bool {
        self.relative > 0.0 && self.absolute.iter().all(|tolerance| *tolerance > 0.0)
    }

    /// What an error of entry `i` is measured by.
    #[inline]
    pub(crate) fn unit(&self, i: usize, y: f64) -> f64 {
        self.relative * y.abs() + self.absolute[i]
    }

    /// Root mean square of errors, over the entries that count.
    pub(crate) fn norm(&self, y: &[f64], errors: impl Iterator<Item = (usize, f64)>) -> f64 {
        let (sum, count) = errors.fold((0.0, 0), |(sum, count), (i, error)| {
            let share = error / self.unit(i, y[i]);
            (sum + share * share, count + 1)
        });
        (sum / f64::from(count.max(1))).sqrt()
    }
}

/// Factor of the next step after one whose error has this norm, for errors of order `order` in h.
pub(crate) fn factor(norm: f64, order: f64) -> f64 {
    if norm.is_finite() { (SAFETY * norm.powf(-1.0 / order)).clamp(CHANGE.0, CHANGE.1) } else { CHANGE.0 }
}

/// Chooses lengths by the errors of the last two steps: proportional and integral control, after which fewer steps are rejected.
///
/// h ← h · 0.9 ‖eₙ‖^(−(1/(q+1) − 3/4 β)) ‖eₙ₋₁‖^β, β = 0.04, between a fifth and ten times h.
#[derive(Debug)]
pub(crate) struct Control {
    order: f64,
    before: f64,
}

impl Control {
    /// For errors of order `order` in h.
    pub(crate) fn new(order: f64) -> Self {
        Self { order, before: LEAST }
    }

    /// Factor of the next step after one that was accepted.
    pub(crate) fn growth(&mut self, norm: f64) -> f64 {
        let growth = SAFETY * norm.powf(0.75 * BETA - 1.0 / self.order) * self.before.powf(BETA);
        self.before = norm.max(LEAST);
        growth.clamp(CHANGE.0, GROWTH)
    }
}

/// The step from `time` that neither passes `limit` nor leaves a scrap before it.
pub(crate) fn fitted(time: f64, step: f64, limit: f64) -> (f64, f64) {
    if time + 1.01 * step >= limit { (limit - time, limit) } else { (step, time + step) }
}
