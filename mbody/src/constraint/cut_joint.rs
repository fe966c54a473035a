//! A joint that closes a loop.
//!
//! ```text
//! gap along e:        Φ = e·p                      moment about e1: Φ = −e2·R a     about e2: Φ = e1·R a      (a, e1, e2 right-handed)
//! no rotation:        Φ = ½ (R − Rᵀ)^∨             universal: Φ = x_F·R y_M         screw: Φ = h sin(a·p/h − θ)
//! ```
//!
//! R, p orientation and position of the second frame in the first; a joint axis, in both; θ angle about it, rad; h advance per radian, m.
//!
//! Source: E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems*, 1989, section 9.4 (dot-product conditions).
//! Range: rows on directions vanish also where the second frame is turned over by half a turn; the assembled branch is kept by continuity.

use super::law::{ConstraintLaw, RowDeclared};
use super::row::{across, gap, tilt};
use crate::scalar::Real;
use crate::spatial::{Pose, Vec3};

/// Which joint closes the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutKind {
    /// No relative motion.
    Fixed,
    /// Rotation about the axis.
    Revolute,
    /// Translation along the axis.
    Prismatic,
    /// Rotation about the axis with an advance along it, m/rad.
    Screw(f64),
    /// Rotation about x of the first frame and y of the second.
    Universal,
    /// Free rotation.
    Spherical,
    /// Translation across the axis and rotation about it.
    Planar,
}

/// A joint that closes a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutJoint {
    kind: CutKind,
    axis: Vec3<f64>,
}

const X: Vec3<f64> = Vec3 { x: 1.0, y: 0.0, z: 0.0 };
const Y: Vec3<f64> = Vec3 { x: 0.0, y: 1.0, z: 0.0 };
const Z: Vec3<f64> = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

impl CutJoint {
    /// A joint of this kind about or along a unit axis (not used by fixed, universal and spherical joints).
    pub fn new(kind: CutKind, axis: Vec3<f64>) -> Self {
        Self { kind, axis }
    }
}

impl ConstraintLaw for CutJoint {
    fn rows(&self) -> Vec<RowDeclared> {
        let [e1, e2] = across(self.axis);
        let gaps = || [X, Y, Z].into_iter().zip(1..).map(|(e, k)| gap(e, k));
        let tilts = || [X, Y, Z].into_iter().zip(1..).map(|(e, k)| tilt(e, k));
        let aside = || [gap(e1, 1), gap(e2, 2)].into_iter();
        let leaning = || [tilt(e1, 1), tilt(e2, 2)].into_iter();
        match self.kind {
            CutKind::Fixed => gaps().chain(tilts()).collect(),
            CutKind::Revolute => gaps().chain(leaning()).collect(),
            CutKind::Prismatic => aside().chain(tilts()).collect(),
            CutKind::Screw(_) => aside().chain(leaning()).chain([RowDeclared { error: "advance".into(), ..gap(self.axis, 3) }]).collect(),
            CutKind::Universal => gaps().chain([RowDeclared { error: "angle between the axes".into(), ..tilt(Z, 1) }]).collect(),
            CutKind::Spherical => gaps().collect(),
            CutKind::Planar => [gap(self.axis, 1)].into_iter().chain(leaning()).collect(),
        }
    }
    fn error<R: Real>(&self, X_FM: &Pose<R>, error: &mut [R]) {
        let (a, [e1, e2]) = (self.axis, across(self.axis));
        let (rot, p) = (&X_FM.R, X_FM.p);
        let axis = rot.times_const(a);
        let leaning = [-axis.dot_const(e2), axis.dot_const(e1)];
        let aside = [p.dot_const(e1), p.dot_const(e2)];
        let [x, y, z] = rot.columns;
        let turned = [(y.z - z.y) * 0.5, (z.x - x.z) * 0.5, (x.y - y.x) * 0.5];
        let gaps = [p.x, p.y, p.z];
        let mut put = |parts: &[&[R]]| error.iter_mut().zip(parts.iter().copied().flatten()).for_each(|(e, &part)| *e = part);
        match self.kind {
            CutKind::Fixed => put(&[&gaps, &turned]),
            CutKind::Revolute => put(&[&gaps, &leaning]),
            CutKind::Prismatic => put(&[&aside, &turned]),
            CutKind::Screw(pitch) => {
                let turned_e1 = rot.times_const(e1);
                let (sin, cos) = (turned_e1.dot_const(e2), turned_e1.dot_const(e1));
                let (s, c) = (p.dot_const(a) / pitch).sin_cos();
                put(&[&aside, &leaning, &[(s * cos - c * sin) * pitch]]);
            }
            CutKind::Universal => put(&[&gaps, &[y.x]]),
            CutKind::Spherical => put(&[&gaps]),
            CutKind::Planar => put(&[&[p.dot_const(a)], &leaning]),
        }
    }
}
