//! Full names of the signals of the tree, and the axes of its joints.

use mbody::model::{BodyIndex, Model};
use mbody::spatial::{Twist, Vec3};

/// Full name of the signal of a joint's only coordinate.
pub(crate) fn coordinate_signal(model: &Model, joint: BodyIndex) -> String {
    let body = model.body(joint);
    format!("{}.{}", body.joint_name, body.joint.coordinates()[0].name)
}

/// Axis of a joint that turns about one axis, in the frame of the body that it carries.
pub(crate) fn turning_axis(model: &Model, joint: BodyIndex) -> Vec3<f64> {
    let body = model.body(joint);
    let mut H = [Twist::zero()];
    body.joint.place(&body.X_PF, body.joint.reference(), &mut H);
    H[0].w
}
