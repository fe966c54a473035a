//! One JSON object, SI units and radians. A value that is not finite is `null`.

use super::{History, Outcome};
use crate::output::Options;
use analyses::transient::{Crossing, Worst};
use serde::ser::{Error, Serialize, SerializeMap, Serializer};
use serde_json::{Map, Value, json};
use std::io;

pub(in crate::output) fn write(history: &History, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let document = Document { head: head(history), time: history.recording.time(), signals: Columns(history) };
    serde_json::to_writer(&mut *out, &document)?;
    writeln!(out)
}

/// The object, columns of signals last: those are read as they are written.
#[derive(serde::Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    head: Value,
    time: &'a [f64],
    signals: Columns<'a>,
}

/// One array per signal.
struct Columns<'a>(&'a History);

impl Serialize for Columns<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(History { signals, recording, .. }) = self;
        let mut map = serializer.serialize_map(Some(signals.len()))?;
        for (k, signal) in signals.iter().enumerate() {
            map.serialize_entry(&signal.name, &recording.column(k).map_err(S::Error::custom)?)?;
        }
        map.end()
    }
}

/// Everything but the columns.
fn head(history: &History) -> Value {
    let outcome = &history.outcome;
    let given: Map<String, Value> = history.given.iter().map(|(g, v)| (g.name.clone(), json!(v))).collect();
    let given_units: Map<String, Value> = history.given.iter().map(|(g, _)| (g.name.clone(), json!(g.unit))).collect();
    let units: Map<String, Value> = history.signals.iter().map(|s| (s.name.clone(), json!(s.unit))).collect();
    let limits = outcome.limits.iter();
    let mut object = json!({
        "fastbike": env!("CARGO_PKG_VERSION"),
        "command": "run",
        "model": history.model,
        "axes": history.axes.name(),
        "given": given,
        "given_units": given_units,
        "backend": outcome.backend,
        "formulation": outcome.formulation,
        "rtol": outcome.relative_tolerance,
        "ending": outcome.ending,
    });
    if let Some(because) = &outcome.because {
        object["because"] = because.as_str().into();
    }
    if let Some(condition) = &outcome.condition {
        object["condition"] = condition.as_str().into();
    }
    object["statistics"] = statistics(outcome);
    object["drift"] = json!({ "position": worst(outcome.drift.position.as_ref()), "velocity": worst(outcome.drift.velocity.as_ref()) });
    object["limits"] =
        limits.map(|l| json!({ "name": l.name, "signal": l.signal, "value": l.value, "threshold": l.threshold, "time": l.time })).collect();
    let events = outcome.crossings.iter();
    let event =
        |c: &Crossing| json!({ "name": c.name, "signal": c.signal, "threshold": c.threshold, "violated": c.violated, "time": c.time });
    object["events"] = events.map(event).collect();
    object["warnings"] = json!(history.warnings);
    object["units"] = units.into();
    object
}

/// Time reached and work done.
pub(super) fn statistics(outcome: &Outcome) -> Value {
    let s = &outcome.statistics;
    json!({
        "time": s.time,
        "duration": outcome.duration,
        "steps": s.steps,
        "rejected": s.rejected,
        "convergence_failures": s.convergence_failures,
        "residuals": s.residuals,
        "jacobians": s.jacobians,
        "products": s.products,
        "iterations": s.iterations,
        "wall_s": outcome.wall,
    })
}

/// The row that was off most, or `null` where there is no row.
fn worst(worst: Option<&Worst>) -> Value {
    worst.map_or(Value::Null, |w| json!({ "row": w.off.row, "by": w.off.by, "unit": w.off.unit, "time": w.time }))
}
