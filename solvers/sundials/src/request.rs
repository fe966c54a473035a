//! What both integrators demand of times and options before they start.

use problem::{IntegrationEnding, IntegrationOptions, IntegrationOutcome};

/// Distance of two times in units of rounding below which they are the same; SUNDIALS' own figure.
const FUZZ: f64 = 100.0 * f64::EPSILON;

/// Holds the sampling times to their contract.
///
/// # Panics
/// Where there is none, one is not finite, or they decrease.
pub fn check_times(times: &[f64]) {
    assert!(times.iter().all(|time| time.is_finite()), "sampling times are finite");
    assert!(!times.is_empty(), "an integration has a time to start from");
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]), "sampling times increase");
}

/// Whether tolerances and steps have values that an integrator can work with.
pub fn acceptable(options: &IntegrationOptions) -> bool {
    let usable = |value: f64| value.is_finite() && value >= 0.0;
    usable(options.relative_tolerance)
        && usable(options.absolute_tolerance_factor)
        && options.first_step.is_none_or(|step| usable(step) && step > 0.0)
        && options.max_step > 0.0
}

/// Whether no step fits between two times: rounding is all that separates them.
pub fn coincide(a: f64, b: f64) -> bool {
    (b - a).abs() <= resolution(a, b)
}

/// Smallest distance of two times around `a` and `b` that means anything.
pub fn resolution(a: f64, b: f64) -> f64 {
    FUZZ * (a.abs() + b.abs())
}

/// The outcome of an integration that has not begun.
pub fn nothing_done(ending: IntegrationEnding, time: f64) -> IntegrationOutcome {
    IntegrationOutcome { ending, time, steps: 0, rejected: 0, convergence_failures: 0, residuals: 0, jacobians: 0, iterations: 0 }
}
