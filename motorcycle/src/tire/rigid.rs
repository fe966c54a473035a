//! Rigid tire: a constraint holds the wheel on the road; side forces build up as [`Relaxation`] says.
//!
//! ```text
//! N = λ        P = C − a e − b n + δ k        re = a
//! ```
//!
//! λ multiplier of the constraint `surface_contact`, N, which pushes the wheel itself: the tire adds friction only; δ depth of the undeformed
//! tire below the road, m, zero where the constraint is kept.
//!
//! Source: the models of R. S. Sharp, J. Mech. Eng. Sci. 13 (1971) 316–329, and of most linear studies, whose wheels stay on the road.
//! Range: a level road; a constraint pulls, too, where N < 0 (limit `wheel_lifted`).

use super::element::Tire;
use super::law::Friction;
use super::patch::Patch;
use super::relaxation::{Relaxation, Sliding};
use super::wheel::Rolling;
use mbody::force::Evaluated;
use mbody::scalar::SystemScalar;

/// A tire that does not give way.
#[derive(Clone, Debug)]
pub struct Rigid {
    /// Full signal name of the force with which the constraint pushes the wheel.
    pub load: String,
    /// How side forces build up.
    pub relaxation: Relaxation,
}

impl Rigid {
    #[inline]
    pub(super) fn patch<S: SystemScalar>(&self, tire: &Tire, wheel: &Rolling<S>, at: &Evaluated<'_, S>) -> Patch<S> {
        let (frame, meridian, load) = (&wheel.frame, &wheel.meridian, at.multiplier(0));
        let arm = frame.k.scaled(wheel.penetration) - frame.e.scaled(meridian.a) - wheel.axis.scaled(meridian.b);
        let v = wheel.velocity_at(arm);
        let speed = v.dot(frame.x);
        let effective_radius = tire.effective_radius.at(meridian.a, S::zero(), load);
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
            lever: meridian.a - wheel.penetration * frame.cos_camber,
            deflection: wheel.penetration,
            effective_radius,
            load,
            support: S::zero(),
            friction: Friction::default(),
            rolling_moment: tire.rolling_resistance.moment(load, effective_radius, wheel.spin, speed),
            slip_angle: S::zero(),
            longitudinal_slip: S::zero(),
            rows: [S::zero(); 2],
            stored: S::zero(),
            stored_rate: S::zero(),
        };
        self.relaxation.relax(tire, &sliding, at, &mut patch);
        patch
    }
}
