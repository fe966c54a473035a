//! What elements and constraints look like, for drawings: nothing is computed from it.

use super::BodyIndex;
use crate::contact::Profile;
use crate::spatial::Vec3;

/// A point fixed in a body: the body, and the place in its frame, m.
pub type Attachment = (BodyIndex, Vec3<f64>);

/// A shape that belongs to an element or a constraint.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A round body that rolls.
    Round {
        /// The body, and its center.
        at: Attachment,
        /// Unit spin axis in the frame of the body.
        axis: Vec3<f64>,
        /// Cross-section.
        profile: Profile,
    },
    /// A spring between two points.
    Spring {
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
    },
    /// A rod between two points.
    Rod {
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
    },
}
