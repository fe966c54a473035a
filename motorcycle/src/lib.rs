//! Tires, suspensions, drivetrain, brakes, aerodynamics, riders: force elements for mbody.
//!
//! Each kind of element is one file: its law, generic over the scalar, and its written form. [`KINDS`] lists them.
#![forbid(unsafe_code)]
#![allow(non_snake_case)]

pub mod aero;
pub mod brake;
mod chain_rule;
pub mod drivetrain;
pub mod handling;
mod kinds;
pub mod maneuver;
mod planar;
pub mod rider;
pub mod road;
pub mod setup;
mod signal;
pub mod steering;
pub mod suspension;
pub mod tire;

#[cfg(test)]
mod bench_tree;

pub use kinds::{EXAMPLE_TREE, KINDS};
pub use planar::Planar;
