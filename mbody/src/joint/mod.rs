//! Joints: one small file each, one row in [`KINDS`].
//!
//! An author writes [`JointLaw`]: the pose of the outboard frame M in the inboard frame F, and, for speed, the motion
//! subspace `H` and the bias `Ḣ v` by hand; what is left out follows from the pose by jets. The conformity tests hold every
//! hand-written `H` and bias to the jet of the pose.

mod columns;
mod fixed;
mod free;
mod law;
mod planar;
mod prismatic;
mod revolute;
mod screw;
mod spherical;
mod universal;
mod vehicle_base;

pub use columns::Columns;
pub use fixed::Fixed;
pub use free::Free;
pub use law::{Coordinate, Joint, JointLaw, from_jet};
pub use planar::Planar;
pub use prismatic::Prismatic;
pub use revolute::Revolute;
pub use screw::Screw;
pub use spherical::Spherical;
pub use universal::Universal;
pub use vehicle_base::VehicleBase;

use crate::spatial::Vec3;

/// A kind of joint: its name in descriptions and how to make one.
pub struct JointKind {
    /// Name in descriptions.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Makes the joint from a unit axis and a pitch (m per radian, only the screw uses it).
    pub make: fn(axis: Vec3<f64>, pitch: f64) -> Joint,
}

/// All kinds of joints.
pub const KINDS: &[JointKind] = &[
    JointKind { name: "fixed", about: "no motion", make: |_, _| Joint::new(Fixed) },
    JointKind { name: "revolute", about: "rotation about an axis", make: |a, _| Joint::new(Revolute::new(a)) },
    JointKind { name: "prismatic", about: "translation along an axis", make: |a, _| Joint::new(Prismatic::new(a)) },
    JointKind {
        name: "screw",
        about: "rotation about an axis with a proportional advance along it",
        make: |a, p| Joint::new(Screw::new(a, p)),
    },
    JointKind {
        name: "universal",
        about: "rotation about x of the inboard frame, then about y of the outboard frame",
        make: |_, _| Joint::new(Universal),
    },
    JointKind { name: "spherical", about: "free rotation, quaternion", make: |_, _| Joint::new(Spherical) },
    JointKind {
        name: "planar",
        about: "translation in the plane across an axis and rotation about it, velocities in the moving frame",
        make: |a, _| Joint::new(Planar::new(a)),
    },
    JointKind { name: "free", about: "free motion, quaternion, velocities in body axes", make: |_, _| Joint::new(Free) },
    JointKind {
        name: "vehicle_base",
        about: "planar motion with velocities in the yawed frame, then heave, roll and pitch",
        make: |_, _| Joint::new(VehicleBase),
    },
];
