//! Tires: how the road pushes back.
//!
//! A friction law ([`TireLaw`]) turns slip, camber and load into forces and moments, in the ISO axes of the contact point:
//! x forward, y left, z up; camber positive leaning right; lateral slip `a = −V_sy/V*` positive when the tire slides to the
//! right, so that for small slips `Fy ≈ C_α a − C_γ γ` with both stiffnesses positive. One file holds one law.

pub mod compact_motorcycle;
pub mod invalid;
pub mod law;
pub mod linear_normalized;
pub mod magic_formula_motorcycle;
pub mod rolling_resistance;
pub mod sharp_linear;

#[cfg(test)]
mod conformity;
mod shape;

pub use invalid::InvalidTireData;
pub use law::{AnyTireLaw, Friction, Slip, TireLaw};
