//! Steering dampers and stops, and the signals of a vehicle as a whole.
//!
//! The torque of the rider is `mbody`'s `joint_torque`: an element `steer: { joint_torque: { joint: steer } }` has the input `steer.torque`.

mod multi_track;
mod single_track;
mod steering_damper;
mod steering_stop;

pub use multi_track::{Balance, MultiTrack, MultiTrackDescription, STANDS};
pub use single_track::{SingleTrack, SingleTrackDescription, Wheel};
pub use steering_damper::{SteeringDamper, SteeringDamperDescription};
pub use steering_stop::{STEERING_STOP, SteeringStopDescription};
