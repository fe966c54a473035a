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
//! Range: camber below 75 degrees or so; a level road that may rise and fall under each wheel.

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
    /// Name under which the height of the road comes in: inputs `<road>.height` and `<road>.height_rate`; none: the plane z = 0.
    pub road: Option<String>,
}

impl Wheel {
    /// The wheel carried by a joint that turns about one axis; `None` for other joints.
    pub fn new(model: &Model, body: BodyIndex, profile: Profile, road: impl Into<String>) -> Option<Self> {
        let joint = model.body(body);
        let axis = joint.X_PF.R.times_const(joint.joint.rotation_axis()?);
        Some(Self { body, carrier: joint.parent, axis, profile, road: Some(road.into()) })
    }

    /// The inputs that every tire on such a road reads first.
    pub(super) fn inputs(&self) -> Vec<InputDeclared> {
        let Some(road) = &self.road else { return Vec::new() };
        let (height, rate) = (format!("{road}.height"), format!("{road}.height_rate"));
        vec![
            InputDeclared {
                name: height,
                unit: "m",
                about: "height of the road, upward",
                nominal: 0.01,
                rate: Some(rate.clone()),
                default: 0.0,
            },
            InputDeclared { name: rate, unit: "m/s", about: "rate of the height of the road", nominal: 0.1, rate: None, default: 0.0 },
        ]
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
        let (height, height_rate) = if self.road.is_some() { (at.input(0), at.input(1)) } else { (S::zero(), S::zero()) };
        let up = Vec3::from_f64(Vec3 { x: 0.0, y: 0.0, z: 1.0 });
        let plane = TangentPlane { point: Vec3::new(S::zero(), S::zero(), height), normal: up };
        let frame = ContactFrame::new(center, axis, &plane);
        let meridian = self.profile.meridian_at(&frame);
        let penetration = meridian.a * frame.cos_camber + meridian.b * frame.sin_camber - frame.center_height;
        Rolling {
            frame,
            meridian,
            penetration,
            axis,
            center,
            center_velocity: at.v_WQ(self.carrier, center),
            angular_velocity: at.w_WB(self.carrier),
            spin: at.speed(self.body),
            height_rate,
        }
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
    /// Vertical speed of the road, m/s.
    pub height_rate: S,
}

impl<S: SystemScalar> Rolling<S> {
    /// Velocity of the carrier, without the spin, at a distance from the center of the wheel.
    #[inline]
    pub fn velocity_at(&self, arm: Vec3<S>) -> Vec3<S> {
        self.center_velocity + self.angular_velocity.cross(arm)
    }
}
