//! Wrenches: moment and force.

use super::Vec3;
use crate::scalar::Real;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

/// Spatial force vector: moment n about the origin of the frame it is written in, and force f.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Wrench<S> {
    /// Moment about the origin.
    pub n: Vec3<S>,
    /// Force.
    pub f: Vec3<S>,
}

impl<S: Real> Wrench<S> {
    /// From moment and force.
    #[inline(always)]
    pub fn new(n: Vec3<S>, f: Vec3<S>) -> Self {
        Self { n, f }
    }

    /// Nothing.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::default()
    }

    /// The same wrench about the point at p.
    #[inline(always)]
    pub fn shifted_to(self, p: Vec3<S>) -> Self {
        Self::new(self.n - p.cross(self.f), self.f)
    }

    /// Each component times s.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        Self::new(self.n.scaled(s), self.f.scaled(s))
    }
}

impl<S: Real> Add for Wrench<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.n + b.n, self.f + b.f)
    }
}

impl<S: Real> Sub for Wrench<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.n - b.n, self.f - b.f)
    }
}

impl<S: Real> Neg for Wrench<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.n, -self.f)
    }
}

impl<S: Real> AddAssign for Wrench<S> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<S: Real> SubAssign for Wrench<S> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
