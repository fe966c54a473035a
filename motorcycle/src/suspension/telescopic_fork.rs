//! Telescopic fork: spring, damper, air column, stops and friction on the joint between upper and lower fork.
//!
//! `F = F₀ + k (s − s₀) + F_air(s) + F_stop(s) + F_damp(ṡ) + F_c tanh(ṡ/v_c)`, s compression, m, positive when the lower fork
//! has moved up; F opposes compression, N. The parts are those of `mbody`'s one-dimensional laws.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics* (2006), chapter 5. Both legs together; the axis of the joint must point up.

use super::SUSPENSION_STOP;
use crate::signal::coordinate_signal;
use mbody::assembly::characteristic::{
    AirDescription, DamperDescription, FrictionDescription, LawDescription, Sliding, SpringDescription, StopsDescription,
};
use mbody::assembly::{ElementDescription, Site};
use mbody::force::{JointEffortUnit, JointSpring};
use schemars::JsonSchema;
use serde::Deserialize;

/// Telescopic fork, both legs together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TelescopicForkDescription {
    /// Name of the joint between upper and lower fork; its coordinate is positive in compression.
    joint: String,
    /// Spring; the deflection is the compression, the preload acts at zero compression.
    #[schemars(extend("plausible" = { "stiffness": [500.0, 2e6], "preload": [1.0, 2e5] }))]
    spring: Option<SpringDescription<Sliding>>,
    /// Damper; bump is compression.
    #[schemars(extend("plausible" = { "coefficient": [10.0, 2e5], "bump": [10.0, 2e5], "rebound": [10.0, 2e5] }))]
    damper: Option<DamperDescription<Sliding>>,
    /// Air above the oil.
    air: Option<AirDescription>,
    /// Top-out and bottoming, in terms of the compression.
    #[schemars(extend("plausible" = { "lower": [1e-4, 1.0], "upper": [1e-4, 1.0], "stiffness": [3e3, 1e8], "width": [1e-4, 0.2] }))]
    stops: Option<StopsDescription<Sliding>>,
    /// Friction of seals and bushings.
    friction: Option<FrictionDescription<Sliding>>,
}

impl ElementDescription for TelescopicForkDescription {
    const KIND: &'static str = "telescopic_fork";
    const ABOUT: &'static str = "telescopic fork: spring, damper, air column, stops and friction on a joint that slides";
    const EXAMPLE: &'static str = "{ joint: fork, spring: { stiffness: 18 kN/m, preload: 800 N }, damper: { bump: 900 N s/m, rebound: 1500 N s/m }, \
        air: { force: 60 N, length: 0.3 m, exponent: 1.2 }, stops: { lower: -50 mm, upper: 75 mm, stiffness: 300 kN/m, width: 10 mm }, \
        friction: { effort: 40 N, rounding: 10 mm/s } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = JointSpring;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointSpring> {
        let Self { joint, spring, damper, air, stops, friction } = self;
        let joint = site.joint_with("joint", &joint, "m");
        let law = LawDescription { spring, damper, air, stops, friction }.law(site);
        let (joint, law) = (joint?, law?);
        let stop = Some((SUSPENSION_STOP, coordinate_signal(site.model(), joint)));
        Some(JointSpring { joint, law, effort: JointEffortUnit::Force, stop })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::{Air, Damping, Force, Friction, SpringDamperLaw, Stops};

    fn fork() -> Bench {
        let law = SpringDamperLaw {
            damping: Damping::Bilinear { bump: 900.0, rebound: 1500.0, rounding: 0.01 },
            air: Some(Air { force: 60.0, length: 0.3, exponent: 1.2 }),
            stops: Some(Stops { lower: -0.05, upper: 0.075, stiffness: 3e5, width: 0.01 }),
            friction: Some(Friction { force: 40.0, speed: 0.01 }),
            ..SpringDamperLaw::linear(800.0, 18e3, 0.0)
        };
        let stop = Some((SUSPENSION_STOP, "fork.travel".to_owned()));
        let joint = tree().1.front_lower;
        Bench::new(vec![Force::new("fork", JointSpring { joint, law, effort: JointEffortUnit::Force, stop })])
    }

    #[test]
    fn a_compressed_fork_pushes_the_wheel_down() {
        let mut bench = fork();
        bench.rest();
        bench.set("fork.travel", 0.02);
        // 800 + 18000·0.02 + 60[(0.3/0.28)^1.2 − 1], below the stop and at rest
        let expected = 800.0 + 360.0 + 60.0 * ((0.3f64 / 0.28).powf(1.2) - 1.0);
        assert!((bench.output("fork.force") - expected).abs() < 1e-10);
        assert!((bench.effort("fork.speed") + expected).abs() < 1e-9);
        let limits = bench.limits();
        assert!(limits.iter().all(|l| l.0 == "suspension_stop" && l.1 == "fork.travel"));
        assert!((limits[0].2 - 0.085).abs() < 1e-15 && (limits[1].2 + 0.06).abs() < 1e-15);
    }

    #[test]
    fn derivatives_are_exact_and_energy_balances() {
        let mut bench = fork();
        for travel in [-0.06, 0.0, 0.04, 0.08] {
            bench.set("fork.travel", travel);
            bench.set("fork.speed", 0.3);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
