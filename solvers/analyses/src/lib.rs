//! Analyses as services: they know signals and problem traits, never an engine and never a trade.
//!
//! [`trim`] finds steady states by inverse dynamics, [`mod@linearize`] makes linear models at them, [`mod@eigen`] their eigenvalues, which
//! [`modes`] names and follows along a sweep; [`sensitivity`] says how both move with a parameter; [`transient`] follows a motion over time;
//! [`expression`] is the small language in which conditions are written.

#![allow(non_snake_case)]

mod condition;
pub mod eigen;
pub mod expression;
pub mod linearize;
pub mod modes;
pub mod sensitivity;
pub mod transient;
pub mod trim;
pub mod variable;

pub use eigen::{EigenError, Spectrum, eigen};
pub use expression::{Expression, ExpressionError};
pub use linearize::{LinearModel, LinearizeError, linearize};
pub use modes::{Mode, Modes};
pub use sensitivity::{Sensitivity, SensitivityError};
pub use variable::{Variable, Variables};
