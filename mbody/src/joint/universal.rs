//! Two crossing axes: `R_FM = Rx(q₁) Ry(q₂)`.
//!
//! `H = [(Ryᵀ x), y]` in M: the first axis is fixed in F (its x), the second in M (its y). Singular nowhere.

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Twist, Vec3};

/// Rotation about x of F, then about y of M.
#[derive(Clone, Copy, Debug)]
pub struct Universal;

impl JointLaw for Universal {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[
            Coordinate { name: "first_angle", unit: "rad", about: "angle about x of the inboard frame", nominal: 0.01, cyclic: false },
            Coordinate { name: "second_angle", unit: "rad", about: "angle about y of the outboard frame", nominal: 0.01, cyclic: false },
        ]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[
            Coordinate {
                name: "first_rate",
                unit: "rad/s",
                about: "angular speed about x of the inboard frame",
                nominal: 1.0,
                cyclic: false,
            },
            Coordinate {
                name: "second_rate",
                unit: "rad/s",
                about: "angular speed about y of the outboard frame",
                nominal: 1.0,
                cyclic: false,
            },
        ]
    }
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(Rotation::about_x(q[0]) * Rotation::about_y(q[1]), Vec3::zero())
    }
    fn subspace<S: Real>(&self, q: &[S], H: &mut [Twist<S>]) {
        let (s, c) = q[1].sin_cos();
        H[0] = Twist::new(Vec3::new(c, S::zero(), s), Vec3::zero());
        H[1] = Twist::new(Vec3::new(S::zero(), S::one(), S::zero()), Vec3::zero());
    }
    fn bias<S: Real>(&self, q: &[S], v: &[S]) -> Twist<S> {
        let (s, c) = q[1].sin_cos();
        let both = v[0] * v[1];
        Twist::new(Vec3::new(-s * both, S::zero(), c * both), Vec3::zero())
    }
}
