//! Rolling without slip on a smooth surface, and touching it.
//!
//! ```text
//! Φ = −δ (touches)        s₁ = v_P·x = 0,  s₂ = v_P·y = 0 (no slip)        v_P = v + w × (P − C)
//! ```
//!
//! δ penetration of the undeformed body, m; P contact point, x and y forward and left in the tangent plane ([`crate::contact::rolling`]);
//! v, w velocity of the center C and angular velocity, spin included. Multipliers: forces of the surface on the body, N. A sharp
//! edge is a disc; a torus rolls over its crown without sliding, too: P is where the material touches.
//!
//! Source: J. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972, chapter III. Range: as the contact geometry.

use super::law::{ConstraintLaw, Level, Place, RowDeclared};
use crate::contact::{Contact, Plane, Profile, Surface};
use crate::model::Outline;
use crate::scalar::Real;
use crate::spatial::{Pose, Twist, Vec3};

/// A round body on the plane z = 0 of the first frame; its center is the origin of the second frame, its spin axis fixed there.
#[derive(Clone, Debug, PartialEq)]
struct RoundBody {
    profile: Profile,
    axis: Vec3<f64>,
}

impl RoundBody {
    fn contact<R: Real>(&self, X_FM: &Pose<R>) -> Contact<R> {
        let axis = X_FM.R.times_const(self.axis);
        Contact::with_plane(&self.profile, X_FM.p, axis, &Plane::LEVEL.tangent_plane(X_FM.p.x, X_FM.p.y))
    }
    fn outline(&self, to: &Place) -> Outline {
        Outline::Round { at: to.origin(), axis: to.X_BF.R * self.axis, profile: self.profile.clone() }
    }
}

fn normal() -> RowDeclared {
    RowDeclared {
        multiplier: "normal_force".into(),
        unit: "N",
        about: "force of the surface on the body along the normal of the surface, up",
        error: "height over the surface".into(),
        error_unit: "m",
        nominal: 0.01,
        level: Level::Position,
    }
}

fn slip(multiplier: &'static str, about: &'static str, error: &'static str) -> RowDeclared {
    RowDeclared {
        multiplier: multiplier.into(),
        unit: "N",
        about,
        error: error.into(),
        error_unit: "m/s",
        nominal: 1.0,
        level: Level::Velocity,
    }
}

/// Touching: the normal row only.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceContact(RoundBody);

impl SurfaceContact {
    /// A body of this profile with its spin axis, a unit vector.
    pub fn new(profile: Profile, axis: Vec3<f64>) -> Self {
        Self(RoundBody { profile, axis })
    }
}

impl ConstraintLaw for SurfaceContact {
    fn rows(&self) -> Vec<RowDeclared> {
        vec![normal()]
    }
    fn spin_axis(&self) -> Option<Vec3<f64>> {
        Some(self.0.axis)
    }
    fn outline(&self, _from: &Place, to: &Place) -> Option<Outline> {
        Some(self.0.outline(to))
    }
    fn error<R: Real>(&self, X_FM: &Pose<R>, error: &mut [R]) {
        error[0] = -self.0.contact(X_FM).penetration;
    }
}

/// Touching and rolling without slip.
#[derive(Clone, Debug, PartialEq)]
pub struct Rolling(RoundBody);

impl Rolling {
    /// A body of this profile with its spin axis, a unit vector.
    pub fn new(profile: Profile, axis: Vec3<f64>) -> Self {
        Self(RoundBody { profile, axis })
    }
}

impl ConstraintLaw for Rolling {
    fn rows(&self) -> Vec<RowDeclared> {
        vec![
            normal(),
            slip("longitudinal_force", "force of the surface on the body, forward", "slip forward"),
            slip("lateral_force", "force of the surface on the body, to the left", "slip to the left"),
        ]
    }
    fn spin_axis(&self) -> Option<Vec3<f64>> {
        Some(self.0.axis)
    }
    fn outline(&self, _from: &Place, to: &Place) -> Option<Outline> {
        Some(self.0.outline(to))
    }
    fn error<R: Real>(&self, X_FM: &Pose<R>, error: &mut [R]) {
        error[0] = -self.0.contact(X_FM).penetration;
    }
    fn slip<R: Real>(&self, X_FM: &Pose<R>, V_FM: &Twist<R>, slip: &mut [R]) {
        let contact = self.0.contact(X_FM);
        let v = X_FM.R * V_FM.v + (X_FM.R * V_FM.w).cross(contact.arm);
        slip[0] = v.dot(contact.frame.x);
        slip[1] = v.dot(contact.frame.y);
    }
}
