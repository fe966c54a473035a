//! The design of a rider: one line per point, gains, JSON, CSV.

use super::number::{aligned, number};
use super::palette::styled;
use super::report::Report;
use super::table::{self, Column};
use super::{Options, csv, responses};
use analyses::regulator::Regulator;
use problem::Signal;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::io;

/// Regulators at all points of a report.
#[derive(Clone, Debug, Default)]
pub struct RiderAlong {
    /// How the rider steers, in words.
    pub law: &'static str,
    /// Unit of the input.
    pub effort: String,
    /// What is fed back, the path and the states of the human last.
    pub feedback: Vec<Signal>,
    /// In the order of the report's points.
    pub points: Vec<Result<Regulator, String>>,
}

/// All gains, in the order of [`RiderAlong::feedback`].
fn gains(regulator: &Regulator) -> impl Iterator<Item = f64> {
    regulator.gains.iter().chain(&regulator.path_gains).chain(&regulator.actuator_gains).copied()
}

/// Real part of the slowest pole, and the least damping ratio of those that oscillate.
fn poles(regulator: &Regulator) -> (f64, f64) {
    let slowest = regulator.closed.iter().map(|s| s.re).fold(f64::NEG_INFINITY, f64::max);
    let damping = regulator.closed.iter().filter(|s| s.im > 0.0).map(|s| -s.re / s.norm()).fold(f64::INFINITY, f64::min);
    (slowest, damping)
}

/// Highest frequency at which the loop has a gain of one, Hz.
fn crossover(regulator: &Regulator) -> f64 {
    regulator.margins.crossings.iter().map(|c| c.frequency).fold(f64::NAN, f64::max)
}

/// Adds the regulators to the points of the object.
pub(super) fn add_json(along: &RiderAlong, object: &mut Value) {
    let units: Map<String, Value> =
        along.feedback.iter().map(|s| (s.name.clone(), json!(format!("({})/({})", along.effort, s.unit)))).collect();
    object["law"] = json!(along.law);
    object["gain_units"] = units.into();
    for (k, point) in along.points.iter().enumerate() {
        match point {
            Ok(r) => {
                let named: Map<String, Value> = along.feedback.iter().zip(gains(r)).map(|(s, g)| (s.name.clone(), json!(g))).collect();
                let closed: Vec<Value> = r.closed.iter().map(|s| json!({ "re": s.re, "im": s.im })).collect();
                let crossings: Vec<Value> =
                    (r.margins.crossings.iter()).map(|c| json!({ "frequency_hz": c.frequency, "phase_margin": c.phase_margin })).collect();
                let margins = json!({
                    "phase_margin": r.margins.phase_margin(),
                    "least_factor": r.margins.least_factor,
                    "greatest_factor": r.margins.greatest_factor,
                    "distance": r.margins.distance,
                    "crossings": crossings,
                });
                let preview = json!({ "interval": r.preview.interval, "weights": r.preview.weights, "tail": r.preview.tail });
                object["points"][k]["rider"] = json!({ "gains": named, "preview": preview, "closed": closed, "margins": margins });
            }
            Err(because) => object["points"][k]["refused"] = json!(because),
        }
    }
}

/// One line per point: gains, then the weights of what is ahead.
pub(super) fn write_csv(report: &Report, along: &RiderAlong, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let samples = along.points.iter().flatten().map(|r| r.preview.weights.len()).max().unwrap_or(0);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    let columns = ["phase_margin", "crossover_hz", "slowest_pole", "least_damping_ratio", "preview_interval"].map(str::to_owned);
    let gain = along.feedback.iter().map(|s| format!("gain.{}", s.name));
    table.write_record(given.chain(columns).chain(gain).chain((0..samples).map(|k| format!("preview.{k}"))))?;
    for (at, point) in report.points.iter().zip(&along.points) {
        let Ok(r) = point else { continue };
        let (slowest, damping) = poles(r);
        let numbers = [r.margins.phase_margin(), crossover(r), slowest, damping, r.preview.interval];
        let ahead = (0..samples).map(|k| r.preview.weights.get(k).copied().unwrap_or(f64::NAN));
        table.write_record(at.given.iter().copied().chain(numbers).chain(gains(r)).chain(ahead).map(csv::cell))?;
    }
    table.flush()
}

/// One line per point, then the gains.
pub(super) fn write_table(report: &Report, along: &RiderAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (fixed, mut columns) = table::prescribed_columns(report, &report.points, options);
    table::write_given(report, &fixed, options, out)?;
    writeln!(out, "{}; margins of the loop cut at the torque that the rider wants", along.law)?;
    let value = |f: &dyn Fn(&Regulator) -> f64| along.points.iter().map(|p| p.as_ref().map_or(f64::NAN, f)).collect::<Vec<_>>();
    let mut add = |title: &str, unit: &str, f: &dyn Fn(&Regulator) -> f64| {
        columns.push(Column::new(title, unit, value(f).into_iter(), options.angles));
    };
    add("phase margin", "rad", &|r| r.margins.phase_margin());
    add("crossover", "Hz", &crossover);
    add("less gain to", "-", &|r| r.margins.least_factor.unwrap_or(0.0));
    add("more gain to", "-", &|r| r.margins.greatest_factor.unwrap_or(f64::NAN));
    add("slowest pole", "1/s", &|r| poles(r).0);
    add("least damping", "-", &|r| poles(r).1);
    add("looks ahead", "s", &|r| r.preview.interval * (r.preview.weights.len() - 1) as f64);
    table::write_columns(&columns, &report.points, options, out)?;
    table::write_summary(report, &report.points, options, out)?;
    write_gains(report, along, options, out)?;
    responses::refusals(along.points.iter().map(|p| p.as_ref().err()), report, options, out)
}

/// Gains at some points: a line per signal.
fn write_gains(report: &Report, along: &RiderAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let known: Vec<usize> = (0..along.points.len()).filter(|&k| along.points[k].is_ok()).collect();
    // as many as a line holds, evenly over the sweep
    let count = known.len().min(5);
    let chosen: Vec<usize> = (0..count).map(|i| known[i * (known.len() - 1) / (count - 1).max(1)]).collect();
    if chosen.is_empty() {
        return Ok(());
    }
    let names = along.feedback.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
    writeln!(out, "\n{}", styled(options.palette.heading, &format!("gains, {} per unit of the signal in SI", along.effort)))?;
    let titles = chosen.iter().map(|&k| table::prescribed(report, &report.points[k], options.angles)).collect::<Vec<_>>();
    titles.iter().enumerate().try_for_each(|(k, title)| writeln!(out, "  ({}) {title}", k + 1))?;
    let columns: Vec<Vec<String>> =
        chosen.iter().map(|&k| aligned(&along.points[k].iter().flat_map(gains).map(number).collect::<Vec<_>>())).collect();
    for (row, signal) in along.feedback.iter().enumerate() {
        let cells = columns.iter().map(|c| format!("{:>14}", c[row])).collect::<Vec<_>>().join("");
        writeln!(out, "  {:names$}{cells}  per {}", signal.name, signal.unit)?;
    }
    Ok(())
}

/// Frequencies in Hz and values of the loop, for figures.
pub fn loop_of(regulator: &Regulator) -> Vec<(f64, f64, f64)> {
    let mut turned = 0.0;
    let mut last: Option<f64> = None;
    let points = regulator.margins.response.iter().map(|&(frequency, value)| {
        let phase = value.arg();
        // a phase that goes on instead of jumping by a turn, and begins below zero
        match last {
            Some(before) => turned -= TAU * ((phase + turned - before) / TAU).round(),
            None => turned = if phase > 0.0 { -TAU } else { 0.0 },
        }
        last = Some(phase + turned);
        (frequency, value.norm(), phase + turned)
    });
    points.collect()
}
