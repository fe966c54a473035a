//! A general engine for multibody systems in relative coordinates.
//!
//! A system is assembled at run time from files into an immutable [`model::Model`]; algorithms are free functions over
//! stages ([`stage`]); every law is written once, generic over the scalar ([`scalar`]), so Jacobians are exact.
//!
//! Frames and quantities are written in monogram notation (`X_AB` pose of B in A, `V_AB` twist of B in A …), see
//! `NOTATION.md` at the root of the repository.
#![forbid(unsafe_code)]
#![allow(non_snake_case)]

pub mod algorithm;
pub mod assembly;
pub mod constraint;
pub mod contact;
pub mod description;
pub mod dynamics;
pub mod force;
pub mod joint;
pub mod model;
pub mod scalar;
pub mod spatial;
pub mod stage;
