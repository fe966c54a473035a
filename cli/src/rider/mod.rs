//! Makes the virtual rider of a maneuver: steady states and linear models over speed and lateral acceleration, a regulator at each, a table of all.
//!
//! The order is: assemble, trim, linearize, gains, rider. Nothing is tuned by hand; what the user may choose is what counts as much as what.

mod driving;

use crate::Failure;
use crate::base::base_name;
use crate::lateral::{self, Steering, steer};
use crate::output::Point;
use crate::output::rider::RiderAlong;
use crate::plan::{Prescribed, Request, Turn};
use crate::small_motions::SmallMotions;
use crate::steady;
use analyses::LinearModel;
use analyses::regulator::{Actuator, Course as Line, Design, Regulator};
use driving::Driving;
use mbody::description::finding::Finding;
use mbody::dynamics::{System, TreePlant};
use motorcycle::maneuver::{Course, RiderDescription};
use motorcycle::rider::schedule::Table;
use motorcycle::rider::{Reins, Rider, RowLayout, Settings};
use problem::{Dae, Signal};
use rayon::prelude::*;
use std::sync::Arc;

/// Offset (m), heading error (rad) and steering torque (N m) that count alike, where the user does not say otherwise. The theory manual (10.4) starts with 0.3 m;
/// half of that keeps changes of lanes at 5 m/s² to the side within 0.2 m at 35 m/s.
const USUAL: (f64, f64, f64) = (0.15, 0.05, 20.0);
/// Greatest steering torque of a rider, N m.
const GREATEST_TORQUE: f64 = 150.0;
/// Damping ratio of the muscles: theory manual 10.6.
const MUSCLE_DAMPING: f64 = 0.7;
/// Time between two samples of the path ahead, s.
const INTERVAL: f64 = 0.05;
/// Previews that are tried, s, and the share of the kernel at which one is long enough.
const PREVIEWS: [f64; 4] = [2.0, 3.0, 4.5, 6.0];
const FAR_ENOUGH: f64 = 0.01;
/// Lead of the schedule before the path, s: lean comes about so much before the curvature that it answers.
const LEAD: f64 = 0.5;
/// Bandwidth of the speed loop, rad/s, critically damped.
const SPEED_BANDWIDTH: f64 = 0.7;
/// Share of the front brake where the loads do not say it.
pub const FRONT_BRAKE_SHARE: f64 = 0.7;
/// Slowest speed of the table, m/s.
const SLOWEST: f64 = 2.0;
/// Wheel torque of the engine.
const DRIVE: &str = "drive.torque";
/// Largest distance of two nodes: share of the speed, and lateral acceleration, m/s².
const SPEED_STEP: f64 = 0.2;
const LATERAL_STEP: f64 = 2.0;

/// One node of the table: what it stands on and how well it holds.
#[derive(Clone, Debug)]
pub struct Node {
    /// Speed, m/s.
    pub speed: f64,
    /// Lateral acceleration, m/s², positive to the left.
    pub lateral_acceleration: f64,
    /// Feedback, preview, closed loop and margins.
    pub regulator: Regulator,
}

/// A rider and what it was made from.
pub struct Designed {
    /// The rider.
    pub rider: Rider,
    /// The nodes of its table.
    pub nodes: Vec<Node>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

/// What a rider is made for.
#[derive(Debug)]
pub struct Task<'a> {
    /// The vehicle.
    pub system: &'a Arc<System>,
    /// Backend of the steady states.
    pub backend: &'a str,
    /// What counts as much as what, and human limits.
    pub wishes: &'a RiderDescription,
    /// Share of the front brake where it cannot be found from the loads.
    pub front_brake_share: f64,
}

/// Speeds from the slowest to the fastest, close enough to each other.
fn speeds((low, high): (f64, f64)) -> Vec<f64> {
    let (low, high) = ((0.85 * low).max(SLOWEST), (1.15 * high).max(SLOWEST * 1.5));
    let count = ((high / low).ln() / SPEED_STEP.ln_1p()).ceil().max(2.0) as usize;
    (0..=count).map(|k| low * (high / low).powf(k as f64 / count as f64)).collect()
}

/// Lateral accelerations to both sides, zero among them.
fn laterals(greatest: f64) -> Vec<f64> {
    let greatest = greatest.max(0.5);
    let half = (greatest / LATERAL_STEP).ceil().max(1.0) as i32;
    (-half..=half).map(|k| greatest * f64::from(k) / f64::from(half)).collect()
}

impl Task<'_> {
    fn steady(&self, speeds: &[f64], laterals: &[f64], acceleration: Option<f64>) -> Result<steady::Steady, Failure> {
        let prescribed = |name, unit, values: Vec<f64>| Prescribed { name, unit, values };
        let request = Request {
            speed: Some(prescribed("speed", "m/s", speeds.to_vec())),
            turn: Some((Turn::LateralAcceleration, prescribed("lateral_acceleration", "m/s²", laterals.to_vec()))),
            acceleration: acceleration.map(|a| prescribed("acceleration", "m/s²", vec![a])),
            front_brake_share: self.front_brake_share,
            ..Request::default()
        };
        steady::run(&request, self.system, self.backend, "steady states of the rider")
    }

    /// Steady states on a grid whose every point is reached: lateral accelerations that are too much for some speed are left out.
    fn grid(&self, speeds: &[f64], greatest: f64) -> Result<(Vec<f64>, steady::Steady), Failure> {
        let mut wanted = greatest;
        loop {
            let laterals = laterals(wanted);
            let found = self.steady(speeds, &laterals, None)?;
            let Some(missed) = found.points.iter().find(|p| p.values.is_empty()) else { return Ok((laterals, found)) };
            if wanted < 1.0 {
                let message = format!(
                    "there is no steady state at {:.1} m/s and a lateral acceleration of {:.1} m/s²: {}",
                    missed.given[0],
                    missed.given[1],
                    missed.ending.name()
                );
                return Err(Finding::error("no_steady_state", message).with_hint("see `fastbike trim` at this speed").into());
            }
            wanted *= 0.8;
        }
    }

    /// Makes the rider of a course.
    ///
    /// # Errors
    /// The vehicle cannot be steered, has no steady states there, or no feedback stabilizes it.
    pub fn design(&self, course: Course) -> Result<Designed, Failure> {
        let plant = TreePlant::new(self.system.clone());
        let base = ridable(&plant)?;
        let reins = reins(&plant, &base)?;
        let wanted = speeds(course.speed.range());
        let speeds = if reins.commands.len() == 4 { self.reachable(wanted)? } else { wanted };
        let fastest = speeds[speeds.len() - 1];
        let greatest = 1.15 * course.speed.greatest_lateral(&course.path) + 0.5;
        let (laterals, steady) = self.grid(&speeds, greatest)?;
        let mut warnings = Vec::new();
        if fastest < course.speed.range().1 {
            let asked = course.speed.range().1;
            warnings.push(format!(
                "the maneuver asks for up to {asked:.1} m/s; steady states end at {fastest:.1} m/s, whose gains hold beyond"
            ));
        }
        let reached = laterals.last().copied().unwrap_or_default();
        if reached < greatest - 1e-9 {
            warnings.push(format!(
                "the path asks for up to {:.1} m/s² to the side; steady states end at {reached:.1} m/s², whose gains hold beyond",
                (greatest - 0.5) / 1.15
            ));
        }
        let models = self.linear(&steady)?;
        let held: Vec<String> = models[0].states.iter().map(|s| s.signal.name.to_string()).filter(|n| is_held(n, &base)).collect();
        let (design, actuator) = (self.wanted(&reins, &held), self.actuator());
        let steerings = self.steerings(&steady, &models, &base, &plant, &design)?;
        let feedback = steerings[0].regulator.states.clone();
        let layout =
            RowLayout { feedback: feedback.len(), preview: steerings[0].regulator.preview.weights.len(), human: actuator.states() };
        let per_speed = if reins.commands.len() == 4 { self.driving(&speeds, &steady, laterals.len())? } else { Driving::none(&speeds) };
        let value = |point: &Point, name: &str| steady.signals.iter().position(|s| s.name == *name).map_or(0.0, |k| point.value(k));
        let rows: Vec<Vec<f64>> = (steady.points.iter().zip(&steerings).enumerate())
            .map(|(k, (point, Steering { regulator, integral_gain, lead }))| {
                let mut row = vec![0.0; layout.width()];
                for (i, name) in feedback.iter().enumerate() {
                    (row[i], row[layout.gain(i)]) = (value(point, name), regulator.gains[i]);
                }
                (row[layout.path_gain(0)], row[layout.path_gain(1)]) = (regulator.path_gains[0], regulator.path_gains[1]);
                row[layout.torque()] = value(point, &reins.commands[0]);
                row[layout.drive()] = reins.commands.get(1).map_or(0.0, |drive| value(point, drive));
                row[layout.torque_per_acceleration()] = per_speed.torque_per_acceleration[k / laterals.len()];
                row[layout.slip()] = value(point, &reins.base[4]).atan2(value(point, &reins.base[3]));
                (row[layout.integral()], row[layout.lead()]) = (*integral_gain, *lead);
                regulator.preview.weights.iter().enumerate().for_each(|(i, w)| row[layout.preview(i)] = *w);
                regulator.actuator_gains.iter().enumerate().for_each(|(i, g)| row[layout.human_gain(i)] = *g);
                row
            })
            .collect();
        let nodes = steady.points.iter().zip(&steerings).map(|(p, s)| Node {
            speed: p.given[0],
            lateral_acceleration: p.given[1],
            regulator: s.regulator.clone(),
        });
        let nodes = nodes.collect();
        let settings = Settings {
            lateral: lateral::law(self.wishes.lateral),
            lead: LEAD,
            interval: steerings[0].regulator.preview.interval,
            greatest_torque: self.wishes.greatest_torque.map_or(GREATEST_TORQUE, |q| q.si()),
            speed_gain: 2.0 * SPEED_BANDWIDTH,
            speed_integral_gain: SPEED_BANDWIDTH * SPEED_BANDWIDTH,
            brake_per_drive: per_speed.brake_per_drive,
            front_share: per_speed.front_share,
            full_throttle: per_speed.full_throttle,
            delay: actuator.delay,
            lag: actuator.lag,
        };
        let broken = || Finding::error("no_rider", "the table of the rider does not go together");
        let laterals_count = laterals.len();
        let table = Table::new(speeds, laterals, &rows).ok_or_else(broken)?;
        let reins = Reins { feedback, ..reins };
        let start = table.nodes().0.iter().rposition(|v| *v <= course.speed.first()).unwrap_or(0);
        let held_at_start = rows[start * laterals_count + laterals_count / 2][layout.torque()];
        let mut rider = Rider::new(reins, settings, layout, table, course).ok_or_else(broken)?;
        rider.start_with(held_at_start);
        Ok(Designed { rider, nodes, warnings })
    }

    /// The design at every point of a grid; points without a steady state or without a stabilizing feedback say why.
    ///
    /// # Errors
    /// The vehicle cannot be ridden at all.
    pub fn along(&self, speeds: &[f64], laterals: &[f64]) -> Result<(steady::Steady, RiderAlong), Failure> {
        let plant = TreePlant::new(self.system.clone());
        let base = ridable(&plant)?;
        let reins = reins(&plant, &base)?;
        let steady = self.steady(speeds, laterals, None)?;
        let models = self.motions(&Request::default()).linear_models(&steady).points;
        let first = models.iter().flatten().next();
        let held: Vec<String> = first.iter().flat_map(|m| &m.states).map(|s| s.signal.name.clone()).filter(|n| is_held(n, &base)).collect();
        let design = self.wanted(&reins, &held);
        let one = |point: &Point, model: &Result<LinearModel, String>| {
            let model = model.as_ref().map_err(String::clone)?;
            let mut found = Err(String::new());
            for preview in self.previews() {
                let steered = steer(self.wishes.lateral, model, &line(point, &plant, &base), &design(preview), &base);
                found = steered.map(|s| s.regulator).map_err(|e| e.to_string());
                if found.as_ref().map_or(true, |r| r.preview.tail < FAR_ENOUGH) {
                    break;
                }
            }
            found
        };
        let points: Vec<Result<Regulator, String>> = steady.points.par_iter().zip(&models).map(|(p, m)| one(p, m)).collect();
        let signal = |name: &str, unit: &'static str, about: &'static str| Signal::new(name, unit, about);
        let mut feedback: Vec<Signal> = Vec::new();
        if let Some(regulator) = points.iter().flatten().next() {
            let of = |name: &String| plant.unknowns().iter().find(|u| u.signal.name == *name).map(|u| u.signal.clone());
            feedback.extend(regulator.states.iter().filter_map(of));
            feedback.push(signal("path.offset", "m", "offset from the path, positive to the left"));
            feedback.push(signal("path.heading", "rad", "heading against that of the path, positive to the left"));
            let delay = [signal("rider.delay", "N m s^2", "torque on its way"), signal("rider.delay_rate", "N m s", "torque on its way")];
            let lag =
                [signal("rider.muscle_torque", "N m", "torque of the muscles"), signal("rider.muscle_torque_rate", "N m/s", "its rate")];
            feedback.extend(self.wishes.delay.is_some().then_some(delay).into_iter().flatten());
            feedback.extend(self.wishes.muscles.is_some().then_some(lag).into_iter().flatten());
        }
        Ok((steady, RiderAlong { law: lateral::about(self.wishes.lateral), effort: "N m".to_owned(), feedback, points }))
    }

    /// What is wanted, for a preview (s).
    fn wanted(&self, reins: &Reins, held: &[String]) -> impl Fn(f64) -> Design + Sync + use<> {
        let actuator = self.actuator();
        let design = Design {
            input: reins.commands[0].clone(),
            effort: self.wishes.torque.map_or(USUAL.2, |q| q.si()),
            deviations: Vec::new(),
            path: (self.wishes.offset.map_or(USUAL.0, |q| q.si()), self.wishes.heading.map_or(USUAL.1, |q| q.si())),
            held: held.to_vec(),
            preview: (0.0, 0),
            actuator,
        };
        move |preview: f64| Design { preview: (preview, (preview / INTERVAL).round() as usize), ..design.clone() }
    }

    fn actuator(&self) -> Actuator {
        Actuator { delay: self.wishes.delay.map(|q| q.si()), lag: self.wishes.muscles.map(|q| (q.si(), MUSCLE_DAMPING)) }
    }

    /// Previews to be tried, s.
    fn previews(&self) -> Vec<f64> {
        lateral::previews(self.wishes.lateral, self.wishes.preview.map_or(PREVIEWS.to_vec(), |wanted| vec![wanted.si()]))
    }

    fn motions<'a>(&'a self, request: &'a Request) -> SmallMotions<'a> {
        SmallMotions { request, system: self.system, backend: self.backend, residual_tolerance: 1e-6 }
    }

    /// Linear models at all points, with the same states.
    fn linear(&self, steady: &steady::Steady) -> Result<Vec<LinearModel>, Failure> {
        let request = Request::default();
        let models: Result<Vec<LinearModel>, String> = self.motions(&request).linear_models(steady).points.into_iter().collect();
        models.map_err(|why| Finding::error("no_linear_model", format!("the rider cannot be made: {why}")).into())
    }

    /// The steering at every point, all with one preview that is long enough.
    fn steerings(
        &self,
        steady: &steady::Steady,
        models: &[LinearModel],
        base: &str,
        plant: &TreePlant,
        design: &(dyn Fn(f64) -> Design + Sync),
    ) -> Result<Vec<Steering>, Failure> {
        let mut found = Vec::new();
        for preview in self.previews() {
            let design = design(preview);
            let steerings: Result<Vec<Steering>, Failure> = (steady.points.par_iter().zip(models))
                .map(|(point, model)| {
                    steer(self.wishes.lateral, model, &line(point, plant, base), &design, base).map_err(|why| {
                        let message = format!("no rider at {:.1} m/s and {:.1} m/s² to the side: {why}", point.given[0], point.given[1]);
                        Finding::error("no_rider", message).into()
                    })
                })
                .collect();
            found = steerings?;
            if found.iter().all(|s| s.regulator.preview.tail < FAR_ENOUGH) {
                break;
            }
        }
        Ok(found)
    }
}

/// States that the speed section holds: the speed itself and the spins of the wheels.
fn is_held(name: &str, base: &str) -> bool {
    name == format!("{base}.forward_speed") || name.ends_with("_wheel.spin_rate")
}

/// Name of the base of a vehicle that somebody may ride.
pub(crate) fn ridable(plant: &TreePlant) -> Result<String, Failure> {
    let missing = || Finding::error("no_vehicle_base", "this model has no vehicle base, so nobody can ride it");
    base_name(plant).ok_or_else(|| missing().into())
}

/// How a vehicle moves along its path in a steady state.
fn line(point: &Point, plant: &TreePlant, base: &str) -> Line {
    let at = |name: String| plant.unknowns().iter().position(|u| u.signal.name == name).unwrap_or_default();
    let [forward, lateral_speed, yaw_rate] = ["forward_speed", "lateral_speed", "yaw_rate"].map(|name| at(format!("{base}.{name}")));
    let speed = (point.value(forward), point.value(lateral_speed));
    Line { lateral_speed, yaw_rate, speed, curvature: point.value(yaw_rate) / speed.0.hypot(speed.1) }
}

/// What a rider can read and command on this vehicle.
pub(crate) fn reins(plant: &TreePlant, base: &str) -> Result<Reins, Failure> {
    let input = |name: &str| plant.inputs().iter().any(|i| i.signal.name == name);
    if !input("steer.torque") {
        let finding = Finding::error("missing_input", "this model has no input `steer.torque`, so nobody can steer it");
        return Err(finding.with_hint("an element `steer: { joint_torque: { joint: steer } }` offers it").into());
    }
    let speed = [DRIVE, "front_brake.torque", "rear_brake.torque"];
    let mut commands = vec!["steer.torque".to_owned()];
    if speed.iter().all(|name| input(name)) {
        commands.extend(speed.map(str::to_owned));
    }
    let of_base = ["x", "y", "yaw", "forward_speed", "lateral_speed"].map(|name| format!("{base}.{name}"));
    Ok(Reins { base: of_base, feedback: Vec::new(), commands })
}
