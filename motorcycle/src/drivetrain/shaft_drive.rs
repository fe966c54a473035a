//! Shaft drive: the torque of the engine on the wheel, and its reaction.
//!
//! `+T n` on the wheel, `−T n` on the body that takes the reaction. Symbols: T torque of the engine on the wheel, N m, an input; n axis of
//! the wheel. With the reaction on the arm (bevel housing bolted to it) the torque lifts or lowers the arm in full; with the reaction on
//! the chassis (ideal parallelogram with a torque rod) it does not act on the arm.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics* (2006), chapter 6. Range: no elasticity, no gear friction; the shaft's own spin is not modeled.

use super::chain::drive_input;
use crate::signal::turning_axis;
use mbody::assembly::{ElementDescription, Site};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A shaft drive of a wheel.
#[derive(Clone, Debug)]
pub struct ShaftDrive {
    /// The wheel.
    pub wheel: BodyIndex,
    /// Unit axis of the wheel, in the wheel.
    pub axis: Vec3<f64>,
    /// The body that takes the reaction.
    pub reaction: BodyIndex,
    /// First part of the name of the input: `drive` reads `drive.torque`.
    pub input: String,
}

impl ShaftDrive {
    #[inline]
    fn moment<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Vec3<S> {
        at.X_WB(self.wheel).R.times_const(self.axis).scaled(at.input(0))
    }
}

impl ForceLaw for ShaftDrive {
    fn declare(&self, _element: &str) -> Declared {
        Declared { inputs: vec![drive_input(&self.input)], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let moment = self.moment(at);
        out.moment(self.wheel, moment);
        out.moment(self.reaction, -moment);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let supplied = self.moment(at).dot(at.w_WB(self.wheel) - at.w_WB(self.reaction));
        Energy { supplied, ..Default::default() }
    }
}

/// Shaft drive of a wheel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaftDriveDescription {
    /// Name of the joint of the driven wheel.
    wheel: String,
    /// Name of the link that takes the reaction: the arm, or the chassis where a torque rod leads it there. The link that carries the
    /// wheel where left out.
    reaction: Option<String>,
    /// First part of the name of the input: `drive`, also where left out, reads `drive.torque`.
    input: Option<String>,
}

impl ElementDescription for ShaftDriveDescription {
    const KIND: &'static str = "shaft_drive";
    const ABOUT: &'static str = "shaft that carries the input `drive.torque` to a wheel, with its reaction on arm or chassis";
    const EXAMPLE: &'static str = "{ wheel: rear_wheel, reaction: arm }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = ShaftDrive;
    fn assemble(self, site: &mut Site<'_>) -> Option<ShaftDrive> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad")?;
        let reaction = match &self.reaction {
            Some(link) => site.link("reaction", link)?.0,
            None => site.model().body(wheel).parent,
        };
        if reaction == wheel {
            site.refuse("reaction", "wrong_link", "the wheel cannot take the reaction of its own drive");
            return None;
        }
        let input = self.input.unwrap_or_else(|| "drive".to_owned());
        Some(ShaftDrive { wheel, axis: turning_axis(site.model(), wheel), reaction, input })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    fn drive(reaction: BodyIndex) -> Bench {
        let law = ShaftDrive { wheel: tree().1.rear_rim, axis: Vec3::new(0.0, 1.0, 0.0), reaction, input: "drive".into() };
        Bench::new(vec![Force::new("shaft", law)])
    }

    #[test]
    fn the_arm_feels_the_torque_only_without_a_torque_rod() {
        for (reaction, on_arm) in [(tree().1.arm, 0.0), (tree().1.chassis, 300.0)] {
            let mut bench = drive(reaction);
            bench.set("drive.torque", 300.0);
            // generalized force on the joint of the arm: everything outboard of it, wheel included
            assert!((bench.effort("swingarm.rate") - on_arm).abs() < 1e-9);
            assert!((bench.effort("rear_wheel.rate") - 300.0).abs() < 1e-9);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
