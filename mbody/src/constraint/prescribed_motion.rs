//! A joint whose coordinate is prescribed.
//!
//! `Φ = q − (q₀ + v₀ t + u)`; q coordinate, m or rad; q₀, v₀ position at t = 0 and speed of the description; u input with its rate and second
//! rate as inputs, so that any smooth motion can be given. The multiplier is the effort of the drive; its power is the effort times the
//! prescribed speed.
//!
//! Source: rheonomic constraints, e.g. E. J. Haug (1989), section 9.5.

use super::law::{Level, Moment, RowDeclared, RowValue};
use crate::model::{BodyIndex, Model};
use crate::scalar::SystemScalar;
use crate::spatial::{Twist, Vec3, Wrench};
use crate::stage::Workspace;
use problem::Signal;

/// A prescribed coordinate of a joint that has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrescribedMotion {
    /// The body that the joint carries.
    pub joint: BodyIndex,
    /// Coordinate at t = 0, m or rad.
    pub position: f64,
    /// Constant speed, m/s or rad/s.
    pub speed: f64,
}

impl PrescribedMotion {
    fn turns(&self, model: &Model) -> bool {
        model.body(self.joint).joint.coordinates()[0].unit == "rad"
    }

    pub(super) fn row(&self, model: &Model) -> RowDeclared {
        let (multiplier, unit, error_unit) = if self.turns(model) { ("torque", "N m", "rad") } else { ("force", "N", "m") };
        RowDeclared {
            multiplier: multiplier.into(),
            unit,
            about: "effort of the drive on the joint, positive in the sense of its coordinate",
            error: "position".into(),
            error_unit,
            nominal: 0.01,
            level: Level::Position,
        }
    }

    pub(super) fn inputs(&self, name: &str, model: &Model) -> Vec<Signal> {
        let (unit, rate, second) = if self.turns(model) { ("rad", "rad/s", "rad/s^2") } else { ("m", "m/s", "m/s^2") };
        vec![
            Signal::new(format!("{name}.position"), unit, "prescribed coordinate, on top of the motion in the description"),
            Signal::new(format!("{name}.speed"), rate, "its rate"),
            Signal::new(format!("{name}.acceleration"), second, "its second rate"),
        ]
    }

    /// The row, and the wrench on the body that has unit power at unit joint speed.
    #[inline]
    pub(super) fn observe<S: SystemScalar>(&self, model: &Model, w: &Workspace<S>, moment: &Moment<S>) -> (RowValue<S>, Wrench<S>) {
        let body = model.body(self.joint);
        let (q, v) = (body.q.start, body.v.start);
        let [position, speed, acceleration] = moment.inputs;
        let row = RowValue {
            error: w.position.q[q] - position - (self.position + self.speed * moment.time),
            rate: w.velocity.v[v] - speed - self.speed,
            acceleration: w.acceleration.vd[v] - acceleration,
        };
        // the joint turns about an axis or slides along one: its subspace has one part of unit length
        let H: Twist<S> = w.position.H[v];
        let turning = H.w.norm_squared().value() > 0.5;
        let direction = if turning { Wrench::new(H.w, Vec3::zero()) } else { Wrench::new(Vec3::zero(), H.v) };
        (row, direction)
    }
}
