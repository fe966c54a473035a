//! Analyses as services: they know signals and problem traits, never an engine and never a trade.
//!
//! [`trim`] finds steady states by inverse dynamics, [`mod@linearize`] makes linear models at them, [`mod@eigen`] their eigenvalues, which
//! [`modes`] names and follows along a sweep; [`sensitivity`] says how both move with a parameter; [`mod@frequency_response`] answers inputs that
//! oscillate, [`mod@comfort`] random ones, with the [`weighting`] of a person; [`regulator`] designs feedback from linear models; [`transient`] follows a
//! motion over time, [`closed_loop`] puts a plant under the command of controllers; [`expression`] is the small language in which conditions are written.

#![allow(non_snake_case)]

pub mod closed_loop;
pub mod comfort;
mod condition;
pub mod eigen;
pub mod expression;
pub mod frequency_response;
mod hessenberg;
pub mod linearize;
pub mod modes;
pub mod random;
pub mod regulator;
pub mod sensitivity;
pub mod transient;
pub mod trim;
pub mod variable;
pub mod weighting;

pub use closed_loop::{ClosedLoop, LoopError};
pub use comfort::{Comfort, comfort};
pub use eigen::{EigenError, Spectrum, eigen};
pub use expression::{Expression, ExpressionError};
pub use frequency_response::{Excitation, FrequencyResponse, FrequencyResponseError};
pub use linearize::{LinearModel, LinearizeError, linearize};
pub use modes::{Mode, Modes};
pub use sensitivity::{Sensitivity, SensitivityError};
pub use variable::{Variable, Variables};
