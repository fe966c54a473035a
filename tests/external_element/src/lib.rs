//! Elements from outside: a damper and a friction law that `mbody`, `motorcycle` and `cli` know nothing of, and the command with them.
//!
//! This is the whole of it: a file per law, a row per kind in [`KINDS`], and a `main` that hands them to the command. Copy the folder to begin
//! one of your own; `docs/guide/own_element.md` goes through it.
#![forbid(unsafe_code)]
#![allow(non_snake_case)]

mod brush;
mod eddy_current_damper;

pub use brush::{Brush, BrushParameters};
pub use eddy_current_damper::{EddyCurrentDamper, EddyCurrentDamperDescription};

use mbody::assembly::{ElementKind, Kinds};
use motorcycle::tire::{Extended, TireWith};

/// The kinds of this crate. The tire takes the place of the standard one: it has one law more.
pub const KINDS: &[ElementKind] =
    &[ElementKind::of::<EddyCurrentDamperDescription>(), ElementKind::of::<TireWith<Extended<BrushParameters>>>()];

/// The registry of the command of this crate.
pub fn kinds() -> Kinds {
    fastbike::standard_kinds().with(KINDS)
}
