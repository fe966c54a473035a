//! Analyses as services: they know signals and problem traits, never an engine and never a trade.
//!
//! [`trim`] finds steady states by inverse dynamics, [`transient`] follows a motion over time; [`expression`] is the small language in
//! which conditions are written.

#![allow(non_snake_case)]

pub mod expression;
pub mod transient;
pub mod trim;
pub mod variable;

pub use expression::{Expression, ExpressionError};
pub use variable::{Variable, Variables};
