//! Motion in the plane across an axis: coordinates (x, y, angle), velocities (v_x, v_y, rate) in the moving frame.
//!
//! `p = x e₁ + y e₂`, `R = exp([a]× ψ)`, `ẋ = v_x cos ψ − v_y sin ψ`, `ẏ = v_x sin ψ + v_y cos ψ`; H is constant in M.

use super::{Coordinate, JointLaw, revolute::rotation};
use crate::scalar::Real;
use crate::spatial::{Pose, Turn, Twist, Vec3};

/// Translation along e₁ and e₂ and rotation about their normal.
#[derive(Clone, Copy, Debug)]
pub struct Planar {
    axis: Vec3<f64>,
    e1: Vec3<f64>,
    e2: Vec3<f64>,
}

impl Planar {
    /// The plane across a unit axis. For the z axis e₁ and e₂ are x and y; else e₁ is the axis among x, y, z most
    /// across the normal, made perpendicular to it.
    pub fn new(axis: Vec3<f64>) -> Self {
        let candidates = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        let mut best = candidates[0];
        for c in candidates {
            if c.dot(axis).abs() < best.dot(axis).abs() - 1e-12 {
                best = c;
            }
        }
        let e1 = (best - axis * best.dot(axis)).normalized().unwrap_or(best);
        Self { axis, e1, e2: axis.cross(e1) }
    }
}

impl JointLaw for Planar {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[
            Coordinate { name: "x", unit: "m", about: "position along the first direction of the plane", nominal: 0.01, cyclic: false },
            Coordinate { name: "y", unit: "m", about: "position along the second direction of the plane", nominal: 0.01, cyclic: false },
            Coordinate { name: "angle", unit: "rad", about: "angle about the normal of the plane", nominal: 0.01, cyclic: false },
        ]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[
            Coordinate {
                name: "velocity_x",
                unit: "m/s",
                about: "velocity along the first direction of the moving frame",
                nominal: 1.0,
                cyclic: false,
            },
            Coordinate {
                name: "velocity_y",
                unit: "m/s",
                about: "velocity along the second direction of the moving frame",
                nominal: 1.0,
                cyclic: false,
            },
            Coordinate { name: "rate", unit: "rad/s", about: "angular speed about the normal", nominal: 1.0, cyclic: false },
        ]
    }
    fn turn(&self) -> Turn {
        Turn::about(self.axis)
    }
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(rotation(self.axis, q[2]), self.e1.times(q[0]) + self.e2.times(q[1]))
    }
    fn rates<S: Real>(&self, q: &[S], v: &[S], rates: &mut [S]) {
        let (s, c) = q[2].sin_cos();
        rates[0] = v[0] * c - v[1] * s;
        rates[1] = v[0] * s + v[1] * c;
        rates[2] = v[2];
    }
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        H[0] = Twist::new(Vec3::zero(), Vec3::from_f64(self.e1));
        H[1] = Twist::new(Vec3::zero(), Vec3::from_f64(self.e2));
        H[2] = Twist::new(Vec3::from_f64(self.axis), Vec3::zero());
    }
    fn subspace_is_constant(&self) -> bool {
        true
    }
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
}
