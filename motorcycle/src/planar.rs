//! Vectors of the plane of symmetry: x forward, z up, turned about y to the left.

use mbody::scalar::Real;
use std::ops::{Add, Neg, Sub};

/// A vector or point of the plane of symmetry, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planar<S> {
    /// Forward.
    pub x: S,
    /// Up.
    pub z: S,
}

impl<S: Real> Planar<S> {
    /// A vector from its coordinates.
    #[inline]
    pub fn new(x: S, z: S) -> Self {
        Self { x, z }
    }

    /// A constant vector.
    #[inline]
    pub fn from_f64(c: Planar<f64>) -> Self {
        Self::new(S::from_f64(c.x), S::from_f64(c.z))
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, b: Self) -> S {
        self.x * b.x + self.z * b.z
    }

    /// Component along y (to the left) of the vector product.
    #[inline]
    pub fn cross(self, b: Self) -> S {
        self.z * b.x - self.x * b.z
    }

    /// Length.
    #[inline]
    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }

    /// Multiplied by a number.
    #[inline]
    pub fn scaled(self, s: S) -> Self {
        Self::new(self.x * s, self.z * s)
    }

    /// Turned about y by the angle of this cosine and sine; a positive angle takes z to x.
    #[inline]
    pub fn turned(self, cos: S, sin: S) -> Self {
        Self::new(self.x * cos + self.z * sin, self.z * cos - self.x * sin)
    }
}

impl From<[f64; 2]> for Planar<f64> {
    fn from([x, z]: [f64; 2]) -> Self {
        Self { x, z }
    }
}

impl<S: Real> Add for Planar<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.z + b.z)
    }
}

impl<S: Real> Sub for Planar<S> {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.z - b.z)
    }
}

impl<S: Real> Neg for Planar<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::spatial::{Rotation, Vec3};

    #[test]
    fn turning_and_crossing_agree_with_space() {
        let (a, b, angle) = (Planar::from([0.3, -0.7]), Planar::from([-0.2, 0.5]), 0.83_f64);
        let space = |p: Planar<f64>| Vec3::new(p.x, 0.0, p.z);
        let turned = a.turned(angle.cos(), angle.sin());
        let expected = Rotation::about_y(angle) * space(a);
        assert!((turned.x - expected.x).abs() < 1e-15 && (turned.z - expected.z).abs() < 1e-15);
        assert!((a.cross(b) - space(a).cross(space(b)).y).abs() < 1e-15);
    }
}
