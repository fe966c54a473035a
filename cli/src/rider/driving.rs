//! How a vehicle gains and loses speed: what the speed section of the rider knows of engine and brakes.

use super::{DRIVE, Task};
use crate::Failure;
use crate::output::Point;
use crate::steady;
use mbody::description::finding::Finding;
use mbody::dynamics::TreePlant;
use mbody::scalar::Pchip;
use motorcycle::drivetrain::ENGINE_LIMIT;
use problem::{At, Dae, Limits, Outputs, Side, Signal, UnknownKind};

/// Accelerations at which driving and braking are measured, m/s², the first ones where there are steady states.
const GAINING: [f64; 2] = [0.5, 0.1];
const LOSING: [f64; 3] = [-3.0, -1.5, -0.7];
/// How close the fastest speed is found.
const CLOSE: f64 = 0.02;
/// Points of the torque at full throttle over the speed of the wheel, and how much faster than in steady running it may spin.
const SPINS: usize = 1000;
const SPINNING: f64 = 1.5;
/// A wheel torque beside zero, N m: the margin of the engine is linear between them.
const SOME_TORQUE: f64 = 100.0;

/// A steady state that gains or loses speed, m/s².
struct Probe {
    acceleration: f64,
    point: Point,
}

impl Task<'_> {
    /// How the speed answers to drive and brakes, from steady states that accelerate and brake.
    ///
    /// # Errors
    /// At some speed there is none.
    pub(super) fn driving(&self, speeds: &[f64], steady: &steady::Steady, laterals: usize) -> Result<Driving, Failure> {
        let at = |name: &str| steady.signals.iter().position(|s| s.name == *name);
        let value = |point: &Point, name: &str| at(name).map_or(f64::NAN, |k| point.value(k));
        let middle = laterals / 2;
        let (driven, braked) = (self.probed(speeds, &GAINING)?, self.probed(speeds, &LOSING)?);
        let mut driving = Driving::none(speeds);
        let mut shares = Vec::new();
        for (i, per) in driving.torque_per_acceleration.iter_mut().enumerate() {
            let level = &steady.points[i * laterals + middle];
            let (Some(faster), Some(slower)) = (&driven[i], &braked[i]) else {
                let message = format!("at {:.1} m/s the vehicle can neither gain nor lose speed steadily", speeds[i]);
                return Err(Finding::error("no_steady_state", message).into());
            };
            let drive = value(level, DRIVE);
            *per = (value(&faster.point, DRIVE) - drive) / faster.acceleration;
            let brakes = value(&slower.point, "front_brake.torque") + value(&slower.point, "rear_brake.torque");
            let load = |p: &Point| loads_of(&steady.signals, p, "front") / loads_of(&steady.signals, p, "");
            let slope = (load(&slower.point) - load(level)) / -slower.acceleration;
            shares.push((brakes / -(drive + *per * slower.acceleration), load(level), slope));
        }
        let mean = |f: &dyn Fn(&(f64, f64, f64)) -> f64| shares.iter().map(f).sum::<f64>() / shares.len() as f64;
        driving.brake_per_drive = mean(&|s| s.0);
        driving.full_throttle = steady.points.get(middle).and_then(|point| self.full_throttle(point, speeds[speeds.len() - 1] / speeds[0]));
        driving.front_share = match mean(&|s| s.1).is_finite() {
            true => [mean(&|s| s.1), mean(&|s| s.2)],
            false => [self.front_brake_share, 0.0],
        };
        Ok(driving)
    }

    /// Straight running at each speed with the first of these accelerations that has a steady state.
    fn probed(&self, speeds: &[f64], accelerations: &[f64]) -> Result<Vec<Option<Probe>>, Failure> {
        let mut found: Vec<Option<Probe>> = speeds.iter().map(|_| None).collect();
        for &acceleration in accelerations {
            if found.iter().all(Option::is_some) {
                break;
            }
            let points = self.steady(speeds, &[0.0], Some(acceleration))?.points;
            for (found, point) in found.iter_mut().zip(points).filter(|(found, point)| found.is_none() && !point.values.is_empty()) {
                *found = Some(Probe { acceleration, point });
            }
        }
        Ok(found)
    }

    /// How many of the speeds, from the slowest on, are such that the vehicle can run straight, and gain and lose speed.
    fn run(&self, speeds: &[f64]) -> Result<usize, Failure> {
        let level = self.steady(speeds, &[0.0], None)?;
        let (driven, braked) = (self.probed(speeds, &GAINING)?, self.probed(speeds, &LOSING)?);
        let missed = |i: &usize| level.points[*i].values.is_empty() || driven[*i].is_none() || braked[*i].is_none();
        Ok((0..speeds.len()).find(missed).unwrap_or(speeds.len()))
    }

    /// Speeds from the slowest up to the fastest at which there are steady states; all where already the first two have none.
    pub(super) fn reachable(&self, speeds: Vec<f64>) -> Result<Vec<f64>, Failure> {
        let count = self.run(&speeds)?;
        if count < 2 || count == speeds.len() {
            return Ok(speeds);
        }
        let (mut reached, mut beyond) = (speeds[count - 1], speeds[count]);
        while beyond > (1.0 + CLOSE) * reached {
            let middle = 0.5 * (reached + beyond);
            if self.run(&[middle])? == 1 { reached = middle } else { beyond = middle }
        }
        let mut kept = speeds[..count].to_vec();
        if reached > (1.0 + CLOSE) * kept[count - 1] {
            kept.push(reached);
        }
        Ok(kept)
    }

    /// The joint speed that the engine turns with, and the torque of the wheel at full throttle over it: where the margin of the engine, which is linear in that torque, is
    /// used up. None where the model has no such limit.
    ///
    /// `point`: straight running; `faster`: how many times as fast the wheels may turn.
    fn full_throttle(&self, point: &Point, faster: f64) -> Option<(String, Pchip)> {
        let mut plant = TreePlant::new(self.system.clone());
        let limit = plant.limits().iter().find(|l| l.name == ENGINE_LIMIT && l.side == Side::Below)?.clone();
        let margin = plant.outputs().iter().position(|o| o.name == limit.signal)?;
        let drive = plant.inputs().iter().position(|i| i.signal.name == DRIVE)?;
        let mut u: Vec<f64> = plant.inputs().iter().map(|i| i.default).collect();
        let n = plant.unknowns().len();
        let (yd, mut residual, mut outputs) = (vec![0.0; n], vec![0.0; plant.equations().len()], vec![0.0; plant.outputs().len()]);
        // unknowns are the first signals
        let mut y: Vec<f64> = (0..n).map(|i| point.value(i)).collect();
        let names: Vec<String> = plant.unknowns().iter().map(|u| u.signal.name.clone()).collect();
        let turning: Vec<usize> = (0..n).filter(|&i| plant.unknowns()[i].kind == UnknownKind::Velocity).collect();
        let mut left = |y: &[f64], torque: f64| {
            u[drive] = torque;
            plant.evaluate(At { time: 0.0, y, yd: &yd, u: &u }, &mut residual, &mut outputs).ok()?;
            Some(outputs[margin] - limit.threshold)
        };
        let present = left(&y, 0.0)?;
        let wheel = turning.into_iter().find(|&i| {
            let kept = y[i];
            y[i] = 1.1 * kept + 1.0;
            let moved = left(&y, 0.0);
            y[i] = kept;
            moved.is_some_and(|m| m != present)
        })?;
        let fastest = SPINNING * faster * y[wheel];
        let spins: Vec<f64> = (0..=SPINS).map(|k| fastest * k as f64 / SPINS as f64).collect();
        let full = spins.iter().map(|&spin| {
            y[wheel] = spin;
            let (none, some) = (left(&y, 0.0)?, left(&y, SOME_TORQUE)?);
            Some(none / (none - some) * SOME_TORQUE)
        });
        let full: Option<Vec<f64>> = full.collect();
        Some((names[wheel].clone(), Pchip::new(&spins, &full?).ok()?))
    }
}

/// How the speed answers to drive and brakes.
pub(super) struct Driving {
    /// Wheel torque per acceleration, at every speed.
    pub torque_per_acceleration: Vec<f64>,
    /// Sum of the brake torques per wheel torque of the engine that they replace.
    pub brake_per_drive: f64,
    /// Front share at no acceleration, and its growth per deceleration.
    pub front_share: [f64; 2],
    /// Speed of the joint that the engine turns with, and the wheel torque at full throttle over it.
    pub full_throttle: Option<(String, Pchip)>,
}

impl Driving {
    /// Of a vehicle whose speed nobody holds.
    pub fn none(speeds: &[f64]) -> Self {
        Self { torque_per_acceleration: vec![1.0; speeds.len()], brake_per_drive: 1.0, front_share: [0.5, 0.0], full_throttle: None }
    }
}

/// Load of all tires whose names begin like this, N: `front_tire`, or `front_left_tire` and `front_right_tire`.
fn loads_of(signals: &[Signal], point: &Point, beginning: &str) -> f64 {
    let loads = signals.iter().enumerate().filter(|(_, s)| s.name.starts_with(beginning) && s.name.ends_with("_tire.normal_force"));
    let loads: Vec<f64> = loads.map(|(k, _)| point.value(k)).collect();
    if loads.is_empty() { f64::NAN } else { loads.iter().sum() }
}
