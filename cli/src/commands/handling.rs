//! `handling`: handling indices over speed, from steady turns and from rides.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::output::handling::{HandlingAlong, Index, shown};
use crate::output::{Angles, Beside, History, Point, Report};
use crate::plan::{Prescribed, Request, Turn};
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::{Context, Exit, Failure, maneuver, model, motion, results, steady};
use clap::{ArgMatches, Args, Command};
use mbody::description::OneText;
use mbody::description::finding::{Finding, Findings, Severity};
use mbody::description::quantity::Dimensioned;
use mbody::description::quantity::dimension::{Acceleration, Length, Speed};
use mbody::dynamics::System;
use motorcycle::handling::indices::{curvature, koch, lane_change_roll};
use problem::{Derivatives, LinearSolver, Signal};
use rayon::prelude::*;
use std::sync::Arc;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "handling", command, run };

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// Forward speed
    #[arg(long, value_name = "SPEED", default_value = "10..50:5")]
    speed: String,
    /// Lateral acceleration of the steady turns, and the largest one that the paths of the rides ask for; positive to the left
    #[arg(long, value_name = "ACCELERATION", default_value = "4", allow_hyphen_values = true)]
    lateral_acceleration: String,
    /// How far the lane change goes aside
    #[arg(long, value_name = "LENGTH", default_value = "3.6m", allow_hyphen_values = true)]
    width: String,
    /// Steady turns only, nothing is ridden
    #[arg(long)]
    no_rides: bool,
    #[command(flatten)]
    output: OutputArguments,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Handling indices over speed: steady turns, entrance of a curve, lane change").after_help(
        "Steady turns: torque over lateral acceleration, over roll and over yaw rate, and the steering ratio: above 1 the motorcycle oversteers, below 1 it\n\
         understeers, below 0 the bar is turned out of the turn. The virtual rider rides into a curve (Koch index: peak torque over speed and peak roll rate) and through a lane change (lane change roll\n\
         index: the same from peak to peak). A low index means a vehicle that leans with little torque.\n\n\
         Examples:\n  fastbike handling gsxr1000 --speed 10..50:5 --plot handling.svg\n  fastbike handling ref11 --speed 20 --no-rides --format json",
    )
}

/// Sources of definitions: [`motorcycle::handling::indices`].
const INDICES: [Index; 6] = [
    Index { name: "acceleration_index", title: "torque/a_y", unit: "N s²/m", quotient: Some(["steer.torque", "lateral_acceleration"]) },
    Index { name: "roll_index", title: "torque/roll", unit: "N m/rad", quotient: Some(["steer.torque", "chassis.roll"]) },
    Index { name: "yaw_index", title: "torque/yaw rate", unit: "N m s/rad", quotient: Some(["steer.torque", "chassis.yaw_rate"]) },
    Index { name: "steering_ratio", title: "steering ratio", unit: "-", quotient: None },
    Index { name: "koch_index", title: "Koch", unit: "N s²/rad", quotient: None },
    Index { name: "lane_change_roll_index", title: "lane change roll", unit: "N s²/rad", quotient: None },
];

/// One value, positive where it has to be.
fn single<D: Dimensioned>(option: &str, text: &str, fits: impl Fn(f64) -> bool, what: &str) -> Result<f64, Failure> {
    match sweep::<D>(option, text)?[..] {
        [value] if fits(value) => Ok(value),
        [_] => Err(argument(option, text, "out_of_range", format!("this must {what}")).into()),
        _ => Err(argument(option, text, "wrong_count", "this takes one value").into()),
    }
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let speeds = sweep::<Speed>("speed", &arguments.speed)?;
    if speeds.iter().any(|v| *v <= 0.0) {
        return Err(argument("speed", &arguments.speed, "out_of_range", "a turn needs a speed greater than 0").into());
    }
    let lateral = single::<Acceleration>("lateral-acceleration", &arguments.lateral_acceleration, |a| a != 0.0, "not be 0")?;
    let width = single::<Length>("width", &arguments.width, |w| w > 0.0, "be greater than 0")?;
    arguments.output.check()?;
    let loaded = model::load(&arguments.model, context)?;
    let system = &loaded.assembled.system;
    let prescribed = |name, unit, values: Vec<f64>| Prescribed { name, unit, values };
    let request = Request {
        speed: Some(prescribed("speed", "m/s", speeds)),
        turn: Some((Turn::LateralAcceleration, prescribed("lateral_acceleration", "m/s²", vec![lateral]))),
        ..Request::default()
    };
    let mut steady = steady::run(&request, system, "kinsol", "steady turns")?;
    let mut points: Vec<Vec<f64>> = steady.points.iter().map(|p| turning(p, &steady.signals)).collect();
    let mut about = vec![format!("steady turns at {lateral} m/s² to the side")];
    if !arguments.no_rides {
        let speeds: Vec<f64> = steady.points.iter().map(|p| p.given[0]).collect();
        let ridden: Vec<[Result<f64, String>; 2]> = speeds.par_iter().map(|&v| ridden(system, v, lateral, width)).collect();
        for ((point, ridden), speed) in points.iter_mut().zip(ridden).zip(&speeds) {
            for index in ridden {
                point.push(index.as_ref().copied().unwrap_or(f64::NAN));
                steady.warnings.extend(index.err().map(|why| format!("at {speed} m/s: {why}")));
            }
        }
        about.push(format!("rides: into a curve, and {width} m aside, on paths that ask for {} m/s² at most", lateral.abs()));
    }
    let indices = INDICES[..points.first().map_or(INDICES.len(), Vec::len)].to_vec();
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    let mut report = results::report("handling", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Handling(HandlingAlong { indices, points, about });
    results::deliver(context, (&arguments.model, &arguments.output), report, figure)
}

/// Indices of a steady turn; NaN where there is none.
fn turning(point: &Point, signals: &[Signal]) -> Vec<f64> {
    let value = |name: &str| signals.iter().position(|s| s.name == name).map_or(f64::NAN, |k| point.value(k));
    let of = |name: &str| value(&format!("chassis.{name}"));
    let (torque, yaw_rate) = (value("steer.torque"), of("yaw_rate"));
    // a steady state has the heading 0
    let rear = (value("rear_tire.contact_x") - of("x"), value("rear_tire.contact_y") - of("y"));
    let actual = curvature(rear, (of("forward_speed"), of("lateral_speed")), yaw_rate);
    vec![torque / value("lateral_acceleration"), torque / of("roll"), torque / yaw_rate, actual / value("kinematic_curvature")]
}

/// Koch index and lane change roll index at a speed (m/s) on paths that ask for a lateral acceleration (m/s²) at most, or why there is none.
fn ridden(system: &Arc<System>, speed: f64, lateral: f64, width: f64) -> [Result<f64, String>; 2] {
    let aside = lateral.signum() * width;
    // peak of the quintic: 10 w V²/(√3 L²)
    let length = speed * (10.0 * width / (3f64.sqrt() * lateral.abs())).sqrt();
    let radius = speed * speed / lateral;
    let run_up = speed;
    let curve = format!("curve: {{ radius: {radius}, transition: {speed}, length: {} }}", 2.0 * speed);
    let change = format!("lane_change: {{ width: {aside}, length: {length} }}");
    let ride = |section: &str, beyond: f64| {
        let end = if beyond > 0.0 { format!("\n  - straight: {{ length: {beyond} }}") } else { String::new() };
        let text =
            format!("maneuver: 1\nname: Handling\nspeed: {speed}\npath:\n  - straight: {{ length: {run_up} }}\n  - {section}{end}\n");
        ride(system, &text).map_err(|failure| failure.to_string())
    };
    let signals = |section: &str, beyond: f64| -> Result<[Vec<f64>; 3], String> {
        let history = ride(section, beyond)?;
        let mut columns = [const { Vec::new() }; 3];
        for (column, name) in columns.iter_mut().zip(RECORDED) {
            *column = history.column(name).map_err(|failure| failure.to_string())?.unwrap_or_default();
        }
        Ok(columns)
    };
    [
        signals(&curve, 0.0).map(|[torque, rate, _]| koch(&torque, &rate, speed)),
        signals(&change, 2.0 * speed).map(|[torque, rate, forward]| lane_change_roll(&torque, &rate, &forward)),
    ]
}

/// What the indices of rides are made of.
const RECORDED: [&str; 3] = ["steer.torque", "chassis.roll_rate", "chassis.forward_speed"];

/// Rides a maneuver to its end.
fn ride(system: &Arc<System>, text: &str) -> Result<History, Failure> {
    let mut findings = Findings::new();
    let Some(maneuver) = motorcycle::maneuver::read("handling", &OneText(text), &[], &mut findings) else {
        return Err(Failure::Findings(findings));
    };
    let speed = maneuver.course.speed.first();
    let duration = maneuver.longest();
    let request = motion::Request {
        times: (0..=(100.0 * duration) as usize).map(|k| 0.01 * k as f64).collect(),
        relative_tolerance: 1e-6,
        backend: "ida".to_owned(),
        formulation: None,
        derivatives: Derivatives::Exact,
        linear_solver: LinearSolver::Direct,
        fixed_step: motion::USUAL_STEP,
        steady: Some(Request { speed: Some(Prescribed { name: "speed", unit: "m/s", values: vec![speed] }), ..Request::default() }),
        given: Vec::new(),
        signals: None,
        until: Vec::new(),
        interrupt: None,
        record: RECORDED.map(str::to_owned).to_vec(),
        keep: None,
    };
    let history = motion::run(&request, system, "", Some(maneuver::ride("handling", maneuver, system)?))?;
    match history.outcome.ending.as_str() {
        maneuver::GOAL => Ok(history),
        other => Err(Finding::error("not_ridden", format!("a ride ended with `{other}`, so it has no index")).into()),
    }
}

/// Indices over speed, one panel per unit.
fn figure(report: &Report) -> Result<Figure, Failure> {
    let Beside::Handling(along) = &report.beside else { return Err(Finding::error("no_sweep", "there is nothing to draw").into()) };
    if report.points.len() < 2 {
        let finding = Finding::error("no_sweep", "the figure of a single speed would be empty");
        return Err(finding.with_hint("sweep the speed, for example `--speed 10..50:5`").into());
    }
    let mut panels: Vec<LinePanel> = Vec::new();
    for (i, index) in along.indices.iter().enumerate() {
        let (unit, factor) = shown(index, Angles::Degrees);
        // the ratio passes infinity where the bar is straight, its inverse does not
        let inverse = index.name == "steering_ratio";
        let value = |values: &Vec<f64>| if inverse { 1.0 / values[i] } else { values[i] * factor };
        let points = report.points.iter().zip(&along.points).map(|(at, values)| (at.given[0], value(values))).collect();
        let title = if inverse { "1/steering ratio" } else { index.title };
        let curve = Curve { name: title.to_owned(), points, markers: Markers::WhenFew, variant: 0 };
        // both indices of rides share a panel
        match panels.last_mut().filter(|_| index.name == "lane_change_roll_index") {
            Some(panel) => {
                panel.curves.push(curve);
                panel.y = Axis::new("index of rides", unit);
            }
            None => panels.push(LinePanel { y: Axis::new(title, if unit == "-" { "".into() } else { unit }), curves: vec![curve] }),
        }
    }
    Ok(Figure::Lines(Lines {
        title: format!("Handling indices of {}", report.model),
        x: Axis::new("speed", "m/s"),
        panels,
        bands: Vec::new(),
        variants: Vec::new(),
    }))
}
