//! `linearize`: E, A, B, C, D of small motions about steady states.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::output::linear::{Export, export};
use crate::output::{Beside, Report, Results};
use crate::plan::TrimArguments;
use crate::plot::{Figure, PlotError};
use crate::small_motions::{FROZEN, SmallMotions, accelerates};
use crate::{Context, Exit, Failure, model, results, steady};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::{Finding, Severity};
use mbody::description::quantity::dimension::Number;
use std::path::{Path, PathBuf};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "linearize", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// File for the matrices of one point, with names and units: .json, .npz (NumPy) or .mat (MATLAB)
    #[arg(long, value_name = "FILE")]
    export: Option<PathBuf>,
    /// Largest scaled residual of a point that counts as a steady state; others are refused
    #[arg(long, value_name = "NUMBER", default_value = "1e-6")]
    residual_tolerance: String,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Linear model at a steady state: E, A, B, C, D with names and units").after_help(
        "E dx/dt = A x + B u, z = C x + D u, with x, u, z the deviations from the steady state, in SI units.\n\
         Cyclic coordinates (position, heading, wheel angles) are no states; constraints are eliminated.\n\n\
         Examples:\n  fastbike linearize ref11 --speed 30 --export ref11.npz\n  fastbike linearize gsxr1000 --speed 30 --lean 35deg --format json",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    if let Some(path) = &arguments.output.plot {
        let finding = argument("plot", &path.display().to_string(), "unknown_value", "a linear model has no figure");
        return Err(finding.with_hint("`fastbike modes` draws its eigenvalues").into());
    }
    let file = arguments.export.as_ref().map(|path| format_of(path).map(|format| (path, format))).transpose()?;
    if file.is_some() && request.swept() > 0 {
        return Err(Finding::error("too_many_points", "a file holds the linear model of one point")
            .with_hint("leave out the sweep")
            .into());
    }
    let [residual_tolerance] = sweep::<Number>("residual-tolerance", &arguments.residual_tolerance)?[..] else {
        return Err(argument("residual-tolerance", &arguments.residual_tolerance, "wrong_count", "this takes one value").into());
    };
    let loaded = model::load(&arguments.model, context)?;
    let mut steady = steady::run(&request, &loaded.assembled.system, &arguments.trim.backend, "linearize")?;
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    if accelerates(request.acceleration.as_ref()) {
        steady.warnings.push(FROZEN.to_owned());
    }
    let small = SmallMotions { request: &request, system: &loaded.assembled.system, backend: &arguments.trim.backend, residual_tolerance };
    let linear = small.linear_models(&steady);
    let mut report = results::report("linearize", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Linear(linear);
    if let Some((path, format)) = file {
        // an exported file has the axes of what is printed
        let report = report.clone().in_axes(arguments.output.axes);
        if let Beside::Linear(linear) = &report.beside
            && let Some(bytes) = export(&report, linear, format)
        {
            results::write(path, &bytes)?;
        }
    }
    results::deliver(context, (&arguments.model, &arguments.output), report, no_figure)
}

/// The format of an exported file.
fn format_of(path: &Path) -> Result<Export, Failure> {
    Export::of(path).ok_or_else(|| {
        let finding = argument("export", &path.display().to_string(), "unknown_value", "there is no file of this format");
        finding.with_hint("the name of the file ends in `.json`, `.npz` or `.mat`").into()
    })
}

fn no_figure(_: &Report) -> Result<Figure, Failure> {
    Err(PlotError::Raster { because: "a linear model has no figure".to_owned() }.into())
}
