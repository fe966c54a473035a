//! Forces of the air.

mod aerodynamics;

pub use aerodynamics::{Aerodynamics, AerodynamicsDescription};
