//! A number with N directional derivatives over any other scalar.
//!
//! `f(x + Σ εᵢ dᵢ) = f(x) + f′(x) Σ εᵢ dᵢ`, εᵢ εⱼ = 0. Constraints get the direction of their forces from it: the derivatives of an
//! error along the six small displacements of a frame are the wrench of a unit multiplier.

use super::Real;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Value and N derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Dual<S, const N: usize> {
    /// Value.
    pub x: S,
    /// Derivatives.
    pub d: [S; N],
}

impl<S: Real, const N: usize> Default for Dual<S, N> {
    fn default() -> Self {
        Self::constant(S::zero())
    }
}

impl<S: Real, const N: usize> Dual<S, N> {
    /// A constant.
    #[inline(always)]
    pub fn constant(x: S) -> Self {
        Self { x, d: [S::zero(); N] }
    }

    /// f(x) from value and slope of f.
    #[inline(always)]
    fn chain(self, f: S, slope: S) -> Self {
        Self { x: f, d: self.d.map(|d| slope * d) }
    }

    /// Product.
    #[inline(always)]
    fn times(self, b: Self) -> Self {
        Self { x: self.x * b.x, d: from_fn(|i| self.d[i] * b.x + self.x * b.d[i]) }
    }

    /// Quotient, by differentiating x = q b.
    #[inline(always)]
    fn over(self, b: Self) -> Self {
        let per = b.x.recip();
        let x = self.x * per;
        Self { x, d: from_fn(|i| (self.d[i] - x * b.d[i]) * per) }
    }
}

impl<S: Real, const N: usize> Neg for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, d: self.d.map(|d| -d) }
    }
}

impl<S: Real, const N: usize> Add for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { x: self.x + b.x, d: from_fn(|i| self.d[i] + b.d[i]) }
    }
}

impl<S: Real, const N: usize> Sub for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { x: self.x - b.x, d: from_fn(|i| self.d[i] - b.d[i]) }
    }
}

impl<S: Real, const N: usize> Mul for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self.times(b)
    }
}

impl<S: Real, const N: usize> Div for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.over(b)
    }
}

impl<S: Real, const N: usize> Add<f64> for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: f64) -> Self {
        Self { x: self.x + b, d: self.d }
    }
}

impl<S: Real, const N: usize> Sub<f64> for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: f64) -> Self {
        Self { x: self.x - b, d: self.d }
    }
}

impl<S: Real, const N: usize> Mul<f64> for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: f64) -> Self {
        Self { x: self.x * b, d: self.d.map(|d| d * b) }
    }
}

impl<S: Real, const N: usize> Div<f64> for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: f64) -> Self {
        Self { x: self.x / b, d: self.d.map(|d| d / b) }
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $op:tt $rhs:ty),*) => {$(
        impl<S: Real, const N: usize> $trait<$rhs> for Dual<S, N> {
            #[inline(always)]
            fn $method(&mut self, b: $rhs) {
                *self = *self $op b;
            }
        }
    )*};
}
assign!(AddAssign add_assign + Self, SubAssign sub_assign - Self, MulAssign mul_assign * Self, DivAssign div_assign / Self,
        AddAssign add_assign + f64, SubAssign sub_assign - f64, MulAssign mul_assign * f64);

impl<S: Real, const N: usize> Real for Dual<S, N> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::constant(S::from_f64(value))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.x.value()
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.x.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.x.sqrt();
        self.chain(root, root.recip() * 0.5)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let i = self.x.recip();
        self.chain(i, -i * i)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.x.exp();
        self.chain(e, e)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.x.ln(), self.x.recip())
    }
    #[inline(always)]
    fn atan(self) -> Self {
        self.chain(self.x.atan(), (self.x * self.x + 1.0).recip())
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let (s, c) = (self, x);
        let per = (s.x * s.x + c.x * c.x).recip();
        Self { x: s.x.atan2(c.x), d: from_fn(|i| (c.x * s.d[i] - s.x * c.d[i]) * per) }
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        let t = self.x.tanh();
        self.chain(t, -(t * t) + 1.0)
    }
    #[inline(always)]
    fn powf(self, n: f64) -> Self {
        self.chain(self.x.powf(n), self.x.powf(n - 1.0) * n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Jet;

    /// Every operation at once, away from its singular points.
    fn f<R: Real>(x: R, y: R) -> R {
        let (s, c) = (x * y).sin_cos();
        let a = (s * 2.0 + 3.0).ln() * (c * 0.5).exp() - (x * x + y * y + 0.1).sqrt() / (y + 4.0);
        a + (s.atan2(c + 2.0) + x.atan()).tanh() * (y * 0.3 + 2.0).powf(1.7) - (x / 3.0 - 5.0).recip()
    }

    #[test]
    fn two_directions_are_two_jets() {
        for (x, y) in [(0.3, -0.7), (1.4, 0.2), (-0.9, 1.1)] {
            let both = f(Dual { x, d: [1.0, 0.0] }, Dual { x: y, d: [0.0, 1.0] });
            let along = |dx, dy| f(Jet::new(x, dx, 0.0), Jet::new(y, dy, 0.0)).d;
            assert!((both.x - f(x, y)).abs() < 1e-15);
            assert!((both.d[0] - along(1.0, 0.0)).abs() < 1e-14 && (both.d[1] - along(0.0, 1.0)).abs() < 1e-14);
        }
    }
}
