//! From reports to figures: what an engineer expects to see.

pub mod modes;
pub mod ride;
