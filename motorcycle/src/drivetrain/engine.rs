//! What the engine does while the wheel is driven: speed, torque and throttle behind the input `drive.torque`; no forces.
//!
//! `ω = G Ω`, `T = T_w/G`, `G = primary · gear · final`, throttle by inversion of the map, margin `T_max(ω) − T`.
//!
//! | symbol | unit | |
//! |---|---|---|
//! | T_w, T | N m | torque on the wheel, an input that the chain or shaft carries; torque of the engine |
//! | Ω, ω | rad/s | spin rate of the wheel relative to its carrier, speed of the engine |
//! | G | – | engine turns per turn of the wheel in the gear that is engaged |
//! | T_max | N m | torque of the map at full throttle |
//!
//! Source: gear ratios; losses are part of the map. Range: clutch closed. Where the margin is negative or the speed exceeds its maximum, the wheel
//! asks for more than the engine can do: limit `engine_limit`.

use super::EngineMap;
use super::chain::drive_input;
use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::dimension::{AngularSpeed, Number, Torque};
use mbody::description::quantity::{Fraction, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, LimitDeclared, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use problem::Side;
use schemars::JsonSchema;
use serde::Deserialize;

/// Name of the limit that the engine declares.
pub const ENGINE_LIMIT: &str = "engine_limit";

/// Observer of an engine that is geared to a wheel.
#[derive(Clone, Debug)]
pub struct Engine {
    /// The wheel.
    pub wheel: BodyIndex,
    /// The gear that is engaged, from 1.
    pub gear: usize,
    /// Engine turns per turn of the wheel.
    pub ratio: f64,
    /// Torque over speed and throttle.
    pub map: Option<EngineMap>,
    /// Highest speed, rad/s.
    pub maximum_speed: Option<f64>,
    /// First part of the name of the input: `drive` reads `drive.torque`.
    pub input: String,
}

impl ForceLaw for Engine {
    fn declare(&self, element: &str) -> Declared {
        let name = |quantity: &str| format!("{element}.{quantity}");
        let output = |name, unit, about| OutputDeclared { name, unit, about };
        let limit = |signal, threshold, side, nominal, about| LimitDeclared { name: ENGINE_LIMIT, signal, threshold, side, nominal, about };
        let mut outputs = vec![
            output(name("speed"), "rad/s", "speed of the engine"),
            output(name("torque"), "N m", "torque of the engine"),
            output("drivetrain.gear".to_owned(), "-", "gear that is engaged"),
        ];
        let mut limits = Vec::new();
        if self.map.is_some() {
            outputs.push(output(name("throttle"), "-", "throttle that gives the torque; below 0 or above 1 where the engine cannot"));
            outputs.push(output(name("torque_margin"), "N m", "torque at full throttle minus torque"));
            let about = "the torque is more than the engine gives at full throttle";
            limits.push(limit(name("torque_margin"), 0.0, Side::Below, 100.0, about));
        }
        if let Some(speed) = self.maximum_speed {
            limits.push(limit(name("speed"), speed, Side::Above, speed, "the engine turns faster than it may"));
        }
        Declared { inputs: vec![drive_input(&self.input)], outputs, limits, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let (speed, torque) = (at.speed(self.wheel) * self.ratio, at.input(0) / self.ratio);
        out.output(0, speed);
        out.output(1, torque);
        out.output(2, S::from_f64(self.gear as f64));
        if let Some(map) = &self.map {
            out.output(3, map.throttle(speed, torque));
            out.output(4, map.full_torque(speed) - torque);
        }
    }
    fn energy<S: SystemScalar>(&self, _at: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

/// Torque of the engine over throttle and speed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineMapDescription {
    /// Throttle settings, increasing from 0 to 1; one row of `torque` each.
    throttle: Vec<Quantity<Number, Fraction>>,
    /// Engine speeds, increasing; one column of `torque` each.
    speed: Vec<PositiveQuantity<AngularSpeed>>,
    /// Torques: one row per throttle setting, rising from row to row; negative at closed throttle.
    torque: Vec<Vec<Quantity<Torque>>>,
}

/// Ratios between engine and wheel, each in turns in per turn out.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GearsDescription {
    /// Primary ratio, engine to clutch; 1 where left out.
    primary: Option<PositiveQuantity<Number>>,
    /// Ratios of the gears, from first to last.
    ratios: Vec<PositiveQuantity<Number>>,
    /// Final ratio, gearbox to wheel: teeth of the rear sprocket over teeth of the front one.
    r#final: PositiveQuantity<Number>,
}

/// Engine that is geared to a wheel: what it does while `drive.torque` acts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineDescription {
    /// Name of the joint of the driven wheel.
    wheel: String,
    /// Ratios between engine and wheel.
    gears: GearsDescription,
    /// The gear that is engaged, from 1; the last one where left out.
    #[schemars(range(min = 1))]
    gear: Option<u32>,
    /// Torque over throttle and speed.
    map: Option<EngineMapDescription>,
    /// Highest speed of the engine.
    #[schemars(extend("plausible" = [50.0, 3000.0]))]
    maximum_speed: Option<PositiveQuantity<AngularSpeed>>,
    /// First part of the name of the input: `drive`, also where left out, reads `drive.torque`.
    input: Option<String>,
}

impl GearsDescription {
    /// Gear that is engaged, and engine turns per turn of the wheel.
    fn engaged(&self, gear: Option<u32>, site: &mut Site<'_>) -> Option<(usize, f64)> {
        let count = self.ratios.len();
        if count == 0 {
            site.refuse("gears.ratios", "out_of_range", "the gearbox has no gears");
            return None;
        }
        let gear = gear.map_or(count, |g| g as usize);
        if !(1..=count).contains(&gear) {
            site.refuse("gear", "out_of_range", format!("gear {gear} does not exist: the gears are 1 to {count}"));
            return None;
        }
        let primary = self.primary.map_or(1.0, Quantity::si);
        Some((gear, primary * self.ratios[gear - 1].si() * self.r#final.si()))
    }
}

impl EngineMapDescription {
    pub(super) fn map(self, site: &mut Site<'_>) -> Option<EngineMap> {
        let settings: Vec<f64> = self.throttle.into_iter().map(Quantity::si).collect();
        let speeds: Vec<f64> = self.speed.into_iter().map(Quantity::si).collect();
        let rows: Vec<Vec<f64>> = self.torque.into_iter().map(|row| row.into_iter().map(Quantity::si).collect()).collect();
        match EngineMap::new(&settings, &speeds, &rows) {
            Ok(map) => Some(map),
            Err(error) => {
                site.refuse("map", "invalid_table", error.to_string());
                None
            }
        }
    }
}

impl ElementDescription for EngineDescription {
    const KIND: &'static str = "engine";
    const ABOUT: &'static str = "speed, torque and throttle of the engine behind `drive.torque`, with the limit `engine_limit`";
    const EXAMPLE: &'static str = "{ wheel: rear_wheel, gears: { primary: 1.553, ratios: [2.687, 2.105, 1.761, 1.521, 1.347, 1.23], final: 2.625 }, gear: 4, \
        map: { throttle: [0, 0.3, 1], speed: [2000 rpm, 6000 rpm, 11000 rpm], torque: [[-8, -14, -24], [45, 48, 20], [65, 95, 90]] }, \
        maximum_speed: 12500 rpm }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Engine;
    fn assemble(self, site: &mut Site<'_>) -> Option<Engine> {
        let wheel = site.joint_with("wheel", &self.wheel, "rad");
        let engaged = self.gears.engaged(self.gear, site);
        let map = match self.map {
            Some(description) => Some(description.map(site)?),
            None => None,
        };
        let (wheel, (gear, ratio)) = (wheel?, engaged?);
        let maximum_speed = self.maximum_speed.map(Quantity::si);
        Some(Engine { wheel, gear, ratio, map, maximum_speed, input: self.input.unwrap_or_else(|| "drive".to_owned()) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use crate::drivetrain::engine_map::tests::map;
    use mbody::force::Force;

    fn engine() -> Bench {
        // 55 rad/s at the wheel are 550 rad/s at the engine
        let law =
            Engine { wheel: tree().1.rear_rim, gear: 3, ratio: 10.0, map: Some(map()), maximum_speed: Some(1250.0), input: "drive".into() };
        Bench::new(vec![Force::new("engine", law)])
    }

    #[test]
    fn the_engine_answers_the_wheel() {
        let mut bench = engine();
        bench.set("rear_wheel.rate", 50.0);
        bench.set("drive.torque", 480.0);
        assert!((bench.output("engine.speed") - 500.0).abs() < 1e-12);
        assert!((bench.output("engine.torque") - 48.0).abs() < 1e-12);
        assert!((bench.output("engine.throttle") - 0.3).abs() < 1e-12);
        assert!((bench.output("engine.torque_margin") - 37.0).abs() < 1e-12);
        assert_eq!(bench.output("drivetrain.gear"), 3.0);
        let limits = bench.limits();
        assert!(limits.iter().all(|l| l.0 == "engine_limit"));
        assert_eq!((limits[0].1.as_str(), limits[1].1.as_str()), ("engine.torque_margin", "engine.speed"));
        bench.set("drive.torque", 900.0);
        assert!(bench.output("engine.torque_margin") < 0.0 && bench.output("engine.throttle") > 1.0);
    }

    #[test]
    fn derivatives_are_exact_and_nothing_acts() {
        let mut bench = engine();
        bench.assert_derivatives_are_exact();
        assert!(bench.efforts().iter().all(|e| e.abs() == 0.0));
    }
}
