//! Nonlinear and time solvers written in Rust.
