//! `run`: a motion over time.

use super::{Kind, read};
use crate::animation::{self, Scene};
use crate::arguments::{Jacobian, Linear, ModelArguments, OutputArguments, argument};
use crate::figures::ride::{self, Picture};
use crate::incline::Incline;
use crate::output::{Angles, History, Results, unreadable};
use crate::plan::SteadyArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::{Context, Exit, Failure, interrupt, maneuver, model, motion, results};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Severity;
use mbody::description::quantity::dimension::{Frequency, Number, Time};
use mbody::description::quantity::{Dimensioned, parse_quantity};
use motorcycle::maneuver::Control;
use std::path::PathBuf;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "run", command, run };

/// Samples per second, where nobody says otherwise.
const RATE: f64 = 100.0;
/// Least intervals between samples, where nobody says otherwise.
const FEWEST: f64 = 200.0;
/// Most samples.
const MOST: f64 = 1e6;

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// A maneuver to ride: the name of a bundled one, or the path of a .yaml file
    maneuver: Option<String>,
    /// Override an entry of the maneuver: `speed=20`, `path.1.lane_change.width=-3m` (repeatable)
    #[arg(long, value_name = "PATH=VALUE", requires = "maneuver", allow_hyphen_values = true)]
    change: Vec<String>,
    /// How long; left out: 5 s, or what the maneuver takes
    #[arg(long, value_name = "TIME")]
    duration: Option<String>,
    /// Samples per second; left out: 100 Hz, or more where the motion is short
    #[arg(long, value_name = "FREQUENCY")]
    rate: Option<String>,
    #[command(flatten)]
    steady: SteadyArguments,
    /// Start value of a coordinate, velocity or state, which is held while the rest is brought onto the constraints; or a constant
    /// input: `steer.torque=1`. With `--speed` it replaces values of the steady state (repeatable)
    #[arg(long, value_name = "SIGNAL=VALUE", allow_hyphen_values = true)]
    given: Vec<String>,
    /// Inputs over time: a CSV file with the columns `time` and one or more inputs, or that of an earlier run
    #[arg(long, value_name = "FILE.csv")]
    signals: Option<PathBuf>,
    /// End where a signal passes a value: `chassis.forward_speed<5`, `rear_tire.slip_angle>4deg` (repeatable)
    #[arg(long, value_name = "SIGNAL>VALUE", allow_hyphen_values = true)]
    until: Vec<String>,
    /// Signals to record: any of `fastbike info`, `rate(SIGNAL)` of an unknown, `system.energy`, `system.power_in`,
    /// `system.power_dissipated`; left out: all (repeatable)
    #[arg(long, value_name = "SIGNAL")]
    record: Vec<String>,
    /// Solver: ida, generalized_alpha (implicit form); erk, dopri5, dirk, cvode, cvode_adams, ros2, linear_euler, diffsol_bdf,
    /// diffsol_esdirk34, diffsol_tsit45 (explicit form)
    #[arg(long, default_value = "ida", value_name = "NAME")]
    backend: String,
    /// Matrices of implicit methods: exact derivatives, or differences of residuals
    #[arg(long, value_enum, default_value_t = Jacobian::Exact)]
    jacobian: Jacobian,
    /// What solves the linear equations of ida, cvode and dirk; the other implicit solvers factorize matrices
    #[arg(long, value_enum, default_value_t = Linear::Direct)]
    linear_solver: Linear,
    /// Length of the steps of ros2 and linear_euler
    #[arg(long, value_name = "TIME", default_value = "1ms")]
    step: String,
    /// How constraints enter the implicit form: ggl (default), velocity or acceleration; the other solvers take the explicit form
    #[arg(long, value_name = "NAME")]
    formulation: Option<String>,
    /// Relative tolerance
    #[arg(long, value_name = "NUMBER", default_value = "1e-6")]
    rtol: String,
    /// What --plot draws of a ride; left out: histories
    #[arg(long, value_name = "PICTURE", value_enum, requires = "maneuver")]
    figure: Option<Picture>,
    /// Animation to write: one .html file that opens in a browser without a network
    #[arg(long, value_name = "FILE.html")]
    animate: Option<PathBuf>,
    #[command(flatten)]
    output: OutputArguments,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Motion over time from a steady state or from start values").after_help(
        "With a maneuver the virtual rider is made for it: gains from the vehicle itself, over speed and lateral acceleration. With `--speed` the motion of a vehicle starts from the steady state that `trim` finds for the same options, and every input keeps the \
         value that it has there. Otherwise it starts from `start` of the description and the design pose, with inputs at their defaults. \
         `--signals` then replaces inputs, `--given` start values and inputs. A vehicle that has fallen ends the motion; lifting wheels and \
         other limits are told with their times, and the motion goes on. Ctrl-C ends it and keeps what was computed.\n\n\
         Examples:\n  fastbike run gsxr1000 lane_change --plot lane_change.svg\n  fastbike run gsxr1000 double_lane_change --figure path --plot path.svg\n  fastbike run ref11 u_turn --change speed=4 --animate u_turn.html\n  \
         fastbike run gsxr1000 --speed 30 --given steer.torque=2 --until 'chassis.roll<-30deg'\n  \
         fastbike run ref11 --speed 25 --lean 20deg --signals pulse.csv --plot run.svg\n  fastbike run andrews_squeezer --duration 30ms\n  \
         fastbike run whipple --given chassis.roll_rate=0.05 --plot run.svg --animate run.html\n  \
         fastbike run pendulum --backend erk --rtol 1e-9 --record system.energy --format csv",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.steady.gear_override());
    let maneuver = arguments.maneuver.as_deref().map(|name| maneuver::read(name, &arguments.change)).transpose()?;
    if let Some(maneuver) = &maneuver {
        if arguments.steady.moving() {
            let finding = argument("speed", "", "given_twice", "a maneuver starts from straight running at its own speed".to_owned());
            return Err(finding.with_hint("to change its speed, write `--change speed=20`").into());
        }
        arguments.steady.speed = Some(format!("{}", maneuver.course.speed.first()));
    }
    let duration = match (&arguments.duration, &maneuver) {
        (Some(duration), _) => duration.clone(),
        (None, Some(maneuver)) => format!("{:.3}", maneuver.longest()),
        (None, None) => "5s".to_owned(),
    };
    // the signals shown are our choice
    let chosen = arguments.record.is_empty();
    let until = maneuver.iter().flat_map(|m| m.until.clone()).collect::<Vec<_>>();
    let (times, relative_tolerance) = (times(&duration, arguments.rate.as_deref())?, tolerance(&arguments.rtol)?);
    arguments.output.check()?;
    arguments.animate.as_deref().map(animation::check).transpose()?;
    let loaded = model::load(&arguments.model, context)?;
    // where signals are chosen, they are the histories
    let ridden = maneuver.as_ref().is_some_and(|m| m.control == Control::Rider);
    let picture = arguments.figure.or((ridden && chosen).then_some(Picture::Histories));
    let scene = arguments.animate.is_some().then(|| Scene::of(&loaded.assembled));
    let mut steady = arguments.steady.moving().then(|| arguments.steady.request(&[], &[])).transpose()?;
    if let (Some(steady), Some(maneuver)) = (&mut steady, &maneuver) {
        steady.incline = Incline::at_start(&maneuver.road);
    }
    let request = motion::Request {
        times,
        relative_tolerance,
        backend: arguments.backend,
        formulation: arguments.formulation,
        derivatives: arguments.jacobian.into(),
        linear_solver: arguments.linear_solver.into(),
        fixed_step: positive::<Time>("step", &arguments.step)?,
        steady,
        given: arguments.given,
        signals: arguments.signals,
        until: arguments.until.iter().cloned().chain(until).collect(),
        interrupt: (!context.console.is_memory()).then(interrupt::flag),
        record: arguments.record,
        keep: scene.as_ref().map(Scene::signals),
    };
    let system = &loaded.assembled.system;
    let ride = arguments.maneuver.as_deref().zip(maneuver).map(|(name, maneuver)| maneuver::ride(name, maneuver, system)).transpose()?;
    let mut history = motion::run(&request, system, &loaded.name, ride)?;
    history.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(|f| f.to_string()));
    let (reached, outcome) = (history.outcome.statistics.time, &history.outcome);
    let ended =
        outcome.because.as_ref().map(|because| format!("error: the motion ended at {reached:.6} s of {} s: {because}\n", outcome.duration));
    // unasked for, the energy of a conservative system would be a figure of rounding errors
    let drawn: Vec<usize> = history.shown.iter().copied().filter(|&s| !chosen || !history.signals[s].name.starts_with("system.")).collect();
    let page = scene.map(|scene| {
        let told = history.clone().in_axes(arguments.output.axes);
        animation::page_of_run(&scene, &history, &told, arguments.output.angles())
    });
    let exit = results::deliver(context, (&arguments.model, &arguments.output), history, |history| match picture {
        Some(picture) => ride::figure(history, picture),
        None => figure(history, &drawn),
    });
    context.console.complain(&ended.unwrap_or_default());
    if let (Ok(_), Some(path), Some(page)) = (&exit, &arguments.animate, page) {
        animation::write(context, path, &page?)?;
    }
    exit
}

/// A positive quantity behind an option.
pub(super) fn positive<D: Dimensioned>(option: &str, text: &str) -> Result<f64, Failure> {
    match parse_quantity(text, D::DIMENSION) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(value) => {
            let why = format!("`{value}` is out of range: it must be greater than 0");
            Err(argument(option, text, "out_of_range", why).into())
        }
        Err(e) => Err(argument(option, text, e.code(), e.to_string()).with_hint_from(e.hint()).into()),
    }
}

fn tolerance(text: &str) -> Result<f64, Failure> {
    let value = positive::<Number>("rtol", text)?;
    match (1e-13..=0.1).contains(&value) {
        true => Ok(value),
        false => {
            let why = format!("a relative tolerance of `{value}` is out of range: it must be from 1e-13 to 0.1");
            Err(argument("rtol", text, "out_of_range", why).into())
        }
    }
}

/// Sampling times: whole periods, and the end.
pub(super) fn times(duration: &str, rate: Option<&str>) -> Result<Vec<f64>, Failure> {
    let end = positive::<Time>("duration", duration)?;
    let count = match rate {
        Some(rate) => end * positive::<Frequency>("rate", rate)?,
        None => (end * RATE).max(FEWEST),
    };
    if count > MOST {
        let finding =
            argument("duration", duration, "too_many_points", format!("that is {count:.0} samples; at most {MOST:.0} are accepted"));
        return Err(finding.with_hint("a lower rate, for example `--rate 10Hz`, or a shorter duration").into());
    }
    // a last period that is lost in rounding is none
    let whole = (count * (1.0 - 1e-12)).ceil() as usize;
    Ok((0..whole).map(|k| k as f64 / count * end).chain([end]).collect())
}

/// Histories of some signals, one panel each.
fn figure(history: &History, drawn: &[usize]) -> Result<Figure, Failure> {
    let panels = drawn.iter().map(|&s| {
        let signal = &history.signals[s];
        let shown = Angles::Degrees.show(&signal.unit);
        let values = history.recording.column(s).map_err(unreadable)?;
        let points = history.recording.time().iter().zip(values).map(|(&t, v)| (t, v * shown.factor)).collect();
        let curve = Curve { name: signal.name.clone(), points, markers: Markers::Never, variant: 0 };
        Ok(LinePanel { y: Axis::new(signal.name.clone(), shown.unit), curves: vec![curve] })
    });
    Ok(Figure::Lines(Lines {
        title: format!("Motion of {}", history.model),
        x: Axis::new("time", "s"),
        panels: panels.collect::<Result<_, Failure>>()?,
        bands: Vec::new(),
        variants: Vec::new(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_whole_periods_and_the_end() {
        let count = |duration, rate| times(duration, rate).map(|t| (t.len(), t[1], t[t.len() - 1])).ok();
        assert_eq!(count("5s", None), Some((501, 0.01, 5.0)));
        assert_eq!(count("30ms", None).map(|c| (c.0, c.2)), Some((201, 0.03)));
        assert_eq!(count("1s", Some("3Hz")), Some((4, 1.0 / 3.0, 1.0)));
        assert_eq!(count("1s", Some("2.5Hz")), Some((4, 0.4, 1.0)));
        assert_eq!(count("1s", Some("0.1Hz")), Some((2, 1.0, 1.0)));
        for (duration, rate) in [("0s", None), ("5m", None), ("5s", Some("-1Hz")), ("5s", Some("1GHz")), ("1e9s", None)] {
            assert!(times(duration, rate).is_err(), "{duration} {rate:?}");
        }
    }
}
