//! Poses: orientation and position of one frame in another.

use super::{Rotation, Twist, Vec3, Wrench};
use crate::scalar::Real;
use std::ops::Mul;

/// Pose `X_AB`: orientation `R_AB` and origin `p_AB` (in A) of frame B in frame A. `X_AC = X_AB * X_BC`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S> {
    /// Orientation of B in A.
    pub R: Rotation<S>,
    /// Position of B's origin, from A's origin, in A.
    pub p: Vec3<S>,
}

impl<S: Real> Default for Pose<S> {
    fn default() -> Self {
        Self::identity()
    }
}

impl<S: Real> Pose<S> {
    /// A pose from its parts.
    #[inline(always)]
    pub fn new(R: Rotation<S>, p: Vec3<S>) -> Self {
        Self { R, p }
    }

    /// B is A.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { R: Rotation::identity(), p: Vec3::zero() }
    }

    /// Lifts a constant pose.
    #[inline]
    pub fn from_f64(X: &Pose<f64>) -> Self {
        Self { R: Rotation::from_f64(&X.R), p: Vec3::from_f64(X.p) }
    }

    /// `X_BA`.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        Self { R: self.R.inverse(), p: -self.R.inverse_times(self.p) }
    }

    /// Position in A of a point given in B.
    #[inline(always)]
    pub fn point(&self, p_BQ: Vec3<S>) -> Vec3<S> {
        self.R * p_BQ + self.p
    }

    /// Position in A of a constant point given in B.
    #[inline(always)]
    pub fn point_const(&self, p_BQ: Vec3<f64>) -> Vec3<S> {
        self.R.times_const(p_BQ) + self.p
    }

    /// The twist V, written in A about Ao, written in B about Bo (same motion): `ᴮX_A V`.
    #[inline(always)]
    pub fn twist_to_child(&self, V_A: Twist<S>) -> Twist<S> {
        Twist::new(self.R.inverse_times(V_A.w), self.R.inverse_times(V_A.v + V_A.w.cross(self.p)))
    }

    /// The twist V, written in B about Bo, written in A about Ao (same motion).
    #[inline(always)]
    pub fn twist_to_parent(&self, V_B: Twist<S>) -> Twist<S> {
        let w = self.R * V_B.w;
        Twist::new(w, self.R * V_B.v + self.p.cross(w))
    }

    /// The wrench F, written in B about Bo, written in A about Ao: `ᴮX_Aᵀ F`.
    #[inline(always)]
    pub fn wrench_to_parent(&self, F_B: Wrench<S>) -> Wrench<S> {
        let f = self.R * F_B.f;
        Wrench::new(self.R * F_B.n + self.p.cross(f), f)
    }
}

impl Pose<f64> {
    /// From URDF `xyz` and `rpy`.
    pub fn from_xyz_rpy(xyz: [f64; 3], rpy: [f64; 3]) -> Self {
        Self { R: Rotation::from_rpy(rpy), p: xyz.into() }
    }

    /// Constant pose times a pose of any scalar.
    #[inline(always)]
    pub fn compose<S: Real>(&self, X_BC: &Pose<S>) -> Pose<S> {
        let p = self.R.apply(X_BC.p);
        Pose { R: self.R.compose(&X_BC.R), p: Vec3::new(p.x + self.p.x, p.y + self.p.y, p.z + self.p.z) }
    }
}

impl<S: Real> Mul for Pose<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, X_BC: Self) -> Self {
        Self { R: self.R * X_BC.R, p: self.R * X_BC.p + self.p }
    }
}
