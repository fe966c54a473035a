//! Rotation matrices.

use super::Vec3;
use crate::scalar::Real;
use std::ops::Mul;

/// Orientation `R_AB` of frame B in frame A; its columns are the axes of B written in A.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Rotation<S> {
    /// Column vectors: the axes of B in A.
    pub columns: [Vec3<S>; 3],
}

impl<S: Real> Default for Rotation<S> {
    fn default() -> Self {
        Self::identity()
    }
}

impl<S: Real> Rotation<S> {
    /// From the axes of B written in A.
    #[inline(always)]
    pub fn from_columns(x: Vec3<S>, y: Vec3<S>, z: Vec3<S>) -> Self {
        Self { columns: [x, y, z] }
    }

    /// No rotation.
    #[inline(always)]
    pub fn identity() -> Self {
        let (o, l) = (S::zero(), S::one());
        Self::from_columns(Vec3::new(l, o, o), Vec3::new(o, l, o), Vec3::new(o, o, l))
    }

    /// Lifts a constant rotation.
    #[inline]
    pub fn from_f64(r: &Rotation<f64>) -> Self {
        Self { columns: [Vec3::from_f64(r.columns[0]), Vec3::from_f64(r.columns[1]), Vec3::from_f64(r.columns[2])] }
    }

    /// Rotation about x.
    #[inline(always)]
    pub fn about_x(angle: S) -> Self {
        let (s, c) = angle.sin_cos();
        let (o, l) = (S::zero(), S::one());
        Self::from_columns(Vec3::new(l, o, o), Vec3::new(o, c, s), Vec3::new(o, -s, c))
    }

    /// Rotation about y.
    #[inline(always)]
    pub fn about_y(angle: S) -> Self {
        let (s, c) = angle.sin_cos();
        let (o, l) = (S::zero(), S::one());
        Self::from_columns(Vec3::new(c, o, -s), Vec3::new(o, l, o), Vec3::new(s, o, c))
    }

    /// Rotation about z.
    #[inline(always)]
    pub fn about_z(angle: S) -> Self {
        let (s, c) = angle.sin_cos();
        let (o, l) = (S::zero(), S::one());
        Self::from_columns(Vec3::new(c, s, o), Vec3::new(-s, c, o), Vec3::new(o, o, l))
    }

    /// Rotation about a constant unit axis (Rodrigues).
    #[inline(always)]
    pub fn about_axis(axis: Vec3<f64>, angle: S) -> Self {
        let (s, c) = angle.sin_cos();
        let t = -c + 1.0;
        let Vec3 { x, y, z } = axis;
        Self::from_columns(
            Vec3::new(t * (x * x) + c, t * (x * y) + s * z, t * (x * z) - s * y),
            Vec3::new(t * (x * y) - s * z, t * (y * y) + c, t * (y * z) + s * x),
            Vec3::new(t * (x * z) + s * y, t * (y * z) - s * x, t * (z * z) + c),
        )
    }

    /// Rotation of a quaternion (x, y, z, w); it is normalized by the formula, so any non-zero quaternion is a rotation.
    #[inline(always)]
    pub fn from_quaternion(q: [S; 4]) -> Self {
        let [x, y, z, w] = q;
        let n = (x * x + y * y + z * z + w * w).recip() * 2.0;
        let (xs, ys, zs) = (x * n, y * n, z * n);
        let (wx, wy, wz) = (w * xs, w * ys, w * zs);
        let (xx, xy, xz) = (x * xs, x * ys, x * zs);
        let (yy, yz, zz) = (y * ys, y * zs, z * zs);
        Self::from_columns(
            Vec3::new(-(yy + zz) + 1.0, xy + wz, xz - wy),
            Vec3::new(xy - wz, -(xx + zz) + 1.0, yz + wx),
            Vec3::new(xz + wy, yz - wx, -(xx + yy) + 1.0),
        )
    }

    /// `R_BA`.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let [a, b, c] = self.columns;
        Self::from_columns(Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z))
    }

    /// `R_BA v_A`: the vector v, given in A, written in B.
    #[inline(always)]
    pub fn inverse_times(&self, v_A: Vec3<S>) -> Vec3<S> {
        Vec3::new(self.columns[0].dot(v_A), self.columns[1].dot(v_A), self.columns[2].dot(v_A))
    }

    /// `R_AB v_B` for a constant vector.
    #[inline(always)]
    pub fn times_const(&self, v_B: Vec3<f64>) -> Vec3<S> {
        self.columns[0] * v_B.x + self.columns[1] * v_B.y + self.columns[2] * v_B.z
    }
}

impl Rotation<f64> {
    /// URDF roll-pitch-yaw: `Rz(yaw) Ry(pitch) Rx(roll)`.
    pub fn from_rpy(rpy: [f64; 3]) -> Self {
        Self::about_z(rpy[2]) * Self::about_y(rpy[1]) * Self::about_x(rpy[0])
    }

    /// Constant rotation times a rotation of any scalar.
    #[inline(always)]
    pub fn compose<S: Real>(&self, b: &Rotation<S>) -> Rotation<S> {
        Rotation { columns: [self.apply(b.columns[0]), self.apply(b.columns[1]), self.apply(b.columns[2])] }
    }

    /// Constant rotation of a vector of any scalar.
    #[inline(always)]
    pub fn apply<S: Real>(&self, v: Vec3<S>) -> Vec3<S> {
        let [a, b, c] = self.columns;
        Vec3::new(v.x * a.x + v.y * b.x + v.z * c.x, v.x * a.y + v.y * b.y + v.z * c.y, v.x * a.z + v.y * b.z + v.z * c.z)
    }
}

impl<S: Real> Mul<Vec3<S>> for &Rotation<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v_B: Vec3<S>) -> Vec3<S> {
        self.columns[0].scaled(v_B.x) + self.columns[1].scaled(v_B.y) + self.columns[2].scaled(v_B.z)
    }
}

impl<S: Real> Mul<Vec3<S>> for Rotation<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v_B: Vec3<S>) -> Vec3<S> {
        &self * v_B
    }
}

impl<S: Real> Mul for Rotation<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self { columns: [self * b.columns[0], self * b.columns[1], self * b.columns[2]] }
    }
}
