//! Roads: what stands under the wheels.

pub mod footing;
mod passing;
pub mod relief;
mod roughness;

pub use footing::{Footing, Under};
pub use passing::{Passing, Tracks};
pub use relief::{Relief, ReliefDescription, ReliefKind};
pub use roughness::{BAND, CLASSES, Profile, RoadClass, Roughness};
