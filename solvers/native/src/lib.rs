//! Nonlinear solvers written in Rust.

mod elimination;
mod newton;

pub use newton::Newton;
