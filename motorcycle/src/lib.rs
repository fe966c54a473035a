//! Tires, suspensions, drivetrain, brakes, aerodynamics, riders: force elements for mbody.
#![forbid(unsafe_code)]
#![allow(non_snake_case)]

pub mod tire;
pub const KINDS: &[mbody::assembly::ElementKind] = &[];
