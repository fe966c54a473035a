//! Free motion: position, unit quaternion (x, y, z, w); velocities are the twist in body axes, linear part first.
//!
//! `ṗ = R v`, `q̇` as in [`super::spherical`]; `H` exchanges the halves, because twists are written angular part first.

use super::{Coordinate, JointLaw, spherical::quaternion_rate};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Twist, Vec3, Wrench};

/// Six free degrees of freedom.
#[derive(Clone, Copy, Debug)]
pub struct Free;

impl JointLaw for Free {
    fn coordinates(&self) -> &'static [Coordinate] {
        const fn p(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "m", about: "position of the body origin", nominal: 0.01, cyclic: false }
        }
        const fn q(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "-", about: "component of the unit quaternion", nominal: 0.01, cyclic: false }
        }
        const Q: [Coordinate; 7] = [p("x"), p("y"), p("z"), q("quaternion_x"), q("quaternion_y"), q("quaternion_z"), q("quaternion_w")];
        &Q
    }
    fn velocities(&self) -> &'static [Coordinate] {
        const fn v(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "m/s", about: "velocity of the body origin in axes of the body", nominal: 1.0, cyclic: false }
        }
        const fn w(name: &'static str) -> Coordinate {
            Coordinate { name, unit: "rad/s", about: "angular velocity in axes of the body", nominal: 1.0, cyclic: false }
        }
        const V: [Coordinate; 6] =
            [v("velocity_x"), v("velocity_y"), v("velocity_z"), w("angular_velocity_x"), w("angular_velocity_y"), w("angular_velocity_z")];
        &V
    }
    fn reference(&self) -> Vec<f64> {
        vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    }
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        Pose::new(Rotation::from_quaternion([q[3], q[4], q[5], q[6]]), Vec3::new(q[0], q[1], q[2]))
    }
    fn rates<S: Real>(&self, q: &[S], v: &[S], rates: &mut [S]) {
        let p = Rotation::from_quaternion([q[3], q[4], q[5], q[6]]) * Vec3::new(v[0], v[1], v[2]);
        (rates[0], rates[1], rates[2]) = (p.x, p.y, p.z);
        quaternion_rate(&q[3..7], Vec3::new(v[3], v[4], v[5]), &mut rates[3..7]);
    }
    fn subspace<S: Real>(&self, _q: &[S], H: &mut [Twist<S>]) {
        let X = Rotation::identity();
        for k in 0..3 {
            H[k] = Twist::new(Vec3::zero(), X.columns[k]);
            H[k + 3] = Twist::new(X.columns[k], Vec3::zero());
        }
    }
    fn subspace_is_constant(&self) -> bool {
        true
    }
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
    fn motion<S: Real>(&self, _H: &[Twist<S>], v: &[S]) -> Twist<S> {
        Twist::new(Vec3::new(v[3], v[4], v[5]), Vec3::new(v[0], v[1], v[2]))
    }
    fn effort<S: Real>(&self, _H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        (tau[0], tau[1], tau[2]) = (F.f.x, F.f.y, F.f.z);
        (tau[3], tau[4], tau[5]) = (F.n.x, F.n.y, F.n.z);
    }
    fn wrench<S: Real>(&self, _H: &[Twist<S>], tau: &[S]) -> Option<Wrench<S>> {
        Some(Wrench::new(Vec3::new(tau[3], tau[4], tau[5]), Vec3::new(tau[0], tau[1], tau[2])))
    }
    fn velocity<S: Real>(&self, _H: &[Twist<S>], V: Twist<S>, v: &mut [S]) {
        v.copy_from_slice(&[V.v.x, V.v.y, V.v.z, V.w.x, V.w.y, V.w.z]);
    }
}
