//! Typed indices.

/// A body, and the joint that carries it. 0 is the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyIndex(pub(crate) usize);

impl BodyIndex {
    /// The world.
    pub const WORLD: Self = Self(0);

    /// Position in [`super::Model::bodies`].
    pub fn get(self) -> usize {
        self.0
    }
}

/// A named frame fixed in a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameIndex(pub(crate) usize);
