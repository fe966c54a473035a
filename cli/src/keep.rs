//! What a run leaves on disk: figures, and a run folder with inputs, version, statistics and results.

use crate::arguments::{ModelArguments, OutputArguments};
use crate::commands::OwnedReport;
use crate::library::Source;
use crate::output::{self, Options};
use crate::plot::{Figure, FileFormat};
use crate::{Context, Failure};
use mbody::description::Library;
use serde_json::json;
use std::fs;
use std::path::Path;

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    fs::write(path, bytes).map_err(|e| Failure::Write { path: path.display().to_string(), cause: e.to_string() })
}

/// Writes the figure (`--plot`) and the run folder (`--out`).
pub fn results(
    context: &Context,
    output: &OutputArguments,
    report: &OwnedReport,
    figure: Option<&Figure>,
    model: &ModelArguments,
) -> Result<(), Failure> {
    if let (Some(path), Some(figure)) = (&output.plot, figure) {
        write(path, &figure.encode(FileFormat::of(path)?)?)?;
    }
    let Some(folder) = &output.out else { return Ok(()) };
    fs::create_dir_all(folder).map_err(|e| Failure::Write { path: folder.display().to_string(), cause: e.to_string() })?;
    for kind in output::KINDS.iter().filter(|k| k.name != "table") {
        let mut text = Vec::new();
        let written = (kind.write)(&report.view(), &Options::default(), &mut text);
        let path = folder.join(format!("results.{}", kind.name));
        written.map_err(|e| Failure::Write { path: path.display().to_string(), cause: e.to_string() })?;
        write(&path, &text)?;
    }
    if let Some(figure) = figure {
        for (name, format) in [("figure.svg", FileFormat::Svg), ("figure.png", FileFormat::Png)] {
            write(&folder.join(name), &figure.encode(format)?)?;
        }
    }
    write(&folder.join("run.json"), format!("{:#}\n", inputs(context, report, model)).as_bytes())
}

/// Inputs with hashes, version and statistics.
fn inputs(context: &Context, report: &OwnedReport, model: &ModelArguments) -> serde_json::Value {
    let files = Source::find(&model.model).map(|source| {
        let mut names = vec![source.file.clone()];
        let text = source.text(&source.file).unwrap_or_default().into_owned();
        names.extend(text.lines().filter_map(|l| l.strip_prefix("urdf:")).map(|u| u.trim().to_owned()));
        names
            .into_iter()
            .map(|name| json!({ "file": name, "fnv1a": hash(source.text(&name).unwrap_or_default().as_bytes()) }))
            .collect::<Vec<_>>()
    });
    let iterations: usize = report.points.iter().map(|p| p.iterations).sum();
    json!({
        "fastbike": env!("CARGO_PKG_VERSION"),
        "arguments": context.arguments,
        "model": model.model,
        "set": model.set,
        "inputs": files.unwrap_or_default(),
        "statistics": { "points": report.points.len(), "iterations": iterations },
        "warnings": report.warnings,
    })
}

/// FNV-1a, 64 bit: tells whether two inputs are the same, nothing more.
fn hash(bytes: &[u8]) -> String {
    let h = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{h:016x}")
}
