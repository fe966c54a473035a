//! Poses, twists and accelerations, from the root outward.
//!
//! `X_WB = X_WP X_PB(q)`, `V = ᴮXᴾ V_P + H v`, `A = ᴮXᴾ A_P + H v̇ + Ḣ v + V × H v`.
//! Source: Featherstone (2008), equations 5.14–5.16.

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::{Twist, Vec3};
use crate::stage::{Acceleration, Position, Velocity, World};

/// Pose of each body in its parent and motion subspaces, from the tree coordinates in `position.q`. O(n).
#[inline]
pub fn position<S: SystemScalar>(model: &Model, position: &mut Position<S>) {
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (q, H) = (&position.q[body.q.clone()], &mut position.H[body.v.clone()]);
        body.joint.update(&body.X_PF, q, &mut position.X_PB[i], H);
    }
}

/// Pose of each body in the world. O(n).
#[inline]
pub fn world<S: SystemScalar>(model: &Model, position: &Position<S>, world: &mut World<S>) {
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let p = body.parent.0;
        world.X_WB[i] = if p == 0 { position.X_PB[i] } else { body.turned(&position.X_PB[i]).seen_from(&world.X_WB[p]) };
    }
}

/// Twist of each body and bias acceleration of each joint, from the tree velocities in `velocity.v`. O(n).
#[inline]
pub fn velocity<S: SystemScalar>(model: &Model, position: &Position<S>, velocity: &mut Velocity<S>) {
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (q, v, H) = (&position.q[body.q.clone()], &velocity.v[body.v.clone()], &position.H[body.v.clone()]);
        let p = body.parent.0;
        // V × H v vanishes for a joint on the world
        (velocity.V_WB[i], velocity.bias[i]) = match p {
            0 => body.joint.motion_and_bias(q, H, v),
            _ => body.joint.carried(body.turned(&position.X_PB[i]).twist_to_child(velocity.V_WB[p]), q, H, v),
        };
    }
}

/// Acceleration of each body relative to free fall, from the tree accelerations in `acceleration.vd`. O(n).
#[inline]
pub fn acceleration<S: SystemScalar>(model: &Model, position: &Position<S>, velocity: &Velocity<S>, acceleration: &mut Acceleration<S>) {
    acceleration.A_WB[0] = Twist::new(Vec3::zero(), Vec3::from_f64(-model.gravity));
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (H, vd) = (&position.H[body.v.clone()], &acceleration.vd[body.v.clone()]);
        let carried = body.turned(&position.X_PB[i]).twist_to_child(acceleration.A_WB[body.parent.0]) + velocity.bias[i];
        acceleration.A_WB[i] = body.joint.moved(carried, H, vd);
    }
}
