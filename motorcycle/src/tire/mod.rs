//! Tires: how the road pushes back.
//!
//! A friction law ([`TireLaw`]) turns slip, camber and load into forces and moments, in the ISO axes of the contact point:
//! x forward, y left, z up; camber positive leaning right; lateral slip `a = −V_sy/V*` positive when the tire slides to the
//! right, so that for small slips `Fy ≈ C_α a − C_γ γ` with both stiffnesses positive. One file holds one law.
//!
//! The element [`Tire`] puts a law on a wheel ([`wheel`]) with a carcass ([`deformable`], [`vertical`], [`rigid`]); [`ThinDiscLinear`] is the
//! tire of a benchmark. Their rows stand in [`crate::KINDS`].

pub mod carcass;
pub mod carcass_description;
pub mod characteristic;
pub mod compact_motorcycle;
pub mod conformity;
pub mod deformable;
pub mod description;
pub mod effective_radius;
pub mod element;
pub mod invalid;
pub mod law;
pub mod law_description;
pub mod linear_normalized;
pub mod magic_formula;
pub mod magic_formula_motorcycle;
pub mod relaxation;
pub mod rigid;
pub mod rolling_resistance;
pub mod sharp_linear;
pub mod thin_disc_linear;
pub mod tir;
pub mod vertical;
pub mod wheel;
pub mod written_law;

mod patch;
mod shape;
pub mod similarity;

pub use carcass::{Elastic, RelaxationLength, RoadContact};
pub use characteristic::{Characteristic, characteristic};
pub use deformable::Deformable;
pub use description::{StatedTire, TireDescription, TireWith};
pub use effective_radius::EffectiveRadius;
pub use element::{Carcass, Tire};
pub use invalid::InvalidTireData;
pub use law::{AnyTireLaw, Fit, Friction, MomentPoint, Slip, TireLaw};
pub use law_description::{LawDescription, Mounted, NamedLaw, Place};
pub use relaxation::Relaxation;
pub use rigid::Rigid;
pub use thin_disc_linear::{ThinDiscLinear, ThinDiscLinearDescription};
pub use vertical::Vertical;
pub use wheel::Wheel;
pub use written_law::{Extended, LawParameters, WrittenLaw};
