//! End stops of the steering.
//!
//! `T = k [S(δ − δ_s) − S(−δ_s − δ)]`, opposing δ; S one-sided ramp that builds up over a width. Symbols: δ steering angle, δ_s angle at
//! which the stops begin, rad; k stiffness, N m/rad.
//!
//! Source: the smoothing is ours; see `mbody`'s one-dimensional laws.

use crate::signal::coordinate_signal;
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{Angle, AngularStiffness};
use mbody::description::quantity::{PositiveQuantity, Quantity};
use mbody::force::{JointEffortUnit, JointSpring, SpringDamperLaw, Stops};
use schemars::JsonSchema;
use serde::Deserialize;

/// Name of the limit that the stops declare.
pub const STEERING_STOP: &str = "steering_stop";

/// End stops on the steering joint, the same to both sides.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SteeringStopDescription {
    /// Name of the steering joint.
    joint: String,
    /// Angle at which the stops begin.
    angle: PositiveQuantity<Angle>,
    /// Stiffness of the stops; 5 kN m/rad where left out.
    #[schemars(extend("plausible" = [50.0, 1e6]))]
    stiffness: Option<PositiveQuantity<AngularStiffness>>,
    /// Angle over which the stiffness builds up; 1 degree where left out.
    width: Option<PositiveQuantity<Angle>>,
}

impl ElementDescription for SteeringStopDescription {
    const KIND: &'static str = "steering_stop";
    const ABOUT: &'static str = "end stops of the steering";
    const EXAMPLE: &'static str = "{ joint: steer, angle: 30 deg, stiffness: 5 kN m/rad, width: 1 deg }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = JointSpring;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointSpring> {
        let joint = site.joint_with("joint", &self.joint, "rad")?;
        let angle = self.angle.si();
        let stiffness = self.stiffness.map_or(5e3, Quantity::si);
        let width = self.width.map_or(1f64.to_radians(), Quantity::si);
        let stops = Some(Stops { lower: -angle, upper: angle, stiffness, width });
        let law = SpringDamperLaw { stops, ..SpringDamperLaw::linear(0.0, 0.0, 0.0) };
        let stop = Some((STEERING_STOP, coordinate_signal(site.model(), joint)));
        Some(JointSpring { joint, law, effort: JointEffortUnit::Torque, stop })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    #[test]
    fn stops_act_beyond_their_angle_only() {
        let stops = Some(Stops { lower: -0.5, upper: 0.5, stiffness: 5e3, width: 0.02 });
        let law = SpringDamperLaw { stops, ..SpringDamperLaw::linear(0.0, 0.0, 0.0) };
        let stop = Some((STEERING_STOP, "steer.angle".to_owned()));
        let joint = tree().1.front_upper;
        let mut bench = Bench::new(vec![Force::new("stop", JointSpring { joint, law, effort: JointEffortUnit::Torque, stop })]);
        for (angle, torque) in [(0.49, 0.0), (-0.499, 0.0), (0.54, 5e3 * 0.03), (-0.54, -5e3 * 0.03)] {
            bench.set("steer.angle", angle);
            assert!((bench.output("stop.torque") - torque).abs() < 1e-9);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
        let limits = bench.limits();
        assert!(limits.iter().all(|l| l.0 == "steering_stop" && l.1 == "steer.angle" && l.2.abs() == 0.52));
    }
}
