//! Scalars: plain numbers, numbers with many derivatives, numbers with two time derivatives.
//!
//! Laws are written over [`Real`]; the assembled system evaluates them over the closed list of [`SystemScalar`]s.

mod dual;
mod jet;
mod lanes;
mod per_scalar;
mod real;
pub mod smooth;
pub mod spline;

pub use dual::Dual;
pub use jet::Jet;
pub use lanes::Lanes;
pub use per_scalar::{Family, Make, PerScalar, SystemScalar};
pub use real::Real;
pub use spline::{CubicSpline, Pchip};
