//! Where a rolling disc, torus or other round body touches a smooth surface.
//!
//! [`surface`] gives the ground, [`profile`] the cross-section of the body, [`rolling`] brings both together. Everything is
//! generic over the scalar and without branches or iterations that depend on the state, so derivatives are those of the
//! function that is computed.

pub mod profile;
pub mod rolling;
pub mod surface;

pub use profile::{Meridian, Profile, ProfileError};
pub use rolling::{Contact, ContactFrame, ContactVelocity};
pub use surface::{Elevation, Ground, HeightField, Plane, Surface, SurfaceError, TangentPlane};
