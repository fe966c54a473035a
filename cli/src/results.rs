//! What a run tells and leaves: a report on standard output, warnings, a figure, and a run folder with inputs, version,
//! statistics and results.

use crate::arguments::{ModelArguments, OutputArguments, unknown_name};
use crate::library::Source;
use crate::output::{self, Options, Point, Report, Results};
use crate::plot::{Figure, FileFormat};
use crate::steady::{self, Steady};
use crate::{Context, Exit, Failure, model};
use mbody::description::Library;
use mbody::dynamics::{System, TreePlant};
use problem::Signal;
use serde_json::json;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Writes a file, or says which one could not be written.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    stream(path, |out| out.write_all(bytes))
}

/// Indices of the signals that `--show` names; asked for before anything is computed.
///
/// # Errors
/// A name that is no signal, with the nearest one.
pub fn shown(show: &[String], system: &Arc<System>) -> Result<Vec<usize>, Failure> {
    let signals = steady::signals(&TreePlant::new(system.clone()));
    let index = |name: &String| {
        let known = || signals.iter().map(|s| s.name.as_str());
        known().position(|s| s == name).ok_or_else(|| Failure::from(unknown_name("show", name, ("signal", name), known())))
    };
    show.iter().map(index).collect()
}

/// A report of steady states; `shown` are the signals of the table.
pub fn report(command: &str, model: &str, shown: Vec<usize>, steady: Steady) -> Report {
    let mut report = Report::new(command, model, steady.given, steady.signals);
    (report.points, report.limits, report.warnings, report.shown) = (steady.points, steady.limits, steady.warnings, shown);
    report
}

/// The points of a variant with the values of a base's signals, in their order; NaN where it has no such signal.
pub fn in_order_of(signals: &[Signal], variant: Steady) -> Vec<Point> {
    let order: Vec<Option<usize>> = signals.iter().map(|s| variant.signals.iter().position(|v| v.name == s.name)).collect();
    let mut points = variant.points;
    for point in points.iter_mut().filter(|p| !p.values.is_empty()) {
        point.values = order.iter().map(|k| k.map_or(f64::NAN, |k| point.values[k])).collect();
    }
    points
}

/// Prints the results in the axes and the format asked for, then writes figure (`--plot`) and run folder (`--out`).
///
/// Done where the goal was reached: in a sweep, at one point at least.
pub fn deliver<R: Results>(
    context: &Context,
    (model, output): (&ModelArguments, &OutputArguments),
    report: R,
    figure: impl FnOnce(&R) -> Result<Figure, Failure>,
) -> Result<Exit, Failure> {
    let report = report.in_axes(output.axes);
    let options = Options { palette: context.palette, angles: output.angles() };
    context.console.stream(|out| R::writer(output.format)(&report, &options, out))?;
    // what was computed is told before anything else can fail
    context.console.warn(report.warnings());
    let figure = output.plot.is_some().then(|| figure(&report)).transpose()?;
    keep(context, (model, output), &report, figure.as_ref())?;
    match report.reached() {
        true => Ok(Exit::Done),
        false => Ok(Exit::Unreached),
    }
}

/// Writes a file piece by piece, or says which one could not be written.
fn stream(path: &Path, write: impl FnOnce(&mut (dyn io::Write + Send)) -> io::Result<()>) -> Result<(), Failure> {
    let streamed = fs::File::create(path).and_then(|file| {
        let mut out = io::BufWriter::new(file);
        write(&mut out)?;
        out.flush()
    });
    streamed.map_err(|e| Failure::Write { path: path.display().to_string(), cause: e.to_string() })
}

/// Writes figure and run folder.
fn keep<R: Results>(
    context: &Context,
    (model, output): (&ModelArguments, &OutputArguments),
    report: &R,
    figure: Option<&Figure>,
) -> Result<(), Failure> {
    if let (Some(path), Some(figure)) = (&output.plot, figure) {
        write(path, &figure.encode(FileFormat::of(path)?)?)?;
    }
    let Some(folder) = &output.out else { return Ok(()) };
    fs::create_dir_all(folder).map_err(|e| Failure::Write { path: folder.display().to_string(), cause: e.to_string() })?;
    for kind in output::KINDS.iter().filter(|k| k.name != "table") {
        let path = folder.join(format!("results.{}", kind.name));
        stream(&path, |out| R::writer(kind)(report, &Options::default(), out))?;
    }
    #[cfg(feature = "parquet")]
    if let Some(history) = report.recording() {
        stream(&folder.join("results.parquet"), |out| output::parquet::write(history, out))?;
    }
    if let Some(figure) = figure {
        for (name, format) in [("figure.svg", FileFormat::Svg), ("figure.png", FileFormat::Png)] {
            write(&folder.join(name), &figure.encode(format)?)?;
        }
    }
    write(&folder.join("run.json"), format!("{:#}\n", inputs(context, report, model)).as_bytes())
}

/// Inputs with hashes, version and statistics.
fn inputs<R: Results>(context: &Context, report: &R, model: &ModelArguments) -> serde_json::Value {
    let files = Source::find(&model.model).map(|source| {
        let names = model::texts(&source, &context.kinds).unwrap_or_else(|_| vec![source.file.clone()]);
        names
            .into_iter()
            .map(|name| json!({ "file": name, "fnv1a": hash(source.text(&name).unwrap_or_default().as_bytes()) }))
            .collect::<Vec<_>>()
    });
    json!({
        "fastbike": env!("CARGO_PKG_VERSION"),
        "arguments": context.arguments,
        "model": model.model,
        "set": model.set,
        "inputs": files.unwrap_or_default(),
        "statistics": report.statistics(),
        "warnings": report.warnings(),
    })
}

/// FNV-1a, 64 bit: tells whether two inputs are the same, nothing more.
fn hash(bytes: &[u8]) -> String {
    let h = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{h:016x}")
}
