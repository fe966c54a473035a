//! Plans of steady states: which signals of a vehicle are given and which are found.
//!
//! The analyses know signals, not vehicles. Here the options of `trim` become roles of signals: `--speed` is the forward speed
//! of the base point, `--lean` the roll, and so on (all of the base point: road level below the rear axle in the design pose).

mod options;

pub use options::{SteadyArguments, TrimArguments};

use crate::Failure;
use crate::arguments::{argument, unknown_name};
use crate::base::{base_name, base_of, stands};
use crate::incline::Incline;
use analyses::trim::{Role, Trim};
use mbody::description::finding::Finding;
use mbody::description::quantity::{Dimension, QuantityError, parse_quantity};
use mbody::dynamics::System;
use problem::{Plant, UnknownKind};
use std::sync::Arc;

/// How the turn is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Roll.
    Lean,
    /// Speed times yaw rate.
    LateralAcceleration,
    /// Yaw rate over speed.
    Curvature,
    /// Inverse of the curvature.
    Radius,
    /// Yaw rate.
    YawRate,
    /// Steering torque, lean to be found.
    SteerTorque,
}

/// One prescribed quantity and its values.
#[derive(Clone, Debug)]
pub struct Prescribed {
    /// Name in reports.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Values, SI.
    pub values: Vec<f64>,
}

/// The options as values; the default asks for the static pose.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Speeds; none: static.
    pub speed: Option<Prescribed>,
    /// Turn; none: straight.
    pub turn: Option<(Turn, Prescribed)>,
    /// Accelerations.
    pub acceleration: Option<Prescribed>,
    /// Share of the front brake.
    pub front_brake_share: f64,
    /// Top speed wanted.
    pub top_speed: bool,
    /// How the road is inclined.
    pub incline: Incline,
    /// `SIGNAL`, formula.
    pub given: Vec<(String, String)>,
    /// Signal, guess.
    pub free: Vec<(String, Option<f64>)>,
}

/// First guess of the heave at rest, m: tires that merely touch the road carry nothing, and a vehicle that they do not carry would
/// find its balance on one wheel.
const FIRST_HEAVE: f64 = -0.01;

/// Slip beyond which a first guess of a spin may be past the peak of the friction, from where Newton's method does not come back.
const MOST_SLIP: f64 = 0.05;

/// States of tires that are zero where a vehicle stands upright.
const LATERAL_STATES: [&str; 3] = [".carcass_lateral", ".lagged_lateral_force", ".lagged_lateral_slip"];

/// Braking that is easy at every speed, m/s².
const EASY_BRAKING: f64 = -3.0;

/// Straight running at the same speed, braking as far as that is easy.
fn easy(goals: &[f64], braking: f64) -> Vec<f64> {
    let of = |(i, &goal): (usize, &f64)| match i {
        0 => goal,
        2 => goal.clamp(braking, 0.0),
        _ => 0.0,
    };
    goals.iter().enumerate().map(of).collect()
}

/// Who drives: the engine or the brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// `drive.torque` is found.
    Engine,
    /// The brake torques are found, split by the front share.
    Brakes,
}

/// A trim with its goals in the order speed, turn, acceleration (those that are there).
#[derive(Debug)]
pub struct Plan {
    /// Roles and conditions.
    pub trim: Trim,
    /// Values of the goals at an easy start: straight running at the same speed.
    pub easy: fn(&[f64]) -> Vec<f64>,
    /// Largest steps of the goals.
    pub largest_steps: Vec<f64>,
    /// Angle by which the road rises, rad: a vehicle noses up by it.
    pub uphill: f64,
}

impl Plan {
    /// Takes the height of the design pose for the first guess: right for vehicles that rest in it.
    pub fn start_at_design_height(&mut self, plant: &dyn Plant) {
        if let Some(base) = base_name(plant) {
            self.trim.guess(&format!("{base}.heave"), 0.0);
        }
    }

    /// Takes the first guess of the shape (non-cyclic coordinates) from a known pose: the unknowns of the system there. Where wheels stand much higher or lower in it than in the
    /// design pose, the guesses of their spins follow.
    pub fn start_from(&mut self, system: &System, pose: &[f64], speed: f64) {
        let moved = |((joint, height), (_, design)): (_, (_, f64))| {
            let (joint, height): (&str, f64) = (joint, height);
            ((height - design).abs() > MOST_SLIP * design.abs()).then_some((joint, height))
        };
        let heights = system.heights(pose.iter().copied()).into_iter().zip(system.design_heights());
        guess_spins(&mut self.trim, heights.filter_map(moved).collect(), speed);
        let pitch = format!("{}.pitch", base_of(system.unknowns()).unwrap_or_default());
        for (unknown, &value) in system.unknowns().iter().zip(pose) {
            if unknown.kind == UnknownKind::Position && !unknown.cyclic {
                let nose_up = if unknown.signal.name == pitch { self.uphill } else { 0.0 };
                self.trim.guess(&unknown.signal.name, value - nose_up);
            }
        }
    }
}

fn fix_if_there(trim: &mut Trim, name: &str, value: f64) -> Result<(), Failure> {
    if trim.role(name).is_some() {
        trim.give(name, value)?;
    }
    Ok(())
}

fn free_if_there(trim: &mut Trim, name: &str, guess: f64) -> Result<(), Failure> {
    if trim.role(name).is_some() {
        trim.free(name, guess)?;
    }
    Ok(())
}

impl Request {
    /// How many quantities take several values.
    pub fn swept(&self) -> usize {
        let prescribed = self.speed.iter().chain(self.turn.as_ref().map(|t| &t.1)).chain(self.acceleration.as_ref());
        prescribed.filter(|p| p.values.len() > 1).count()
    }

    /// The static pose: everything at rest, upright, no lateral deflection.
    ///
    /// A vehicle that stands on its wheels finds its roll. Its wheels may lean a little and push to the side, and a tire at rest has no friction but that of
    /// slip: what holds it in place is a creep of some micrometers a second, in all directions, against the rolling resistance.
    pub fn at_rest(&self, plant: &dyn Plant) -> Result<Plan, Failure> {
        let stands = stands(plant);
        let mut trim = if stands { Trim::steady(plant) } else { Trim::at_rest(plant) };
        if let Some(base) = base_name(plant) {
            if !stands {
                fix_if_there(&mut trim, &format!("{base}.roll"), 0.0)?;
            }
            trim.guess(&format!("{base}.heave"), FIRST_HEAVE);
        }
        if stands {
            free_if_there(&mut trim, "steer.torque", 0.0)?;
        }
        fix_if_there(&mut trim, "steer.angle", 0.0)?;
        for unknown in plant.unknowns().iter().filter(|_| !stands) {
            let name = &unknown.signal.name;
            if unknown.kind == UnknownKind::State && LATERAL_STATES.iter().any(|state| name.ends_with(state)) {
                fix_if_there(&mut trim, name, 0.0)?;
            }
        }
        self.wishes(&mut trim)?;
        Ok(Plan { trim, easy: |goals| goals.to_vec(), largest_steps: Vec::new(), uphill: 0.0 })
    }

    /// Steady motion on the road.
    ///
    /// Goals in this order: forward speed (unless top speed is wanted), turn, acceleration.
    pub fn moving(&self, plant: &dyn Plant, system: &Arc<System>, drive: Drive, speed: f64) -> Result<Plan, Failure> {
        let Some(base) = base_name(plant) else {
            let finding = Finding::error("no_vehicle_base", "this model has no vehicle base, so it has no speed along a road");
            return Err(finding.with_hint("without `--speed` its static pose is found; a vehicle has `base: vehicle_base`").into());
        };
        let mut trim = Trim::steady(plant);
        let (v, r) = (format!("{base}.forward_speed"), format!("{base}.yaw_rate"));
        guess_spins(&mut trim, system.design_heights(), speed);
        free_if_there(&mut trim, "steer.torque", 0.0)?;
        match drive {
            Drive::Engine => free_if_there(&mut trim, "drive.torque", 50.0)?,
            Drive::Brakes => self.brakes(&mut trim)?,
        }
        let mut largest_steps = Vec::new();
        if self.top_speed {
            trim.free(&v, speed)?;
            if trim.variables().find("engine.throttle").is_none() {
                let finding = Finding::error("missing_engine", "this model has no signal `engine.throttle`, so it has no top speed");
                return Err(finding.with_hint("a top speed needs an element `engine` of the kind `engine` with a torque map").into());
            }
            trim.demand("engine.throttle", 1.0, 1.0)?;
            largest_steps.push(1.0);
        } else {
            trim.give(&v, speed)?;
            largest_steps.push(10.0);
        }
        let at = speed.max(1.0);
        // straight on: upright where the lean is chosen, without yaw rate where it is found
        let straight = if stands(plant) { Turn::YawRate } else { Turn::Lean };
        match self.turn.as_ref().map_or(straight, |t| t.0) {
            Turn::Lean => {
                trim.give(&format!("{base}.roll"), 0.0)?;
                largest_steps.push(0.18);
            }
            Turn::LateralAcceleration => {
                trim.demand(&format!("{v} * {r}"), 0.0, 1.0)?;
                largest_steps.push(2.0);
            }
            Turn::Curvature | Turn::Radius => {
                trim.demand(&format!("{r} / {v}"), 0.0, 1.0 / (at * at))?;
                largest_steps.push(2.0 / (at * at));
            }
            Turn::YawRate => {
                trim.give(&r, 0.0)?;
                largest_steps.push(2.0 / at);
            }
            Turn::SteerTorque => {
                trim.give("steer.torque", 0.0)?;
                largest_steps.push(1.0);
            }
        }
        if self.acceleration.is_some() {
            trim.accelerate(&v, 0.0)?;
            largest_steps.push(3.0);
        }
        if self.incline != Incline::default() {
            self.incline.lay(&mut trim, system, &base, self.acceleration.is_some())?;
        }
        self.wishes(&mut trim)?;
        // brakes that push against the drag of a fast vehicle would ask too much of the front tire
        let easy: fn(&[f64]) -> Vec<f64> = match drive {
            Drive::Engine => |goals| easy(goals, 0.0),
            Drive::Brakes => |goals| easy(goals, EASY_BRAKING),
        };
        Ok(Plan { trim, easy, largest_steps, uphill: self.incline.grade.atan() })
    }

    /// Brake torques are found, the engine is off.
    fn brakes(&self, trim: &mut Trim) -> Result<(), Failure> {
        let p = self.front_brake_share;
        let (lead, other, ratio) = match p > 0.5 {
            true => ("front_brake.torque", "rear_brake.torque", (1.0 - p) / p),
            false => ("rear_brake.torque", "front_brake.torque", p / (1.0 - p)),
        };
        if trim.role(lead).is_none() || trim.role(other).is_none() {
            let message = "this model has no inputs `front_brake.torque` and `rear_brake.torque` to brake with";
            return Err(Finding::error("missing_input", message).into());
        }
        trim.free(lead, 0.0)?;
        Ok(trim.tie(other, &format!("{ratio} * {lead}"))?)
    }

    /// `--given` and `--free`.
    fn wishes(&self, trim: &mut Trim) -> Result<(), Failure> {
        let known = |trim: &Trim, option: &str, name: &String| match trim.variables().find(name) {
            Some(_) => Ok(()),
            None => Err(Failure::from(unknown_name(option, name, ("signal", name), trim.variables().names()))),
        };
        for (name, formula) in &self.given {
            known(trim, "given", name)?;
            match formula.parse::<f64>() {
                Ok(value) => {
                    trim.give(name, value)?;
                }
                Err(_) => self.given_formula(trim, name, formula)?,
            }
        }
        for (name, guess) in &self.free {
            known(trim, "free", name)?;
            let guess = guess.or_else(|| match trim.role(name) {
                Some(Role::Fixed(x) | Role::Unknown(x)) => Some(*x),
                _ => None,
            });
            trim.free(name, guess.unwrap_or(0.0))?;
        }
        Ok(())
    }

    /// A value with a unit, or a formula of signals.
    fn given_formula(&self, trim: &mut Trim, name: &str, formula: &str) -> Result<(), Failure> {
        let unit = trim.variables().find(name).map(|v| trim.variables().unit(v));
        let dimension = unit.as_deref().and_then(Dimension::of_unit);
        match dimension.map(|d| parse_quantity(formula, d)) {
            Some(Ok(value)) => {
                trim.give(name, value)?;
                return Ok(());
            }
            // a formula is no quantity of whatever dimension
            Some(Err(e @ QuantityError::WrongDimension { .. })) => {
                let finding = argument("given", &format!("{name}={formula}"), e.code(), e.to_string());
                return Err(finding.with_hint_from(e.hint()).into());
            }
            _ => {}
        }
        if trim.role(name).is_none() && trim.variables().find(name).is_some() {
            trim.demand(&format!("{name} - ({formula})"), 0.0, 1.0)?;
            return Ok(());
        }
        Ok(trim.tie(name, formula)?)
    }
}

/// First guesses of the spin rates: forward speed over the height of the wheel center.
fn guess_spins(trim: &mut Trim, heights: Vec<(&str, f64)>, speed: f64) {
    for (joint, height) in heights {
        if height > 0.05 {
            trim.guess(&format!("{joint}.spin_rate"), speed / height);
        }
    }
}
