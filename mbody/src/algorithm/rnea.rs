//! Inverse dynamics: the generalized forces that make a motion, by the recursive Newton–Euler algorithm.
//!
//! `F = I A + V ×* I V − F_applied`, `τ = Hᵀ F`, `F_P += ᴮXᴾᵀ F`.
//! Source: Featherstone (2008), table 5.1; the outward half is in [`super::kinematics`].

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::Wrench;
use crate::stage::{Acceleration, Position, Velocity};

/// Writes `τ` (tree, N or N m) that the joints must supply for the motion in the three stages under the applied wrenches.
///
/// `applied` and `transmitted` are \[bodies\] wrenches in body axes about the body origin; `transmitted` receives what each
/// joint exerts on its body. O(n), allocates nothing.
#[inline]
pub fn rnea<S: SystemScalar>(
    model: &Model,
    position: &Position<S>,
    velocity: &Velocity<S>,
    acceleration: &Acceleration<S>,
    applied: &[Wrench<S>],
    transmitted: &mut [Wrench<S>],
    tau: &mut [S],
) {
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (V, A) = (velocity.V_WB[i], acceleration.A_WB[i]);
        transmitted[i] = body.inertia.apply(A) + V.cross_star(body.inertia.apply(V)) - applied[i];
    }
    for (i, body) in model.bodies.iter().enumerate().skip(1).rev() {
        let F = transmitted[i];
        body.joint.effort(&position.H[body.v.clone()], F, &mut tau[body.v.clone()]);
        let p = body.parent.0;
        if p != 0 {
            transmitted[p] += body.turned(&position.X_PB[i]).wrench_to_parent(F);
        }
    }
}
