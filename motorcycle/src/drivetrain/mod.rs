//! Chains, shafts, engines, gears.

mod chain;
mod chain_run;
pub mod squat;

pub use chain::{Chain, ChainDescription};
pub use chain_run::{ChainRun, Run, Sprocket};
