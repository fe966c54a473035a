//! Deformable carcass: springs between rim and patch, along the radius and along the axle; slip and forces where the patch is.
//!
//! ```text
//! d = [S(γ) − (C − P0)·k − λ sin γ]/cos γ            P = C − (a − d) e − (b − λ) n
//! ḋ = −(v_P·k + λ̇ sin γ)/cos γ
//! Fr = kr d + cr ḋ        Fn = kl λ + cl λ̇           N = Fr cos γ + Fn sin γ
//! V_sx = v_P·x − re Ω + λ̇x                            re = a − η d
//! V_sy = v_P·y + λ̇ cos γ − ḋ sin γ                    κ = −V_sx/V*,  tan α = −V_sy/V*,  V* = √((v_P·x)² + V0²)
//! 0 = Fn cos γ − Fr sin γ − Fy(κ, α, γ, N)            0 = kx λx + cx λ̇x − Fx(κ, α, γ, N)
//! ```
//!
//! λ, λx displacement of the patch against the rim, along the axle to the left and forward, m; d radial compression, m; S, a, b
//! support and point of the cross-section, m; C center of the wheel; v_P velocity of the carrier against the
//! road, without the spin Ω, at P, m/s; F forces of the carcass on the rim, N; k N/m, c N s/m; η share of d in the effective radius re.
//! Both rows are implicit in λ̇, λ̇x. For small slip upright they make a lag over the length `σ = C_α/kl`. Lean and side force
//! load the springs by themselves: in a balanced turn λ stays small and d is that of the force along the wheel plane. A tire that can lift
//! has `b(δ) Fr sin γ` in its row: in the air λ returns to zero in the time cl/kl.
//!
//! In λ̇ the row has the slope `cl cos γ + cr sin²γ/cos γ + (cr − cl) (Fy/N) sin γ − ∂Fy/∂V_sy/cos γ`. Where a leaning wheel uses its friction up, Fy/N near
//! 1 to the side of the lean and cr > cl, it can vanish (as in the paradox of Painlevé): the patch may then snap back without load, and a motion ends
//! there. It stays positive up to the peak of Fy where `cl/cr > (μ t − t²)/(1 + μ t)`, t = tan |γ|. The right side is largest, and then t² itself, where
//! `t = (√(1 + μ²) − 1)/μ`: 0.172 for μ = 1, 0.243 for μ = 1.3. Past the peak the friction that falls with slip takes from it, the more the slower the wheel.
//!
//! Source: our formulation of the idea of R. Lot, A motorcycle tire model for dynamic simulations, Meccanica 39 (2004) 207–220.
//! Range: camber below 75 degrees; cl > 0 keeps the row of λ regular at vanishing load.

use super::carcass::Elastic;
use super::element::Tire;
use super::law::Slip;
use super::patch::Patch;
use super::similarity;
use super::wheel::Rolling;
use mbody::force::{Evaluated, StateDeclared};
use mbody::scalar::SystemScalar;

/// Springs between rim and patch.
#[derive(Clone, Copy, Debug)]
pub struct Deformable {
    /// Along the radius, positive in compression.
    pub radial: Elastic,
    /// Along the axle.
    pub lateral: Elastic,
    /// Along the circumference; rigid where left out.
    pub longitudinal: Option<Elastic>,
}

pub(super) const CARCASS_LATERAL: StateDeclared = StateDeclared {
    name: "carcass_lateral",
    unit: "m",
    about: "displacement of the contact patch against the rim, to the left",
    nominal: 1e-3,
    absolute_tolerance: 1e-8,
    differential: true,
    row: ("lateral force on the contact patch", "N", 1000.0),
};

const CARCASS_LONGITUDINAL: StateDeclared = StateDeclared {
    name: "carcass_longitudinal",
    about: "displacement of the contact patch against the rim, forward",
    row: ("longitudinal force on the contact patch", "N", 1000.0),
    ..CARCASS_LATERAL
};

impl Deformable {
    pub(super) fn states(&self) -> Vec<StateDeclared> {
        let mut states = vec![CARCASS_LATERAL];
        states.extend(self.longitudinal.map(|_| CARCASS_LONGITUDINAL));
        states
    }

    /// The lateral over the radial damping from which on the row of the lateral creep keeps its slope at every camber, for friction μ; see the head of this file.
    pub(super) fn least_lateral_damping(friction: f64) -> f64 {
        ((friction.hypot(1.0) - 1.0) / friction).powi(2)
    }

    pub(super) fn state_count(&self) -> usize {
        1 + usize::from(self.longitudinal.is_some())
    }

    #[inline]
    pub(super) fn patch<S: SystemScalar>(&self, tire: &Tire, wheel: &Rolling<S>, at: &Evaluated<'_, S>) -> Patch<S> {
        let (frame, meridian) = (&wheel.frame, &wheel.meridian);
        let (sin, cos, per_cos) = (frame.sin_camber, frame.cos_camber, frame.cos_camber.recip());
        let (lateral, lateral_rate) = (at.state(0), at.state_rate(0));
        let forward = self.longitudinal.map(|spring| (spring, at.state(1), at.state_rate(1)));

        // where the deformed tire touches, and how fast it deforms
        let radial = (wheel.penetration - lateral * sin) * per_cos;
        let lever = meridian.a - radial;
        let arm = -(frame.e.scaled(lever) + wheel.axis.scaled(meridian.b - lateral));
        let v = wheel.velocity_at(arm);
        let radial_rate = -(v.dot(frame.k) + lateral_rate * sin) * per_cos;

        // forces of the carcass, along rim and road
        let (along_radius, along_axle) = (self.radial.force(radial, radial_rate), self.lateral.force(lateral, lateral_rate));
        let hold = tire.contact.hold(wheel.penetration);
        let load = tire.contact.load(hold, along_radius * cos + along_axle * sin);
        let elastic_side_force = along_axle * cos - along_radius * sin * hold;

        // friction where the tire touches
        let effective_radius = tire.effective_radius.at(meridian.a, radial, load);
        let (speed_x, speed_y) = (v.dot(frame.x), v.dot(frame.y));
        let reference = tire.reference_speed(speed_x);
        let per_reference = reference.recip();
        let mut slide_x = speed_x - effective_radius * wheel.spin;
        if let Some((_, _, rate)) = forward {
            slide_x += rate;
        }
        let slide_y = speed_y + lateral_rate * cos - radial_rate * sin;
        let slip = Slip {
            load,
            lateral: -slide_y * per_reference,
            longitudinal: -slide_x * per_reference,
            camber: frame.camber,
            speed: reference,
        };
        let friction = similarity::friction(&tire.law, &slip, wheel.road.friction);

        // rows and energy
        let mut rows = [elastic_side_force - friction.lateral, S::zero()];
        let compressed = tire.contact.compressed(radial);
        let [mut stored, mut stored_rate] = self.radial.stored(compressed, radial_rate);
        let [of_axle, of_axle_rate] = self.lateral.stored(lateral, lateral_rate);
        (stored, stored_rate) = (stored + of_axle, stored_rate + of_axle_rate);
        if let Some((spring, x, rate)) = forward {
            rows[1] = spring.force(x, rate) - friction.longitudinal;
            let [more, more_rate] = spring.stored(x, rate);
            (stored, stored_rate) = (stored + more, stored_rate + more_rate);
        }
        Patch {
            arm,
            velocity: v,
            lever,
            deflection: radial,
            effective_radius,
            load,
            support: load,
            friction,
            rolling_moment: tire.rolling_resistance.moment(load, effective_radius, wheel.spin, speed_x),
            slip_angle: slip.lateral.atan(),
            longitudinal_slip: slip.longitudinal,
            rows,
            stored,
            stored_rate,
        }
    }
}
