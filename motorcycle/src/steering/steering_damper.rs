//! Steering damper: linear, quadratic and dry friction on the steering joint.
//!
//! `T = c₁ ω + c₂ ω √(ω² + ω₀²) + T_f tanh(ω/ω_f)`, opposing ω. Symbols: ω steering rate, rad/s; c₁ coefficient, N m s/rad;
//! c₂ ω|ω| the part of a hydraulic orifice, rounded over ω₀ = 0.01 rad/s; T_f friction, N m.
//!
//! Source: orifice flow, force ∝ speed²; the rounding is ours. Range: any rate.

use mbody::assembly::characteristic::{FrictionDescription, Turning};
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{AngularDamping, AngularSpeed, Torque};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, Friction, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::{SystemScalar, smooth::sabs};
use schemars::JsonSchema;
use serde::Deserialize;

/// Rate over which the quadratic part is rounded, rad/s.
const ROUNDING: f64 = 0.01;

/// A damper on the steering joint.
#[derive(Clone, Debug)]
pub struct SteeringDamper {
    /// The body carried by the steering joint.
    pub joint: BodyIndex,
    /// c₁, N m s/rad.
    pub linear: f64,
    /// c₂, N m s²/rad².
    pub quadratic: f64,
    /// Dry friction.
    pub friction: Option<Friction>,
}

impl SteeringDamper {
    #[inline]
    fn torque<S: SystemScalar>(&self, rate: S) -> S {
        let mut T = rate * (sabs(rate, ROUNDING) * self.quadratic + self.linear);
        if let Some(f) = self.friction {
            T += (rate / f.speed).tanh() * f.force;
        }
        T
    }
}

impl ForceLaw for SteeringDamper {
    fn declare(&self, element: &str) -> Declared {
        let about = "torque of the damper, positive when it opposes steering to the left";
        let output = OutputDeclared { name: format!("{element}.torque"), unit: "N m", about };
        Declared { outputs: vec![output], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let T = self.torque(at.speed(self.joint));
        out.joint(self.joint, -T);
        out.output(0, T);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let rate = at.speed(self.joint);
        Energy { dissipated: self.torque(rate) * rate, ..Default::default() }
    }
}

/// The part of a damper that grows with the square of the rate.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuadraticDescription {
    /// Torque of this part at the rate `rate`.
    torque: NonNegativeQuantity<Torque>,
    /// Rate at which this part has the torque `torque`.
    rate: PositiveQuantity<AngularSpeed>,
}

/// Damper on the steering joint.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SteeringDamperDescription {
    /// Name of the steering joint.
    joint: String,
    /// Coefficient of the linear part.
    #[schemars(extend("plausible" = [1e-2, 200.0]))]
    coefficient: Option<NonNegativeQuantity<AngularDamping>>,
    /// Part that grows with the square of the rate, given by one point of its curve.
    quadratic: Option<QuadraticDescription>,
    /// Dry friction of bearings and seals.
    friction: Option<FrictionDescription<Turning>>,
}

impl ElementDescription for SteeringDamperDescription {
    const KIND: &'static str = "steering_damper";
    const ABOUT: &'static str = "steering damper: linear, quadratic and dry friction on the steering joint";
    const EXAMPLE: &'static str = "{ joint: steer, coefficient: 6.9 N m s/rad, quadratic: { torque: 10 N m, rate: 5 rad/s }, \
        friction: { effort: 0.5 N m, rounding: 0.02 rad/s } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = SteeringDamper;
    fn assemble(self, site: &mut Site<'_>) -> Option<SteeringDamper> {
        let joint = site.joint_with("joint", &self.joint, "rad")?;
        let quadratic = self.quadratic.map_or(0.0, |q| q.torque.si() / (q.rate.si() * q.rate.si()));
        let friction = self.friction.map(|f| Friction { force: f.effort.si(), speed: f.rounding.si() });
        Some(SteeringDamper { joint, linear: self.coefficient.map_or(0.0, Quantity::si), quadratic, friction })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    #[test]
    fn a_damper_opposes_and_its_heat_is_accounted_for() {
        let friction = Some(Friction { force: 0.5, speed: 0.02 });
        let law = SteeringDamper { joint: tree().1.front_upper, linear: 6.944, quadratic: 0.4, friction };
        let mut bench = Bench::new(vec![Force::new("steering_damper", law)]);
        for rate in [-3.0, 0.0, 0.01, 2.0] {
            bench.set("steer.rate", rate);
            let T = bench.output("steering_damper.torque");
            // away from rest the roundings are gone
            if f64::abs(rate) > 1.0 {
                let expected = 6.944 * rate + 0.4 * rate * rate.abs() + 0.5 * rate.signum();
                assert!((T - expected).abs() < 1e-4, "{T} against {expected}");
            }
            assert!((bench.effort("steer.rate") + T).abs() < 1e-10);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
