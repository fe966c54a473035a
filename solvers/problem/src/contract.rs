//! What integrators demand of times, options and values, and when an event function has passed its root.

use crate::{EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Sink};

/// Distance of two times in units of rounding below which they are the same; the figure of SUNDIALS.
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
        && options.fixed_step > 0.0
}

/// Hands out the samples of a problem that has no unknowns, for methods of libraries that take none such.
pub fn without_unknowns(times: &[f64], sink: Sink<'_>) -> IntegrationOutcome {
    let stop = times.iter().find(|&&time| sink(time, &[], &[]) == Flow::Stop);
    let ending = stop.map_or(IntegrationEnding::Finished, |_| IntegrationEnding::Stopped);
    IntegrationOutcome::nothing_done(ending, *stop.unwrap_or(&times[times.len() - 1]))
}

/// Whether no step fits between two times: rounding is all that separates them.
pub fn coincide(a: f64, b: f64) -> bool {
    (b - a).abs() <= resolution(a, b)
}

/// Smallest distance of two times around `a` and `b` that means anything.
pub fn resolution(a: f64, b: f64) -> f64 {
    FUZZ * (a.abs() + b.abs())
}

/// `Ok` where every entry is finite, else the recoverable error that names the first row which is not.
pub fn finite(values: &[f64]) -> Result<(), EvalError> {
    // all are, nearly always, and a count has no branches
    if values.iter().filter(|value| value.is_finite()).count() == values.len() {
        return Ok(());
    }
    let equation = values.iter().position(|value| !value.is_finite()).unwrap_or_default();
    Err(EvalError::Recoverable { equation })
}

/// The first event function that reached or passed zero.
pub fn crossed(before: &[f64], after: &[f64]) -> Option<usize> {
    before.iter().zip(after).position(|(before, after)| changes(*before, *after))
}

/// Whether a function passes or reaches zero; one that starts there only leaves it.
pub fn changes(before: f64, after: f64) -> bool {
    before != 0.0 && (after == 0.0 || (before < 0.0) != (after < 0.0))
}

/// Where the first of the event functions that change sign is zero if they are straight, as a share of the way; weights belong to the ends.
///
/// An end that stays twice in a row loses half of its weight: M. Dowell, P. Jarratt, *A modified regula falsi method for computing the root
/// of an equation*, BIT 11, 1971, 168–174 (“Illinois”).
pub fn secant(before: &[f64], beyond: &[f64], weight_before: f64, weight_beyond: f64) -> f64 {
    let crossing = before.iter().zip(beyond).filter(|(before, beyond)| changes(**before, **beyond));
    crossing.fold(1.0, |share, (before, beyond)| {
        let (before, beyond) = (weight_before * before.abs(), weight_beyond * beyond.abs());
        f64::min(share, before / (before + beyond))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_not_finite_is_recoverable_and_names_its_row() {
        assert_eq!(finite(&[0.0, -1.0]), Ok(()));
        assert_eq!(finite(&[0.0, f64::NAN, f64::INFINITY]), Err(EvalError::Recoverable { equation: 1 }));
    }

    #[test]
    fn a_root_at_the_start_is_left_and_one_at_the_end_is_reached() {
        assert_eq!(crossed(&[0.0, 1.0], &[1.0, 0.0]), Some(1));
        assert_eq!(crossed(&[0.0, 1.0], &[-1.0, 2.0]), None);
        assert_eq!(secant(&[1.0, 2.0], &[-1.0, -1.0], 1.0, 1.0), 0.5);
    }
}
