//! Vectors of three components.

use crate::scalar::Real;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// A vector in three dimensions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<S> {
    /// First component.
    pub x: S,
    /// Second component.
    pub y: S,
    /// Third component.
    pub z: S,
}

impl<S: Real> Vec3<S> {
    /// A vector from its components.
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::default()
    }

    /// Lifts a constant vector.
    #[inline(always)]
    pub fn from_f64(c: Vec3<f64>) -> Self {
        Self::new(S::from_f64(c.x), S::from_f64(c.y), S::from_f64(c.z))
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Scalar product with a constant vector.
    #[inline(always)]
    pub fn dot_const(self, b: Vec3<f64>) -> S {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector product self × b.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self::new(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Vector product self × b with a constant vector.
    #[inline(always)]
    pub fn cross_const(self, b: Vec3<f64>) -> Self {
        Self::new(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Squared length.
    #[inline(always)]
    pub fn norm_squared(self) -> S {
        self.dot(self)
    }

    /// Length; not differentiable at zero.
    #[inline(always)]
    pub fn norm(self) -> S {
        self.norm_squared().sqrt()
    }

    /// Each component times s.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }

    /// The real parts.
    pub fn value(self) -> Vec3<f64> {
        Vec3 { x: self.x.value(), y: self.y.value(), z: self.z.value() }
    }
}

impl Vec3<f64> {
    /// Times a scalar of any kind.
    #[inline(always)]
    pub fn times<S: Real>(self, s: S) -> Vec3<S> {
        Vec3::new(s * self.x, s * self.y, s * self.z)
    }

    /// Vector of length one in the same direction; `None` for the zero vector or one that is not finite.
    pub fn normalized(self) -> Option<Self> {
        let length = self.norm();
        (length.is_finite() && length > 1e-12).then(|| self * (1.0 / length))
    }
}

impl<S: Real> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<S: Real> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<S: Real> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<S: Real> Mul<f64> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl<S: Real> AddAssign for Vec3<S> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<S: Real> SubAssign for Vec3<S> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<S> Index<usize> for Vec3<S> {
    type Output = S;
    #[inline(always)]
    fn index(&self, i: usize) -> &S {
        match i {
            0 => &self.x,
            1 => &self.y,
            2 => &self.z,
            _ => panic!("a vector has three components, not {}", i + 1),
        }
    }
}

impl<S> IndexMut<usize> for Vec3<S> {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut S {
        match i {
            0 => &mut self.x,
            1 => &mut self.y,
            2 => &mut self.z,
            _ => panic!("a vector has three components, not {}", i + 1),
        }
    }
}

impl From<[f64; 3]> for Vec3<f64> {
    fn from(c: [f64; 3]) -> Self {
        Self { x: c[0], y: c[1], z: c[2] }
    }
}

impl From<Vec3<f64>> for [f64; 3] {
    fn from(v: Vec3<f64>) -> Self {
        [v.x, v.y, v.z]
    }
}
