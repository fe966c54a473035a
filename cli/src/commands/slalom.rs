//! `slalom`: roll over steering torque at the frequency at which a row of cones is passed, over speed.
//!
//! One full roll per two cones: `f = V / 2d`; the curve is `|φ/τ|` at that frequency. Source: theory manual 9.3.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::figures::quantity;
use crate::output::responses::quotient;
use crate::output::{Angles, Beside, Point, Report};
use crate::plan::TrimArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::responses::{Answers, Excited, check_outputs, names_of_variants, with_variants};
use crate::{Context, Exit, Failure, model, results};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::Length;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "slalom", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Distance of the cones
    #[arg(long, value_name = "LENGTH", default_value = "14m")]
    spacing: String,
    /// Input that the rider uses
    #[arg(long, value_name = "INPUT", default_value = "steer.torque")]
    input: String,
    /// Signal that answers
    #[arg(long = "output", value_name = "SIGNAL", default_value = "chassis.roll")]
    answer: String,
    /// The same analysis for a variant: another description, or `PATH=VALUE` as in --set (repeatable)
    #[arg(long, value_name = "FILE|PATH=VALUE")]
    versus: Vec<String>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Roll over steering torque in a slalom between cones, over speed").after_help(
        "One full roll per two cones: the frequency is speed / (2 spacing). A high curve means that little torque rolls the motorcycle far.\n\
         At low speed straight running is unstable: the curve is then the motion that a rider who stabilizes it has to sustain.\n\n\
         Example:\n  fastbike slalom gsxr1000 --spacing 14 --speed 4..50:0.5 --plot slalom.svg",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    if request.speed.is_none() {
        let finding = Finding::error("missing_speed", "a slalom needs a speed");
        return Err(finding.with_hint("add `--speed`, for example `--speed 4..50:1`").into());
    }
    let [spacing] = sweep::<Length>("spacing", &arguments.spacing)?[..] else {
        return Err(argument("spacing", &arguments.spacing, "wrong_count", "this takes one value").into());
    };
    if spacing <= 0.0 {
        let message = format!("`{spacing} m` is out of range: it must be greater than 0 m");
        return Err(argument("spacing", &arguments.spacing, "out_of_range", message).into());
    }
    let loaded = model::load(&arguments.model, context)?;
    let (system, backend) = (&loaded.assembled.system, arguments.trim.backend.as_str());
    let excited = Excited { inputs: vec![arguments.input.clone()], road: None };
    excited.check(system)?;
    let outputs = [arguments.answer.clone()];
    check_outputs(&outputs, system)?;
    let answers = Answers { request: &request, backend, excited: &excited, outputs: &outputs };
    // the speed is the first of the prescribed quantities
    let at = |point: &Point| vec![point.given[0] / (2.0 * spacing)];
    let (steady, responses) = answers.of(&loaded, "steady states", &at)?;
    let mut report = results::report("slalom", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Responses(responses);
    answers.versus(&mut report, (&arguments.model, &arguments.versus), context, &at)?;
    results::deliver(context, (&arguments.model, &arguments.output), report, |report| figure(report, spacing))
}

/// Magnitude over speed; a curve for every other prescribed value.
fn figure(report: &Report, spacing: f64) -> Result<Figure, Failure> {
    let Beside::Responses(responses) = &report.beside else { return Err(Finding::error("no_sweep", "there is nothing to draw").into()) };
    let varies = |k: usize| report.points.windows(2).any(|w| w[0].given[k] != w[1].given[k]);
    let (Some((input, output)), true) = (responses.pairs().next(), varies(0)) else {
        let finding = Finding::error("no_sweep", "the figure of a single speed would be empty");
        return Err(finding.with_hint("sweep the speed, for example `--speed 4..50:1`").into());
    };
    let (unit, factor) = quotient(input, output, Angles::Degrees);
    let mut curves: Vec<Curve> = Vec::new();
    let all = with_variants(report, responses);
    let points = all.iter().enumerate().flat_map(|(v, r)| report.points.iter().zip(&r.points).map(move |(at, point)| (v, at, point)));
    for (variant, at, point) in points {
        let others = (1..report.given.len()).filter(|&k| varies(k));
        let name = others.map(|k| quantity(&report.given[k].name, &report.given[k].unit, at.given[k])).collect::<Vec<_>>().join(", ");
        let value = (at.given[0], point.as_ref().map_or(f64::NAN, |p| p.values[0][0].norm() * factor));
        match curves.iter_mut().find(|c| c.name == name && c.variant == variant) {
            Some(curve) => curve.points.push(value),
            None => curves.push(Curve { name, points: vec![value], markers: Markers::WhenFew, variant }),
        }
    }
    Ok(Figure::Lines(Lines {
        title: format!("Slalom of {}, cones every {} m", report.model, (spacing * 1e6).round() / 1e6),
        x: Axis::new("speed", "m/s"),
        panels: vec![LinePanel { y: Axis::new(format!("{} / {}", output.name, input.name), unit), curves }],
        bands: Vec::new(),
        variants: names_of_variants(report),
    }))
}
