//! The contact patch: what every tire of this folder comes down to, whatever its carcass.
//!
//! ```text
//! on the wheel at P:   N k + Fx x + Fy y     and     Mz k + My n + Mx x
//! on the road moving   P = N v·k + Fx (v·x − l Ω) + Fy v·y + Mz (w·k + Ω sin γ) + My (w·n + Ω) + Mx w·x
//! power on the wheel   P + R,     R = ż (N k + Fx x + Fy y)·z
//! account              P + R = R − dU/dt − D,     so     D = −P − dU/dt
//! ```
//!
//! N load; F, M friction forces, N, and moments, N m; v velocity of the carrier at P against the road, m/s; w its angular velocity, rad/s; l depth of
//! P below the axle in the plane of the wheel, m (`n × (P − C) = −l x`); Ω spin, rad/s; ż vertical speed of the road itself, m/s; U energy of the
//! carcass, J. With the springs and dampers of a deformable carcass, D is the sum of damping, of friction `−Fx V_sx − Fy V_sy`, of
//! rolling and spinning against the moments, and of `Fx Ω (l − re)`: power that appears or is lost because the effective radius
//! re is not the lever l of the force, as in every tire model with both.
//!
//! Source: balance of power of a rigid body; the account is ours.

use super::law::{Fit, Friction};
use super::wheel::{Rolling, Wheel};
use mbody::force::{Effort, Energy, LimitDeclared, OutputDeclared, RangeDeclared};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use problem::Side;
use std::f64::consts::PI;

/// Load below which a wheel counts as lifted, N; equal to the rounding of the load, hence where the elastic force is zero.
pub(super) const LIFTED: f64 = 1.0;
/// Share of the friction above which a tire counts as saturated.
const SATURATED: f64 = 0.98;
/// Camber up to which the contact of a round body is trusted.
const LARGEST_CAMBER: f64 = 80.0 * PI / 180.0;

/// Forces, slips and energy at the contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch<S> {
    /// From the center of the wheel to the contact point P, m.
    pub arm: Vec3<S>,
    /// Velocity of the carrier at P against the road, m/s.
    pub velocity: Vec3<S>,
    /// Depth of P below the axle, in the plane of the wheel, m.
    pub lever: S,
    /// Compression, m.
    pub deflection: S,
    /// Effective rolling radius, m.
    pub effective_radius: S,
    /// Load N, N.
    pub load: S,
    /// Its part that the tire itself exerts, N: all, or nothing where a constraint holds the wheel.
    pub support: S,
    /// Forces and moments of friction.
    pub friction: Friction<S>,
    /// Moment of rolling resistance about the axle, N m.
    pub rolling_moment: S,
    /// Slip angle that the friction sees, rad.
    pub slip_angle: S,
    /// Longitudinal slip that the friction sees.
    pub longitudinal_slip: S,
    /// Residuals of the rows of the own states, as many of them as there are states.
    pub rows: [S; 2],
    /// Energy of the carcass, J.
    pub stored: S,
    /// Its rate, W.
    pub stored_rate: S,
}

impl<S: SystemScalar> Patch<S> {
    /// Applies the forces to the wheel and writes the outputs of [`outputs`].
    pub fn apply(&self, wheel: &Wheel, at: &Rolling<S>, out: &mut Effort<'_, S>) {
        let (f, point) = (&self.friction, at.center + self.arm);
        let (x, y, k) = (at.frame.x, at.frame.y, at.frame.k);
        let force = k.scaled(self.support) + x.scaled(f.longitudinal) + y.scaled(f.lateral);
        let moment = k.scaled(f.aligning_moment) + at.axis.scaled(self.rolling_moment) + x.scaled(f.overturning_moment);
        out.force_and_moment(wheel.body, point, force, moment);
        let values = [
            self.load,
            f.longitudinal,
            f.lateral,
            f.overturning_moment,
            self.rolling_moment,
            f.aligning_moment,
            self.slip_angle,
            self.longitudinal_slip,
            at.frame.camber,
            self.deflection,
            self.effective_radius,
            f.utilization,
            point.x,
            point.y,
            point.z,
        ];
        for (i, value) in values.into_iter().enumerate() {
            out.output(i, value);
        }
    }

    /// Energy account: see the head of the file.
    pub fn energy(&self, at: &Rolling<S>) -> Energy<S> {
        let (f, v, w, spin) = (&self.friction, self.velocity, at.angular_velocity, at.spin);
        let (x, y, k) = (at.frame.x, at.frame.y, at.frame.k);
        let translation = self.support * v.dot(k) + f.longitudinal * (v.dot(x) - self.lever * spin) + f.lateral * v.dot(y);
        let rotation = f.aligning_moment * (w.dot(k) + spin * at.frame.sin_camber)
            + self.rolling_moment * (w.dot(at.axis) + spin)
            + f.overturning_moment * w.dot(x);
        let upward = self.support * k.z + f.longitudinal * x.z + f.lateral * y.z;
        let supplied = upward * at.road.rise_at(at.center + self.arm);
        Energy { stored: self.stored, supplied, dissipated: -translation - rotation - self.stored_rate }
    }
}

/// The outputs of every tire, in the order of [`Patch::apply`].
pub(super) fn outputs(element: &str) -> Vec<OutputDeclared> {
    const OUTPUTS: [(&str, &str, &str); 15] = [
        ("normal_force", "N", "load: force of the road on the tire along the normal of the road, upward"),
        ("longitudinal_force", "N", "force of the road on the tire, forward"),
        ("lateral_force", "N", "force of the road on the tire, to the left"),
        (
            "overturning_moment",
            "N m",
            "moment of the road on the tire about the forward axis, beyond what the cross-section produces by itself",
        ),
        ("rolling_moment", "N m", "moment of rolling resistance about the axle, negative when it brakes a wheel that rolls forward"),
        ("aligning_moment", "N m", "moment of the road on the tire about the normal of the road, positive to the left"),
        ("slip_angle", "rad", "slip angle at the contact, positive when the tire slides to the right and is pushed to the left"),
        ("longitudinal_slip", "-", "longitudinal slip at the contact, driving positive, locked wheel -1"),
        ("camber", "rad", "inclination of the wheel to the road, positive leaning right"),
        ("deflection", "m", "compression of the tire"),
        ("effective_radius", "m", "effective rolling radius"),
        ("friction_use", "-", "share of the available friction in use, about 1 at the peak; 0 for laws without a peak"),
        ("contact_x", "m", "contact point in the world, forward"),
        ("contact_y", "m", "contact point in the world, to the left"),
        ("contact_z", "m", "contact point in the world, upward"),
    ];
    OUTPUTS.map(|(q, unit, about)| OutputDeclared { name: format!("{element}.{q}"), unit, about }).to_vec()
}

/// The limits of a tire: lifting, the end of the cross-section, and saturation where the law has one.
pub(super) fn limits(element: &str, wheel: &Wheel, saturates: bool) -> Vec<LimitDeclared> {
    let limit = |name, quantity: &str, threshold, side, nominal, about| LimitDeclared {
        name,
        signal: format!("{element}.{quantity}"),
        threshold,
        side,
        nominal,
        about,
    };
    let (first, last) = wheel.profile.measured_range().unwrap_or((-LARGEST_CAMBER, LARGEST_CAMBER));
    let edge = "the wheel leans beyond the edge of the tire's cross-section";
    let mut limits = vec![
        limit("wheel_lifted", "normal_force", LIFTED, Side::Below, 1000.0, "the wheel leaves the road"),
        limit("camber_limit", "camber", last.min(LARGEST_CAMBER), Side::Above, 1.0, edge),
        limit("camber_limit", "camber", first.max(-LARGEST_CAMBER), Side::Below, 1.0, edge),
    ];
    if saturates {
        limits.push(limit("tire_saturated", "friction_use", SATURATED, Side::Above, 1.0, "the tire has no friction left"));
    }
    limits
}

/// The states in which the law was measured.
pub(super) fn ranges(element: &str, fit: Option<Fit>) -> Vec<RangeDeclared> {
    let Some(fit) = fit else { return Vec::new() };
    let range =
        |quantity: &str, bounds| RangeDeclared { signal: format!("{element}.{quantity}"), bounds, about: "the measurements of the tire" };
    vec![
        range("normal_force", fit.load),
        range("slip_angle", fit.slip_angle),
        range("longitudinal_slip", fit.longitudinal_slip),
        range("camber", fit.camber),
    ]
}
