//! From descriptions to systems: checks, the registry of kinds, and the joining of tree and elements.
//!
//! The registry is a value, [`Kinds`]: `Kinds::standard().with(other_crate::KINDS)`, never a global.

mod assembled;
mod blueprint;
pub mod characteristic;
mod closing;
mod constraints;
mod description;
mod editor_schema;
mod elements;
mod kind;
mod site;
mod tree;
mod tree_file;

pub use assembled::{Assembled, Override, assemble, assemble_urdf};
pub use blueprint::{Blueprint, Entry};
pub use constraints::{ConstraintDescription, ConstraintKind, STANDARD_CONSTRAINTS};
pub use description::{BaseDescription, Description, schema};
pub use editor_schema::{editor_schema, part_schema};
pub use elements::STANDARD;
pub use kind::{EXAMPLE_TREE, ElementDescription, ElementKind, Kinds};
pub use site::{PointDescription, Site};
