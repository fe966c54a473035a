//! The immutable model of a tree of bodies: arrays by body, each line says shape and meaning.

mod body;
mod builder;
mod index;
mod layout;
mod outline;

pub use body::{Body, Frame};
pub use builder::{BuildError, ModelBuilder};
pub use index::{BodyIndex, FrameIndex};
pub use layout::{Follower, Layout};
pub use outline::{Attachment, Outline};

use crate::spatial::Vec3;

/// An assembled tree: bodies in an order in which a parent precedes its children. Body 0 is the world.
///
/// A body and the joint that carries it share one index. Immutable once built; share it in an `Arc`.
#[derive(Debug)]
pub struct Model {
    /// [bodies] world first, then in tree order.
    pub(crate) bodies: Vec<Body>,
    /// [frames] named frames fixed in bodies (URDF links welded to a body, and the bodies themselves).
    pub(crate) frames: Vec<Frame>,
    /// Which coordinates belong to whom, and which follow others.
    pub(crate) layout: Layout,
    /// Acceleration of free fall in the world, m/s².
    pub(crate) gravity: Vec3<f64>,
}

impl Model {
    /// All bodies; index 0 is the world.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// One body.
    pub fn body(&self, index: BodyIndex) -> &Body {
        &self.bodies[index.0]
    }

    /// Indices of the moving bodies, parents before children.
    pub fn moving(&self) -> impl Iterator<Item = BodyIndex> + use<> {
        (1..self.bodies.len()).map(BodyIndex)
    }

    /// All named frames.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// A frame by name.
    pub fn frame(&self, name: &str) -> Option<&Frame> {
        self.frames.iter().find(|f| f.name == name)
    }

    /// The body carried by the joint of this name.
    pub fn joint(&self, name: &str) -> Option<BodyIndex> {
        self.moving().find(|&b| self.body(b).joint_name == name)
    }

    /// Coordinate layout.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Acceleration of free fall, m/s².
    pub fn gravity(&self) -> Vec3<f64> {
        self.gravity
    }

    /// Total mass of the moving bodies, kg.
    pub fn total_mass(&self) -> f64 {
        self.bodies.iter().skip(1).map(|b| b.mass.mass).sum()
    }
}
