//! KINSOL, IDA, CVODE and ARKODE behind the vocabulary of `problem`.
//!
//! The C bindings are touched in the module `raw` only, which is also the only module of the workspace with `unsafe`
//! code. What it hands out is safe: contexts, vectors, matrices and solvers free themselves, a panic inside a callback
//! reaches the caller as a panic, and nothing is ever printed.

mod cvode;
mod guard;
mod ida;
mod kinsol;
mod raw;
mod runge_kutta;

pub use cvode::Cvode;
pub use ida::Ida;
pub use kinsol::{Kinsol, Strategy};
pub use raw::version;
pub use runge_kutta::RungeKutta;
