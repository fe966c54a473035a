//! A point held at a point, on a line or on a plane of another body.
//!
//! `Φₑ = e·p` for the held directions e; p position of the origin of the second frame in the first, m.
//! Source: elementary.

use super::law::{ConstraintLaw, RowDeclared};
use super::row::{across, gap};
use crate::scalar::Real;
use crate::spatial::{Pose, Vec3};

/// Directions of the first frame along which a point is held.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldPoint {
    directions: Vec<Vec3<f64>>,
}

impl HeldPoint {
    /// Held at a point.
    pub fn at_point() -> Self {
        Self { directions: vec![Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)] }
    }

    /// Held on a line along a unit vector.
    pub fn on_line(direction: Vec3<f64>) -> Self {
        Self { directions: across(direction).to_vec() }
    }

    /// Held on a plane with this unit normal.
    pub fn on_plane(normal: Vec3<f64>) -> Self {
        Self { directions: vec![normal] }
    }
}

impl ConstraintLaw for HeldPoint {
    fn rows(&self) -> Vec<RowDeclared> {
        self.directions.iter().zip(1..).map(|(&e, k)| gap(e, k)).collect()
    }
    fn error<R: Real>(&self, X_FM: &Pose<R>, error: &mut [R]) {
        for (error, &e) in error.iter_mut().zip(&self.directions) {
            *error = X_FM.p.dot_const(e);
        }
    }
}
