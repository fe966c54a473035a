//! Force elements: one file each.
//!
//! An author writes [`ForceLaw`], one function generic over the scalar; the system stores the object-safe twin that a
//! blanket implementation makes of it.

mod applied_wrench;
mod bushing;
mod characteristic;
mod joint_effort;
mod joint_spring;
mod law;
mod point_sensor;
mod spring_damper;

pub use applied_wrench::{AppliedWrench, WrenchAxes};
pub use bushing::Bushing;
pub use characteristic::{Air, Damping, Friction, Spring, SpringDamperLaw, Stops};
pub use joint_effort::JointEffort;
pub use joint_spring::{JointEffortUnit, JointSpring, stop_limits};
pub use law::{
    Declared, Effort, Energy, Evaluated, Force, ForceLaw, InputDeclared, LimitDeclared, OutputDeclared, RangeDeclared, StateDeclared,
};
pub use point_sensor::PointSensor;
pub use spring_damper::SpringDamper;
