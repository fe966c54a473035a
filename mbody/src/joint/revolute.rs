//! Rotation about a fixed axis: `R_FM = exp([a]× q)`, `H = (a; 0)`.

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Twist, Vec3, Wrench};

/// Rotation by `q` (rad) about a unit axis fixed in both frames.
#[derive(Clone, Copy, Debug)]
pub struct Revolute {
    axis: Vec3<f64>,
}

impl Revolute {
    /// About a unit axis.
    pub fn new(axis: Vec3<f64>) -> Self {
        Self { axis }
    }
}

/// `R(axis, angle)`, with the axis-aligned cases spared their zeros.
#[inline(always)]
pub(super) fn rotation<S: Real>(axis: Vec3<f64>, angle: S) -> Rotation<S> {
    match (axis.x, axis.y, axis.z) {
        (1.0, 0.0, 0.0) => Rotation::about_x(angle),
        (0.0, 1.0, 0.0) => Rotation::about_y(angle),
        (0.0, 0.0, 1.0) => Rotation::about_z(angle),
        _ => Rotation::about_axis(axis, angle),
    }
}

impl JointLaw for Revolute {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "angle", unit: "rad", about: "angle about the joint axis, right-hand rule", nominal: 0.01, cyclic: false }]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "rate", unit: "rad/s", about: "angular speed about the joint axis", nominal: 1.0, cyclic: false }]
    }
    fn rotation_axis(&self) -> Option<Vec3<f64>> {
        Some(self.axis)
    }
    #[inline(always)]
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(rotation(self.axis, q[0]), Vec3::zero())
    }
    #[inline(always)]
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        H[0] = Twist::new(Vec3::from_f64(self.axis), Vec3::zero());
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
        Twist::new(self.axis.times(v[0]), Vec3::zero())
    }
    #[inline(always)]
    fn effort<S: Real>(&self, _H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        tau[0] = F.n.dot_const(self.axis);
    }
    #[inline(always)]
    fn placed<S: Real>(&self, X_PF: &Pose<f64>, q: &[S]) -> Pose<S> {
        let [x, y, z] = X_PF.R.columns;
        let (s, c) = q[0].sin_cos();
        // a column pair (u, w) turned in its plane: c u + s w, c w − s u
        let turn = |u: Vec3<f64>, w: Vec3<f64>| (u.times(c) + w.times(s), w.times(c) - u.times(s));
        let R = match (self.axis.x, self.axis.y, self.axis.z) {
            (1.0, 0.0, 0.0) => {
                let (y, z) = turn(y, z);
                Rotation::from_columns(Vec3::from_f64(x), y, z)
            }
            (0.0, 1.0, 0.0) => {
                let (z, x) = turn(z, x);
                Rotation::from_columns(x, Vec3::from_f64(y), z)
            }
            (0.0, 0.0, 1.0) => {
                let (x, y) = turn(x, y);
                Rotation::from_columns(x, y, Vec3::from_f64(z))
            }
            _ => X_PF.R.compose(&Rotation::about_axis(self.axis, q[0])),
        };
        Pose::new(R, Vec3::from_f64(X_PF.p))
    }
}
