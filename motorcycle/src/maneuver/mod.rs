//! Maneuvers: which path, at which speed, with which disturbances, and when it is over.
//!
//! A maneuver is a file of its own. Its path is a sequence of sections, each one kind ([`section::KINDS`]); its speed is constant, over time or along the path. Where
//! nobody rides, the inputs stay at those of the steady state.

mod columns;
mod input;
mod path;
pub mod section;
mod speed;

pub use columns::columns;
pub use input::{Amount, Moving, Piece};
pub use path::{Layout, Path, Place, Progress, Twice};
pub use section::{SectionDescription, SectionKind};
pub use speed::Speed;

use crate::road::{Relief, relief};
use mbody::description::Library;
use mbody::description::document::Document;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::{Length, Number, Speed as SpeedDimension, Time, Torque};
use mbody::description::quantity::{Fraction, NonNegativeQuantity, PositiveQuantity, Quantity};
use mbody::description::schema::Schema;
use mbody::scalar::Pchip;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::sync::Arc;

/// Where to ride, how fast, and what disturbs.
#[derive(Clone, Debug)]
pub struct Course {
    /// The path.
    pub path: Path,
    /// Target speed.
    pub speed: Speed,
    /// Torques at the bar beside those of the rider.
    pub torque_pulses: Vec<Pulse>,
}

/// `peak sin²(π (t − start)/duration)` while it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Largest value.
    pub peak: f64,
    /// Begin, s.
    pub start: f64,
    /// Length, s.
    pub duration: f64,
}

impl Pulse {
    /// Value at a time, s.
    pub fn at(&self, time: f64) -> f64 {
        let q = (time - self.start) / self.duration;
        if (0.0..=1.0).contains(&q) { self.peak * (PI * q).sin().powi(2) } else { 0.0 }
    }
}

impl Course {
    /// Sum of the pulses at a time, N m.
    pub fn pulses(&self, time: f64) -> f64 {
        self.torque_pulses.iter().map(|p| p.at(time)).sum()
    }

    /// Times at which pulses begin and end and at which the target speed has its points, s.
    pub fn breaks(&self) -> Vec<f64> {
        let pulses = self.torque_pulses.iter().flat_map(|p| [p.start, p.start + p.duration]);
        pulses.chain(self.speed.knots()).collect()
    }

    /// Time that the path takes at its target speed, s.
    pub fn duration(&self) -> f64 {
        // steps of the arc length at the speed of their beginning
        let step = (self.path.length() / 2000.0).max(1e-3);
        let (mut s, mut time) = (0.0, 0.0);
        while s < self.path.length() && time < 3600.0 {
            let speed = self.speed.at(time, s, 0.0).0.max(0.1);
            time += step / speed;
            s += step;
        }
        time
    }
}

/// Who rides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// The virtual rider, with preview.
    #[default]
    Rider,
    /// Nobody: the inputs stay at those of the steady state.
    None,
}

/// A maneuver that was read.
#[derive(Clone, Debug)]
pub struct Maneuver {
    /// Name for headings.
    pub name: String,
    /// A sentence or two.
    pub about: String,
    /// Path, speed and disturbances.
    pub course: Course,
    /// The road along the path, one or more kinds; none where it is level.
    pub road: Vec<Arc<dyn Relief>>,
    /// Inputs over time that nobody commands.
    pub inputs: Vec<Moving>,
    /// Who rides.
    pub control: Control,
    /// How the rider is made.
    pub rider: RiderDescription,
    /// The record that is repeated instead of a rider.
    pub replay: Option<ReplayDescription>,
    /// When it is over, beside the end of the path: `SIGNAL>VALUE`.
    pub until: Vec<String>,
    /// Longest time, s; none: what the path takes, and a little more.
    pub duration: Option<f64>,
}

/// A torque at the bar.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PulseDescription {
    /// Largest torque, positive to the left.
    peak: Quantity<Torque>,
    /// When it begins.
    start: NonNegativeQuantity<Time>,
    /// How long it lasts.
    duration: PositiveQuantity<Time>,
}

/// How a rider steers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LateralLaw {
    /// Optimal feedback of all states and of the way ahead.
    #[default]
    Preview,
    /// Two loops: the path asks for lean, lean asks for torque.
    Pid,
}

/// Rider of a maneuver: what counts as much as what, and human limits.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RiderDescription {
    /// How the rider steers: `preview` (where left out) or `pid`.
    #[serde(default)]
    pub lateral: LateralLaw,
    /// Offset from the path that counts as much as the other values here; 0.15 m where left out. For `preview`, as `heading`.
    pub offset: Option<PositiveQuantity<Length>>,
    /// Heading error that counts as much; 0.05 rad where left out.
    pub heading: Option<PositiveQuantity<mbody::description::quantity::dimension::Angle>>,
    /// Steering torque that counts as much; 20 N m where left out.
    pub torque: Option<PositiveQuantity<Torque>>,
    /// Greatest steering torque; 150 N m where left out.
    pub greatest_torque: Option<PositiveQuantity<Torque>>,
    /// How far the rider looks ahead; as far as it matters where left out (2 s for `pid`).
    pub preview: Option<PositiveQuantity<Time>>,
    /// Reaction time; none where left out.
    pub delay: Option<PositiveQuantity<Time>>,
    /// Natural frequency of the muscles; they follow at once where left out.
    pub muscles: Option<PositiveQuantity<mbody::description::quantity::dimension::AngularSpeed>>,
}

/// A recorded ride: its torques, and a weak feedback of what differs from it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReplayDescription {
    /// CSV file beside the maneuver: that of an earlier run, or measured under the same names.
    pub file: String,
    /// Share of the gains of the rider with preview, 0 to 1; 0.2 where left out.
    pub gain: Option<Quantity<Number, Fraction>>,
}

impl Maneuver {
    /// How long it takes at most, s: what is written, or a fifth more than its path takes at its target speed, and a second.
    pub fn longest(&self) -> f64 {
        self.duration.unwrap_or_else(|| 1.2 * self.course.duration() + 1.0)
    }
}

/// The written form of a maneuver.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ManeuverDescription {
    /// Version of this form: 1.
    #[schemars(range(min = 1, max = 1))]
    #[expect(dead_code, reason = "the schema judges it")]
    maneuver: u32,
    /// Name for headings.
    name: String,
    /// A sentence or two.
    about: Option<String>,
    /// Speed at the start, and the target speed throughout where nothing else is said.
    speed: NonNegativeQuantity<SpeedDimension>,
    /// Target speed over time: points of time and speed, joined smoothly.
    speed_over_time: Option<Vec<(NonNegativeQuantity<Time>, NonNegativeQuantity<SpeedDimension>)>>,
    /// Target speed along the path: points of arc length and speed, joined smoothly.
    speed_along_path: Option<Vec<(NonNegativeQuantity<Length>, NonNegativeQuantity<SpeedDimension>)>>,
    /// The path: sections one after the other, each one kind with its parameters.
    path: Vec<Value>,
    /// The road along the path: one or more kinds with their parameters, whose heights add up and whose frictions multiply; level where left out.
    road: Option<serde_json::Map<String, Value>>,
    /// Torques at the bar beside those of the rider.
    torque_pulses: Option<Vec<PulseDescription>>,
    /// Inputs over time, each added to the value that it has at the start: wind, and what no rider commands.
    inputs: Option<Vec<input::InputDescription>>,
    /// Who rides: `rider` (where left out) or `none`.
    #[serde(default)]
    control: Control,
    /// How the rider is made.
    #[serde(default)]
    rider: RiderDescription,
    /// A recorded ride that is repeated instead of a rider.
    replay: Option<ReplayDescription>,
    /// When it is over, beside the end of the path: conditions `SIGNAL>VALUE` or `SIGNAL<VALUE`.
    #[serde(default)]
    until: Vec<String>,
    /// Longest time.
    duration: Option<PositiveQuantity<Time>>,
}

/// The JSON Schema (draft 2020-12) of maneuvers.
pub fn schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let one = |about: &str, name: &str, parameters: schemars::Schema| {
        json!({
            "type": "object",
            "description": about,
            "properties": { name: parameters },
            "required": [name],
            "additionalProperties": false
        })
    };
    let sections: Vec<Value> = section::KINDS.iter().map(|k| one(k.about, k.name, (k.schema)(&mut generator))).collect();
    let road = |k: &relief::ReliefKind, mut parameters: Value| {
        parameters["description"] = json!(k.about);
        (k.name.to_owned(), parameters)
    };
    let roads: serde_json::Map<String, Value> = relief::KINDS.iter().map(|k| road(k, (k.schema)(&mut generator).to_value())).collect();
    let mut root = generator.root_schema_for::<ManeuverDescription>().to_value();
    root["title"] = json!("FastBike maneuver");
    root["properties"]["path"]["items"] = json!({ "oneOf": sections });
    root["properties"]["path"]["minItems"] = json!(1);
    let about = root["properties"]["road"]["description"].clone();
    root["properties"]["road"] =
        json!({ "description": about, "type": "object", "properties": roads, "additionalProperties": false, "minProperties": 1 });
    root
}

/// Reads a maneuver with `(path, value)` overrides; the files that it names come from the library.
///
/// # Errors
/// Everything that is wrong, each at its line.
pub fn read(file: &str, library: &dyn Library, overrides: &[(String, String)], findings: &mut Findings) -> Option<Maneuver> {
    let Some(text) = library.text(file) else {
        findings.push(Finding::error("missing_file", format!("file `{file}` cannot be read as text")));
        return None;
    };
    let mut document = match Document::parse(file, &text) {
        Ok(document) => document,
        Err(errors) => {
            findings.extend(errors);
            return None;
        }
    };
    if document.value().is_null() {
        let finding = Finding::error("empty_file", "the maneuver is empty").in_file(file);
        findings.push(finding.with_hint("`maneuver`, `name`, `speed` and `path` are needed at least"));
        return None;
    }
    for (path, value) in overrides {
        if let Err(errors) = document.set(path, value) {
            findings.extend(errors);
        }
    }
    match Schema::new(&schema()) {
        Ok(schema) => findings.extend(schema.check(&document)),
        Err(errors) => findings.extend(errors),
    }
    if findings.has_errors() {
        return None;
    }
    let mut written: ManeuverDescription = match document.read("") {
        Ok(written) => written,
        Err(errors) => {
            findings.extend(errors);
            return None;
        }
    };
    let all = |findings: &mut Findings, path: &str, wrong: &Findings| {
        below(path, wrong).iter().for_each(|finding| findings.push(document.locate(finding.clone())));
    };
    let mut layout = Layout::default();
    for (k, entry) in written.path.iter().enumerate() {
        let Some((name, value)) = single(entry) else { continue };
        let Some(kind) = section::KINDS.iter().find(|k| k.name == name) else { continue };
        if let Err(wrong) = (kind.lay)(value, &mut layout, library) {
            all(findings, &format!("path.{k}.{name}"), &wrong);
        }
    }
    let mut road = Vec::new();
    for (name, value) in written.road.iter().flatten() {
        let Some(kind) = relief::KINDS.iter().find(|k| k.name == *name) else { continue };
        match (kind.make)(value, library) {
            Ok(made) => road.extend(made.map(|relief| (kind.name, relief))),
            Err(wrong) => all(findings, &format!("road.{}", kind.name), &wrong),
        }
    }
    let mut inputs = Vec::new();
    for (k, entry) in written.inputs.take().into_iter().flatten().enumerate() {
        match entry.moving() {
            Ok(moving) => inputs.push(moving),
            Err(wrong) => all(findings, &format!("inputs.{k}"), &wrong),
        }
    }
    let speed = match target(&written) {
        Ok(speed) => Some(speed),
        Err((key, why)) => {
            findings.push(document.locate(Finding::error("bad_curve", why).at_path(key)));
            None
        }
    };
    if layout.length() <= 0.0 && !findings.has_errors() {
        findings.push(document.locate(Finding::error("out_of_range", "the path has no length").at_path("path")));
    }
    if findings.has_errors() {
        return None;
    }
    let path = layout.path();
    for (name, relief) in &road {
        if let Some(wrong) = relief.leaves(&path) {
            all(findings, &format!("road.{name}"), &wrong.into());
            return None;
        }
    }
    let pulse = |p: &PulseDescription| Pulse { peak: p.peak.si(), start: p.start.si(), duration: p.duration.si() };
    let torque_pulses = written.torque_pulses.iter().flatten().map(pulse).collect();
    Some(Maneuver {
        name: written.name,
        about: written.about.unwrap_or_default(),
        course: Course { path, speed: speed?, torque_pulses },
        road: road.into_iter().map(|(_, relief)| relief).collect(),
        inputs,
        control: written.control,
        rider: written.rider,
        replay: written.replay,
        until: written.until,
        duration: written.duration.map(|d| d.si()),
    })
}

/// The only entry of an object.
fn single(entry: &Value) -> Option<(&str, &Value)> {
    entry.as_object()?.iter().next().map(|(name, value)| (name.as_str(), value))
}

/// Findings of a part of the maneuver, at their paths from the whole.
pub(crate) fn below(path: &str, findings: &Findings) -> Findings {
    let at = |finding: &Finding| {
        let path = if finding.path.is_empty() { path.to_owned() } else { format!("{path}.{}", finding.path) };
        finding.clone().at_path(path)
    };
    findings.iter().map(at).collect()
}

/// The target speed; where it is not a curve, the key and why.
fn target(written: &ManeuverDescription) -> Result<Speed, (&'static str, String)> {
    let curve = |key: &'static str, (x, y): (Vec<f64>, Vec<f64>)| Pchip::new(&x, &y).map_err(|e| (key, e.to_string()));
    match (&written.speed_over_time, &written.speed_along_path) {
        (None, None) => Ok(Speed::Constant(written.speed.si())),
        (Some(points), None) => curve("speed_over_time", points.iter().map(|(t, v)| (t.si(), v.si())).unzip()).map(Speed::OverTime),
        (None, Some(points)) => curve("speed_along_path", points.iter().map(|(s, v)| (s.si(), v.si())).unzip()).map(Speed::AlongPath),
        (Some(_), Some(_)) => Err(("speed_along_path", "the target speed is given twice, over time and along the path".to_owned())),
    }
}
