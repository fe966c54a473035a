//! Steering dampers and stops, and the signals of a single-track vehicle.
//!
//! The torque of the rider is `mbody`'s `joint_torque`: an element `steer: { joint_torque: { joint: steer } }` has the input `steer.torque`.

mod single_track;
mod steering_damper;
mod steering_stop;

pub use single_track::{SingleTrack, SingleTrackDescription, Wheel};
pub use steering_damper::{SteeringDamper, SteeringDamperDescription};
pub use steering_stop::{STEERING_STOP, SteeringStopDescription};
