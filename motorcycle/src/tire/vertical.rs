//! Vertical carcass: a spring along the normal of the road; side forces build up as [`Relaxation`] says.
//!
//! ```text
//! f = kz δ + k2 δ|δ| + cz δ̇        P = C − a e − b n + δ k        re = a − η δ
//! ```
//!
//! δ depth of the undeformed tire below the road, m; a, b point of the cross-section that touches, m; η share of the depth in the effective
//! radius.
//!
//! Source: ours; the quadratic part after H. B. Pacejka, *Tire and Vehicle Dynamics*, chapter 4.

use super::carcass::Elastic;
use super::element::Tire;
use super::law::Friction;
use super::patch::Patch;
use super::relaxation::{Relaxation, Sliding};
use super::wheel::Rolling;
use mbody::force::Evaluated;
use mbody::scalar::SystemScalar;

/// A spring along the normal of the road.
#[derive(Clone, Debug)]
pub struct Vertical {
    /// Linear part.
    pub normal: Elastic,
    /// Quadratic part k2, N/m².
    pub quadratic: f64,
    /// How side forces build up.
    pub relaxation: Relaxation,
}

impl Vertical {
    #[inline]
    pub(super) fn patch<S: SystemScalar>(&self, tire: &Tire, wheel: &Rolling<S>, at: &Evaluated<'_, S>) -> Patch<S> {
        let (frame, meridian, depth) = (&wheel.frame, &wheel.meridian, wheel.penetration);
        let arm = frame.k.scaled(depth) - frame.e.scaled(meridian.a) - wheel.axis.scaled(meridian.b);
        let v = wheel.velocity_at(arm);

        // load
        let depth_rate = -v.dot(frame.k);
        let force = self.normal.force(depth, depth_rate) + depth * depth.abs() * self.quadratic;
        let load = tire.contact.load(tire.contact.hold(depth), force);
        let compressed = tire.contact.compressed(depth);
        let [stored, stored_rate] = self.normal.stored(compressed, depth_rate);
        let square = compressed * compressed.abs() * self.quadratic;

        // friction after relaxation
        let effective_radius = tire.effective_radius.at(meridian.a, depth, load);
        let speed = v.dot(frame.x);
        let sliding = Sliding {
            x: speed - effective_radius * wheel.spin,
            y: v.dot(frame.y),
            reference: tire.reference_speed(speed),
            load,
            camber: frame.camber,
            road: wheel.road.friction,
        };
        let mut patch = Patch {
            arm,
            velocity: v,
            lever: meridian.a - depth * frame.cos_camber,
            deflection: depth,
            effective_radius,
            load,
            support: load,
            friction: Friction::default(),
            rolling_moment: tire.rolling_resistance.moment(load, effective_radius, wheel.spin, speed),
            slip_angle: S::zero(),
            longitudinal_slip: S::zero(),
            rows: [S::zero(); 2],
            stored: stored + square * compressed.abs() * (1.0 / 3.0),
            stored_rate: stored_rate + square * depth_rate,
        };
        self.relaxation.relax(tire, &sliding, at, &mut patch);
        patch
    }
}
