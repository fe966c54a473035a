//! Algorithms of tree dynamics: free functions over stages, one file each, no state of their own.

pub mod aba;
pub mod crba;
pub mod derivatives;
pub mod energy;
pub mod jacobian;
pub mod kinematics;
pub mod recursive_derivatives;
pub mod rnea;
