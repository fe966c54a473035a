//! `rider`: the design of the virtual rider.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::figures::quantity;
use crate::output::rider::{RiderAlong, loop_of};
use crate::output::{Angles, Beside, Report, responses};
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Locus, Markers, RootLocus};
use crate::rider::{FRONT_BRAKE_SHARE, Task};
use crate::{Context, Exit, Failure, model, results};
use clap::{ArgMatches, Args, Command, ValueEnum};
use mbody::description::finding::{Finding, Severity};
use mbody::description::quantity::Quantity;
use mbody::description::quantity::dimension::{Acceleration, Angle, AngularSpeed, Length, Speed, Time, Torque};
use motorcycle::maneuver::{LateralLaw, RiderDescription};
use problem::Signal;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "rider", command, run };

/// What `--plot` draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Picture {
    /// Magnitude and phase of the open loop
    Loop,
    /// Poles of the closed loop
    Poles,
    /// Gains over speed
    Gains,
}

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// Forward speed
    #[arg(long, value_name = "SPEED", default_value = "10..50:5")]
    speed: String,
    /// Lateral acceleration, positive to the left
    #[arg(long, value_name = "ACCELERATION", default_value = "0", allow_hyphen_values = true)]
    lateral_acceleration: String,
    /// How the rider steers: preview (feedback of all states and of the way ahead) or pid (the path asks for lean, lean asks for torque)
    #[arg(long, value_name = "LAW", value_parser = ["preview", "pid"], default_value = "preview")]
    lateral: String,
    /// Offset from the path that counts as much as --heading and --torque
    #[arg(long, value_name = "LENGTH", default_value = "0.15m", allow_hyphen_values = true)]
    offset: String,
    /// Heading error that counts as much
    #[arg(long, value_name = "ANGLE", default_value = "0.05rad", allow_hyphen_values = true)]
    heading: String,
    /// Steering torque that counts as much
    #[arg(long, value_name = "TORQUE", default_value = "20N m", allow_hyphen_values = true)]
    torque: String,
    /// Reaction time (Padé, second order); left out: none
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    delay: Option<String>,
    /// Natural frequency of the muscles; left out: they follow at once
    #[arg(long, value_name = "FREQUENCY", allow_hyphen_values = true)]
    muscles: Option<String>,
    /// What --plot draws
    #[arg(long, value_name = "PICTURE", value_enum, default_value = "loop")]
    figure: Picture,
    #[command(flatten)]
    output: OutputArguments,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Design of the virtual rider: gains, margins, poles of the closed loop").after_help(
        "At every point the vehicle is trimmed and linearized, and the feedback is computed that holds a path best for what counts as much as what. \
         Gains that do not stabilize are refused. `run` makes the same rider for a maneuver.\n\n\
         Examples:\n  fastbike rider gsxr1000 --speed 10..50:5 --plot loop.svg\n  \
         fastbike rider gsxr1000 --speed 30 --delay 0.1s --muscles 30rad/s --format json",
    )
}

/// One positive value.
fn positive<D: mbody::description::quantity::Dimensioned>(option: &str, text: &str) -> Result<f64, Failure> {
    match sweep::<D>(option, text)?[..] {
        [value] if value > 0.0 => Ok(value),
        [_] => Err(argument(option, text, "out_of_range", "this must be greater than 0".to_owned()).into()),
        _ => Err(argument(option, text, "wrong_count", "this takes one value".to_owned()).into()),
    }
}

fn wishes(arguments: &Arguments) -> Result<RiderDescription, Failure> {
    fn some<D: mbody::description::quantity::Dimensioned>(
        option: &str,
        text: Option<&String>,
    ) -> Result<Option<mbody::description::quantity::PositiveQuantity<D>>, Failure> {
        let Some(text) = text else { return Ok(None) };
        let value = positive::<D>(option, text)?;
        Quantity::new(value).map(Some).map_err(|e| argument(option, text, e.code(), e.to_string()).into())
    }
    Ok(RiderDescription {
        offset: some::<Length>("offset", Some(&arguments.offset))?,
        heading: some::<Angle>("heading", Some(&arguments.heading))?,
        torque: some::<Torque>("torque", Some(&arguments.torque))?,
        delay: some::<Time>("delay", arguments.delay.as_ref())?,
        muscles: some::<AngularSpeed>("muscles", arguments.muscles.as_ref())?,
        lateral: if arguments.lateral == "pid" { LateralLaw::Pid } else { LateralLaw::Preview },
        ..RiderDescription::default()
    })
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let speeds = sweep::<Speed>("speed", &arguments.speed)?;
    let laterals = sweep::<Acceleration>("lateral-acceleration", &arguments.lateral_acceleration)?;
    let wishes = wishes(&arguments)?;
    arguments.output.check()?;
    let loaded = model::load(&arguments.model, context)?;
    let task = Task { system: &loaded.assembled.system, backend: "kinsol", wishes: &wishes, front_brake_share: FRONT_BRAKE_SHARE };
    let (mut steady, rider) = task.along(&speeds, &laterals)?;
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    let mut report = results::report("rider", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Rider(rider);
    results::deliver(context, (&arguments.model, &arguments.output), report, |report| figure(report, arguments.figure))
}

fn figure(report: &Report, picture: Picture) -> Result<Figure, Failure> {
    let Beside::Rider(along) = &report.beside else { return Err(Finding::error("no_sweep", "there is nothing to draw").into()) };
    let varies = |k: usize| report.points.windows(2).any(|w| w[0].given[k] != w[1].given[k]);
    let name = |point: usize| {
        let of = (0..report.given.len()).filter(|&k| varies(k) || report.points.len() == 1);
        of.map(|k| quantity(&report.given[k].name, &report.given[k].unit, report.points[point].given[k])).collect::<Vec<_>>().join(", ")
    };
    let known: Vec<usize> = (0..along.points.len()).filter(|&k| along.points[k].is_ok()).collect();
    let title = |what: &str| format!("{what} of the rider of {}", report.model);
    match picture {
        Picture::Loop => {
            // as many as can be told apart
            let count = known.len().min(6);
            let chosen: Vec<usize> = (0..count).map(|i| known[i * (known.len() - 1) / (count - 1).max(1)]).collect();
            let curves = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
                let curve = |&k: &usize| {
                    let points = along.points[k].iter().flat_map(loop_of).filter(|p| p.0 >= 0.05 && p.0 <= 30.0).map(|p| (p.0, of(&p)));
                    Curve { name: name(k), points: points.collect(), markers: Markers::Never, variant: 0 }
                };
                chosen.iter().map(curve).collect::<Vec<_>>()
            };
            let panels = vec![
                LinePanel { y: Axis::new("Magnitude", "dB"), curves: curves(&|p| 20.0 * p.1.log10()) },
                LinePanel { y: Axis::new("Phase", "deg"), curves: curves(&|p| p.2.to_degrees()) },
            ];
            let x = Axis::new("Frequency", "Hz").logarithmic();
            Ok(Figure::Lines(Lines { title: title("Open loop"), x, panels, bands: Vec::new(), variants: Vec::new() }))
        }
        Picture::Poles => {
            let branches = loci(along, &known, &|k| if varies(0) && varies(1) { laterally(report, k) } else { "poles".to_owned() });
            let first = match (varies(0), known.first()) {
                (true, Some(&k)) => quantity(&report.given[0].name, &report.given[0].unit, report.points[k].given[0]),
                _ => String::new(),
            };
            Ok(Figure::RootLocus(RootLocus { title: title("Closed loop"), branches, first, variants: Vec::new() }))
        }
        Picture::Gains => {
            if !varies(0) {
                let finding = Finding::error("no_sweep", "gains of a single speed would be an empty figure");
                return Err(finding.with_hint("sweep the speed, for example `--speed 10..50:2`").into());
            }
            let panels = along.feedback.iter().enumerate().filter(|(_, s)| drawn(&s.name)).map(|(i, signal)| {
                let mut curves: Vec<Curve> = Vec::new();
                for &k in &known {
                    let at = &report.points[k].given;
                    let name = if varies(1) { laterally(report, k) } else { String::new() };
                    let gain = along.points[k].as_ref().map_or(f64::NAN, |r| {
                        r.gains.iter().chain(&r.path_gains).chain(&r.actuator_gains).nth(i).copied().unwrap_or(f64::NAN)
                    });
                    match curves.iter_mut().find(|c| c.name == name) {
                        Some(curve) => curve.points.push((at[0], gain)),
                        None => curves.push(Curve { name, points: vec![(at[0], gain)], markers: Markers::WhenFew, variant: 0 }),
                    }
                }
                let effort = Signal::new(String::new(), along.effort.clone(), "");
                LinePanel { y: Axis::new(signal.name.clone(), quotient(&effort, signal)), curves }
            });
            let panels = panels.collect();
            Ok(Figure::Lines(Lines {
                title: title("Gains"),
                x: Axis::new("speed", "m/s"),
                panels,
                bands: Vec::new(),
                variants: Vec::new(),
            }))
        }
    }
}

/// The lateral acceleration of a point, for a legend.
fn laterally(report: &Report, point: usize) -> String {
    quantity(&report.given[1].name, &report.given[1].unit, report.points[point].given[1])
}

/// Poles in the upper half-plane, each joined with the nearest one of the next point of the same name.
fn loci(along: &RiderAlong, known: &[usize], name: &dyn Fn(usize) -> String) -> Vec<Locus> {
    let mut branches: Vec<Locus> = Vec::new();
    // where the branches of a name stand that can go on
    let mut open: Vec<(String, Vec<usize>)> = Vec::new();
    for &k in known {
        let (name, poles) = (name(k), along.points[k].iter().flat_map(|r| &r.closed).filter(|s| s.im >= 0.0));
        let poles: Vec<(f64, f64)> = poles.map(|s| (s.re, s.im)).collect();
        let at = open.iter().position(|(n, _)| *n == name);
        let begins = at.is_none();
        let mut before = at.map_or_else(Vec::new, |at| open.swap_remove(at).1);
        let mut after = Vec::new();
        let distance = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1);
        for pole in poles {
            let end = |b: usize| branches[b].points.last().copied().unwrap_or(pole);
            let nearest = (0..before.len()).min_by(|&a, &b| distance(end(before[a]), pole).total_cmp(&distance(end(before[b]), pole)));
            // a pair that meets the real axis ends there, and two others begin
            match nearest.filter(|&n| (end(before[n]).1 == 0.0) == (pole.1 == 0.0)) {
                Some(n) => {
                    let branch = before.swap_remove(n);
                    branches[branch].points.push(pole);
                    after.push(branch);
                }
                None => {
                    after.push(branches.len());
                    branches.push(Locus { name: name.clone(), points: vec![pole], begins, variant: 0 });
                }
            }
        }
        open.push((name, after));
    }
    branches
}

/// Unit of a gain: that of the torque over that of a signal.
fn quotient(effort: &Signal, signal: &Signal) -> String {
    responses::quotient(signal, effort, Angles::Radians).0
}

/// The gains that a reader looks for.
fn drawn(name: &str) -> bool {
    ["path.offset", "path.heading", ".roll", ".roll_rate", "steer.angle", "steer.rate"].iter().any(|end| name.ends_with(end))
}
