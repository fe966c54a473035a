//! Steady states by inverse dynamics: impose the motion, solve algebraic equations.
//!
//! Every scalar variable of the plant gets a [`Role`]; what is left unknown must be matched by as many equations: the
//! equations of motion, the rows of the elements, and the conditions the user adds. A *steady motion* has constant shape and
//! constant velocities; cyclic coordinates (position on the road, heading, wheel angles) grow by themselves and are dropped.
//!
//! - [`Trim`] says what is given and what is unknown;
//! - [`TrimProblem`] is the square system with its exact Jacobian;
//! - [`continuation`] walks to a goal in steps that halve where the method fails;
//! - [`diagnosis`] says in signal names what is undetermined or contradictory, and which declared limit stands in the way.

pub mod continuation;
pub mod diagnosis;
mod roles;
mod system;

pub use continuation::{TrimPoint, Walk};
pub use roles::{Role, Trim, TrimError};
pub use system::{Rows, TrimProblem};
