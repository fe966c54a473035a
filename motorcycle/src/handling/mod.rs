//! What is particular to the handling of single-track vehicles in analyses that know no vehicle.

pub mod indices;
mod mode_names;

pub use mode_names::MODE_RULES;
