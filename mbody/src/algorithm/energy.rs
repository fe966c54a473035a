//! Energy, momentum and mass center of the whole tree.
//!
//! `T = Σ ½ Vᵀ I V`, `U = −Σ m g·c`, `P = Σ m v_c`, `L_O = Σ (p × f + n)` of the body momenta `I V`.

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::{Vec3, Wrench};
use crate::stage::{Velocity, World};

/// Kinetic energy, J. O(n).
pub fn kinetic<S: SystemScalar>(model: &Model, velocity: &Velocity<S>) -> S {
    let mut twice = S::zero();
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let V = velocity.V_WB[i];
        twice += V.dot(body.inertia.apply(V));
    }
    twice * 0.5
}

/// Potential energy of gravity, J; zero with every mass at the world origin. O(n).
pub fn potential<S: SystemScalar>(model: &Model, world: &World<S>) -> S {
    let mut energy = S::zero();
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let c = world.X_WB[i].point_const(body.mass.center);
        energy -= c.dot_const(model.gravity) * body.mass.mass;
    }
    energy
}

/// Mass center in the world, m. O(n).
pub fn mass_center<S: SystemScalar>(model: &Model, world: &World<S>) -> Vec3<S> {
    let mut first = Vec3::zero();
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        first += world.X_WB[i].point_const(body.mass.center) * body.mass.mass;
    }
    first * (1.0 / model.total_mass())
}

/// Momentum about the world origin: angular (kg m²/s) and linear (kg m/s), in world axes. O(n).
pub fn momentum<S: SystemScalar>(model: &Model, world: &World<S>, velocity: &Velocity<S>) -> Wrench<S> {
    let mut sum = Wrench::zero();
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        sum += world.X_WB[i].wrench_to_parent(body.inertia.apply(velocity.V_WB[i]));
    }
    sum
}
