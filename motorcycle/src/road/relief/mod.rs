//! Heights of a road along its path: one kind each, one file and one row.
//!
//! A road is as high everywhere across as on the path: `z(s)` with s the arc length. The wheels feel it by its height and by the rate of that height, whose derivatives
//! need `z'` and `z″`; each kind gives all three in closed form.

mod bump_sequence;
mod cosine_bump;
mod flat;
mod iso_8608;
mod profile;
mod sine;

use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::scalar::spline::CurvePoint;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt::Debug;
use std::sync::Arc;

/// The height of a road over the arc length of its path.
pub trait Relief: Debug + Send + Sync {
    /// Height, m, slope and second derivative, 1/m, at an arc length, m.
    fn at(&self, s: f64) -> CurvePoint<f64>;
    /// Length of its shortest part between level ground, m: no step of an integration should be longer.
    fn shortest(&self) -> f64 {
        f64::INFINITY
    }
}

/// The written form of one kind of road. Implement it on a `deny_unknown_fields` struct.
pub trait ReliefDescription: DeserializeOwned + JsonSchema {
    /// Name in maneuvers.
    const KIND: &'static str;
    /// One sentence.
    const ABOUT: &'static str;
    /// Parameters as a user would write them.
    const EXAMPLE: &'static str;
    /// The road; none where it is level. Files come from the library.
    ///
    /// # Errors
    /// Parameters that do not go together, files that are not there.
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings>;
}

/// Reads the parameters of a kind and makes the road.
type Make = fn(&Value, &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings>;

/// A row of the table.
#[derive(Clone, Copy)]
pub struct ReliefKind {
    /// Name in maneuvers.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Parameters as a user would write them.
    pub example: &'static str,
    /// JSON Schema of the parameters.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Reads the parameters and makes the road.
    pub make: Make,
}

impl ReliefKind {
    const fn of<T: ReliefDescription>() -> Self {
        Self { name: T::KIND, about: T::ABOUT, example: T::EXAMPLE, schema: |generator| generator.subschema_for::<T>(), make: make::<T> }
    }
}

impl Debug for ReliefKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn make<T: ReliefDescription>(value: &Value, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
    let read: T = serde_path_to_error::deserialize(value).map_err(|e| {
        let at = e.path().to_string();
        let at = if at == "." { String::new() } else { at };
        Findings::from(Finding::error("invalid_entry", e.into_inner().to_string()).at_path(at))
    })?;
    read.relief(library)
}

/// All kinds of roads.
pub const KINDS: &[ReliefKind] = &[
    ReliefKind::of::<flat::Flat>(),
    ReliefKind::of::<cosine_bump::CosineBump>(),
    ReliefKind::of::<bump_sequence::BumpSequence>(),
    ReliefKind::of::<sine::Sine>(),
    ReliefKind::of::<profile::Profile>(),
    ReliefKind::of::<iso_8608::Iso8608>(),
];

/// Where an endless road rises out of level ground: `z w(q)`, `w = 10 q³ − 15 q⁴ + 6 q⁵`, q the share of the transition.
#[derive(Clone, Copy, Debug)]
struct Onset {
    begin: f64,
    length: f64,
}

/// Where roads begin and how long they take to reach their full height, m, where nothing else is said.
const USUAL: Onset = Onset { begin: 10.0, length: 5.0 };

impl Onset {
    /// Level ground before it, the road behind it.
    fn of(self, z: CurvePoint<f64>, s: f64) -> CurvePoint<f64> {
        let q = ((s - self.begin) / self.length).clamp(0.0, 1.0);
        let w = q * q * q * (q * (q * 6.0 - 15.0) + 10.0);
        let slope = 30.0 * q * q * (q - 1.0) * (q - 1.0) / self.length;
        let curvature = 60.0 * q * (2.0 * q - 1.0) * (q - 1.0) / (self.length * self.length);
        CurvePoint {
            value: w * z.value,
            slope: w * z.slope + slope * z.value,
            curvature: w * z.curvature + 2.0 * slope * z.slope + curvature * z.value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::borrow::Cow;

    /// One file of heights.
    struct OneFile;

    impl Library for OneFile {
        fn text(&self, name: &str) -> Option<Cow<'_, str>> {
            (name == "track.csv").then_some("station [m],height [mm]\n0,0\n1,2\n2,-3\n3,0\n".into())
        }
    }

    fn road(kind: &str, parameters: &str) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let kind = KINDS.iter().find(|k| k.name == kind).expect("a kind");
        (kind.make)(&serde_yaml::from_str(parameters).unwrap(), &OneFile)
    }

    #[test]
    fn slopes_are_derivatives_of_heights_and_second_derivatives_of_slopes() {
        for kind in KINDS {
            let Some(road) = road(kind.name, kind.example).unwrap_or_else(|e| panic!("{}: {e}", kind.name)) else { continue };
            let mut highest: f64 = 0.0;
            for k in 0..400 {
                // not a multiple of what the examples have corners at
                let (s, h) = (0.1237 * f64::from(k), 1e-5);
                let (a, at, b) = (road.at(s - h), road.at(s), road.at(s + h));
                highest = highest.max(at.value.abs());
                assert!(((b.value - a.value) / (2.0 * h) - at.slope).abs() < 1e-7, "{} at {s}", kind.name);
                assert!(
                    ((b.slope - a.slope) / (2.0 * h) - at.curvature).abs() < 1e-4 * at.curvature.abs().max(1.0),
                    "{} at {s}",
                    kind.name
                );
            }
            assert!(highest > 1e-3, "{}", kind.name);
            assert!(road.at(0.0).value.abs() + road.at(0.0).slope.abs() < 1e-15, "{} begins level", kind.name);
        }
    }

    #[test]
    fn roads_are_as_high_as_their_parameters_say() {
        let height = |kind: &str, parameters: &str, s: f64| road(kind, parameters).unwrap().unwrap().at(s).value;
        let bump = "{ height: 30 mm, length: 0.6 m, station: 20 m }";
        assert!([19.9, 20.0, 20.6, 30.0].iter().all(|&s| height("cosine_bump", bump, s).abs() < 1e-15));
        assert!((height("cosine_bump", bump, 20.3) - 0.03).abs() < 1e-15 && (height("cosine_bump", bump, 20.15) - 0.015).abs() < 1e-15);
        let bumps = "{ height: 30 mm, length: 0.6 m, station: 20 m, spacing: 2 m, count: 3 }";
        assert!([20.3, 22.3, 24.3].iter().all(|&s| (height("bump_sequence", bumps, s) - 0.03).abs() < 1e-15));
        assert!([18.3, 21.3, 26.3].iter().all(|&s| height("bump_sequence", bumps, s) == 0.0));
        let sine = "{ amplitude: 10 mm, wavelength: 4 m, begin: 10 m }";
        assert!((height("sine", sine, 21.0) + 0.01).abs() < 1e-14 && (height("sine", sine, 23.0) - 0.01).abs() < 1e-14);
        let track = "{ file: track.csv }";
        assert!((height("profile", track, 1.0) - 0.002).abs() < 1e-15 && height("profile", track, 9.0) == 0.0);
        let rough = |class: &str| height("iso_8608", &format!("{{ class: {class}, seed: 3 }}"), 77.0);
        assert!((rough("C") / rough("A") - 4.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let why = |kind: &str, parameters: &str| road(kind, parameters).expect_err("a finding").to_string();
        assert!(why("profile", "{ file: none.csv }").contains("`none.csv`"));
        assert!(why("profile", "{ points: [[0 m, 0 m]] }").contains("points"));
        assert!(why("bump_sequence", "{ height: 30 mm, length: 0.6 m, station: 20 m, spacing: 0.5 m, count: 3 }").contains("0.6 m"));
        assert!(why("iso_8608", "{ class: B, level: 1e-6, seed: 1 }").contains("`level`"));
        assert!(why("iso_8608", "{ seed: 1 }").contains("`class`"));
    }
}
