//! Roads: what stands under the wheels.

mod roughness;

pub use roughness::{BAND, CLASSES, Profile, RoadClass, Roughness};
