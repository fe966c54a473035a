//! Command line for motorcycle handling and stability.

pub mod output;
pub mod plot;
