//! Extrapolation of central differences to zero step, with an estimate of what is left of the error.
//!
//! A central difference errs by even powers of its step: `D(h) = f′ + c₂ h² + c₄ h⁴ + …`. With steps halved from row to row
//! `T_k0 = D(h/2ᵏ)`, `T_kj = T_k,j−1 + (T_k,j−1 − T_k−1,j−1) / (4ʲ − 1)`. Of all entries the one counts that moved least on the last step, so rounding,
//! which grows as the step shrinks, ends the extrapolation by itself.
//!
//! Source: L. F. Richardson, J. A. Gaunt, Phil. Trans. R. Soc. A 226 (1927) 299–361; C. J. F. Ridders, Adv. Eng. Softw. 4 (1982) 75–76 (choice of the entry).

use nalgebra::Complex;

/// A derivative and how far it may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<T> {
    /// The derivative.
    pub value: T,
    /// Its error as the table of extrapolations shows it, in the unit of the value; infinite where there is one difference only.
    pub error: f64,
}

/// Extrapolates differences, the one of the largest step first, each step half of the one before.
pub(super) fn extrapolate(differences: &[Complex<f64>]) -> Estimate<Complex<f64>> {
    let mut best = Estimate { value: differences.first().copied().unwrap_or_default(), error: f64::INFINITY };
    let mut before: Vec<Complex<f64>> = Vec::new();
    for difference in differences {
        let mut row = vec![*difference];
        let mut factor = 1.0;
        for (j, above) in before.iter().enumerate() {
            factor *= 4.0;
            let next = row[j] + (row[j] - above) / (factor - 1.0);
            let error = (next - row[j]).norm().max((next - above).norm());
            if error < best.error {
                best = Estimate { value: next, error };
            }
            row.push(next);
        }
        before = row;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differences(f: impl Fn(f64) -> f64, x: f64, step: f64, levels: i32) -> Vec<Complex<f64>> {
        let at = |k: i32| step / 2f64.powi(k);
        (0..levels).map(|k| Complex::new((f(x + at(k)) - f(x - at(k))) / (2.0 * at(k)), 0.0)).collect()
    }

    #[test]
    fn smooth_functions_are_differentiated_to_rounding() {
        for (f, slope) in [(f64::exp as fn(f64) -> f64, 1f64.exp()), (f64::sin, 1f64.cos()), (f64::ln, 1.0), (f64::sqrt, 0.5)] {
            let found = extrapolate(&differences(f, 1.0, 0.05, 4));
            assert!((found.value.re - slope).abs() < 1e-11, "{found:?} instead of {slope}");
            assert!(found.error < 1e-8, "{found:?}");
        }
    }

    #[test]
    fn rounding_does_not_spoil_what_was_found_before() {
        // so many halvings that the last differences are noise
        let found = extrapolate(&differences(f64::exp, 1.0, 0.5, 40));
        assert!((found.value.re - 1f64.exp()).abs() < 1e-11, "{found:?}");
    }

    #[test]
    fn a_kink_shows_in_the_error() {
        // the central difference of |x|³ᐟ² has no even powers of the step
        let found = extrapolate(&differences(|x| x.abs().powf(1.5) * x.signum() + x, 0.0, 0.1, 4));
        assert!((found.value.re - 1.0).abs() <= 3.0 * found.error && found.error > 1e-2, "{found:?}");
    }
}
