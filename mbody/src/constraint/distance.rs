//! A massless rod between two points.
//!
//! `Φ = |p| − L`; p from the first point to the second, L length, m. The multiplier pushes the points apart.
//! Source: elementary. Range: points that do not coincide.

use super::law::{ConstraintLaw, Level, Place, RowDeclared};
use crate::model::Outline;
use crate::scalar::Real;
use crate::spatial::Pose;

/// A rod of constant length between the origins of two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Length, m; positive.
    pub length: f64,
}

impl ConstraintLaw for Distance {
    fn rows(&self) -> Vec<RowDeclared> {
        vec![RowDeclared {
            multiplier: "force".into(),
            unit: "N",
            about: "force along the rod, positive in compression",
            error: "elongation".into(),
            error_unit: "m",
            nominal: 0.01,
            level: Level::Position,
        }]
    }
    fn outline(&self, from: &Place, to: &Place) -> Option<Outline> {
        Some(Outline::Rod { from: from.origin(), to: to.origin() })
    }
    fn error<R: Real>(&self, X_FM: &Pose<R>, error: &mut [R]) {
        error[0] = X_FM.p.norm() - self.length;
    }
}
