//! Solvers written in Rust: nonlinear systems, and methods of one step for motions.

mod diffsol;
mod dormand_prince;
mod elimination;
mod factorization;
mod generalized_alpha;
mod newton;
mod path;
mod rosenbrock;
mod segment;
mod step_control;

pub use diffsol::Diffsol;
pub use dormand_prince::DormandPrince;
pub use generalized_alpha::GeneralizedAlpha;
pub use newton::Newton;
pub use rosenbrock::Rosenbrock;
