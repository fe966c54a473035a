//! `setup`: geometry, suspension, squat, mass center and inertia of a vehicle in a steady pose.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument};
use crate::output::setup::SetupReport;
use crate::plan::TrimArguments;
use crate::plot::FileFormat;
use crate::{Context, Exit, Failure, backend, figures, model, results, steady};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::{Finding, Severity};
use problem::Ending;
use std::path::PathBuf;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "setup", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Second figure to write, .svg or .png: load, wheel rate and motion ratios over travel
    #[arg(long, value_name = "FILE")]
    curves: Option<PathBuf>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command)
        .about("Rake, trail, wheelbase, sag, wheel rates, motion ratios, squat, mass center and inertia by component")
        .after_help(
            "The pose is a steady state, at rest where no speed is given. Suspensions are judged on a stand: the chassis is held in this pose, a jack moves the wheels of an axle.\n\
             JSON and CSV hold the curves over travel; `--plot` draws the side view with the squat line, `--curves` the curves.\n\n\
             Examples:\n  fastbike setup gsxr1000 --plot side.svg --curves travel.svg\n  fastbike setup gsxr1000 --speed 40 --acceleration 5\n  \
             fastbike setup sidecar --format json",
        )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    if let Some(path) = &arguments.curves
        && FileFormat::of(path).is_err()
    {
        let finding = argument("curves", &path.display().to_string(), "unknown_value", "there is no figure of this format");
        return Err(finding.with_hint("the name of the file ends in `.svg` or `.png`").into());
    }
    if request.swept() > 0 {
        let finding = Finding::error("wrong_count", "a setup is that of one steady state, but a sweep is given");
        return Err(finding.with_hint("give one value each; `fastbike trim … --show trail` follows a signal along a sweep").into());
    }
    if request.incline != Default::default() {
        return Err(
            Finding::error("contradictory_entries", "a setup is measured on the level road: leave out `--grade` and `--bank`").into()
        );
    }
    let loaded = model::load(&arguments.model, context)?;
    let system = &loaded.assembled.system;
    let steady = steady::run(&request, system, &arguments.trim.backend, "setup")?;
    let Some(point) = steady.points.iter().find(|p| !p.values.is_empty()) else {
        let ending = steady.points.first().map(|p| &p.ending);
        let because = match ending {
            Some(Ending::NotConverged { because }) => because.clone(),
            Some(ending) => ending.name().to_owned(),
            None => "there is none".to_owned(),
        };
        return Err(Failure::Unreached(format!("the steady state was not found: {because}")));
    };
    let Some(backend) = backend::algebraic(&arguments.trim.backend) else {
        return Err(Failure::Argument(format!("there is no backend `{}`", arguments.trim.backend)));
    };
    let setup = motorcycle::setup::setup(&loaded.assembled, &point.values, (backend.make)().as_mut()).map_err(|because| {
        Finding::error("no_vehicle_base", because).with_hint("`fastbike info MODEL` shows what the model consists of")
    })?;
    let told = |name: &str| name.ends_with("_tire.normal_force") || name.ends_with("_tension") || name == "drive.torque";
    let forces = steady.signals.iter().zip(&point.values).filter(|(s, v)| told(&s.name) && v.is_finite());
    let mut warnings = steady.warnings.clone();
    warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    if let Ending::Limit { name, .. } = &point.ending {
        warnings.push(format!("the pose is beyond a limit: {name}"));
    }
    let given = steady.given.iter().zip(&point.given).map(|(g, v)| (g.name.clone(), g.unit.to_string(), *v));
    let report = SetupReport {
        model: loaded.name.clone(),
        given: given.collect(),
        forces: forces.map(|(s, v)| (s.name.clone(), s.unit.to_string(), *v)).collect(),
        setup,
        warnings,
    };
    let curves = arguments.curves.as_ref().map(|path| Ok::<_, Failure>((path, figures::setup::curves(&report)?))).transpose()?;
    let exit = results::deliver(context, (&arguments.model, &arguments.output), report, |r| Ok(figures::setup::side_view(r)))?;
    if let Some((path, figure)) = curves {
        results::write(path, &figure.encode(FileFormat::of(path)?)?)?;
    }
    Ok(exit)
}
