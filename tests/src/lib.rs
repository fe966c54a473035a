//! Verification, validation and diagnostics of the whole: what its tests share.
//!
//! - [`reference`](mod@reference): published numbers as files;
//! - [`agreement`]: comparisons whose tolerances have reasons, and the worst deviation of each;
//! - [`conformity`]: what is asked of every kind of element, of this repository or of another crate;
//! - [`course`]: motions over time, their energies and the drift of their constraints;
//! - [`guide`]: guides whose commands are run and whose quotes are compared;
//! - [`instant`]: a model at one instant, with constraints, accelerations and forces;
//! - [`numbers`]: numbers without a pattern;
//! - [`rode`]: maneuvers that the virtual rider rode;
//! - [`tree`]: the tree of a model alone, in a motion given by signal names;
//! - [`vehicle`]: bundled vehicles, their steady states by the names of their signals;
//! - [`mod@evidence`]: rows that the tests declare, and the table in `README.md` that is made of them.

#![allow(non_snake_case)]

pub mod agreement;
pub mod conformity;
pub mod course;
pub mod evidence;
pub mod guide;
pub mod instant;
pub mod numbers;
pub mod reference;
pub mod rode;
pub mod tree;
pub mod vehicle;
