//! Brakes.

mod disc;

pub use disc::{Brake, BrakeDescription};
