//! Twists and spatial accelerations.

use super::{Vec3, Wrench};
use crate::scalar::Real;
use std::ops::{Add, AddAssign, Neg, Sub};

/// Spatial motion vector: angular part w, linear part v of the point at the origin of the frame it is written in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Twist<S> {
    /// Angular velocity (or acceleration).
    pub w: Vec3<S>,
    /// Linear velocity (or acceleration) at the origin.
    pub v: Vec3<S>,
}

impl<S: Real> Twist<S> {
    /// From angular and linear part.
    #[inline(always)]
    pub fn new(w: Vec3<S>, v: Vec3<S>) -> Self {
        Self { w, v }
    }

    /// No motion.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::default()
    }

    /// Lifts a constant.
    #[inline]
    pub fn from_f64(t: &Twist<f64>) -> Self {
        Self::new(Vec3::from_f64(t.w), Vec3::from_f64(t.v))
    }

    /// Each component times s.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        Self::new(self.w.scaled(s), self.v.scaled(s))
    }

    /// `self ×`: the rate of a motion vector that is fixed in a body moving with this twist.
    #[inline(always)]
    pub fn cross(self, m: Self) -> Self {
        Self::new(self.w.cross(m.w), self.w.cross(m.v) + self.v.cross(m.w))
    }

    /// `self ×*`: the rate of a force vector that is fixed in a body moving with this twist.
    #[inline(always)]
    pub fn cross_star(self, f: Wrench<S>) -> Wrench<S> {
        Wrench::new(self.w.cross(f.n) + self.v.cross(f.f), self.w.cross(f.f))
    }

    /// Power `n·w + f·v`.
    #[inline(always)]
    pub fn dot(self, f: Wrench<S>) -> S {
        self.w.dot(f.n) + self.v.dot(f.f)
    }

    /// Linear velocity of the point at p (in the same frame).
    #[inline(always)]
    pub fn at_point(self, p: Vec3<S>) -> Vec3<S> {
        self.v + self.w.cross(p)
    }
}

impl Twist<f64> {
    /// Constant motion vector times a scalar of any kind.
    #[inline(always)]
    pub fn times<S: Real>(&self, s: S) -> Twist<S> {
        Twist::new(self.w.times(s), self.v.times(s))
    }
}

impl<S: Real> Add for Twist<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.w + b.w, self.v + b.v)
    }
}

impl<S: Real> Sub for Twist<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.w - b.w, self.v - b.v)
    }
}

impl<S: Real> Neg for Twist<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.w, -self.v)
    }
}

impl<S: Real> AddAssign for Twist<S> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
