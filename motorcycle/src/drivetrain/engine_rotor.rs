//! Rotating parts of an engine that are geared rigidly to a wheel: a gyrostat on the chassis and an inertia on the wheel.
//!
//! ```text
//! h = I i Ω a     moment on the carrier  −(I i Ω̇ a + w × h)     effort on the wheel joint  −I i (i Ω̇ + α·a)
//! E = ½ I i² Ω² + I i Ω (w·a)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | I, a | kg m², – | inertia of the rotor about its axis, and the axis, fixed in the carrier |
//! | i | – | speed of the rotor relative to the carrier over the spin rate of the wheel, negative when it turns against the axis |
//! | Ω | rad/s | spin rate of the wheel relative to the body that carries it (joint speed) |
//! | w, α | rad/s, rad/s² | angular velocity and acceleration of the carrier |
//! | E | J | kinetic energy beyond that of the locked rotor |
//!
//! Convention: the **inertia of the carrier already contains the rotor, as if it were locked** – its mass, its transverse inertia and its
//! inertia about a. What is left of its kinetic energy, ½ I (iΩ + w·a)² − ½ I (w·a)², is E; Lagrange's equations of E are the two lines above.
//! Source: gyrostats, e.g. R. E. Roberson, R. Schwertassek, *Dynamics of Multibody Systems* (1988); the reduction is exact and held
//! against a rotor body that follows the wheel. The rotor must be symmetric about its axis.

use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{Inertia, Number};
use mbody::description::quantity::{NonNegativeQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A rotor on a body, geared to a wheel.
#[derive(Clone, Debug)]
pub struct EngineRotor {
    /// The body that carries the rotor.
    pub carrier: BodyIndex,
    /// Unit axis of the rotor, in the carrier.
    pub axis: Vec3<f64>,
    /// Inertia about the axis, kg m².
    pub inertia: f64,
    /// Speed of the rotor over the spin rate of the wheel.
    pub ratio: f64,
    /// The wheel.
    pub wheel: BodyIndex,
}

impl ForceLaw for EngineRotor {
    fn declare(&self, element: &str) -> Declared {
        let output = |quantity, unit, about| OutputDeclared { name: format!("{element}.{quantity}"), unit, about };
        let outputs = vec![
            output("speed", "rad/s", "speed of the rotor relative to its carrier, about its axis"),
            output("angular_momentum", "kg m²/s", "angular momentum of the rotor relative to its carrier, about its axis"),
        ];
        Declared { outputs, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let a = at.X_WB(self.carrier).R.times_const(self.axis);
        let (speed, acceleration) = (at.speed(self.wheel) * self.ratio, at.acceleration(self.wheel) * self.ratio);
        let h = a.scaled(speed * self.inertia);
        out.moment(self.carrier, -(a.scaled(acceleration * self.inertia) + at.w_WB(self.carrier).cross(h)));
        out.joint(self.wheel, -((acceleration + at.alpha_WB(self.carrier).dot(a)) * (self.inertia * self.ratio)));
        out.output(0, speed);
        out.output(1, speed * self.inertia);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let a = at.X_WB(self.carrier).R.times_const(self.axis);
        let speed = at.speed(self.wheel) * self.ratio;
        let stored = speed * (speed * 0.5 + at.w_WB(self.carrier).dot(a)) * self.inertia;
        Energy { stored, ..Default::default() }
    }
}

/// Rotating parts of an engine that are geared rigidly to a wheel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineRotorDescription {
    /// Name of the link that carries the rotor; its inertia contains the rotor as if it were locked.
    link: String,
    /// Axis of the rotor in the frame of the link, of any length; [0, 1, 0] is a transverse crankshaft.
    axis: [Quantity<Number>; 3],
    /// Inertia about the axis.
    #[schemars(extend("plausible" = [1e-4, 2.0]))]
    inertia: NonNegativeQuantity<Inertia>,
    /// Speed of the rotor over the spin rate of the wheel; negative for a rotor that turns against the axis.
    ratio: Quantity<Number>,
    /// Name of the joint of the driven wheel.
    wheel: String,
}

impl ElementDescription for EngineRotorDescription {
    const KIND: &'static str = "engine_rotor";
    const ABOUT: &'static str = "rotating parts of an engine, geared rigidly to a wheel: gyroscopic moment and reflected inertia";
    const EXAMPLE: &'static str = "{ link: chassis, axis: [0, 1, 0], inertia: 0.02 kg m^2, ratio: 5.5, wheel: rear_wheel }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = EngineRotor;
    fn assemble(self, site: &mut Site<'_>) -> Option<EngineRotor> {
        let link = site.link("link", &self.link);
        let wheel = site.joint_with("wheel", &self.wheel, "rad");
        let ((carrier, X), wheel) = (link?, wheel?);
        let Some(axis) = Vec3::from(self.axis.map(Quantity::si)).normalized() else {
            site.refuse("axis", "no_direction", "the axis of the rotor has no length, so it has no direction");
            return None;
        };
        if self.ratio.si() == 0.0 {
            site.refuse("ratio", "out_of_range", "the ratio is zero, so the rotor never turns");
            return None;
        }
        Some(EngineRotor { carrier, axis: X.R * axis, inertia: self.inertia.si(), ratio: self.ratio.si(), wheel })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, builder, tree};
    use mbody::force::Force;
    use mbody::joint::{Joint, Revolute};
    use mbody::spatial::{MassProperties, Pose};

    const INERTIA: f64 = 0.024;
    const RATIO: f64 = -5.3;

    fn rotor_mass() -> MassProperties {
        // symmetric about its own y axis
        MassProperties { mass: 6.0, center: Vec3::new(0.0, 0.0, 0.0), inertia: [0.05, INERTIA, 0.05, 0.0, 0.0, 0.0] }
    }

    /// Place of the rotor in the chassis: its y axis is the axis of the rotor, oblique so that all terms take part.
    fn place() -> Pose<f64> {
        Pose::from_xyz_rpy([0.65, 0.02, 0.45], [0.3, 0.0, 0.2])
    }

    /// The gyrostat, on a chassis that contains the locked rotor.
    fn gyrostat() -> Bench {
        let model = || {
            let (mut b, bodies) = builder();
            b.weld("rotor", bodies.chassis, place(), rotor_mass()).unwrap();
            b.finish().unwrap()
        };
        let bodies = tree().1;
        let axis = place().R.columns[1];
        let law = EngineRotor { carrier: bodies.chassis, axis, inertia: INERTIA, ratio: RATIO, wheel: bodies.rear_rim };
        Bench::on(model(), model(), vec![Force::new("rotor", law)])
    }

    #[test]
    fn a_rotor_body_that_follows_the_wheel_has_the_same_equations() {
        let with_body = || {
            let (mut b, bodies) = builder();
            let joint = Joint::new(Revolute::new(Vec3::new(0.0, 1.0, 0.0)));
            b.body("rotor", bodies.chassis, "crank", joint, place(), rotor_mass()).unwrap();
            b.follow("crank", "rear_wheel", RATIO, 0.0).unwrap();
            b.finish().unwrap()
        };
        let (mut gyrostat, mut body) = (gyrostat(), Bench::on(with_body(), with_body(), Vec::new()));
        body.y.copy_from_slice(&gyrostat.y);
        body.yd.copy_from_slice(&gyrostat.yd);
        let (a, b) = (gyrostat.evaluate().0, body.evaluate().0);
        let scale = a.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        for (row, (x, y)) in a.iter().zip(&b).enumerate() {
            assert!((x - y).abs() < 1e-12 * scale, "row {row}: {x} against {y}");
        }
    }

    #[test]
    fn derivatives_are_exact_and_energy_balances() {
        let mut bench = gyrostat();
        bench.assert_derivatives_are_exact();
        bench.assert_energy_balances();
        assert!((bench.output("rotor.speed") - RATIO * 55.0).abs() < 1e-12);
    }
}
