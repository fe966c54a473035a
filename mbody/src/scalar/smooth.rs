//! Smooth replacements of kinked functions, so that Newton and integrators see derivatives.
//!
//! Source: `smax`, `splus` are the usual square-root forms; the ramp is the C2 cubic-quartic used for end stops.

use super::Real;

/// Smooth positive part `(x + √(x² + 4e²))/2`; `splus(x) − splus(−x) = x` exactly, value `e` at 0.
#[inline]
pub fn splus<S: Real>(x: S, e: f64) -> S {
    (x + (x * x + 4.0 * e * e).sqrt()) * 0.5
}

/// Smooth absolute value `√(x² + e²)`; value `e` at 0.
#[inline]
pub fn sabs<S: Real>(x: S, e: f64) -> S {
    (x * x + e * e).sqrt()
}

/// One-sided C2 ramp: 0 for x ≤ 0, `x³/w² − x⁴/(2w³)` up to w, then `x − w/2`.
#[inline]
pub fn ramp<S: Real>(x: S, w: f64) -> S {
    let at = x.value();
    if at <= 0.0 {
        S::zero()
    } else if at < w {
        let u = x / w;
        u * u * u * (-(u * 0.5) + 1.0) * w
    } else {
        x - 0.5 * w
    }
}

/// Integral of [`ramp`] from 0: the energy of a stop of unit stiffness.
#[inline]
pub fn ramp_integral<S: Real>(x: S, w: f64) -> S {
    let at = x.value();
    if at <= 0.0 {
        S::zero()
    } else if at < w {
        let u = x / w;
        u.powi(4) * (-(u * 0.1) + 0.25) * (w * w)
    } else {
        // ∫₀ʷ = 0.15 w²
        let beyond = x - w;
        beyond * beyond * 0.5 + beyond * (0.5 * w) + 0.15 * w * w
    }
}

/// Smooth step from 0 at x ≤ 0 to 1 at x ≥ w, `6u⁵ − 15u⁴ + 10u³`: C2.
#[inline]
pub fn step<S: Real>(x: S, w: f64) -> S {
    let at = x.value();
    if at <= 0.0 {
        S::zero()
    } else if at < w {
        let u = x / w;
        u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
    } else {
        S::one()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Jet;

    #[test]
    fn splus_splits_a_number_into_its_parts() {
        for x in [-3.0, -0.1, 0.0, 0.2, 5.0_f64] {
            assert!((splus(x, 0.5) - splus(-x, 0.5) - x).abs() < 1e-14);
        }
    }

    #[test]
    fn ramp_is_the_derivative_of_its_integral_and_twice_differentiable() {
        for x in [-0.1, 0.0, 0.3, 0.999_999, 1.0, 1.000_001, 2.5_f64] {
            let j = ramp_integral(Jet::new(x, 1.0, 0.0), 1.0);
            assert!((j.d - ramp(x, 1.0)).abs() < 1e-12, "at {x}");
        }
        let below = ramp(Jet::new(1.0 - 1e-12, 1.0, 0.0), 1.0);
        let above = ramp(Jet::new(1.0 + 1e-12, 1.0, 0.0), 1.0);
        assert!((below.x - above.x).abs() < 1e-11 && (below.d - above.d).abs() < 1e-11 && (below.dd - above.dd).abs() < 1e-10);
    }
}
