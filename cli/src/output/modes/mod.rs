//! Modes: a table per point, JSON, CSV.

mod sensitivity;
mod versus;

use super::number::{aligned, number};
use super::palette::styled;
use super::report::{Beside, Given, Point, Report};
use super::{Options, csv, table};
use analyses::sensitivity::Estimate;
use nalgebra::Complex;
use problem::{Parameter, Signal};
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::io;

/// One mode at one point.
#[derive(Clone, Debug)]
pub struct NamedMode {
    /// What it is called.
    pub name: String,
    /// How sure that is, 0 to 1.
    pub confidence: f64,
    /// Eigenvalue with imaginary part ≥ 0, 1/s.
    pub value: Complex<f64>,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Share of each of the point's signals.
    pub participation: Vec<f64>,
    /// Deviation of each of [`ModesAlong::shape_signals`]; empty where nobody asked for it.
    pub shape: Vec<Complex<f64>>,
    /// How the eigenvalue moves with parameters, those that matter most first; empty where nobody asked for it.
    pub sensitivity: Vec<Slope>,
}

/// How an eigenvalue moves with a parameter.
#[derive(Clone, Debug)]
pub struct Slope {
    /// The parameter with its value.
    pub parameter: Parameter,
    /// ds/dp, in 1/s per unit of the parameter; the error is absolute.
    pub by: Estimate<Complex<f64>>,
}

impl Slope {
    /// Change of the eigenvalue per change of the parameter by all of itself, 1/s.
    pub fn relative(&self) -> Complex<f64> {
        self.by.value * self.parameter.value
    }
}

impl NamedMode {
    /// `|s| / 2π`, Hz.
    pub fn natural_frequency(&self) -> f64 {
        self.value.norm() / TAU
    }

    /// `ω / 2π`, Hz.
    pub fn damped_frequency(&self) -> f64 {
        self.value.im / TAU
    }

    /// Names and shares of the signals that take part most.
    fn leading(&self, signals: &[String], at_most: usize) -> Vec<(usize, f64)> {
        let mut order: Vec<usize> = (0..signals.len()).collect();
        order.sort_by(|&a, &b| self.participation[b].total_cmp(&self.participation[a]));
        order.into_iter().map(|k| (k, self.participation[k])).take(at_most).filter(|(_, share)| *share >= 0.05).collect()
    }
}

/// All modes at one point.
#[derive(Clone, Debug)]
pub struct PointModes {
    /// What takes part.
    pub signals: Vec<String>,
    /// The modes, oscillations first.
    pub modes: Vec<NamedMode>,
}

/// One mode along a sweep: a piece of its path under one name.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Name of the mode.
    pub name: String,
    /// Values of the swept quantity.
    pub swept: Vec<f64>,
    /// Eigenvalues there, imaginary part ≥ 0.
    pub values: Vec<Complex<f64>>,
    /// Whether the sweep begins with the first value.
    pub begins: bool,
    /// Whether the first value has the name too; otherwise it belongs to the piece before.
    pub continues: bool,
}

/// Where a mode becomes stable or unstable.
#[derive(Clone, Debug)]
pub struct Critical {
    /// Name of the mode.
    pub name: String,
    /// What is prescribed there.
    pub given: Vec<f64>,
    /// Imaginary part there, rad/s.
    pub im: f64,
    /// Whether it is stable beyond, in the direction of the sweep.
    pub becomes_stable: bool,
}

/// Modes at all points of a report.
#[derive(Clone, Debug, Default)]
pub struct ModesAlong {
    /// In the order of the report's points.
    pub points: Vec<Result<PointModes, String>>,
    /// Signals of the shapes; empty where nobody asked for shapes.
    pub shape_signals: Vec<Signal>,
    /// Which of these are displacements of the shape, as opposed to rates and to wheels that turn.
    pub displacements: Vec<bool>,
    /// Paths of the modes along the first swept quantity.
    pub branches: Vec<Branch>,
    /// Index of that quantity among the given ones.
    pub along: Option<usize>,
    /// Changes of stability.
    pub critical: Vec<Critical>,
}

impl ModesAlong {
    /// As if nobody had asked for shapes.
    pub fn leave_out_shapes(&mut self) {
        self.shape_signals.clear();
        self.points.iter_mut().flatten().flat_map(|p| &mut p.modes).for_each(|m| m.shape.clear());
    }

    /// Refers the shapes and what was prescribed to other axes.
    pub(super) fn turn(&mut self, given: &[Given], factor: &dyn Fn(&str) -> f64) {
        let factors: Vec<f64> = self.shape_signals.iter().map(|s| factor(&s.name)).collect();
        for mode in self.points.iter_mut().flatten().flat_map(|p| &mut p.modes) {
            mode.shape.iter_mut().zip(&factors).for_each(|(z, f)| *z *= *f);
        }
        for critical in &mut self.critical {
            critical.given.iter_mut().zip(given).for_each(|(v, g)| *v *= factor(&g.name));
        }
        if let Some(given) = self.along.and_then(|k| given.get(k)) {
            self.branches.iter_mut().flat_map(|b| &mut b.swept).for_each(|v| *v *= factor(&given.name));
        }
    }
}

/// Adds the modes to the points of the object, and what the sweep as a whole has shown.
pub(super) fn add_json(along: &ModesAlong, given: &[Given], object: &mut Value) {
    for (k, point) in along.points.iter().enumerate() {
        match point {
            Ok(point) => object["points"][k]["modes"] = point.modes.iter().map(|m| mode(along, point, m)).collect::<Vec<_>>().into(),
            Err(because) => object["points"][k]["refused"] = json!(because),
        }
    }
    let critical = along.critical.iter().map(|c| {
        let at: Map<String, Value> = given.iter().zip(&c.given).map(|(g, v)| (g.name.clone(), json!(v))).collect();
        json!({ "name": c.name, "given": at, "frequency_hz": c.im / TAU, "becomes": stability(c) })
    });
    object["critical"] = critical.collect::<Vec<_>>().into();
    if !along.shape_signals.is_empty() {
        let units: Map<String, Value> = along.shape_signals.iter().map(|s| (s.name.to_string(), json!(s.unit))).collect();
        object["shape_units"] = units.into();
    }
}

fn stability(critical: &Critical) -> &'static str {
    if critical.becomes_stable { "stable" } else { "unstable" }
}

fn mode(along: &ModesAlong, point: &PointModes, mode: &NamedMode) -> Value {
    let participation: Map<String, Value> = point.signals.iter().cloned().zip(mode.participation.iter().map(|p| json!(p))).collect();
    let mut object = json!({
        "name": mode.name,
        "re": mode.value.re,
        "im": mode.value.im,
        "frequency_hz": mode.natural_frequency(),
        "damped_frequency_hz": mode.damped_frequency(),
        "damping_ratio": mode.damping_ratio,
        "confidence": mode.confidence,
        "participation": participation,
    });
    if !mode.shape.is_empty() {
        let entries = along.shape_signals.iter().zip(&mode.shape);
        let shape: Map<String, Value> = entries.map(|(s, z)| (s.name.to_string(), json!({ "re": z.re, "im": z.im }))).collect();
        object["shape"] = shape.into();
    }
    if !mode.sensitivity.is_empty() {
        let slopes = mode.sensitivity.iter().map(|s| {
            json!({
                "parameter": s.parameter.name, "value": s.parameter.value, "unit": s.parameter.unit,
                "re": s.by.value.re, "im": s.by.value.im, "error": s.by.error,
            })
        });
        object["sensitivity"] = slopes.collect::<Vec<_>>().into();
    }
    object
}

/// Points with their modes, of the base and of every variant that has some.
fn tagged<'a>(report: &'a Report, along: &'a ModesAlong) -> impl Iterator<Item = (&'a str, &'a [Point], &'a ModesAlong)> {
    let variants = report.variants.iter().filter_map(|v| match &v.beside {
        Beside::Modes(modes) => Some((v.name.as_str(), v.points.as_slice(), modes)),
        _ => None,
    });
    std::iter::once(("base", report.points.as_slice(), along)).chain(variants)
}

/// One line per mode and point; a first column tells variants apart, where there are any.
pub(super) fn write_csv(report: &Report, along: &ModesAlong, out: &mut dyn io::Write) -> io::Result<()> {
    let mut signals: Vec<&String> = Vec::new();
    for signal in tagged(report, along).flat_map(|(_, _, along)| &along.points).flatten().flat_map(|p| &p.signals) {
        if !signals.contains(&signal) {
            signals.push(signal);
        }
    }
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    let columns = ["ending", "name", "re", "im", "frequency_hz", "damped_frequency_hz", "damping_ratio", "confidence"].map(str::to_owned);
    let tag = |name: &str| (!report.variants.is_empty()).then(|| name.to_owned()).into_iter();
    table.write_record(tag("variant").chain(given).chain(columns).chain(signals.iter().map(|s| format!("participation.{s}"))))?;
    let all = tagged(report, along).flat_map(|(name, points, along)| points.iter().zip(&along.points).map(move |(at, p)| (name, at, p)));
    for (name, at, point) in all {
        let Ok(point) = point else { continue };
        for mode in &point.modes {
            let given = at.given.iter().map(|v| csv::cell(*v));
            let words = [at.ending.name().to_owned(), mode.name.clone()];
            let numbers =
                [mode.value.re, mode.value.im, mode.natural_frequency(), mode.damped_frequency(), mode.damping_ratio, mode.confidence];
            let share = |s: &&String| point.signals.iter().position(|p| p == *s).map_or(f64::NAN, |k| mode.participation[k]);
            let shares = signals.iter().map(|s| csv::cell(share(s)));
            table.write_record(tag(name).chain(given).chain(words).chain(numbers.map(csv::cell)).chain(shares))?;
        }
    }
    table.flush()
}

/// A table per point, then changes of stability.
pub(super) fn write_table(report: &Report, along: &ModesAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    for (at, point) in report.points.iter().zip(&along.points) {
        let given = table::prescribed(report, at, options.angles);
        writeln!(out, "\n{}", if given.is_empty() { "no speed: static pose".to_owned() } else { format!("given: {given}") })?;
        writeln!(out, "ending: {}", table::describe(report, at, options))?;
        match point {
            Ok(point) => write_point(along, point, options, out)?,
            Err(because) => writeln!(out, "{}", styled(palette.bad, &format!("no modes: {because}")))?,
        }
    }
    if !along.critical.is_empty() {
        writeln!(out, "\n{}", styled(palette.heading, "changes of stability"))?;
    }
    for critical in &along.critical {
        let names: Vec<String> = (report.given.iter().zip(&critical.given))
            .map(|(g, v)| {
                let shown = options.angles.show(&g.unit);
                format!("{} {} {}", g.name, number(v * shown.factor), shown.unit).trim_end().to_owned()
            })
            .collect();
        let text = format!("  {}: {} becomes {}", names.join(", "), critical.name, stability(critical));
        writeln!(out, "{}", styled(if critical.becomes_stable { palette.good } else { palette.caution }, &text))?;
    }
    versus::write(report, along, options, out)
}

/// The columns with numbers.
const COLUMNS: [(&str, &str); 6] =
    [("re", "1/s"), ("im", "rad/s"), ("natural", "Hz"), ("damped", "Hz"), ("damping ratio", ""), ("confidence", "")];

fn write_point(along: &ModesAlong, point: &PointModes, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    let number_of = |mode: &NamedMode, column: usize| match column {
        0 => number(mode.value.re),
        1 => number(mode.value.im),
        2 => number(mode.natural_frequency()),
        3 => number(mode.damped_frequency()),
        4 => format!("{:.3}", mode.damping_ratio),
        _ => format!("{:.2}", mode.confidence),
    };
    let columns: Vec<Vec<String>> =
        (0..COLUMNS.len()).map(|c| aligned(&point.modes.iter().map(|m| number_of(m, c)).collect::<Vec<_>>())).collect();
    let widths: Vec<usize> = columns
        .iter()
        .zip(COLUMNS)
        .map(|(cells, (name, unit))| cells.iter().map(|c| c.chars().count()).max().unwrap_or(0).max(name.len()).max(unit.len()))
        .collect();
    let names = point.modes.iter().map(|m| m.name.chars().count()).max().unwrap_or(0).max(4);
    let line =
        |text: &dyn Fn(usize) -> String| widths.iter().enumerate().map(|(c, w)| format!("{:>w$}", text(c))).collect::<Vec<_>>().join("  ");
    writeln!(out, "{}", styled(palette.heading, &format!("{:names$}  {}  takes part", "mode", line(&|c| COLUMNS[c].0.to_owned()))))?;
    writeln!(out, "{}", styled(palette.faint, format!("{:names$}  {}", "", line(&|c| COLUMNS[c].1.to_owned())).trim_end()))?;
    for (row, mode) in point.modes.iter().enumerate() {
        let style = if mode.value.re > 0.0 { palette.caution } else { palette.good };
        let leading = mode.leading(&point.signals, 4).into_iter().map(|(k, share)| format!("{} {share:.2}", point.signals[k]));
        let name = styled(style, &format!("{:names$}", mode.name));
        writeln!(out, "{name}  {}  {}", line(&|c| columns[c][row].clone()), leading.collect::<Vec<_>>().join(", "))?;
    }
    if !along.shape_signals.is_empty() {
        point.modes.iter().try_for_each(|mode| write_shape(along, mode, options, out))?;
    }
    point.modes.iter().filter(|m| !m.sensitivity.is_empty()).try_for_each(|mode| sensitivity::write(mode, options, out))
}

/// Magnitudes and phases of what moves in a mode.
fn write_shape(along: &ModesAlong, mode: &NamedMode, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let at = if mode.value.im > 0.0 { format!("{} Hz", number(mode.damped_frequency())) } else { format!("{} 1/s", number(mode.value.re)) };
    writeln!(out, "\n{}", styled(options.palette.heading, &format!("shape of {}, {at}", mode.name)))?;
    let rows: Vec<usize> = (0..mode.shape.len()).filter(|&k| mode.shape[k].norm() > 1e-9).collect();
    let magnitudes: Vec<String> = rows.iter().map(|&k| number(mode.shape[k].norm())).collect();
    let names = rows.iter().map(|&k| along.shape_signals[k].name.chars().count()).max().unwrap_or(0);
    let units = rows.iter().map(|&k| along.shape_signals[k].unit.chars().count()).max().unwrap_or(0);
    for (text, &k) in aligned(&magnitudes).iter().zip(&rows) {
        let signal = &along.shape_signals[k];
        writeln!(out, "  {:names$}  {text}  {:units$}  at {:6.1} deg", signal.name, signal.unit, mode.shape[k].arg().to_degrees())?;
    }
    Ok(())
}
