//! Disc or drum brake between a wheel and the body that carries it.
//!
//! `T = −B tanh(Ω/Ω₀)` on the joint of the wheel, N m; B ≥ 0 commanded torque, an input; Ω spin rate of the wheel relative to its
//! carrier, rad/s; Ω₀ rate over which the torque turns its sign. The reaction acts on the carrier, where the caliper is.
//!
//! Source: dry friction, rounded; at 3 Ω₀ the torque is B to half a percent. Range: no sticking, a braked wheel creeps when at rest.

use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::AngularSpeed;
use mbody::description::quantity::{PositiveQuantity, Quantity};
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
}

impl Brake {
    /// Torque on the wheel, N m.
    #[inline]
    fn torque<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> S {
        -(at.input(0) * (at.speed(self.wheel) / self.rounding).tanh())
    }
}

impl ForceLaw for Brake {
    fn declare(&self, element: &str) -> Declared {
        let about = "torque of the brake against the spin of the wheel, not negative";
        let input = InputDeclared { name: format!("{element}.torque"), unit: "N m", about, nominal: 100.0, rate: None, default: 0.0 };
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
}

impl ElementDescription for BrakeDescription {
    const KIND: &'static str = "brake";
    const ABOUT: &'static str = "brake: input `<element>.torque` against the spin of a wheel";
    const EXAMPLE: &'static str = "{ wheel: front_wheel }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Brake;
    fn assemble(self, site: &mut Site<'_>) -> Option<Brake> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad")?;
        Some(Brake { wheel, rounding: self.rounding.map_or(0.5, Quantity::si) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    #[test]
    fn a_brake_opposes_the_spin_and_its_heat_is_accounted_for() {
        let mut bench = Bench::new(vec![Force::new("front_brake", Brake { wheel: tree().1.front_rim, rounding: 0.5 })]);
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
}
