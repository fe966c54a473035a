//! Geometric Jacobian of a body: how the tree velocities move it.
//!
//! `V_WB = Σ ᴮXʲ Hⱼ vⱼ` over the joints between the body and the world.

use crate::model::{BodyIndex, Model};
use crate::scalar::SystemScalar;
use crate::spatial::{Pose, Twist};
use crate::stage::Position;

/// Writes the columns of the Jacobian of `body`, [tree nv] twists in axes and about the origin of the body; columns of
/// joints that do not carry the body are zero. O(depth), allocates nothing.
pub fn jacobian<S: SystemScalar>(model: &Model, position: &Position<S>, body: BodyIndex, columns: &mut [Twist<S>]) {
    columns.fill(Twist::zero());
    let mut X_JB = Pose::identity();
    let mut at = body;
    while at != BodyIndex::WORLD {
        let b = model.body(at);
        for j in b.v.clone() {
            columns[j] = X_JB.twist_to_child(position.H[j]);
        }
        X_JB = position.X_PB[at.0] * X_JB;
        at = b.parent;
    }
}
