//! Relative motion of the two frames of a constraint, and the way of its wrench onto the bodies.
//!
//! `V_FM = V_M − ᴹXᶠ V_F`, `A_FM = A_M − ᴹXᶠ A_F + V_FM × ᴹXᶠ V_F` (rates of components in M).
//! Source: Featherstone (2008), section 2.10.

use super::{Constraint, Place, RelativeMotion};
use crate::model::{BodyIndex, Model};
use crate::scalar::SystemScalar;
use crate::spatial::{Pose, Twist, Vec3, Wrench};
use crate::stage::Workspace;

/// Motion of a frame in the world.
struct FrameMotion<S> {
    X_WF: Pose<S>,
    V_WF: Twist<S>,
    A_WF: Twist<S>,
}

fn frame_motion<S: SystemScalar>(model: &Model, w: &Workspace<S>, place: &Place) -> FrameMotion<S> {
    let X_BF = Pose::from_f64(&place.X_BF);
    if place.body == BodyIndex::WORLD {
        return FrameMotion { X_WF: X_BF, V_WF: Twist::zero(), A_WF: Twist::zero() };
    }
    let i = place.body.get();
    let (X_WB, V, A) = (&w.world.X_WB[i], w.velocity.V_WB[i], w.acceleration.A_WB[i]);
    // accelerations of the tree are relative to free fall
    let falling = X_WB.R.inverse_times(Vec3::from_f64(model.gravity));
    let A = Twist::new(A.w, A.v + falling);
    FrameMotion { X_WF: *X_WB * X_BF, V_WF: X_BF.twist_to_child(V), A_WF: X_BF.twist_to_child(A) }
}

/// Motion of the second frame in the first; all kinematic stages must be filled. Allocates nothing.
pub fn relative_motion<S: SystemScalar>(model: &Model, w: &Workspace<S>, constraint: &Constraint) -> RelativeMotion<S> {
    let M = frame_motion(model, w, constraint.to());
    if constraint.from().body == BodyIndex::WORLD {
        let X_FM = Pose::from_f64(&constraint.from().X_BF.inverse()) * M.X_WF;
        return RelativeMotion { X_FM, V_FM: M.V_WF, A_FM: M.A_WF };
    }
    let F = frame_motion(model, w, constraint.from());
    let X_FM = F.X_WF.inverse() * M.X_WF;
    let carried = X_FM.twist_to_child(F.V_WF);
    let V_FM = M.V_WF - carried;
    RelativeMotion { X_FM, V_FM, A_FM: M.A_WF - X_FM.twist_to_child(F.A_WF) + V_FM.cross(carried) }
}

/// Adds a wrench on the second frame (in its axes about its origin) to the wrenches on the bodies, and its opposite on the first.
pub fn apply_wrench<S: SystemScalar>(constraint: &Constraint, X_FM: &Pose<S>, F_M: Wrench<S>, bodies: &mut [Wrench<S>]) {
    let (from, to) = (constraint.from(), constraint.to());
    if to.body != BodyIndex::WORLD {
        bodies[to.body.get()] += Pose::from_f64(&to.X_BF).wrench_to_parent(F_M);
    }
    if from.body != BodyIndex::WORLD {
        bodies[from.body.get()] += -Pose::from_f64(&from.X_BF).wrench_to_parent(X_FM.wrench_to_parent(F_M));
    }
}
