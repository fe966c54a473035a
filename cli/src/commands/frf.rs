//! `frf`: frequency responses at a steady state or along a sweep.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::figures::quantity;
use crate::output::responses::{Responses, quotient};
use crate::output::{Angles, Beside, Point, Report};
use crate::plan::TrimArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::responses::{Answers, Excited, Road, check_outputs, names_of_variants, with_variants};
use crate::{Context, Exit, Failure, model, results};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::Frequency;
use mbody::dynamics::System;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "frf", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Input that oscillates; left out: the steering torque, or the road alone (repeatable)
    #[arg(long, value_name = "INPUT")]
    input: Vec<String>,
    /// Signal that answers: any unknown or output, `rate(SIGNAL)` for its rate; left out: what is usual for the inputs (repeatable)
    #[arg(long = "output", value_name = "SIGNAL")]
    outputs: Vec<String>,
    /// Frequencies: `0.1..30:log200` (200 of them in equal ratios), `1..20:0.5`, `2,5,10`
    #[arg(long, value_name = "FREQUENCY", default_value = "0.1..30:log200")]
    frequency: String,
    /// A road of height 1 that oscillates along the track
    #[arg(long, value_name = "WHEELS", value_enum)]
    road: Option<Road>,
    /// The same analysis for a variant: another description, or `PATH=VALUE` as in --set (repeatable)
    #[arg(long, value_name = "FILE|PATH=VALUE")]
    versus: Vec<String>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Frequency responses at a steady state or along a sweep").after_help(
        "A response is the amplitude of a signal over that of an input, with its phase. Heights of the road move with their rates.\n\
         Where the steady state is unstable, it is the motion that whoever stabilizes it has to sustain.\n\n\
         Examples:\n  fastbike frf gsxr1000 --speed 30 --plot steering.svg\n  \
         fastbike frf gsxr1000 --speed 20,40 --road both --output 'rate(chassis.pitch_rate)' --plot pitch.svg\n  \
         fastbike frf ref11 --speed 30 --input steer.torque --output chassis.roll --frequency 0.05..5:log100 --format csv",
    )
}

/// What answers where nobody says otherwise, of the signals that a model has: to the road, and to everything else.
const TO_THE_ROAD: [&str; 2] = ["saddle.acceleration_z", "rate(chassis.pitch_rate)"];
const TO_INPUTS: [&str; 2] = ["chassis.roll", "steer.angle"];

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    let frequencies = frequencies(&arguments.frequency)?;
    let loaded = model::load(&arguments.model, context)?;
    let (system, backend) = (&loaded.assembled.system, arguments.trim.backend.as_str());
    let excited = excited(&arguments, system)?;
    let outputs = outputs(&arguments, system)?;
    let answers = Answers { request: &request, backend, excited: &excited, outputs: &outputs };
    let at = |_: &Point| frequencies.clone();
    let (steady, responses) = answers.of(&loaded, "steady states", &at)?;
    let mut report = results::report("frf", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Responses(responses);
    answers.versus(&mut report, (&arguments.model, &arguments.versus), context, &at)?;
    results::deliver(context, (&arguments.model, &arguments.output), report, figure)
}

/// Frequencies, Hz.
fn frequencies(text: &str) -> Result<Vec<f64>, Failure> {
    let frequencies = sweep::<Frequency>("frequency", text)?;
    match frequencies.iter().find(|f| **f < 0.0) {
        None => Ok(frequencies),
        Some(negative) => {
            let message = format!("a frequency of `{negative} Hz` is out of range: it must be 0 Hz or more");
            Err(argument("frequency", text, "out_of_range", message).into())
        }
    }
}

fn excited(arguments: &Arguments, system: &System) -> Result<Excited, Failure> {
    let mut excited = Excited { inputs: arguments.input.clone(), road: arguments.road };
    if excited.inputs.is_empty() && excited.road.is_none() {
        let usual = system.inputs().iter().find(|i| i.signal.name == "steer.torque").or(system.inputs().first());
        let Some(usual) = usual else {
            return Err(Finding::error("missing_input", "this model has no input that could oscillate").into());
        };
        excited.inputs.push(usual.signal.name.clone());
    }
    excited.check(system)?;
    Ok(excited)
}

fn outputs(arguments: &Arguments, system: &System) -> Result<Vec<String>, Failure> {
    let outputs: Vec<String> = match arguments.outputs.is_empty() {
        false => arguments.outputs.clone(),
        true => {
            let usual = if arguments.input.is_empty() && arguments.road.is_some() { TO_THE_ROAD } else { TO_INPUTS };
            usual.into_iter().filter(|name| check_outputs(&[(*name).to_owned()], system).is_ok()).map(str::to_owned).collect()
        }
    };
    if outputs.is_empty() {
        return Err(Finding::error("missing_output", "name a signal that answers").with_hint("for example `--output chassis.roll`").into());
    }
    check_outputs(&outputs, system)?;
    Ok(outputs)
}

/// Magnitudes and phases, a pair of panels for every signal that answers.
fn figure(report: &Report) -> Result<Figure, Failure> {
    let Beside::Responses(responses) = &report.beside else { return Err(Finding::error("no_sweep", "there is nothing to draw").into()) };
    if responses.points.iter().flatten().all(|p| p.frequencies.len() < 2) {
        return Err(Finding::error("no_sweep", "the figure of a single frequency would be empty")
            .with_hint("sweep the frequency, for example `--frequency 0.1..30:log200`")
            .into());
    }
    let mut panels = Vec::new();
    for (k, output) in responses.outputs.iter().enumerate() {
        let all = with_variants(report, responses);
        let drawn = |of: Part<'_>| all.iter().enumerate().flat_map(|(v, r)| curves(report, (r, v), k, of)).collect::<Vec<_>>();
        let magnitudes = drawn(&|unit_factor, values| values.iter().map(|z| z.norm() * unit_factor).collect());
        let phases = drawn(&|_, values| unwrapped(values));
        let units: Vec<String> = responses.inputs.iter().map(|input| quotient(input, output, Angles::Degrees).0).collect();
        let unit = if units.iter().all(|u| *u == units[0]) { units[0].clone() } else { String::new() };
        panels.push(LinePanel { y: Axis::new(output.name.clone(), unit).logarithmic(), curves: magnitudes });
        panels.push(LinePanel { y: Axis::new("phase", "deg"), curves: phases });
    }
    let log = |f: &[f64]| f.windows(3).all(|w| w[0] > 0.0 && (w[2] / w[1] - w[1] / w[0]).abs() < 1e-6 * w[2] / w[1]);
    let axis = Axis::new("frequency", "Hz");
    let logarithmic = responses.points.iter().flatten().all(|p| log(&p.frequencies));
    Ok(Figure::Lines(Lines {
        title: title(report, responses),
        x: if logarithmic { axis.logarithmic() } else { axis },
        panels,
        bands: Vec::new(),
        variants: names_of_variants(report),
    }))
}

/// What is drawn of a response: from the factor of its unit and its values.
type Part<'a> = &'a dyn Fn(f64, &[Complex<f64>]) -> Vec<f64>;

/// Curves of one output: a curve per point and input.
fn curves(report: &Report, (responses, variant): (&Responses, usize), output: usize, of: Part<'_>) -> Vec<Curve> {
    let mut curves = Vec::new();
    for (at, point) in report.points.iter().zip(&responses.points) {
        let Ok(point) = point else { continue };
        for (k, input) in responses.inputs.iter().enumerate() {
            let mut names = if responses.inputs.len() > 1 { vec![input.name.clone()] } else { Vec::new() };
            names.extend(varying(report).map(|g| quantity(&report.given[g].name, &report.given[g].unit, at.given[g])));
            let factor = quotient(input, &responses.outputs[output], Angles::Degrees).1;
            let values = of(factor, &point.values[k * responses.outputs.len() + output]);
            let points = point.frequencies.iter().copied().zip(values).collect();
            curves.push(Curve { name: names.join(", "), points, markers: Markers::Never, variant });
        }
    }
    curves
}

/// Phases in degrees without jumps, the first between −180 and 180.
fn unwrapped(values: &[Complex<f64>]) -> Vec<f64> {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    values
        .iter()
        .map(|z| {
            let phase = z.arg();
            if let Some(last) = before.filter(|_| phase.is_finite()) {
                turns -= ((phase - last) / TAU).round();
            }
            before = if phase.is_finite() { Some(phase) } else { before };
            (phase + TAU * turns).to_degrees()
        })
        .collect()
}

/// Indices of the prescribed quantities that vary.
fn varying(report: &Report) -> impl Iterator<Item = usize> + '_ {
    (0..report.given.len()).filter(|&k| report.points.windows(2).any(|w| w[0].given[k] != w[1].given[k]))
}

/// `Response of ref11 to steer.torque, speed 30 m/s`: what does not vary stands in the title.
fn title(report: &Report, responses: &Responses) -> String {
    let mut title = format!("Response of {}", report.model);
    if let [input] = responses.inputs.as_slice() {
        title.push_str(&format!(" to {}", input.name));
    }
    let vary: Vec<usize> = varying(report).collect();
    for (k, given) in report.given.iter().enumerate().filter(|(k, _)| !vary.contains(k)) {
        if let Some(point) = report.points.first() {
            title.push_str(&format!(", {}", quantity(&given.name, &given.unit, point.given[k])));
        }
    }
    title
}
