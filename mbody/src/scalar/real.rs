//! The arithmetic every law is written in.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number, possibly with derivatives attached.
///
/// Products with `f64` are separate operations: a constant costs no derivative arithmetic.
/// Branch on [`Real::value`] only where the function is at least C1 across the branch.
pub trait Real:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign<f64>
    + SubAssign<f64>
    + MulAssign<f64>
{
    /// A constant.
    fn from_f64(value: f64) -> Self;
    /// The real part.
    fn value(self) -> f64;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Square root; not differentiable at 0.
    fn sqrt(self) -> Self;
    /// 1/x.
    fn recip(self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// Angle of the point (x, self); not differentiable at (0, 0).
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// x to a constant real power; x > 0.
    fn powf(self, exponent: f64) -> Self;

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::default()
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    /// Sine.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Tangent.
    #[inline(always)]
    fn tan(self) -> Self {
        let (s, c) = self.sin_cos();
        s / c
    }
    /// x².
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
    /// x to an integer power.
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        if exponent < 0 {
            return self.powi(-exponent).recip();
        }
        let (mut result, mut power, mut left) = (Self::one(), self, exponent);
        while left > 0 {
            if left & 1 == 1 {
                result *= power;
            }
            power *= power;
            left >>= 1;
        }
        result
    }
    /// |x| with derivative sign(x), and derivative 0 at x = 0.
    #[inline(always)]
    fn abs(self) -> Self {
        self * self.sign()
    }
    /// Sign of the real part: −1, 0 or 1.
    #[inline(always)]
    fn sign(self) -> f64 {
        let x = self.value();
        if x > 0.0 {
            1.0
        } else if x < 0.0 {
            -1.0
        } else {
            0.0
        }
    }
}

/// Sine, cosine and arc tangents are those of `libm`: alike on every machine, and half the price of a call into the C library.
impl Real for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn atan(self) -> Self {
        libm::atan(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        f64::tanh(self)
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        f64::powf(self, exponent)
    }
}
