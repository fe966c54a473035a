//! Columns of a motion subspace in the products that the algorithms of the mass matrix need.

use crate::scalar::Real;
use crate::spatial::{ArticulatedInertia, Component, Inertia, Twist, Wrench};

/// The columns of `H` of one joint; where they are unit vectors, products with them pick numbers.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a, S> {
    H: &'a [Twist<S>],
    components: Option<&'a [Component]>,
}

impl<'a, S: Real> Columns<'a, S> {
    pub(super) fn new(H: &'a [Twist<S>], components: Option<&'a [Component]>) -> Self {
        Self { H, components }
    }

    /// `Hₐᵀ F`.
    #[inline(always)]
    pub fn dot(&self, a: usize, F: &Wrench<S>) -> S {
        match self.components {
            Some(components) => F.along(components[a]),
            None => self.H[a].dot(*F),
        }
    }

    /// `I Hₐ` of a composite body.
    #[inline(always)]
    pub fn carry(&self, a: usize, I: &Inertia<S>) -> Wrench<S> {
        match self.components {
            Some(components) => I.column(components[a]),
            None => I.times(self.H[a]),
        }
    }

    /// `Iᴬ Hₐ` of an articulated body.
    #[inline(always)]
    pub fn carry_articulated(&self, a: usize, I: &ArticulatedInertia<S>) -> Wrench<S> {
        match self.components {
            Some(components) => I.column(components[a]),
            None => I.times(self.H[a]),
        }
    }
}
