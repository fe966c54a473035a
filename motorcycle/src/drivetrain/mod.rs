//! Chains, shafts, engines, gears, variators.

mod chain;
mod chain_run;
mod engine;
mod engine_map;
mod engine_rotor;
mod shaft_drive;
pub mod squat;
mod variator;

pub use chain::{Chain, ChainDescription};
pub use chain_run::{ChainRun, Run, Sprocket};
pub use engine::{ENGINE_LIMIT, Engine, EngineDescription};
pub use engine_map::{EngineMap, EngineMapError};
pub use engine_rotor::{EngineRotor, EngineRotorDescription};
pub use shaft_drive::{ShaftDrive, ShaftDriveDescription};
pub use variator::{Variator, VariatorDescription};
