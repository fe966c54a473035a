//! Engine behind a continuously variable transmission: its speed and torque while the wheel is driven; no forces.
//!
//! ```text
//! ω = G_s Ω + (ω_c − G_s Ω)⁺ − (ω_c − G_l Ω)⁺        T = T_w Ω/(ω η)        (x)⁺ = (x + √(x² + 4e²))/2
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | T_w, T | N m | torque on the wheel, an input; torque of the engine |
//! | Ω, ω | rad/s | spin rate of the wheel relative to its carrier, speed of the engine |
//! | G_l, G_s | – | engine turns per turn of the wheel in the lowest (starting) and in the highest gear of the variator |
//! | ω_c | rad/s | speed at which rollers and springs of the variator balance: the engine stays there while the ratio changes |
//! | η | – | efficiency of the belt |
//! | e | rad/s | rounding of the corners |
//!
//! Below `ω_c/G_l` at the wheel the transmission stays in its lowest gear, above `ω_c/G_s` in its highest, between them the engine keeps its speed. The ratio
//! is `ω/Ω`; at rest it is that of the lowest gear. The clutch is closed.
//!
//! Source: function of centrifugal variators with rubber belts, e.g. G. Carbone, L. Mangialardi, G. Mantriota, Mechanism and Machine Theory 36 (2001)
//! 1093–1114; the steady characteristic with corners is the usual idealization. Range: forward; the shift takes no time.

use super::EngineMap;
use super::chain::drive_input;
use super::engine::{ENGINE_LIMIT, EngineMapDescription};
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{AngularSpeed, Number};
use mbody::description::quantity::{Fraction, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, LimitDeclared, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::{SystemScalar, smooth::splus};
use problem::Side;
use schemars::JsonSchema;
use serde::Deserialize;

/// Rounding of the corners, rad/s.
const ROUNDING: f64 = 1.0;

/// Observer of an engine behind a variator.
#[derive(Clone, Debug)]
pub struct Variator {
    /// The wheel.
    pub wheel: BodyIndex,
    /// Engine turns per turn of the wheel in the lowest gear.
    pub lowest: f64,
    /// The same in the highest gear.
    pub highest: f64,
    /// Speed of the engine while the ratio changes, rad/s.
    pub shift_speed: f64,
    /// Efficiency of the belt.
    pub efficiency: f64,
    /// Torque over speed and throttle.
    pub map: Option<EngineMap>,
    /// First part of the name of the input: `drive` reads `drive.torque`.
    pub input: String,
}

impl Variator {
    /// Ratio of the speeds of engine and wheel.
    #[inline]
    fn ratio<S: SystemScalar>(&self, wheel: S) -> S {
        // between the gears `ω_c/Ω`, so that nothing is divided by a wheel at rest
        let (low, high) = (wheel * self.lowest, wheel * self.highest);
        let speed = high + splus(-high + self.shift_speed, ROUNDING) - splus(-low + self.shift_speed, ROUNDING);
        // at rest numerator and denominator vanish together: their quotient there is the slope
        let rolling = wheel * wheel + ROUNDING * ROUNDING;
        (speed * wheel + self.lowest * ROUNDING * ROUNDING) / rolling
    }
}

impl ForceLaw for Variator {
    fn declare(&self, element: &str) -> Declared {
        let name = |quantity: &str| format!("{element}.{quantity}");
        let output = |name, unit, about| OutputDeclared { name, unit, about };
        let mut outputs = vec![
            output(name("speed"), "rad/s", "speed of the engine"),
            output(name("torque"), "N m", "torque of the engine"),
            output("drivetrain.ratio".to_owned(), "-", "engine turns per turn of the wheel"),
        ];
        let mut limits = Vec::new();
        if self.map.is_some() {
            outputs.push(output(name("throttle"), "-", "throttle that gives the torque; below 0 or above 1 where the engine cannot"));
            outputs.push(output(name("torque_margin"), "N m", "torque at full throttle minus torque"));
            let about = "the torque is more than the engine gives at full throttle";
            let signal = name("torque_margin");
            limits.push(LimitDeclared { name: ENGINE_LIMIT, signal, threshold: 0.0, side: Side::Below, nominal: 10.0, about });
        }
        Declared { inputs: vec![drive_input(&self.input)], outputs, limits, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let wheel = at.speed(self.wheel);
        let ratio = self.ratio(wheel);
        let (speed, torque) = (ratio * wheel, at.input(0) / (ratio * self.efficiency));
        out.output(0, speed);
        out.output(1, torque);
        out.output(2, ratio);
        if let Some(map) = &self.map {
            out.output(3, map.throttle(speed, torque));
            out.output(4, map.full_torque(speed) - torque);
        }
    }
    fn energy<S: SystemScalar>(&self, _at: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

/// Engine behind a continuously variable transmission: what it does while `drive.torque` acts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VariatorDescription {
    /// Name of the joint of the driven wheel.
    wheel: String,
    /// Ratio of the belt in the lowest gear, engine turns per turn of the driven pulley.
    lowest: PositiveQuantity<Number>,
    /// Ratio of the belt in the highest gear.
    highest: PositiveQuantity<Number>,
    /// Reduction between the driven pulley and the wheel.
    r#final: PositiveQuantity<Number>,
    /// Speed of the engine while the ratio changes.
    shift_speed: PositiveQuantity<AngularSpeed>,
    /// Efficiency of the belt; 1 where left out.
    efficiency: Option<Quantity<Number, Fraction>>,
    /// Torque over throttle and speed.
    map: Option<EngineMapDescription>,
    /// First part of the name of the input: `drive`, also where left out, reads `drive.torque`.
    input: Option<String>,
}

impl ElementDescription for VariatorDescription {
    const KIND: &'static str = "variator";
    const ABOUT: &'static str = "engine behind a continuously variable transmission: speed, torque, ratio and throttle behind `drive.torque`, with the limit `engine_limit`";
    const EXAMPLE: &'static str = "{ wheel: rear_wheel, lowest: 2.6, highest: 0.85, final: 7.6, shift_speed: 7000 rpm, efficiency: 0.85, \
        map: { throttle: [0, 1], speed: [2000 rpm, 6000 rpm, 9500 rpm], torque: [[-2, -3, -5], [9, 12, 8]] } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Variator;
    fn assemble(self, site: &mut Site<'_>) -> Option<Variator> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad");
        let (lowest, highest) = (self.lowest.si() * self.r#final.si(), self.highest.si() * self.r#final.si());
        if lowest <= highest {
            let message =
                format!("the lowest gear {} must have more engine turns per turn than the highest {}", self.lowest.si(), self.highest.si());
            site.refuse("lowest", "out_of_range", message);
            return None;
        }
        let efficiency = self.efficiency.map_or(1.0, Quantity::si);
        if efficiency <= 0.0 {
            site.refuse("efficiency", "out_of_range", "an efficiency of zero carries no torque; it must be above 0");
            return None;
        }
        let map = match self.map {
            Some(description) => Some(description.map(site)?),
            None => None,
        };
        let input = self.input.unwrap_or_else(|| "drive".to_owned());
        Some(Variator { wheel: wheel?, lowest, highest, shift_speed: self.shift_speed.si(), efficiency, map, input })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use crate::drivetrain::engine_map::tests::map;
    use mbody::force::Force;

    fn variator() -> Bench {
        let law = Variator {
            wheel: tree().1.rear_rim,
            lowest: 20.0,
            highest: 7.0,
            shift_speed: 700.0,
            efficiency: 0.8,
            map: Some(map()),
            input: "drive".into(),
        };
        Bench::new(vec![Force::new("engine", law)])
    }

    /// Lowest gear to 35 rad/s at the wheel, highest from 100 rad/s, the engine at 700 rad/s between; corners round to e²/distance.
    #[test]
    fn the_engine_keeps_its_speed_between_the_gears() {
        let mut bench = variator();
        bench.set("drive.torque", 100.0);
        for (wheel, engine) in [(10.0, 200.0), (20.0, 400.0), (50.0, 700.0), (70.0, 700.0), (110.0, 770.0), (150.0, 1050.0)] {
            bench.set("rear_wheel.rate", wheel);
            let (speed, ratio) = (bench.output("engine.speed"), bench.output("drivetrain.ratio"));
            // two corners, each rounded by at most e²/|x| with |x| > 70 rad/s, and the quotient by (ROUNDING/Ω)²
            assert!((speed / engine - 1.0).abs() < 0.02 && (ratio * wheel - speed).abs() < 1e-9, "{wheel}: {speed} {engine}");
            // what the engine gives arrives but for the losses
            let power = bench.output("engine.torque") * speed;
            assert!((power * 0.8 - 100.0 * wheel).abs() < 1e-8);
        }
        bench.set("rear_wheel.rate", 0.0);
        assert!((bench.output("drivetrain.ratio") - 20.0).abs() < 1e-12);
        assert_eq!(bench.limits()[0].0, ENGINE_LIMIT);
    }

    #[test]
    fn derivatives_are_exact_and_nothing_acts() {
        let mut bench = variator();
        bench.set("drive.torque", 100.0);
        for wheel in [0.0, 34.0, 60.0, 101.0] {
            bench.set("rear_wheel.rate", wheel);
            bench.assert_derivatives_are_exact();
        }
        assert!(bench.efforts().iter().all(|e| e.abs() == 0.0));
    }
}
