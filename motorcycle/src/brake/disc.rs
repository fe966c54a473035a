//! Disc or drum brake between a wheel and the body that carries it.
//!
//! `T = −p B tanh(Ω/Ω₀)` about the axis of the wheel, N m; B ≥ 0 commanded torque, an input; p share of this wheel, 1 where it is alone; Ω spin rate of the wheel relative to the
//! body that takes the reaction, rad/s; Ω₀ rate over which the torque turns its sign. The reaction acts on the carrier of the wheel, where the caliper is, or on the body to
//! which a torque rod leads it (an ideal parallelogram).
//!
//! Source: dry friction, rounded; at 3 Ω₀ the torque is B to half a percent. Range: no sticking, a braked wheel creeps when at rest.

use crate::signal::turning_axis;
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{AngularSpeed, Number};
use mbody::description::quantity::{Fraction, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A brake on a wheel.
#[derive(Clone, Debug)]
pub struct Brake {
    /// The wheel.
    pub wheel: BodyIndex,
    /// Spin rate over which the torque turns its sign, rad/s.
    pub rounding: f64,
    /// First part of the name of the input where it is not that of the element.
    pub input: Option<String>,
    /// Share of the commanded torque.
    pub share: f64,
    /// Where a torque rod leads the reaction: that body, and the unit axis of the wheel in the wheel; none: the carrier of the wheel.
    pub floating: Option<(BodyIndex, Vec3<f64>)>,
}

impl Brake {
    /// Spin rate against the body that takes the reaction, rad/s, and the torque on the wheel, N m.
    #[inline]
    fn torque<S: SystemScalar>(&self, at: &Evaluated<'_, S>, axis: Option<(BodyIndex, Vec3<S>)>) -> (S, S) {
        let rate = match axis {
            Some((reaction, axis)) => axis.dot(at.w_WB(self.wheel) - at.w_WB(reaction)),
            None => at.speed(self.wheel),
        };
        (rate, -(at.input(0) * (rate / self.rounding).tanh()) * self.share)
    }

    /// The axis of the wheel in the world, where the reaction is led elsewhere.
    #[inline]
    fn axis<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Option<(BodyIndex, Vec3<S>)> {
        self.floating.map(|(reaction, axis)| (reaction, at.X_WB(self.wheel).R.times_const(axis)))
    }
}

impl ForceLaw for Brake {
    fn declare(&self, element: &str) -> Declared {
        let about = "torque of the brake against the spin of the wheel, not negative";
        let of = self.input.as_deref().unwrap_or(element);
        let input = InputDeclared { name: format!("{of}.torque"), unit: "N m", about, nominal: 100.0, rate: None, default: 0.0 };
        Declared { inputs: vec![input], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let axis = self.axis(at);
        let (_, torque) = self.torque(at, axis);
        match axis {
            Some((reaction, axis)) => {
                out.moment(self.wheel, axis.scaled(torque));
                out.moment(reaction, -axis.scaled(torque));
            }
            None => out.joint(self.wheel, torque),
        }
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let (rate, torque) = self.torque(at, self.axis(at));
        Energy { dissipated: -(torque * rate), ..Default::default() }
    }
}

/// Brake between a wheel and the body that carries it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BrakeDescription {
    /// Name of the joint of the wheel.
    wheel: String,
    /// Spin rate over which the torque turns its sign; 0.5 rad/s where left out.
    rounding: Option<PositiveQuantity<AngularSpeed>>,
    /// First part of the name of the input, for brakes that share one: `front_brake` reads `front_brake.torque`. The name of the element where left out.
    input: Option<String>,
    /// Share of that torque which acts on this wheel; all of it where left out.
    share: Option<Quantity<Number, Fraction>>,
    /// Name of the link to which a torque rod leads the reaction; the link that carries the wheel where left out.
    reaction: Option<String>,
}

impl ElementDescription for BrakeDescription {
    const KIND: &'static str = "brake";
    const ABOUT: &'static str = "brake: input `<element>.torque` against the spin of a wheel; brakes of several wheels may share one";
    const EXAMPLE: &'static str = "{ wheel: front_wheel }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Brake;
    fn assemble(self, site: &mut Site<'_>) -> Option<Brake> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad")?;
        let reaction = match &self.reaction {
            Some(link) => Some(site.link("reaction", link)?.0),
            None => None,
        };
        if reaction == Some(wheel) {
            site.refuse("reaction", "wrong_link", "the wheel cannot take the reaction of its own brake");
            return None;
        }
        let floating = reaction.filter(|&body| body != site.model().body(wheel).parent);
        let floating = floating.map(|body| (body, turning_axis(site.model(), wheel)));
        let (rounding, share) = (self.rounding.map_or(0.5, Quantity::si), self.share.map_or(1.0, Quantity::si));
        Some(Brake { wheel, rounding, input: self.input, share, floating })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    #[test]
    fn a_brake_opposes_the_spin_and_its_heat_is_accounted_for() {
        let brake = Brake { wheel: tree().1.front_rim, rounding: 0.5, input: None, share: 1.0, floating: None };
        let mut bench = Bench::new(vec![Force::new("front_brake", brake)]);
        bench.set("front_brake.torque", 300.0);
        for (rate, torque) in [(80.0, -300.0), (-80.0, 300.0), (0.0, 0.0), (0.5, -300.0 * 1f64.tanh())] {
            bench.set("front_wheel.rate", rate);
            assert!((bench.effort("front_wheel.rate") - torque).abs() < 1e-10);
            // between fork and wheel: nothing on the base as a whole
            assert!(bench.effort("chassis.pitch_rate").abs() < 1e-10);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }

    #[test]
    fn brakes_share_a_torque() {
        let (bodies, brake) = (tree().1, |wheel, share| Brake { wheel, rounding: 0.5, input: Some("brake".into()), share, floating: None });
        let mut bench =
            Bench::new(vec![Force::new("front", brake(bodies.front_rim, 0.7)), Force::new("rear", brake(bodies.rear_rim, 0.3))]);
        bench.set("brake.torque", 300.0);
        for (wheel, torque) in [("front_wheel.rate", -210.0), ("rear_wheel.rate", -90.0)] {
            bench.set(wheel, 80.0);
            assert!((bench.effort(wheel) - torque).abs() < 1e-10);
        }
    }

    /// With a torque rod to the chassis the arm feels nothing of the brake, and the chassis as a whole nothing either.
    #[test]
    fn a_torque_rod_leads_the_reaction_past_the_arm() {
        let bodies = tree().1;
        for (floating, on_arm) in [(None, 0.0), (Some((bodies.chassis, Vec3::new(0.0, 1.0, 0.0))), -300.0)] {
            let brake = Brake { wheel: bodies.rear_rim, rounding: 0.5, input: None, share: 1.0, floating };
            let mut bench = Bench::new(vec![Force::new("rear_brake", brake)]);
            bench.set("rear_brake.torque", 300.0);
            bench.set("rear_wheel.rate", 80.0);
            // effort on the joint of the arm: what acts on arm and wheel together
            assert!((bench.effort("swingarm.rate") - on_arm).abs() < 1e-9);
            assert!(bench.effort("chassis.pitch_rate").abs() < 1e-9);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
