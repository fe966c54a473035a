//! Translation along a fixed axis: `p_FM = a q`, `H = (0; a)`.

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Turn, Twist, Vec3, Wrench};

/// Translation by `q` (m) along a unit axis.
#[derive(Clone, Copy, Debug)]
pub struct Prismatic {
    axis: Vec3<f64>,
}

impl Prismatic {
    /// Along a unit axis.
    pub fn new(axis: Vec3<f64>) -> Self {
        Self { axis }
    }
}

impl JointLaw for Prismatic {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "travel", unit: "m", about: "travel along the joint axis", nominal: 0.01, cyclic: false }]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "speed", unit: "m/s", about: "speed along the joint axis", nominal: 1.0, cyclic: false }]
    }
    fn turn(&self) -> Turn {
        Turn::Still
    }
    #[inline(always)]
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(Rotation::identity(), self.axis.times(q[0]))
    }
    #[inline(always)]
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        H[0] = Twist::new(Vec3::zero(), Vec3::from_f64(self.axis));
    }
    fn subspace_is_constant(&self) -> bool {
        true
    }
    #[inline(always)]
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
    #[inline(always)]
    fn motion<S: Real>(&self, _H: &[Twist<S>], v: &[S]) -> Twist<S> {
        Twist::new(Vec3::zero(), self.axis.times(v[0]))
    }
    #[inline(always)]
    fn effort<S: Real>(&self, _H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        tau[0] = F.f.dot_const(self.axis);
    }
    #[inline(always)]
    fn placed<S: Real>(&self, X_PF: &Pose<f64>, q: &[S]) -> Pose<S> {
        let along = X_PF.R.apply(self.axis).times(q[0]);
        Pose::new(Rotation::from_f64(&X_PF.R), Vec3::new(along.x + X_PF.p.x, along.y + X_PF.p.y, along.z + X_PF.p.z))
    }
}
