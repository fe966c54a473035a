//! No motion: `X_FM = 1`.

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Turn, Twist};

/// A joint without motion.
#[derive(Clone, Copy, Debug)]
pub struct Fixed;

impl JointLaw for Fixed {
    fn coordinates(&self) -> &'static [Coordinate] {
        &[]
    }
    fn velocities(&self) -> &'static [Coordinate] {
        &[]
    }
    fn turn(&self) -> Turn {
        Turn::Still
    }
    fn pose<S: Real>(&self, _q: &[S]) -> Pose<S> {
        Pose::identity()
    }
    fn bias<S: Real>(&self, _q: &[S], _v: &[S]) -> Twist<S> {
        Twist::zero()
    }
}
