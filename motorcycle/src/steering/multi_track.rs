//! Signals of a vehicle with more than one track as a whole; no forces.
//!
//! Those of [`super::SingleTrack`], where several wheels stand side by side as means over them, and
//!
//! ```text
//! b = max (P_i·y) − min (P_i·y)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | b | m | width of the track: distance of the outermost contact points across the heading |
//! | P_i | m | contact point of an undeformed tire with the level road |
//! | y | | horizontal, to the left of the heading of the base |
//!
//! `balance` says who holds the vehicle up. A leaning one (two front wheels on a parallelogram) is balanced like a single track: its lean is
//! prescribed and the turn follows. A standing one (sidecar, trike) rests on its wheels: the turn is prescribed and the roll is found. It says so
//! by the output [`STANDS`], by which steady states choose who is given.
//!
//! Source: definitions; V. Cossalter, *Motorcycle Dynamics* (2006), chapter 1. Range: level road.

use super::single_track::{Course, OUTPUTS, SingleTrack, Wheel, WheelDescription, inputs_of};
use mbody::assembly::{ElementDescription, Site};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, OutputDeclared};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// The output of a vehicle that stands on its wheels.
pub const STANDS: &str = "stands";

/// Who holds a vehicle up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Balance {
    /// It leans into turns and has to be balanced: its lean is chosen.
    Leaning,
    /// It stands on three or more wheels: its roll is found.
    Standing,
}

/// Observer of a vehicle with more than one track.
#[derive(Clone, Debug)]
pub struct MultiTrack {
    /// What it shares with a single-track vehicle.
    pub course: SingleTrack,
    /// Wheels beside it, that belong neither to the front nor to the rear.
    pub side: Vec<Wheel>,
    /// Who holds it up.
    pub balance: Balance,
}

impl ForceLaw for MultiTrack {
    fn declare(&self, element: &str) -> Declared {
        let mut declared = self.course.declare(element);
        let about = "distance of the outermost contact points across the heading";
        declared.inputs.extend(self.side.iter().flat_map(Wheel::inputs));
        declared.outputs.push(OutputDeclared { name: "track_width".into(), unit: "m", about });
        if self.balance == Balance::Standing {
            let about = "1: the vehicle stands on its wheels, so that its roll is found and not chosen";
            declared.outputs.push(OutputDeclared { name: STANDS.into(), unit: "-", about });
        }
        declared
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        self.course.apply(at, out);
        // the heading is that of the base, across the pitch axis and level
        let left = at.X_WB(self.course.base).R.times_const(Vec3::new(0.0, 1.0, 0.0));
        let heading = Vec3::new(left.y, -left.x, S::zero());
        let across = Vec3::new(-heading.y, heading.x, S::zero()).scaled(heading.norm().recip());
        let wheels = self.course.front.iter().chain(&self.course.rear).chain(&self.side);
        let mut first = 1;
        let (mut low, mut high) = (S::from_f64(f64::INFINITY), S::from_f64(f64::NEG_INFINITY));
        for wheel in wheels {
            let y = wheel.contact(at, first).0.point.dot(across);
            first += inputs_of(std::slice::from_ref(wheel));
            (low, high) = (if y.value() < low.value() { y } else { low }, if y.value() > high.value() { y } else { high });
        }
        out.output(OUTPUTS, high - low);
        if self.balance == Balance::Standing {
            out.output(OUTPUTS + 1, S::one());
        }
    }
    fn energy<S: SystemScalar>(&self, _at: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

/// Signals of a vehicle with more than one track as a whole.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MultiTrackDescription {
    /// Name of the link that moves on the vehicle base.
    base: String,
    /// Name of the steering joint.
    steer: String,
    /// Front wheels.
    #[schemars(length(min = 1))]
    front_wheels: Vec<WheelDescription>,
    /// Rear wheels.
    #[schemars(length(min = 1))]
    rear_wheels: Vec<WheelDescription>,
    /// Wheels beside them, as that of a sidecar; none where left out.
    #[serde(default)]
    side_wheels: Vec<WheelDescription>,
    /// Who holds the vehicle up.
    balance: Balance,
    /// First part of the name of the torque of the rider: `steer`, also where left out, reads `steer.torque`.
    input: Option<String>,
}

impl ElementDescription for MultiTrackDescription {
    const KIND: &'static str = "multi_track";
    const ABOUT: &'static str = "signals of a vehicle with more than one track (sidecar, trike, tilting three-wheeler): those of `single_track`, track_width, and stands";
    const EXAMPLE: &'static str = "{ base: chassis, steer: steer, front_wheels: [{ joint: front_wheel, radius: 0.3 m, crown_radius: 60 mm }], \
        rear_wheels: [{ joint: rear_wheel, radius: 0.32 m, crown_radius: 95 mm }], balance: leaning }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = MultiTrack;
    fn assemble(self, site: &mut Site<'_>) -> Option<MultiTrack> {
        let course = Course::find(&self.base, &self.steer, site);
        let mut axle = |key: &str, wheels: &[WheelDescription]| -> Option<Vec<Wheel>> {
            let found: Vec<_> = wheels.iter().enumerate().map(|(i, wheel)| wheel.wheel(&format!("{key}.{i}"), site)).collect();
            found.into_iter().collect()
        };
        let (front, rear) = (axle("front_wheels", &self.front_wheels), axle("rear_wheels", &self.rear_wheels));
        let side = axle("side_wheels", &self.side_wheels);
        let (course, front, rear, side) = (course?, front?, rear?, side?);
        if front.is_empty() || rear.is_empty() {
            let key = if front.is_empty() { "front_wheels" } else { "rear_wheels" };
            site.refuse(key, "missing_entry", "a vehicle needs at least one wheel there");
            return None;
        }
        Some(MultiTrack { course: course.observer(front, rear, self.input), side, balance: self.balance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::contact::Profile;
    use mbody::force::Force;

    fn observer(balance: Balance) -> Bench {
        let bodies = tree().1;
        let left = Vec3::new(0.0, 1.0, 0.0);
        let wheel = |body, radius, crown| Wheel { body, axis: left, profile: Profile::torus(radius, crown).unwrap(), road: None };
        let front = wheel(bodies.front_rim, 0.3, 0.06);
        let course = SingleTrack {
            base: bodies.chassis,
            steer: bodies.front_upper,
            steer_axis: Vec3::new(0.0, 0.0, 1.0),
            front: vec![front.clone(), front],
            rear: vec![wheel(bodies.rear_rim, 0.32, 0.095)],
            input: "steer".into(),
        };
        Bench::new(vec![Force::new("track", MultiTrack { course, side: Vec::new(), balance })])
    }

    /// The same wheel twice is that wheel once: wheelbase and trail are those of the drawing (see `single_track`); all wheels on one line have no width.
    #[test]
    fn means_of_equal_wheels_are_the_wheel() {
        let mut bench = observer(Balance::Leaning);
        bench.rest();
        let (sin, cos) = 0.42f64.sin_cos();
        let wheelbase = 1.2 + 0.03 * cos + 0.49 * sin;
        assert!((bench.output("wheelbase") - wheelbase).abs() < 1e-12);
        assert!((bench.output("trail") - (1.2 + 0.75 * sin / cos - wheelbase)).abs() < 1e-12);
        assert!(bench.output("track_width").abs() < 1e-12);
        // a leaning vehicle with a crown of 95 and one of 60 mm: contacts move aside by ρ sin φ
        bench.set("chassis.roll", 0.3);
        let aside = (0.095 - 0.06) * 0.3f64.sin();
        assert!((bench.output("track_width") - aside).abs() < 0.01, "{} {aside}", bench.output("track_width"));
    }

    #[test]
    fn derivatives_are_exact_and_nothing_acts() {
        let mut bench = observer(Balance::Standing);
        bench.set("chassis.roll", 0.2);
        bench.set("chassis.yaw", 0.7);
        assert_eq!(bench.output(STANDS), 1.0);
        bench.assert_derivatives_are_exact();
        bench.assert_energy_balances();
        assert!(bench.efforts().iter().all(|e| e.abs() == 0.0));
    }
}
