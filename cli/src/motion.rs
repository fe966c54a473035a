//! A motion over time from options: where it starts, which inputs act, which method follows it, and what is told about it.

use crate::Failure;
use crate::arguments::{argument, unknown_name};
use crate::backend::{self, Integrator};
use crate::output::{Given, History, Outcome, small};
use analyses::transient::{
    Cause, Constant, Drift, Method, Simulation, Start, Trajectory, Transient, TransientEnding, TransientError, Worst,
};
use analyses::{Variable, Variables};
use mbody::description::finding::Finding;
use mbody::description::quantity::{Dimension, Dimensioned, dimension::Number, parse_quantity};
use mbody::dynamics::{Formulation, System, TreePlant};
use problem::{At, Dae, EquationKind, IntegrationOptions, Off, Outputs, Plant, Signal, UnknownKind};
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// Rate at which an error of the constraints decays in the formulation of accelerations, 1/s.
const DECAY: f64 = 10.0;
/// The relative tolerance at which absolute tolerances are those that the signals declare.
const USUAL_TOLERANCE: f64 = 1e-6;
/// The total energy, beside the signals of the plant.
pub const ENERGY: &str = "system.energy";
/// What table and figure show of a vehicle, where the user does not choose.
const VEHICLE: [&str; 7] = [
    "chassis.forward_speed",
    "chassis.roll",
    "chassis.roll_rate",
    "chassis.yaw_rate",
    "steer.angle",
    "front_tire.normal_force",
    "rear_tire.normal_force",
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
    /// `SIGNAL=VALUE` as typed.
    pub given: Vec<String>,
    /// Signals to be recorded; none: all.
    pub record: Vec<String>,
    /// Signals to be kept for an animation beside the coordinates, where they exist; `None` where there is no animation.
    pub keep: Option<Vec<String>>,
}

/// What `--given` says.
struct GivenValues {
    unknowns: Vec<(usize, f64)>,
    inputs: Constant,
    told: Vec<(Given, f64)>,
}

/// What is recorded.
struct Recorded {
    variables: Vec<Variable>,
    /// Place of the energy among them, where it is wanted.
    energy: Option<usize>,
}

/// Follows the motion.
///
/// # Errors
/// The input is wrong, or the start cannot satisfy the constraints; a motion that ends early is no error.
pub fn run(request: &Request, system: &Arc<System>, model: &str) -> Result<History, Failure> {
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
    // all levels of the constraints stand in the rows of GGL, so the explicit form is judged by them
    let mut plant = TreePlant::in_formulation(system.clone(), if explicit { Formulation::Ggl } else { formulation });
    let given = given(&request.given, &plant)?;
    let recorded = recorded(&request.record, &plant, system)?;
    let n = system.unknowns().len();
    let mut transient = Transient::new(&plant, request.times.clone());
    transient.options = IntegrationOptions {
        relative_tolerance: request.relative_tolerance,
        absolute_tolerance_factor: absolute_factor(request.relative_tolerance, explicit),
        ..IntegrationOptions::default()
    };
    let beside = beside(request.keep.as_deref(), &plant);
    transient.record = (0..n).map(Variable::Unknown).chain(recorded.variables.iter().chain(&beside).copied()).collect();
    let began = Instant::now();
    let simulation = follow(&mut transient, &mut plant, &given, &backend.make, &mut warnings)?;
    let wall = began.elapsed().as_secs_f64();
    if let Some(near) = simulation.near_singular {
        warnings.push(format!(
            "at {:.4} s the mechanism is near a singular position (constraints are {:.1e} as independent as at the start): what follows may be another branch of the \
             motion; compare tolerances, and look at `{ENERGY}`",
            near.time, near.independence
        ));
    }
    let (energy, drift) = account(&simulation, system, &given.inputs.0);
    let told = n..n + recorded.variables.len();
    let mut signals = simulation.trajectory.signals[told.clone()].to_vec();
    let mut columns = simulation.trajectory.columns[told.clone()].to_vec();
    let kept = if request.keep.is_some() { kept(&simulation.trajectory, told) } else { Trajectory::default() };
    if let Some(at) = recorded.energy {
        signals.insert(at, energy_signal());
        columns.insert(at, energy);
    }
    let (ending, because) = match &simulation.ending {
        TransientEnding::Failed { cause } => (simulation.ending.name(), Some(because(cause))),
        TransientEnding::Reached => (simulation.ending.name(), None),
        other => (other.name(), Some("it was stopped".to_owned())),
    };
    let shown = if request.record.is_empty() { shown(&signals, &plant) } else { (0..signals.len()).collect() };
    Ok(History {
        model: model.to_owned(),
        axes: Default::default(),
        given: given.told,
        signals,
        shown,
        time: simulation.trajectory.time,
        columns,
        outcome: Outcome {
            backend: backend.name,
            formulation: if explicit { "explicit" } else { formulation.name() },
            relative_tolerance: request.relative_tolerance,
            ending,
            because,
            duration: request.times.last().copied().unwrap_or_default(),
            statistics: simulation.statistics,
            wall,
            drift,
            limits: simulation.limits,
        },
        kept,
        warnings,
    })
}

/// Signals kept beside the recorded ones.
fn beside(keep: Option<&[String]>, plant: &TreePlant) -> Vec<Variable> {
    let names = Variables::of(plant);
    keep.unwrap_or_default().iter().filter_map(|name| names.find(name)).collect()
}

/// All of a trajectory but the signals that are told.
fn kept(all: &Trajectory, told: Range<usize>) -> Trajectory {
    fn others<T: Clone>(list: &[T], told: &Range<usize>) -> Vec<T> {
        list[..told.start].iter().chain(&list[told.end..]).cloned().collect()
    }
    Trajectory { time: all.time.clone(), signals: others(&all.signals, &told), columns: others(&all.columns, &told) }
}

/// What multiplies absolute tolerances.
///
/// Those of the implicit form are not tightened: the rounding of a closed loop over a short step is all that a tighter tolerance of the
/// stabilizing multipliers would ask for.
fn absolute_factor(relative_tolerance: f64, explicit: bool) -> f64 {
    let factor = relative_tolerance / USUAL_TOLERANCE;
    if explicit { factor } else { factor.max(1.0) }
}

fn formulation(name: Option<&str>) -> Result<Formulation, Failure> {
    let Some(name) = name else { return Ok(FORMULATIONS[0]) };
    let known = || FORMULATIONS.iter().map(|f| f.name());
    let found = FORMULATIONS.iter().copied().find(|f| f.name() == name);
    found.ok_or_else(|| unknown_name("formulation", name, ("formulation", name), known()).into())
}

/// Values of unknowns and inputs.
fn given(given: &[String], plant: &TreePlant) -> Result<GivenValues, Failure> {
    let variables = Variables::of(plant);
    let mut values = GivenValues { unknowns: Vec::new(), inputs: Constant::defaults(plant), told: Vec::new() };
    for text in given {
        let wrong = |code, why: String| argument("given", text, code, why);
        let Some((name, value)) = text.split_once('=').map(|(n, v)| (n.trim(), v.trim())) else {
            let finding = wrong("bad_argument", "this is not of the form SIGNAL=VALUE".to_owned());
            return Err(finding.with_hint("for example `--given chassis.forward_speed=20m/s`").into());
        };
        let Some(variable) = variables.find(name) else {
            return Err(unknown_name("given", text, ("signal", name), variables.names()).into());
        };
        let unit = variables.unit(variable);
        let value = quantity(value, &unit).map_err(|(code, why, hint)| Failure::from(wrong(code, why).with_hint_from(hint)))?;
        match variable {
            Variable::Unknown(i) if plant.unknowns()[i].differential => match values.unknowns.iter_mut().find(|(u, _)| *u == i) {
                Some(_) => return Err(wrong("given_twice", format!("`{name}` is given twice")).into()),
                None => values.unknowns.push((i, value)),
            },
            Variable::Input(i) => values.inputs.0[i] = value,
            _ => {
                let finding = wrong("wrong_role", format!("`{name}` follows from the others, so it has no start value"));
                return Err(finding.with_hint("coordinates, velocities, states and inputs can be given; see `fastbike info MODEL`").into());
            }
        }
        values.told.push((Given::new(name, unit), value));
    }
    Ok(values)
}

/// A value with an optional unit, in the unit of a signal.
fn quantity(text: &str, unit: &str) -> Result<f64, (&'static str, String, Option<String>)> {
    let unit = unit.replace("^2", "²").replace("^3", "³");
    let dimension = if unit == "-" { Some(Number::DIMENSION) } else { Dimension::of_unit(&unit) };
    match dimension {
        Some(dimension) => parse_quantity(text, dimension).map_err(|e| (e.code(), e.to_string(), e.hint())),
        // a unit without a name of its own: a bare number
        None => match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(("bad_number", format!("`{text}` is not a number"), Some(format!("write a bare number in {unit}")))),
        },
    }
}

fn energy_signal() -> Signal {
    Signal::new(ENERGY, "J", "total energy: of motion, of gravity, stored in elements")
}

/// Everything but the multipliers that only stabilize, or what `--record` names.
fn recorded(record: &[String], plant: &TreePlant, system: &System) -> Result<Recorded, Failure> {
    if record.is_empty() {
        let all = analyses::transient::everything(plant).into_iter();
        let variables: Vec<Variable> = all.filter(|v| !matches!(v, Variable::Unknown(i) if *i >= system.unknowns().len())).collect();
        return Ok(Recorded { energy: Some(variables.len()), variables });
    }
    let names = Variables::of(plant);
    let mut recorded = Recorded { variables: Vec::new(), energy: None };
    for (k, name) in record.iter().enumerate() {
        if record[..k].contains(name) {
            return Err(argument("record", name, "given_twice", format!("`{name}` is recorded twice")).into());
        }
        match names.find(name) {
            Some(variable) => recorded.variables.push(variable),
            None if name == ENERGY => recorded.energy = Some(k),
            None => {
                let known = names.names().into_iter().chain([ENERGY]);
                return Err(unknown_name("record", name, ("signal", name), known).into());
            }
        }
    }
    Ok(recorded)
}

/// Runs it from a start that has all stated and all given values; where these do not go together, from the given ones alone.
fn follow(
    transient: &mut Transient,
    plant: &mut TreePlant,
    given: &GivenValues,
    make: &Integrator,
    warnings: &mut Vec<String>,
) -> Result<Simulation, Failure> {
    let stated = Start::stated(plant);
    for &(i, value) in &given.unknowns {
        (transient.start.y[i], transient.start.held[i]) = (value, true);
    }
    let run = |transient: &Transient, plant: &mut TreePlant| match make {
        Integrator::Implicit(make) => transient.run(plant, &given.inputs, Method::Dae(make().as_mut())),
        Integrator::Explicit(make) => transient.run(plant, &given.inputs, Method::Ode(make().as_mut())),
    };
    let mut tried = run(transient, plant);
    let open = |e: &TransientError| matches!(e, TransientError::Open { .. } | TransientError::Velocity { .. });
    if !given.unknowns.is_empty() && tried.as_ref().is_err_and(open) {
        let mut released = stated.clone();
        released.hold(plant, &given.unknowns);
        let left: Vec<usize> = (0..stated.held.len()).filter(|&i| stated.held[i] && !released.held[i]).collect();
        if !left.is_empty() {
            transient.start = released;
            tried = run(transient, plant);
            let names = left.iter().map(|&i| format!("`{}`", plant.unknowns()[i].signal.name)).collect::<Vec<_>>().join(", ");
            warnings.push(format!("`start` of the description does not go with what is given; it was left for {names}"));
        }
    }
    tried.map_err(|error| cannot_start(&error, plant, &transient.start, given).into())
}

/// Why a motion cannot start, with rows in mm and degrees and with what is held.
fn cannot_start(error: &TransientError, plant: &dyn Plant, start: &Start, given: &GivenValues) -> Finding {
    let (what, kind, rows) = match error {
        TransientError::Open { rows } => ("coordinates", UnknownKind::Position, rows),
        TransientError::Velocity { rows } => ("velocities", UnknownKind::Velocity, rows),
        TransientError::Times => return Finding::error("bad_range", error.to_string()),
        TransientError::NotFinite { .. } => {
            return Finding::error("not_finite", error.to_string()).with_hint("give other start values with `--given SIGNAL=VALUE`");
        }
    };
    let held: Vec<String> = (0..start.held.len())
        .filter(|&i| start.held[i] && plant.unknowns()[i].kind == kind)
        .map(|i| {
            let whence = if given.unknowns.iter().any(|&(g, _)| g == i) { "--given" } else { "start" };
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

/// Total energy at every sample, and the largest errors of the constraints on coordinates and on velocities: in all forms alike.
fn account(simulation: &Simulation, system: &Arc<System>, inputs: &[f64]) -> (Vec<f64>, Drift) {
    let mut plant = TreePlant::in_formulation(system.clone(), Formulation::Ggl);
    let size = plant.unknowns().len();
    let (mut y, still) = (vec![0.0; size], vec![0.0; size]);
    let (mut residual, mut outputs) = (vec![0.0; size], vec![0.0; plant.outputs().len()]);
    let (mut drift, mut energy) = (Drift::default(), Vec::new());
    for (k, &time) in simulation.trajectory.time.iter().enumerate() {
        for (y, column) in y.iter_mut().zip(&simulation.trajectory.columns[..system.unknowns().len()]) {
            *y = column[k];
        }
        let at = At { time, y: &y, yd: &still, u: inputs };
        let account = plant.account_at(at);
        energy.push(account.kinetic + account.gravity + account.elements.stored);
        // accelerations are not known here: only rows of constraints count
        let _ = plant.evaluate(at, &mut residual, &mut outputs);
        for (row, &by) in plant.equations().iter().zip(&residual) {
            let worst = match row.kind {
                EquationKind::Constraint => &mut drift.position,
                EquationKind::VelocityConstraint => &mut drift.velocity,
                _ => continue,
            };
            if by.is_finite() && worst.as_ref().is_none_or(|w: &Worst| by.abs() > w.off.by) {
                let off = Off { row: row.name.clone(), by: by.abs(), unit: row.unit.to_string() };
                *worst = Some(Worst { off, time });
            }
        }
    }
    (energy, drift)
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
        let room = VEHICLE.len() - velocities.len().min(3);
        shown = coordinates.into_iter().take(room).collect();
        shown.extend(velocities.into_iter().take(VEHICLE.len() - shown.len()));
    }
    shown.extend(find(ENERGY));
    shown
}
