//! Free rotation: unit quaternion (x, y, z, w), velocity w in M.
//!
//! `q̇ = ½ q ∘ (w, 0) + (1 − |q|²) q`: the last term vanishes on the unit sphere and draws back to it, so that steady states
//! and integrators need no separate normalization. Source of N: Diebel (2006), equation 152.

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Twist, Vec3};

/// Free rotation about a point.
#[derive(Clone, Copy, Debug)]
pub struct Spherical;

/// Rate of a quaternion (x, y, z, w) whose body turns with w, given in the body.
#[inline(always)]
pub(super) fn quaternion_rate<S: Real>(q: &[S], w: Vec3<S>, rate: &mut [S]) {
    let [x, y, z, r] = [q[0], q[1], q[2], q[3]];
    let pull = -(x * x + y * y + z * z + r * r) + 1.0;
    rate[0] = (r * w.x + y * w.z - z * w.y) * 0.5 + pull * x;
    rate[1] = (r * w.y + z * w.x - x * w.z) * 0.5 + pull * y;
    rate[2] = (r * w.z + x * w.y - y * w.x) * 0.5 + pull * z;
    rate[3] = -(x * w.x + y * w.y + z * w.z) * 0.5 + pull * r;
}

impl JointLaw for Spherical {
    fn coordinates(&self) -> &'static [Coordinate] {
        const fn q(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "-", about: "component of the unit quaternion", nominal: 0.01, cyclic: false }
        }
        const Q: [Coordinate; 4] = [q("quaternion_x"), q("quaternion_y"), q("quaternion_z"), q("quaternion_w")];
        &Q
    }
    fn velocities(&self) -> &'static [Coordinate] {
        const fn w(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "rad/s", about: "angular velocity in axes of the body", nominal: 1.0, cyclic: false }
        }
        const W: [Coordinate; 3] = [w("angular_velocity_x"), w("angular_velocity_y"), w("angular_velocity_z")];
        &W
    }
    fn reference(&self) -> Vec<f64> {
        vec![0.0, 0.0, 0.0, 1.0]
    }
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(Rotation::from_quaternion([q[0], q[1], q[2], q[3]]), Vec3::zero())
    }
    fn rates<S: Real>(&self, q: &[S], v: &[S], rates: &mut [S]) {
        quaternion_rate(q, Vec3::new(v[0], v[1], v[2]), rates);
    }
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        let X = Rotation::identity();
        for k in 0..3 {
            H[k] = Twist::new(X.columns[k], Vec3::zero());
        }
    }
    fn subspace_is_constant(&self) -> bool {
        true
    }
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
    fn motion<S: Real>(&self, _H: &[Twist<S>], v: &[S]) -> Twist<S> {
        Twist::new(Vec3::new(v[0], v[1], v[2]), Vec3::zero())
    }
}
