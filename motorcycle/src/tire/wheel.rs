//! A wheel over the road: where it is, how it leans, how fast it goes.
//!
//! ```text
//! n spin axis, C center, k normal of the road; frame x, y, e and camber γ of `mbody::contact`
//! v(P) = v_C + w × (P − C)      v_C, w of the carrier: without the spin Ω
//! ```
//!
//! The axis is taken from the carrier and the spin from the joint, so nothing depends on the angle of the wheel.
//!
//! Source: V. Cossalter, R. Lot, Vehicle System Dynamics 37 (2002) 423–447.
//! Range: camber below 75 degrees or so; the road is a plane under each wheel ([`crate::road::Footing`]), level where nobody says otherwise. v is taken against the road.

use crate::road::{Footing, Under};
use mbody::contact::{ContactFrame, Meridian, Profile, TangentPlane};
use mbody::force::{Evaluated, InputDeclared};
use mbody::model::{BodyIndex, Model};
use mbody::scalar::SystemScalar;
use mbody::spatial::{Pose, Vec3};

/// The left, in the world at the design pose and in most bodies.
const LEFT: Vec3<f64> = Vec3 { x: 0.0, y: 1.0, z: 0.0 };

/// A body that spins on its carrier and rolls on the road.
#[derive(Clone, Debug)]
pub struct Wheel {
    /// The spinning body; its origin is the center of the wheel.
    pub body: BodyIndex,
    /// The body that carries the wheel joint.
    pub carrier: BodyIndex,
    /// Unit spin axis in the frame of the carrier, to the left.
    pub axis: Vec3<f64>,
    /// Cross-section of the tire.
    pub profile: Profile,
    /// The road as inputs tell it; none: the plane z = 0.
    pub road: Option<Footing>,
}

impl Wheel {
    /// The wheel carried by a joint that turns about one axis; `None` for other joints.
    pub fn new(model: &Model, body: BodyIndex, profile: Profile, road: impl Into<String>) -> Option<Self> {
        let joint = model.body(body);
        let axis = joint.X_PF.R.times_const(joint.joint.rotation_axis()?);
        Some(Self { body, carrier: joint.parent, axis, profile, road: Some(Footing::new(model, body, road)) })
    }

    /// The inputs that every tire on such a road reads first.
    pub(super) fn inputs(&self) -> Vec<InputDeclared> {
        self.road.as_ref().map(Footing::inputs).unwrap_or_default()
    }

    /// Depth of the undeformed tire below the plane z = 0, m, from the poses of wheel and carrier in the world.
    pub(super) fn depth(&self, X_WB: &Pose<f64>, X_WC: &Pose<f64>) -> f64 {
        let plane = TangentPlane { point: Vec3::new(0.0, 0.0, 0.0), normal: Vec3::new(0.0, 0.0, 1.0) };
        let frame = ContactFrame::new(X_WB.p, X_WC.R * self.axis, &plane);
        let meridian = self.profile.meridian_at(&frame);
        meridian.a * frame.cos_camber + meridian.b * frame.sin_camber - frame.center_height
    }

    /// State of motion over the road.
    #[inline]
    pub(super) fn rolling<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Rolling<S> {
        let center = at.X_WB(self.body).p;
        let R_WC = &at.X_WB(self.carrier).R;
        let axis = if self.axis == LEFT { R_WC.columns[1] } else { R_WC.times_const(self.axis) };
        let road = self.road.as_ref().map_or_else(|| Under::level(S::zero(), S::zero()), |road| road.under(at, 0));
        let frame = ContactFrame::new(center, axis, &road.plane);
        let meridian = self.profile.meridian_at(&frame);
        let penetration = meridian.a * frame.cos_camber + meridian.b * frame.sin_camber - frame.center_height;
        let (angular_velocity, center_velocity) = at.motion_at(self.carrier, center);
        Rolling { frame, meridian, penetration, axis, center, center_velocity, angular_velocity, spin: at.speed(self.body), road }
    }
}

/// State of motion of a wheel over the road, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rolling<S> {
    /// Directions and angles at the contact.
    pub frame: ContactFrame<S>,
    /// Point of the cross-section that touches.
    pub meridian: Meridian<S>,
    /// Depth of the undeformed tire below the road, m; negative in the air.
    pub penetration: S,
    /// Spin axis, to the left.
    pub axis: Vec3<S>,
    /// Center of the wheel, m.
    pub center: Vec3<S>,
    center_velocity: Vec3<S>,
    /// Angular velocity of the carrier, rad/s.
    pub angular_velocity: Vec3<S>,
    /// Spin, rad/s.
    pub spin: S,
    /// The road.
    pub road: Under<S>,
}

impl<S: SystemScalar> Rolling<S> {
    /// Velocity of the carrier against the road, without the spin, at a distance from the center of the wheel.
    #[inline]
    pub fn velocity_at(&self, arm: Vec3<S>) -> Vec3<S> {
        let v = self.center_velocity + self.angular_velocity.cross(arm);
        Vec3::new(v.x, v.y, v.z - self.road.rise_at(self.center + arm))
    }
}
