//! A quantity with its first and second time derivative along one motion.
//!
//! `x(t) = x + ẋ t + ½ ẍ t²`, truncated: the arithmetic of second-order Taylor polynomials. From the pose of a joint on
//! jets follow its twist and its acceleration; constraints get rate and acceleration bias from their error alone.

use super::Real;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Value, rate and second rate of one quantity.
#[derive(Clone, Copy, Debug, Default)]
pub struct Jet<S> {
    /// Value.
    pub x: S,
    /// First derivative with respect to time.
    pub d: S,
    /// Second derivative with respect to time.
    pub dd: S,
}

impl<S: Real> Jet<S> {
    /// A jet from its three parts.
    #[inline]
    pub fn new(x: S, d: S, dd: S) -> Self {
        Self { x, d, dd }
    }

    /// A constant.
    #[inline]
    pub fn constant(x: S) -> Self {
        Self { x, d: S::zero(), dd: S::zero() }
    }

    /// f(x) from value, slope and second derivative of f.
    #[inline(always)]
    fn chain(self, f: S, f1: S, f2: S) -> Self {
        Self { x: f, d: f1 * self.d, dd: f1 * self.dd + f2 * self.d * self.d }
    }
}

impl<S: Real> Neg for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.d, -self.dd)
    }
}

impl<S: Real> Add for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.d + b.d, self.dd + b.dd)
    }
}

impl<S: Real> Sub for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.d - b.d, self.dd - b.dd)
    }
}

impl<S: Real> Mul for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::new(self.x * b.x, self.d * b.x + self.x * b.d, self.dd * b.x + self.d * b.d * 2.0 + self.x * b.dd)
    }
}

impl<S: Real> Div for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        // x = q b, differentiated twice
        let x = self.x / b.x;
        let d = (self.d - x * b.d) / b.x;
        Self::new(x, d, (self.dd - d * b.d * 2.0 - x * b.dd) / b.x)
    }
}

impl<S: Real> Add<f64> for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: f64) -> Self {
        Self::new(self.x + b, self.d, self.dd)
    }
}

impl<S: Real> Sub<f64> for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: f64) -> Self {
        Self::new(self.x - b, self.d, self.dd)
    }
}

impl<S: Real> Mul<f64> for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: f64) -> Self {
        Self::new(self.x * b, self.d * b, self.dd * b)
    }
}

impl<S: Real> Div<f64> for Jet<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: f64) -> Self {
        Self::new(self.x / b, self.d / b, self.dd / b)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $op:tt $rhs:ty),*) => {$(
        impl<S: Real> $trait<$rhs> for Jet<S> {
            #[inline(always)]
            fn $method(&mut self, b: $rhs) {
                *self = *self $op b;
            }
        }
    )*};
}
assign!(AddAssign add_assign + Self, SubAssign sub_assign - Self, MulAssign mul_assign * Self, DivAssign div_assign / Self,
        AddAssign add_assign + f64, SubAssign sub_assign - f64, MulAssign mul_assign * f64);

impl<S: Real> Real for Jet<S> {
    #[inline]
    fn from_f64(value: f64) -> Self {
        Self::constant(S::from_f64(value))
    }
    #[inline]
    fn value(self) -> f64 {
        self.x.value()
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.x.sin_cos();
        (self.chain(s, c, -s), self.chain(c, -s, -c))
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.x.sqrt();
        let slope = root.recip() * 0.5;
        self.chain(root, slope, -(slope / self.x) * 0.5)
    }
    #[inline]
    fn recip(self) -> Self {
        let i = self.x.recip();
        self.chain(i, -i * i, i * i * i * 2.0)
    }
    #[inline]
    fn exp(self) -> Self {
        let e = self.x.exp();
        self.chain(e, e, e)
    }
    #[inline]
    fn ln(self) -> Self {
        let i = self.x.recip();
        self.chain(self.x.ln(), i, -i * i)
    }
    #[inline]
    fn atan(self) -> Self {
        let slope = (self.x * self.x + 1.0).recip();
        self.chain(self.x.atan(), slope, -self.x * slope * slope * 2.0)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        // θ̇ = (c ṡ − s ċ)/r², differentiated once more by jets of the first order
        let (s, c) = (self, x);
        let r2 = (s.x * s.x + c.x * c.x).recip();
        let rate = (c.x * s.d - s.x * c.d) * r2;
        let r2_rate = (s.x * s.d + c.x * c.d) * 2.0;
        let second = (c.x * s.dd - s.x * c.dd) * r2 - rate * r2 * r2_rate;
        Self::new(s.x.atan2(c.x), rate, second)
    }
    #[inline]
    fn tanh(self) -> Self {
        let t = self.x.tanh();
        let slope = -(t * t) + 1.0;
        self.chain(t, slope, -t * slope * 2.0)
    }
    #[inline]
    fn powf(self, n: f64) -> Self {
        self.chain(self.x.powf(n), self.x.powf(n - 1.0) * n, self.x.powf(n - 2.0) * (n * (n - 1.0)))
    }
}
