//! Disc or drum brake between a wheel and the body that carries it.
//!
//! `T = −p B tanh(Ω/Ω₀)` on the joint of the wheel, N m; B ≥ 0 commanded torque, an input; p share of this wheel, 1 where it is alone; Ω spin rate of the wheel relative to its
//! carrier, rad/s; Ω₀ rate over which the torque turns its sign. The reaction acts on the carrier, where the caliper is.
//!
//! Source: dry friction, rounded; at 3 Ω₀ the torque is B to half a percent. Range: no sticking, a braked wheel creeps when at rest.

use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{AngularSpeed, Number};
use mbody::description::quantity::{Fraction, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
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
}

impl Brake {
    /// Torque on the wheel, N m.
    #[inline]
    fn torque<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> S {
        -(at.input(0) * (at.speed(self.wheel) / self.rounding).tanh()) * self.share
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
        out.joint(self.wheel, self.torque(at));
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        Energy { dissipated: -(self.torque(at) * at.speed(self.wheel)), ..Default::default() }
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
}

impl ElementDescription for BrakeDescription {
    const KIND: &'static str = "brake";
    const ABOUT: &'static str = "brake: input `<element>.torque` against the spin of a wheel; brakes of several wheels may share one";
    const EXAMPLE: &'static str = "{ wheel: front_wheel }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Brake;
    fn assemble(self, site: &mut Site<'_>) -> Option<Brake> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad")?;
        let (rounding, share) = (self.rounding.map_or(0.5, Quantity::si), self.share.map_or(1.0, Quantity::si));
        Some(Brake { wheel, rounding, input: self.input, share })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    #[test]
    fn a_brake_opposes_the_spin_and_its_heat_is_accounted_for() {
        let brake = Brake { wheel: tree().1.front_rim, rounding: 0.5, input: None, share: 1.0 };
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
        let (bodies, brake) = (tree().1, |wheel, share| Brake { wheel, rounding: 0.5, input: Some("brake".into()), share });
        let mut bench = Bench::new(vec![Force::new("front", brake(bodies.front_rim, 0.7)), Force::new("rear", brake(bodies.rear_rim, 0.3))]);
        bench.set("brake.torque", 300.0);
        for (wheel, torque) in [("front_wheel.rate", -210.0), ("rear_wheel.rate", -90.0)] {
            bench.set(wheel, 80.0);
            assert!((bench.effort(wheel) - torque).abs() < 1e-10);
        }
    }
}
