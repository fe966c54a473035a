//! A motion over time from options: where it starts, which inputs act, which method follows it, and what is told about it.

mod account;
mod acting;
mod condition;
mod start;
mod table;

use crate::Failure;
use crate::arguments::{argument, unknown_name};
use crate::backend::{self, Integrator};
use crate::interrupt::Interrupt;
use crate::maneuver::Ride;
use crate::output::{History, Kept, Outcome, Progress, Tape, small, unreadable};
use crate::plan;
use crate::trust;
pub use account::{DISSIPATED, ENERGY, SUPPLIED};
use analyses::transient::{Cause, Method, Sample, Simulation, Start, Transient, TransientEnding, TransientError};
use analyses::{ClosedLoop, Variable, Variables};
use mbody::description::finding::Finding;
use mbody::dynamics::{Formulation, System, TreePlant};
use problem::{Dae, Derivatives, Flow, IntegrationOptions, Limit, LinearSolver, Off, Plant, Side, Signal, UnknownKind};
use start::Beginning;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Rate at which an error of the constraints decays in the formulation of accelerations, 1/s.
const DECAY: f64 = 10.0;
/// Average step below which a motion is given up, s, and steps that are allowed in any case.
const SHORTEST_STEP: f64 = 5e-6;
const FEWEST_STEPS: usize = 2000;
/// Length of the steps of methods whose steps are all alike, s, where nobody says otherwise: that of many simulators.
pub const USUAL_STEP: f64 = 1e-3;
/// The relative tolerance at which absolute tolerances are those that the signals declare.
const USUAL_TOLERANCE: f64 = 1e-6;
/// How many coordinates and velocities table and figure show of a mechanism, where the user does not choose.
const SHOWN: usize = 7;
/// What they show of a vehicle.
const VEHICLE: [&str; 10] = [
    "chassis.forward_speed",
    "chassis.roll",
    "chassis.roll_rate",
    "chassis.yaw_rate",
    "steer.angle",
    "front_tire.normal_force",
    "front_left_tire.normal_force",
    "front_right_tire.normal_force",
    "rear_tire.normal_force",
    "side_tire.normal_force",
];

/// The formulations on offer; the first is the default.
pub const FORMULATIONS: &[Formulation] = &[Formulation::Ggl, Formulation::Velocity, Formulation::Acceleration { decay: DECAY }];

/// What is to be computed.
#[derive(Clone, Debug)]
pub struct Request {
    /// Sampling times, s; the last is the goal.
    pub times: Vec<f64>,
    /// Relative tolerance.
    pub relative_tolerance: f64,
    /// Name of the backend.
    pub backend: String,
    /// Name of the formulation, where one is wanted.
    pub formulation: Option<String>,
    /// Where matrices come from.
    pub derivatives: Derivatives,
    /// What solves the linear equations of a step, where the method knows several.
    pub linear_solver: LinearSolver,
    /// Length of the steps of methods whose steps are all alike, s.
    pub fixed_step: f64,
    /// The steady state to start from, where one is wanted.
    pub steady: Option<plan::Request>,
    /// `SIGNAL=VALUE` as typed: replaces values of the start, and inputs.
    pub given: Vec<String>,
    /// Table of inputs over time.
    pub signals: Option<PathBuf>,
    /// `SIGNAL>VALUE` or `SIGNAL<VALUE` as typed: ends the motion.
    pub until: Vec<String>,
    /// What may ask for the end on the way.
    pub interrupt: Option<&'static Interrupt>,
    /// Signals to be recorded; none: all.
    pub record: Vec<String>,
    /// Signals to be kept for an animation beside the coordinates, where they exist; `None` where there is no animation.
    pub keep: Option<Vec<String>>,
}

/// What is recorded.
struct Recorded {
    variables: Vec<Variable>,
    /// Places of energy and powers among them, where they are wanted, in the order of places.
    accounts: Vec<(usize, usize)>,
}

/// A tree under the command of whoever rides it.
type Ridden = ClosedLoop<TreePlant>;

/// Follows the motion, ridden or not.
///
/// # Errors
/// The input is wrong, or the start cannot satisfy the constraints; a motion that ends early is no error.
pub fn run(request: &Request, system: &Arc<System>, model: &str, ride: Option<Ride>) -> Result<History, Failure> {
    let Some(backend) = backend::integration(&request.backend) else {
        let known = backend::INTEGRATION.iter().map(|b| b.name);
        return Err(unknown_name("backend", &request.backend, ("backend", &request.backend), known).into());
    };
    let explicit = matches!(backend.make, Integrator::Explicit(_));
    let formulation = formulation(request.formulation.as_deref())?;
    let mut warnings = Vec::new();
    if explicit && request.formulation.is_some() {
        warnings.push(format!("`{}` takes the explicit form; `--formulation` changes nothing", backend.name));
    }
    if request.linear_solver != LinearSolver::Direct && !backend.linear_solvers.contains(&request.linear_solver) {
        let why = if backend.linear_solvers.is_empty() { "solves no linear equations" } else { "factorizes its matrices" };
        warnings.push(format!("`{}` {why}; `--linear-solver` changes nothing", backend.name));
    }
    // all levels of the constraints stand in the rows of GGL, so the explicit form is judged by them
    let tree = TreePlant::in_formulation(system.clone(), if explicit { Formulation::Ggl } else { formulation });
    let Ride { controllers, inputs, longest_step: max_step, end, ends, warnings: of_ride } = ride.unwrap_or_default();
    warnings.extend(of_ride);
    let mut plant = ClosedLoop::new(tree, controllers).map_err(|e| Finding::error("signal_clash", e.to_string()))?;
    let mut beginning = match &request.steady {
        Some(steady) => Beginning::steady(&plant, steady, system)?,
        None => Beginning::stated(&plant),
    };
    acting::act(&inputs, &plant, &mut beginning.inputs)?;
    if let Some(file) = &request.signals {
        table::act(file, &plant, &[ENERGY, SUPPLIED, DISSIPATED], &mut beginning.inputs)?;
    }
    beginning.give(&request.given, &plant)?;
    let recorded = recorded(&request.record, &plant, system)?;
    let mut transient = Transient::new(&plant, request.times.iter().copied().filter(|t| *t <= end).collect());
    transient.options = IntegrationOptions {
        relative_tolerance: request.relative_tolerance,
        absolute_tolerance_factor: request.relative_tolerance / USUAL_TOLERANCE,
        max_step,
        fixed_step: request.fixed_step,
        derivatives: request.derivatives,
        linear_solver: request.linear_solver,
        max_steps: most_steps(&transient.times),
        ..IntegrationOptions::default()
    };
    // of multipliers that stabilize, rounding leaves no more than their declared tolerance
    transient.algebraic_factor = Some((request.relative_tolerance / USUAL_TOLERANCE).max(1.0));
    transient.ends = condition::conditions(&request.until, &plant)?;
    transient.ends.extend(ends);
    transient.breaks = plant.breaks();
    let n = system.unknowns().len();
    // what is commanded is an output of the whole
    let names = Variables::of(&plant);
    let commanded = system.inputs().iter().map(|i| names.find(&i.signal.name).unwrap_or(Variable::Input(0)));
    let rates = (0..n).map(Variable::Rate).chain(commanded);
    let moving: Vec<Variable> = (0..n).map(Variable::Unknown).chain(rates).collect();
    let beside = beside(request.keep.as_deref(), &plant);
    // the tape keeps what is recorded, each variable once
    transient.record.clear();
    let mut taped = Vec::new();
    let [of_motion, told_columns, kept_columns] = [&moving, &recorded.variables, &beside].map(|wanted| places(wanted, &mut taped));
    let began = Instant::now();
    let (simulation, tape, full) =
        follow(&mut transient, &mut plant, &beginning, &taped, (&backend.make, request.interrupt), &mut warnings)?;
    let wall = began.elapsed().as_secs_f64();
    let all = tape.finish();
    if let Some(near) = simulation.near_singular {
        warnings.push(format!(
            "at {:.4} s the mechanism is near a singular position (constraints are {:.1e} as independent as at the start): what follows may be another branch of the \
             motion; compare tolerances, and look at `{ENERGY}`",
            near.time, near.independence
        ));
    }
    let mut accounts = account::account(&all.pick(of_motion.iter().copied()), system).map_err(unreadable)?;
    let signal = |&v: &Variable| names.signal(v);
    let kept = match request.keep {
        Some(_) => Kept {
            signals: moving.iter().chain(&beside).map(signal).collect(),
            recording: all.pick(of_motion.into_iter().chain(kept_columns)),
        },
        None => Kept::default(),
    };
    let (mut signals, mut recording): (Vec<Signal>, _) = (recorded.variables.iter().map(signal).collect(), all.pick(told_columns));
    for &(at, which) in &recorded.accounts {
        signals.insert(at, account::signals()[which].clone());
        recording.insert(at, std::mem::take(&mut accounts.columns[which]));
    }
    warnings.extend(trust::left(system, &signals, |k| recording.column(k)).map_err(unreadable)?);
    let (condition, because) = match full {
        Some(cause) => (None, Some(unreadable(cause).to_string())),
        None => told(&simulation.ending, &transient.ends),
    };
    let shown = if request.record.is_empty() { shown(&signals, &plant) } else { (0..signals.len()).collect() };
    Ok(History {
        model: model.to_owned(),
        axes: Default::default(),
        given: beginning.told,
        signals,
        shown,
        recording,
        outcome: Outcome {
            backend: backend.name,
            formulation: if explicit { "explicit" } else { formulation.name() },
            relative_tolerance: request.relative_tolerance,
            ending: simulation.ending.name().to_owned(),
            because,
            condition,
            duration: request.times.last().copied().unwrap_or_default(),
            statistics: simulation.statistics,
            wall,
            drift: accounts.drift,
            limits: simulation.limits,
            crossings: simulation.crossings,
        },
        kept,
        warnings,
    })
}

/// Columns of the tape for variables, which are added where it does not have them yet.
fn places(wanted: &[Variable], taped: &mut Vec<Variable>) -> Vec<usize> {
    let place = |variable: &Variable| {
        taped.iter().position(|t| t == variable).unwrap_or_else(|| {
            taped.push(*variable);
            taped.len() - 1
        })
    };
    wanted.iter().map(place).collect()
}

/// Signals kept beside the recorded ones.
fn beside(keep: Option<&[String]>, plant: &Ridden) -> Vec<Variable> {
    let names = Variables::of(plant);
    keep.unwrap_or_default().iter().filter_map(|name| names.find(name)).collect()
}

/// Most steps between two samples: what takes more has steps of some microseconds and will not end.
fn most_steps(times: &[f64]) -> usize {
    let longest = times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    (longest / SHORTEST_STEP) as usize + FEWEST_STEPS
}

fn formulation(name: Option<&str>) -> Result<Formulation, Failure> {
    let Some(name) = name else { return Ok(FORMULATIONS[0]) };
    let known = || FORMULATIONS.iter().map(|f| f.name());
    let found = FORMULATIONS.iter().copied().find(|f| f.name() == name);
    found.ok_or_else(|| unknown_name("formulation", name, ("formulation", name), known()).into())
}

/// The condition that ended a motion, and the cause where that was not asked for.
fn told(ending: &TransientEnding, ends: &[Limit]) -> (Option<String>, Option<String>) {
    match ending {
        TransientEnding::Reached => (None, None),
        TransientEnding::Failed { cause } => (None, Some(because(cause))),
        TransientEnding::Stopped => (None, Some("it was interrupted".to_owned())),
        TransientEnding::Met { name, signal, threshold } => {
            let met = ends.iter().find(|l| l.name == *name && l.signal == *signal && l.threshold == *threshold);
            let sign = if met.is_some_and(|l| l.side == Side::Below) { "<" } else { ">" };
            let passed = format!("`{signal}` {sign} {threshold:.6}");
            let cause =
                (name != condition::UNTIL && name != crate::maneuver::GOAL).then(|| format!("{}: {passed}", met.map_or("", |l| &l.about)));
            (Some(passed), cause)
        }
    }
}

/// Everything but the multipliers that only stabilize, or what `--record` names.
fn recorded(record: &[String], plant: &Ridden, system: &System) -> Result<Recorded, Failure> {
    let beside = account::signals();
    if record.is_empty() {
        // between the unknowns of the system and the states of who rides
        let stabilizing = system.unknowns().len()..plant.plant().unknowns().len();
        let all = analyses::transient::everything(plant).into_iter();
        let variables: Vec<Variable> = all.filter(|v| !matches!(v, Variable::Unknown(i) if stabilizing.contains(i))).collect();
        let accounts = (0..beside.len()).map(|k| (variables.len() + k, k)).collect();
        return Ok(Recorded { variables, accounts });
    }
    let names = Variables::of(plant);
    let mut recorded = Recorded { variables: Vec::new(), accounts: Vec::new() };
    for (k, name) in record.iter().enumerate() {
        if record[..k].contains(name) {
            return Err(argument("record", name, "given_twice", format!("`{name}` is recorded twice")).into());
        }
        match (names.find(name), beside.iter().position(|s| s.name == *name)) {
            (Some(variable), _) => recorded.variables.push(variable),
            (None, Some(which)) => recorded.accounts.push((k, which)),
            (None, None) => {
                let known = names.names().into_iter().chain(beside.iter().map(|s| s.name.as_str()));
                return Err(unknown_name("record", name, ("signal", name), known).into());
            }
        }
    }
    Ok(recorded)
}

/// Runs it from a start that has all stated and all given values; where these do not go together, from the given ones alone.
fn follow(
    transient: &mut Transient,
    plant: &mut Ridden,
    beginning: &Beginning,
    taped: &[Variable],
    (make, interrupt): (&Integrator, Option<&Interrupt>),
    warnings: &mut Vec<String>,
) -> Result<(Simulation, Tape, Option<io::Error>), Failure> {
    let stated = beginning.start.clone();
    transient.start = stated.clone();
    for &(i, value) in &beginning.given {
        (transient.start.y[i], transient.start.held[i]) = (value, true);
    }
    let run = |transient: &Transient, plant: &mut Ridden| {
        let progress = Progress::new("run", transient.times.len());
        let (mut tape, mut full) = (Tape::new(taped.len()), None);
        let mut watcher = |sample: &Sample<'_>| {
            progress.advance();
            if full.is_none() {
                full = tape.push(sample.time, taped.iter().map(|&v| sample.value(v))).err();
            }
            if full.is_some() || interrupt.is_some_and(Interrupt::is_set) { Flow::Stop } else { Flow::Continue }
        };
        let run = match make {
            Integrator::Implicit(make) => transient.run_watched(plant, &beginning.inputs, Method::Dae(make().as_mut()), &mut watcher),
            Integrator::Explicit(make) => transient.run_watched(plant, &beginning.inputs, Method::Ode(make().as_mut()), &mut watcher),
        };
        run.map(|simulation| (simulation, tape, full))
    };
    let mut tried = run(transient, plant);
    let open = |e: &TransientError| matches!(e, TransientError::Open { .. } | TransientError::Velocity { .. });
    if !beginning.given.is_empty() && tried.as_ref().is_err_and(open) {
        let mut released = stated.clone();
        released.hold(plant, &beginning.given);
        let left: Vec<usize> = (0..stated.held.len()).filter(|&i| stated.held[i] && !released.held[i]).collect();
        if !left.is_empty() {
            transient.start = released;
            tried = run(transient, plant);
            let names = left.iter().map(|&i| format!("`{}`", plant.unknowns()[i].signal.name)).collect::<Vec<_>>().join(", ");
            warnings.push(format!("`start` of the description does not go with what is given; it was left for {names}"));
        }
    }
    tried.map_err(|error| cannot_start(&error, plant, &transient.start, beginning).into())
}

/// Why a motion cannot start, with rows in mm and degrees and with what is held.
fn cannot_start(error: &TransientError, plant: &dyn Plant, start: &Start, beginning: &Beginning) -> Finding {
    let (what, kind, rows) = match error {
        TransientError::Open { rows } => ("coordinates", UnknownKind::Position, rows),
        TransientError::Velocity { rows } => ("velocities", UnknownKind::Velocity, rows),
        TransientError::Times => return Finding::error("bad_range", error.to_string()),
        TransientError::UnknownSignal { .. } => return Finding::error("unknown_signal", error.to_string()),
        TransientError::NotFinite { .. } => {
            return Finding::error("not_finite", error.to_string()).with_hint("give other start values with `--given SIGNAL=VALUE`");
        }
    };
    let held: Vec<String> = (0..start.held.len())
        .filter(|&i| start.held[i] && plant.unknowns()[i].kind == kind)
        .map(|i| {
            let whence = if beginning.given.iter().any(|&(g, _)| g == i) { "--given" } else { "start" };
            format!("`{}` ({whence})", plant.unknowns()[i].signal.name)
        })
        .collect();
    let hint = match held.is_empty() {
        true => "give a start nearer to a closed pose with `--given SIGNAL=VALUE`".to_owned(),
        false => format!("start values are held: {}; leave one out, or check the lengths", held.join(", ")),
    };
    Finding::error("open_start", format!("the {what} of the start cannot satisfy the constraints: {}", violated(rows))).with_hint(hint)
}

/// Rows in mm and degrees.
fn violated(rows: &[Off]) -> String {
    let row = |off: &Off| {
        let shown = small(&off.unit);
        format!("`{}` is off by {:.4} {}", off.row, off.by.abs() * shown.factor, shown.unit)
    };
    match rows {
        [] => "no row is known".to_owned(),
        rows => rows.iter().map(row).collect::<Vec<_>>().join(", "),
    }
}

/// Why a motion ended early.
fn because(cause: &Cause) -> String {
    match cause {
        Cause::Open { rows } => format!("the motion leaves the constraints; {}", violated(rows)),
        other => other.to_string(),
    }
}

/// A handful of the recorded signals: those of a vehicle, or coordinates that are not cyclic and velocities; the energy.
fn shown(signals: &[Signal], plant: &dyn Plant) -> Vec<usize> {
    let find = |name: &str| signals.iter().position(|s| s.name == name);
    let mut shown: Vec<usize> = VEHICLE.iter().filter_map(|name| find(name)).collect();
    if shown.len() < 3 {
        let of = |kind, cyclic: bool| {
            plant.unknowns().iter().filter(move |u| u.kind == kind && !(cyclic && u.cyclic)).filter_map(|u| find(&u.signal.name))
        };
        let (coordinates, velocities): (Vec<_>, Vec<_>) =
            (of(UnknownKind::Position, true).collect(), of(UnknownKind::Velocity, false).collect());
        let room = SHOWN - velocities.len().min(3);
        shown = coordinates.into_iter().take(room).collect();
        shown.extend(velocities.into_iter().take(SHOWN - shown.len()));
    }
    shown.extend(find(ENERGY));
    shown
}
