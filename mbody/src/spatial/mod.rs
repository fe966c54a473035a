//! Spatial algebra: vectors, rotations, poses, twists, wrenches, inertias. Knows no tree.
//!
//! Spatial vectors are written about a point and in axes that the name of the variable tells (monogram notation);
//! twists and spatial accelerations are (angular, linear), wrenches (moment, force).
//! Source: R. Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapter 2.

mod component;
mod inertia;
mod pose;
mod rotation;
mod turn;
mod twist;
mod vector;
mod wrench;

pub use component::Component;
pub use inertia::{ArticulatedInertia, Inertia, MassProperties};
pub use pose::Pose;
pub use rotation::Rotation;
pub use turn::{Turn, Turned};
pub use twist::Twist;
pub use vector::Vec3;
pub use wrench::Wrench;
