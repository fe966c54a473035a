//! Rotation about an axis with proportional advance: `R = exp([a]× q)`, `p = a h q`, `H = (a; h a)`.

use super::{Coordinate, JointLaw, revolute::rotation};
use crate::scalar::Real;
use crate::spatial::{Pose, Turn, Twist, Vec3};

/// Rotation by `q` (rad) and advance `pitch·q` (m) along the same unit axis.
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    axis: Vec3<f64>,
    pitch: f64,
}

impl Screw {
    /// From a unit axis and a pitch in m per radian.
    pub fn new(axis: Vec3<f64>, pitch: f64) -> Self {
        Self { axis, pitch }
    }
}

impl JointLaw for Screw {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "angle", unit: "rad", about: "angle about the screw axis", nominal: 0.01, cyclic: false }]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[Coordinate { name: "rate", unit: "rad/s", about: "angular speed about the screw axis", nominal: 1.0, cyclic: false }]
    }
    fn turn(&self) -> Turn {
        Turn::about(self.axis)
    }
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(rotation(self.axis, q[0]), self.axis.times(q[0] * self.pitch))
    }
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        H[0] = Twist::new(Vec3::from_f64(self.axis), Vec3::from_f64(self.axis * self.pitch));
    }
    fn subspace_is_constant(&self) -> bool {
        true
    }
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
}
