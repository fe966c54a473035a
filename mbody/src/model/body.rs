//! Bodies and frames.

use super::BodyIndex;
use crate::joint::Joint;
use crate::scalar::Real;
use crate::spatial::{Inertia, MassProperties, Pose, Turn, Turned};
use std::ops::Range;

/// A rigid body and the joint between it and its parent.
#[derive(Debug)]
pub struct Body {
    /// Name of the body (in URDF: the link).
    pub name: String,
    /// The body that carries the joint; lower index than this body.
    pub parent: BodyIndex,
    /// Name of the joint.
    pub joint_name: String,
    /// The joint from frame F (fixed in the parent) to frame B of this body.
    pub joint: Joint,
    /// Pose of the joint's inboard frame F in the parent.
    pub X_PF: Pose<f64>,
    /// What is known of the rotation of this body in its parent, whatever the coordinates.
    pub(crate) turn: Turn,
    /// Mass properties in the body frame, everything welded to it included.
    pub mass: MassProperties,
    /// Spatial inertia about the body origin.
    pub inertia: Inertia<f64>,
    /// Tree coordinates of the joint.
    pub q: Range<usize>,
    /// Tree velocities of the joint.
    pub v: Range<usize>,
}

impl Body {
    /// The pose `X_PB` of this body in its parent, for products that spare what they know of it.
    #[inline(always)]
    pub fn turned<'a, S: Real>(&self, X_PB: &'a Pose<S>) -> Turned<'a, S> {
        Turned::new(X_PB, self.turn)
    }
}

/// A named frame fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Name.
    pub name: String,
    /// The body it is fixed in.
    pub body: BodyIndex,
    /// Its pose in that body.
    pub X_BF: Pose<f64>,
}
