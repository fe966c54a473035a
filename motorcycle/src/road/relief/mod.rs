//! What stands on a road: unevenness, slopes, banks, friction; one kind each, one file and one row.
//!
//! A kind gives height and friction over arc length s and offset n of the path, or over x and y of the world, with the derivatives that rates and exact Jacobians need, all in closed form. Short unevenness
//! (`Uneven`) is as high everywhere across as on the path and is felt by its height alone, as if the road stayed level under each wheel; wheels stand on the slopes of everything else. A road may consist of several kinds:
//! heights add, frictions multiply.

mod bank;
mod bump_sequence;
mod cosine_bump;
mod flat;
mod friction;
mod grid;
mod iso_8608;
mod profile;
mod shape;
mod sine;
mod slope;

pub use shape::Shape;

use crate::maneuver::{Path, below, columns};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::Length;
use mbody::description::quantity::{Dimension, Dimensioned};
use mbody::scalar::spline::{CurveError, CurvePoint};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fmt::Debug;
use std::sync::Arc;

/// Over what a kind is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// Arc length of the path and offset from it to the left, m.
    Path,
    /// x and y of the world, m.
    World,
}

/// One kind of road with its parameters.
pub trait Relief: Debug + Send + Sync {
    /// Height and its derivatives at a place in its coordinates; level without an override.
    fn shape(&self, _u: f64, _v: f64) -> Shape {
        Shape::default()
    }
    /// Friction over that of the road on which tires were measured, and its derivatives by both coordinates, 1/m.
    fn friction(&self, _u: f64, _v: f64) -> [f64; 3] {
        [1.0, 0.0, 0.0]
    }
    /// Over what it is given.
    fn coordinates(&self) -> Coordinates {
        Coordinates::Path
    }
    /// Whether wheels stand on its slopes.
    fn tilts(&self) -> bool {
        true
    }
    /// Length of its shortest part, m: no step of an integration should be longer.
    fn shortest(&self) -> f64 {
        f64::INFINITY
    }
    /// What is wrong where a path leaves it.
    fn leaves(&self, _path: &Path) -> Option<Finding> {
        None
    }
}

/// Unevenness along the path.
trait Uneven: Debug + Send + Sync {
    /// Height, m, slope and second derivative, 1/m, at an arc length, m.
    fn at(&self, s: f64) -> CurvePoint<f64>;
    /// Length of its shortest part between level ground, m.
    fn shortest(&self) -> f64 {
        f64::INFINITY
    }
}

impl<T: Uneven> Relief for T {
    fn shape(&self, s: f64, _: f64) -> Shape {
        Shape::along(self.at(s))
    }
    fn tilts(&self) -> bool {
        false
    }
    fn shortest(&self) -> f64 {
        Uneven::shortest(self)
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
    ReliefKind::of::<slope::Slope>(),
    ReliefKind::of::<bank::Bank>(),
    ReliefKind::of::<grid::Grid>(),
    ReliefKind::of::<friction::Friction>(),
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
    /// Integral from its begin, m, share of the transition that is done, and three derivatives, of which the last jumps at both ends.
    fn share(self, s: f64) -> [f64; 5] {
        let q = ((s - self.begin) / self.length).clamp(0.0, 1.0);
        [
            self.length * q * q * q * q * (q * (q - 3.0) + 2.5) + (s - self.begin - self.length).max(0.0),
            q * q * q * (q * (q * 6.0 - 15.0) + 10.0),
            30.0 * q * q * (q - 1.0) * (q - 1.0) / self.length,
            60.0 * q * (2.0 * q - 1.0) * (q - 1.0) / (self.length * self.length),
            60.0 * (6.0 * q * (q - 1.0) + 1.0) / self.length.powi(3),
        ]
    }

    /// Level ground before it, the road behind it.
    fn of(self, z: CurvePoint<f64>, s: f64) -> CurvePoint<f64> {
        let [_, w, slope, curvature, _] = self.share(s);
        CurvePoint {
            value: w * z.value,
            slope: w * z.slope + slope * z.value,
            curvature: w * z.curvature + 2.0 * slope * z.slope + curvature * z.value,
        }
    }
}

/// Points over stations, given here or in a file with the columns `station` and a name: the key that they came from, stations and values.
fn over_stations(
    points: Option<(Vec<f64>, Vec<f64>)>,
    file: Option<String>,
    library: &dyn Library,
    (name, dimension): (&str, &'static Dimension),
) -> Result<(&'static str, Vec<f64>, Vec<f64>), Findings> {
    match (points, file) {
        (Some((stations, values)), None) => Ok(("points", stations, values)),
        (None, Some(file)) => {
            let wanted = [("station", Some(Length::DIMENSION)), (name, Some(dimension))];
            let mut read = columns(library, &file, &wanted).map_err(|e| below("file", &e))?.into_iter();
            Ok(("file", read.next().unwrap_or_default(), read.next().unwrap_or_default()))
        }
        _ => Err(Finding::error("missing_entry", "one of `points` and `file` is needed").at_path("").into()),
    }
}

/// Points that make no curve.
fn bad_curve(key: &str, error: &CurveError) -> Finding {
    Finding::error("bad_curve", error.to_string()).at_path(key)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::borrow::Cow;

    /// A file of heights, and one of a field that is level where it begins.
    struct Files;

    impl Library for Files {
        fn text(&self, name: &str) -> Option<Cow<'_, str>> {
            match name {
                "track.csv" => Some("station [m],height [mm]\n0,0\n1,2\n2,-3\n3,0\n".into()),
                "field.csv" => Some(field(|x, y| (0.1 * x).powi(2) * 0.1 * (0.2 * y).cos(), 0.5).into()),
                "holes.csv" => Some("x,y,height\n0,0,0\n1,0,0\n0,1,0\n".into()),
                "twice.csv" => Some("x,y,height\n0,0,0\n1,0,0\n0,1,0\n0,0,0\n".into()),
                "waves.csv" => Some(field(waves, 0.25).into()),
                _ => None,
            }
        }
    }

    fn waves(x: f64, y: f64) -> f64 {
        0.2 * (0.3 * x).sin() * (0.2 * y).cos()
    }

    /// A grid from −5 to 50 m along x, from −8 to 8 m along y.
    fn field(height: impl Fn(f64, f64) -> f64, mesh: f64) -> String {
        let along = |from: f64, to: f64| (0..=((to - from) / mesh) as usize).map(move |k| from + mesh * k as f64);
        let rows = along(-5.0, 50.0).flat_map(|x| along(-8.0, 8.0).map(move |y| (x, y)));
        rows.fold("x [m],y [m],height [m]\n".to_owned(), |text, (x, y)| format!("{text}{x},{y},{}\n", height(x, y)))
    }

    fn road(kind: &str, parameters: &str) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let kind = KINDS.iter().find(|k| k.name == kind).expect("a kind");
        (kind.make)(&serde_yaml::from_str(parameters).unwrap(), &Files)
    }

    #[test]
    fn slopes_are_derivatives_of_heights_and_second_derivatives_of_slopes() {
        for kind in KINDS {
            let Some(road) = road(kind.name, kind.example).unwrap_or_else(|e| panic!("{}: {e}", kind.name)) else { continue };
            let mut most: f64 = 0.0;
            for k in 0..400 {
                // not a multiple of what the examples have corners at
                let (s, n, h) = (0.1237 * f64::from(k), 0.7, 1e-5);
                let at = road.shape(s, n);
                let [u, v] = [(h, 0.0), (0.0, h)].map(|(du, dv)| (road.shape(s - du, n - dv), road.shape(s + du, n + dv)));
                let slope = |(a, b): &(Shape, Shape), of: fn(&Shape) -> f64| (of(b) - of(a)) / (2.0 * h);
                let near = |name: &str, found: f64, wanted: f64, tolerance: f64| {
                    assert!((found - wanted).abs() < tolerance * wanted.abs().max(1.0), "{} at {s}, {name}: {found} {wanted}", kind.name);
                };
                near("u", slope(&u, |z| z.height), at.first[0], 1e-7);
                near("v", slope(&v, |z| z.height), at.first[1], 1e-7);
                near("uu", slope(&u, |z| z.first[0]), at.second[0], 1e-4);
                near("uv", slope(&v, |z| z.first[0]), at.second[1], 1e-4);
                near("vv", slope(&v, |z| z.first[1]), at.second[2], 1e-4);
                if road.tilts() {
                    near("uuv", slope(&u, |z| z.second[1]), at.third[1], 1e-4);
                    near("uvv", slope(&v, |z| z.second[1]), at.third[2], 1e-4);
                    near("vvv", slope(&v, |z| z.second[2]), at.third[3], 1e-4);
                }
                let friction = |ds: f64, dn: f64| road.friction(s + ds, n + dn)[0];
                near("friction", (friction(h, 0.0) - friction(-h, 0.0)) / (2.0 * h), road.friction(s, n)[1], 1e-7);
                near("friction across", (friction(0.0, h) - friction(0.0, -h)) / (2.0 * h), road.friction(s, n)[2], 1e-7);
                most = most.max(at.height.abs()).max((friction(0.0, 0.0) - 1.0).abs());
            }
            assert!(most > 1e-3, "{}", kind.name);
            let begin = road.shape(0.0, 0.0);
            assert!(begin.height.abs() + begin.first[0].abs() + begin.first[1].abs() < 1e-6, "{} begins level", kind.name);
        }
    }

    #[test]
    fn slopes_add_up_and_sides_differ() {
        let at = |kind: &str, parameters: &str, s: f64, n: f64| road(kind, parameters).unwrap().unwrap().shape(s, n);
        let hill = "{ points: [[10 m, 0], [20 m, 6%], [30 m, 6%], [40 m, 0]] }";
        // half of each transition, all of what is between
        assert!((at("slope", hill, 50.0, 3.0).height - 0.06 * 20.0).abs() < 1e-14 && at("slope", hill, 5.0, 0.0).height == 0.0);
        assert!((at("slope", hill, 25.0, 0.0).first[0] - 0.06).abs() < 1e-16);
        let bank = "{ points: [[10 m, 0], [20 m, -8 deg]] }";
        assert!((at("bank", bank, 30.0, 2.0).height + 2.0 * 8.0_f64.to_radians().tan()).abs() < 1e-15, "the left is lower");
        let ice = road("friction", "{ points: [[0 m, 1], [1 m, 1]], right: [[0 m, 0.5], [1 m, 0.5]] }").unwrap().unwrap();
        assert!(ice.friction(5.0, 0.2)[0] == 1.0 && ice.friction(5.0, -0.2)[0] == 0.5 && (ice.friction(5.0, 0.0)[0] - 0.75).abs() < 1e-15);
    }

    #[test]
    fn a_grid_of_a_known_surface_is_that_surface() {
        let field = road("grid", "{ file: waves.csv }").unwrap().unwrap();
        for (x, y) in [(0.1, 0.1), (7.3, -3.1), (20.05, 4.4), (44.4, 0.6)] {
            let at = field.shape(x, y);
            let (by_x, by_y) = (0.06 * (0.3 * x).cos() * (0.2 * y).cos(), -0.04 * (0.3 * x).sin() * (0.2 * y).sin());
            // cubic splines over a mesh of 0.25 m: 5/384 h⁴ z⁗ = 1e-7 m; slopes h³ z⁗/24 = 1e-6; the free ends die away
            assert!((at.height - waves(x, y)).abs() < 1e-6 && (at.first[0] - by_x).abs() < 3e-6 && (at.first[1] - by_y).abs() < 3e-6);
        }
        let straight = |length: f64| {
            let mut layout = crate::maneuver::Layout::default();
            layout.straight(length);
            layout.path()
        };
        assert!(field.leaves(&straight(49.0)).is_none());
        assert!(field.leaves(&straight(60.0)).expect("a finding").to_string().contains("50.5 m from its start"));
    }

    #[test]
    fn roads_are_as_high_as_their_parameters_say() {
        let height = |kind: &str, parameters: &str, s: f64| road(kind, parameters).unwrap().unwrap().shape(s, 0.0).height;
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
        assert!(why("slope", "{ points: [[10 m, 0], [5 m, 6%]] }").contains("not beyond"));
        assert!(why("slope", "{}").contains("one of `points` and `file`"));
        assert!(why("bank", "{ points: [[10 m, 0], [20 m, 8]] }").contains("8 rad"));
        assert!(why("friction", "{ points: [[10 m, 1], [20 m, -0.2]] }").contains("-0.2"));
        assert!(why("grid", "{ file: none.csv }").contains("`none.csv`"));
        assert!(why("grid", "{ file: holes.csv }").contains("no height at x = 1 m, y = 1 m"));
        assert!(why("grid", "{ file: twice.csv }").contains("stands twice"));
    }
}
