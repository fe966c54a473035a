//! From descriptions to systems: checks, the registry of kinds, and the joining of tree and elements.
//!
//! The registry is a value, [`Kinds`]: `Kinds::standard().with(other_crate::KINDS)`, never a global.

pub mod characteristic;
mod elements;
mod kind;
mod site;

pub use elements::STANDARD;
pub use kind::{ElementDescription, ElementKind, Kinds};
pub use site::{PointDescription, Site};
