//! The functions that friction laws of the Magic Formula family are made of.
//!
//! ```text
//! θ(x; E) = atan(x − E (x − atan x))      force: D sin(C θ)      moment arm: D cos(C θ)
//! ```
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, chapter 4.

use mbody::scalar::Real;

/// Added to squares of slips under a root: smooth at zero slip, and too small to be seen elsewhere.
pub(super) const TINY_SQUARED: f64 = 1e-16;

/// Angle θ of the Magic Formula for x = B·slip and curvature factor E.
#[inline]
pub(super) fn angle<S: Real>(x: S, e: S) -> S {
    (x - e * (x - x.atan())).atan()
}

/// cos(atan x).
#[inline]
pub(super) fn cos_atan<S: Real>(x: S) -> S {
    (x * x + 1.0).sqrt().recip()
}

/// cos(C atan x): how a force or a moment arm fades with slip in the other direction.
#[inline]
pub(super) fn fading<S: Real>(c: f64, x: S) -> S {
    (x.atan() * c).cos()
}

/// Length of a pair of slips, smooth at zero.
#[inline]
pub(super) fn length<S: Real>(a: S, b: S) -> S {
    (a * a + b * b + TINY_SQUARED).sqrt()
}

/// sin(p atan u)/u, even in u and finite at 0: a stiffness that saturates with load, per unit of load.
#[inline]
pub(super) fn saturation<S: Real>(p: f64, u: S) -> S {
    if u.value().abs() < 1e-4 {
        // next term of the series: of order u⁴ = 1e-16
        return u * u * (-p / 3.0 - p * p * p / 6.0) + p;
    }
    (u.atan() * p).sin() / u
}

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::scalar::Jet;

    #[test]
    fn the_saturating_stiffness_joins_its_series() {
        for p in [0.7, 2.0, 2.5] {
            let (series, closed) = (saturation(p, Jet::new(0.999_999e-4, 1.0, 0.0)), saturation(p, Jet::new(1.000_001e-4, 1.0, 0.0)));
            assert!((series.x - closed.x).abs() < 1e-12 && (series.d - closed.d).abs() < 1e-8);
            // sin(2 atan u) = 2u/(1 + u²)
            assert!((saturation(2.0, 0.3) - 2.0 / 1.09_f64).abs() < 1e-15);
        }
    }
}
