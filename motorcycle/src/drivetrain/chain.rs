//! Chain drive: the tension of both runs between the chassis and the rear wheel, from the wheel torque that is asked for.
//!
//! ```text
//! F = T/r2     T_up = ½ (F + √(F² + 4 ε²))     T_lo = T_up − F = ε²/T_up
//! each run: force T t on the wheel at X2, −T t on the chassis at X1
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | T | N m | torque of the engine on the wheel, an input; positive drives forward |
//! | r2, X1, X2, t | m | pitch radius of the rear sprocket, and the run as in [`ChainRun`] |
//! | ε | N | tension of both runs without torque; the runs change their roles over a few ε |
//!
//! The rotor of the engine has no mass here: its torque and the force on its shaft together are the force at X1 of the chassis, so
//! the pull of the chain on arm and chassis (anti-squat) is complete and nothing else acts. Runs do not stretch.
//! Source: V. Cossalter, R. Lot, M. Massaro, *Motorcycle Dynamics* (2014) for the pull of the chain; the smooth split of the tension is ours.
//! Range: rear sprocket behind the front one; the wheel must turn about +y, positive forward.

use super::{ChainRun, Run, Sprocket};
use crate::Planar;
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{Force as ForceDimension, Length};
use mbody::description::quantity::{PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::{Real, SystemScalar};
use mbody::spatial::{Pose, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

/// A chain between the chassis and a wheel.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The wheel; its origin lies on its axle.
    pub wheel: BodyIndex,
    /// The body with the front sprocket.
    pub chassis: BodyIndex,
    /// Center of the front sprocket and axes of the chain (x forward, y left, z up) in that body.
    pub front: Pose<f64>,
    /// Pitch radius of the front sprocket, m.
    pub front_radius: f64,
    /// Pitch radius of the rear sprocket, m.
    pub rear_radius: f64,
    /// Tension of both runs without torque, N.
    pub slack_force: f64,
    /// First part of the name of the input: `drive` reads `drive.torque`.
    pub input: String,
}

/// A run in the world.
struct Pull<S> {
    tension: S,
    front: Vec3<S>,
    rear: Vec3<S>,
    force_on_wheel: Vec3<S>,
}

/// Tensions of the upper and the lower run with the difference F and the product ε²; without cancellation in the slack run.
#[inline]
fn split<S: Real>(F: S, epsilon: f64) -> (S, S) {
    let root = (F * F + 4.0 * epsilon * epsilon).sqrt();
    if F.value() >= 0.0 {
        let upper = (root + F) * 0.5;
        (upper, upper.recip() * (epsilon * epsilon))
    } else {
        let lower = (root - F) * 0.5;
        (lower.recip() * (epsilon * epsilon), lower)
    }
}

/// The input of a torque that drives a wheel.
pub(super) fn drive_input(input: &str) -> InputDeclared {
    let about = "torque of the engine on the driven wheel, positive accelerates";
    InputDeclared { name: format!("{input}.torque"), unit: "N m", about, nominal: 100.0, rate: None, default: 0.0 }
}

impl Chain {
    #[inline]
    fn pulls<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> [Pull<S>; 2] {
        // into the plane of the chain
        let X_WC = *at.X_WB(self.chassis) * Pose::from_f64(&self.front);
        let axle = X_WC.R.inverse_times(at.X_WB(self.wheel).p - X_WC.p);
        let origin = Planar::new(S::zero(), S::zero());
        let front = Sprocket { center: origin, radius: self.front_radius };
        let rear = Sprocket { center: Planar::new(axle.x, axle.z), radius: self.rear_radius };
        let (upper, lower) = split(at.input(0) / self.rear_radius, self.slack_force);
        [(Run::Upper, upper), (Run::Lower, lower)].map(|(run, tension)| {
            let run = ChainRun::between(front, rear, run);
            let space = |p: Planar<S>| Vec3::new(p.x, S::zero(), p.z);
            let force_on_wheel = X_WC.R * space(run.direction).scaled(tension);
            Pull { tension, front: X_WC.point(space(run.front)), rear: X_WC.point(space(run.rear)), force_on_wheel }
        })
    }
}

impl ForceLaw for Chain {
    fn declare(&self, element: &str) -> Declared {
        let output = |quantity, about| OutputDeclared { name: format!("{element}.{quantity}"), unit: "N", about };
        let outputs = vec![output("upper_tension", "tension of the upper run"), output("lower_tension", "tension of the lower run")];
        Declared { inputs: vec![drive_input(&self.input)], outputs, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        for (i, pull) in self.pulls(at).into_iter().enumerate() {
            out.force(self.wheel, pull.rear, pull.force_on_wheel);
            out.force(self.chassis, pull.front, -pull.force_on_wheel);
            out.output(i, pull.tension);
        }
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        // a run does not stretch: what its ends do together is what the engine puts in
        let mut supplied = S::zero();
        for pull in self.pulls(at) {
            supplied += pull.force_on_wheel.dot(at.v_WQ(self.wheel, pull.rear) - at.v_WQ(self.chassis, pull.front));
        }
        Energy { supplied, ..Default::default() }
    }
}

/// Front sprocket of a chain, on the chassis.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontSprocketDescription {
    /// Name of the link that carries the engine; the chain runs in its plane of x (forward) and z (up).
    link: String,
    /// Center, in the frame of the link.
    at: [Quantity<Length>; 3],
    /// Pitch radius.
    #[schemars(extend("plausible" = [0.01, 0.3]))]
    radius: PositiveQuantity<Length>,
}

/// Rear sprocket of a chain, on the axle of the wheel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RearSprocketDescription {
    /// Pitch radius.
    #[schemars(extend("plausible" = [0.01, 0.3]))]
    radius: PositiveQuantity<Length>,
}

/// Chain drive of a wheel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainDescription {
    /// Name of the joint of the driven wheel.
    wheel: String,
    /// Sprocket of the engine.
    front_sprocket: FrontSprocketDescription,
    /// Sprocket of the wheel.
    rear_sprocket: RearSprocketDescription,
    /// Tension of both runs without torque; 0.5 N where left out.
    slack_force: Option<PositiveQuantity<ForceDimension>>,
    /// First part of the name of the input: `drive`, also where left out, reads `drive.torque`.
    input: Option<String>,
}

impl ElementDescription for ChainDescription {
    const KIND: &'static str = "chain";
    const ABOUT: &'static str = "chain that carries the input `drive.torque` (total torque on the wheel) from the chassis to a wheel";
    const EXAMPLE: &'static str = "{ wheel: rear_wheel, front_sprocket: { link: chassis, at: [0.64, 0, 0.42], radius: 40 mm }, \
        rear_sprocket: { radius: 105 mm } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Chain;
    fn assemble(self, site: &mut Site<'_>) -> Option<Chain> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad");
        let front = site.link("front_sprocket.link", &self.front_sprocket.link);
        let (wheel, (chassis, X_BL)) = (wheel?, front?);
        let FrontSprocketDescription { link, at, radius } = self.front_sprocket;
        let front = X_BL * Pose::from_xyz_rpy(at.map(Quantity::si), [0.0; 3]);
        let (front_radius, rear_radius) = (radius.si(), self.rear_sprocket.radius.si());
        let point = site.design_position(chassis, front.p);
        let X = site.design_pose(chassis);
        let d = X.R.compose(&front.R).inverse_times(site.design_pose(wheel).p - point);
        let (distance, needed) = (f64::hypot(d.x, d.z), front_radius + rear_radius);
        if distance <= needed {
            let message = format!("the sprockets overlap: centers {distance:.4} m apart, pitch radii together {needed:.4} m");
            site.refuse("front_sprocket", "sprockets_overlap", message);
            return None;
        }
        if d.x >= 0.0 {
            site.refuse("front_sprocket.at", "sprockets_reversed", format!("the front sprocket on `{link}` is not ahead of the wheel"));
            return None;
        }
        let slack_force = self.slack_force.map_or(0.5, Quantity::si);
        let input = self.input.unwrap_or_else(|| "drive".to_owned());
        Some(Chain { wheel, chassis, front, front_radius, rear_radius, slack_force, input })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    /// The sprockets of the worked example, on the example tree: its arm pivot and axle are those of the example.
    fn chain() -> Bench {
        let bodies = tree().1;
        let front = Pose::from_xyz_rpy([0.64, 0.0, 0.42], [0.0; 3]);
        let (wheel, chassis) = (bodies.rear_rim, bodies.chassis);
        let law = Chain { wheel, chassis, front, front_radius: 0.04, rear_radius: 0.105, slack_force: 0.5, input: "drive".into() };
        Bench::new(vec![Force::new("chain", law)])
    }

    #[test]
    fn tensions_make_the_torque_that_is_asked_for() {
        let mut bench = chain();
        for torque in [-250.0, -0.02, 0.0, 3.0, 400.0] {
            bench.set("drive.torque", torque);
            let (upper, lower) = (bench.output("chain.upper_tension"), bench.output("chain.lower_tension"));
            assert!(upper > 0.0 && lower > 0.0);
            assert!((0.105 * (upper - lower) - torque).abs() < 1e-10);
            // the rounded split: T_up·T_lo = ε²
            assert!((upper * lower - 0.25).abs() < 1e-14);
            assert!((bench.effort("rear_wheel.rate") - torque).abs() < 1e-9);
        }
    }

    #[test]
    fn thrust_extends_or_compresses_the_arm_as_the_squat_point_says() {
        // with the road force F = T/R at the contact K, the arm is in balance without spring when the line K–A has the slope of the
        // force; then the moment of run and force about the pivot vanishes
        let mut bench = chain();
        bench.rest();
        bench.set("drive.torque", 400.0);
        let run = ChainRun::between(
            Sprocket { center: [0.64, 0.42].into(), radius: 0.04 },
            Sprocket { center: [0.0, 0.32].into(), radius: 0.105 },
            Run::Upper,
        );
        let pivot: Planar<f64> = [0.56, 0.4].into();
        let slope = super::super::squat::squat_slope([0.0, 0.0].into(), super::super::squat::squat_point(&run, pivot, [0.0, 0.32].into()));
        // road force that balances the wheel about its axle, and its vertical partner along K–A
        let thrust = 400.0 / 0.32;
        let force = Planar::new(thrust, thrust * slope);
        let road = (Planar::from([0.0, 0.0]) - pivot).cross(force);
        let chain = bench.effort("swingarm.rate");
        // the slack tension of the lower run is 0.25/3810 N
        assert!((chain + road).abs() < 1e-3, "{chain} against {road} N m");
    }

    #[test]
    fn derivatives_are_exact_and_energy_balances() {
        let mut bench = chain();
        for torque in [-300.0, 0.0, 0.1, 500.0] {
            bench.set("drive.torque", torque);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
