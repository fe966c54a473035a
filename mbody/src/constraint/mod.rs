//! Constraints between two frames: one small file each.
//!
//! An author writes [`ConstraintLaw`]: the errors of a relative pose, and for rolling the slip of a relative twist. Rates, accelerations
//! and the wrenches of the multipliers follow by automatic differentiation.

mod cut_joint;
mod distance;
mod law;
mod point;
mod prescribed_motion;
mod relative;
mod rolling;
mod row;

pub use cut_joint::{CutJoint, CutKind};
pub use distance::Distance;
pub use law::{Constraint, ConstraintLaw, Level, MAX_ROWS, Moment, Place, RelativeMotion, RowDeclared, RowValue};
pub use point::HeldPoint;
pub use prescribed_motion::PrescribedMotion;
pub use relative::{apply_wrench, relative_motion};
pub use rolling::{Rolling, SurfaceContact};

#[cfg(test)]
mod tests;
