//! The virtual rider: holds, steers, drives and brakes a single-track vehicle along a path.
//!
//! [`Rider`] is a [`Controller`]: it reads coordinates and velocities and commands steering torque, wheel torque and brake torques. Its laws are in `law.rs`; what
//! it knows of the machine, steady states and gains, is a table ([`schedule`]) that somebody else computed from the model: nothing here is tuned by hand.

pub mod cascade;
mod law;
mod preview;
pub mod replay;
pub mod schedule;

use crate::chain_rule::along_directions;
use crate::maneuver::Course;
use cascade::CascadeSettings;
use law::MOST;
use mbody::scalar::{Lanes, Pchip, SystemScalar};
use problem::{Answer, AnswerAlong, Controller, EvalError, Matrix, Signal, Unknown, UnknownKind};
use schedule::{Row, Table};

/// Names of what a rider reads and commands.
#[derive(Clone, Debug)]
pub struct Reins {
    /// Position along x, along y and heading of the base, its forward and its lateral speed.
    pub base: [String; 5],
    /// What is fed back to the steering, in the order of the table.
    pub feedback: Vec<String>,
    /// Inputs: steering torque; then wheel torque of the engine, front and rear brake torque where the speed is held.
    pub commands: Vec<String>,
}

/// How a rider steers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lateral {
    /// Feedback of all states, and of the way ahead.
    Preview,
    /// The path asks for lean, lean asks for torque.
    Cascade(CascadeSettings),
}

/// Numbers of a rider.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How he steers.
    pub lateral: Lateral,
    /// How far ahead the curvature is taken for which the schedule is read, s.
    pub lead: f64,
    /// Time between two samples of the path ahead, s.
    pub interval: f64,
    /// Greatest steering torque, N m.
    pub greatest_torque: f64,
    /// Acceleration demanded per speed error, 1/s.
    pub speed_gain: f64,
    /// Acceleration demanded per integral of the speed error, 1/s².
    pub speed_integral_gain: f64,
    /// Sum of the brake torques per wheel torque of the engine that they replace.
    pub brake_per_drive: f64,
    /// Front share of the brake torque at no acceleration, and by how much it grows per deceleration, s²/m.
    pub front_share: [f64; 2],
    /// Speed of the joint that the engine turns with, and the wheel torque at full throttle over it, N m; none where the engine gives whatever is asked for.
    pub full_throttle: Option<(String, Pchip)>,
    /// Reaction time, s.
    pub delay: Option<f64>,
    /// Natural frequency (rad/s) and damping ratio of the muscles.
    pub lag: Option<(f64, f64)>,
}

/// Entries of a row of the table: steady values and gains of the feedback, gains of the path, torques, weights of the path ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowLayout {
    /// Number of signals that are fed back.
    pub feedback: usize,
    /// Number of samples of the path ahead.
    pub preview: usize,
    /// Number of states of delay and muscles, which are fed back too.
    pub human: usize,
}

impl RowLayout {
    /// Gain of a signal.
    pub fn gain(&self, k: usize) -> usize {
        self.feedback + k
    }
    /// Gain of the offset (0) or of the heading error (1).
    pub fn path_gain(&self, k: usize) -> usize {
        2 * self.feedback + k
    }
    /// Steering torque of the steady state.
    pub fn torque(&self) -> usize {
        2 * self.feedback + 2
    }
    /// Wheel torque of the steady state.
    pub fn drive(&self) -> usize {
        2 * self.feedback + 3
    }
    /// Wheel torque per acceleration.
    pub fn torque_per_acceleration(&self) -> usize {
        2 * self.feedback + 4
    }
    /// Angle by which the steady state slips to the left.
    pub fn slip(&self) -> usize {
        2 * self.feedback + 5
    }
    /// Gain of the integral of the lean.
    pub fn integral(&self) -> usize {
        2 * self.feedback + 6
    }
    /// Change of the lean per lateral acceleration.
    pub fn lead(&self) -> usize {
        2 * self.feedback + 7
    }
    /// Weight of a sample ahead.
    pub fn preview(&self, k: usize) -> usize {
        2 * self.feedback + 8 + k
    }
    /// Gain of a state of delay and muscles.
    pub fn human_gain(&self, k: usize) -> usize {
        2 * self.feedback + 8 + self.preview + k
    }
    /// Length of a row.
    pub fn width(&self) -> usize {
        2 * self.feedback + 8 + self.preview + self.human
    }
}

/// The virtual rider.
pub struct Rider {
    course: Course,
    table: Table,
    layout: RowLayout,
    settings: Settings,
    measured: Vec<String>,
    commanded: Vec<String>,
    states: Vec<Unknown>,
    outputs: Vec<Signal>,
    row: Row,
    duals: Vec<Wide>,
    jacobian: Matrix,
}

/// The scalar of the rider's own derivatives: as many directions as it reads signals, in one or two sweeps.
type Wide = Lanes<6>;

/// A state of a rider, zero at the start.
struct State {
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    nominal: f64,
    tolerance: f64,
}

impl State {
    fn unknown(&self) -> Unknown {
        Unknown {
            signal: Signal::new(self.name, self.unit, self.about),
            kind: UnknownKind::State,
            cyclic: false,
            differential: true,
            nominal: self.nominal,
            absolute_tolerance: self.tolerance,
            design: 0.0,
            start: Some(0.0),
        }
    }
}

const STATION: State = State { name: "rider.station", unit: "m", about: "arc length on the path", nominal: 10.0, tolerance: 1e-5 };
const SPEED_INTEGRAL: State =
    State { name: "rider.speed_integral", unit: "m", about: "integral of the speed error", nominal: 1.0, tolerance: 1e-5 };
const DELAY: [State; 2] = [
    State { name: "rider.delay", unit: "N m s^2", about: "torque on its way, integrated twice", nominal: 0.1, tolerance: 1e-6 },
    State { name: "rider.delay_rate", unit: "N m s", about: "torque on its way, integrated once", nominal: 1.0, tolerance: 1e-5 },
];
const MUSCLES: [State; 2] = [
    State { name: "rider.muscle_torque", unit: "N m", about: "torque that the muscles have built up", nominal: 10.0, tolerance: 1e-4 },
    State { name: "rider.muscle_torque_rate", unit: "N m/s", about: "rate of the torque of the muscles", nominal: 100.0, tolerance: 1e-3 },
];

impl Rider {
    /// A rider on a course. `None` where the table has another width than its layout says, or the speed is held without its inputs.
    pub fn new(reins: Reins, settings: Settings, layout: RowLayout, table: Table, course: Course) -> Option<Self> {
        let holds_speed = reins.commands.len() == 4;
        let human = 2 * usize::from(settings.delay.is_some()) + 2 * usize::from(settings.lag.is_some());
        let fits = table.width() == layout.width() && layout.human == human && reins.feedback.len() == layout.feedback;
        let in_loops = settings.lateral == Lateral::Preview || layout.feedback == cascade::FEEDBACK.len();
        if !fits || !in_loops || !(holds_speed || reins.commands.len() == 1) {
            return None;
        }
        let delay = settings.delay.iter().flat_map(|_| &DELAY);
        let muscles = settings.lag.iter().flat_map(|_| &MUSCLES);
        let loops: &[State] = if settings.lateral == Lateral::Preview { &[] } else { &cascade::STATES };
        let integral = holds_speed.then_some(&SPEED_INTEGRAL);
        let states: Vec<Unknown> =
            [&STATION].into_iter().chain(integral).chain(delay).chain(muscles).chain(loops).map(State::unknown).collect();
        let signal = |name: &str, unit: &'static str, about: &'static str| Signal::new(name, unit, about);
        let outputs = vec![
            signal("rider.path_error", "m", "offset of the base point from the path, positive to the left"),
            signal("rider.heading_error", "rad", "heading against that of the path, positive to the left"),
            signal("rider.path_curvature", "1/m", "curvature of the path, positive to the left"),
            signal("rider.target_speed", "m/s", "speed that the maneuver asks for"),
            signal("rider.path_x", "m", "place on the path, along x"),
            signal("rider.path_y", "m", "place on the path, along y"),
            signal("rider.scheduled_acceleration", "m/s^2", "lateral acceleration for which steady state and gains are taken"),
        ];
        let turning = settings.full_throttle.iter().map(|(joint_speed, _)| joint_speed.clone());
        let measured: Vec<String> = reins.base.into_iter().chain(reins.feedback).chain(turning).collect();
        let reads = measured.len() + states.len();
        Some(Self {
            row: Row::of(&table),
            duals: vec![Wide::default(); reads],
            jacobian: Matrix::zeros(reins.commands.len() + states.len() + outputs.len(), reads),
            commanded: reins.commands,
            course,
            table,
            layout,
            settings,
            measured,
            states,
            outputs,
        })
    }

    /// The course that it rides.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// Lets delay and muscles begin where they hold a steady torque, N m.
    pub fn start_with(&mut self, torque: f64) {
        let (first, steady) = (self.human_states(), self.human_at(torque));
        for (state, start) in self.states[first..].iter_mut().zip(steady).take(self.layout.human) {
            (state.start, state.design) = (Some(start), start);
        }
    }

    fn acceleration_range(&self) -> [f64; 2] {
        let (low, high) = self.table.ranges()[1];
        [low, high]
    }

    /// State of the integral of the speed error, where the speed is held.
    fn speed_state(&self) -> Option<usize> {
        (self.commanded.len() == 4).then_some(1)
    }

    /// First state of delay and lag.
    fn human_states(&self) -> usize {
        1 + usize::from(self.speed_state().is_some())
    }

    /// First state of the loops of lean and path.
    fn loop_states(&self) -> usize {
        self.human_states() + self.layout.human
    }

    /// Derivatives of commands, rates and outputs by all that is read: rows in this order.
    fn differentiate(&mut self, time: f64, measured: &[f64], states: &[f64]) {
        let (m, n) = (measured.len(), measured.len() + states.len());
        let counts = [self.commanded.len(), self.states.len(), self.outputs.len()];
        for first in (0..n).step_by(Wide::DIRECTIONS) {
            for (k, (dual, value)) in self.duals.iter_mut().zip(measured.iter().chain(states)).enumerate() {
                *dual = <Wide as mbody::scalar::Real>::from_f64(*value);
                if (first..first + Wide::DIRECTIONS).contains(&k) {
                    dual.set_derivative(k - first, 1.0);
                }
            }
            let (z, x) = self.duals.split_at(m);
            let reply = self.law(time, z, x, &self.row, self.scheduled(z, x));
            let parts = [reply.commands, reply.rates, reply.outputs];
            let mut row = 0;
            for (part, count) in parts.iter().zip(counts) {
                for value in &part[..count] {
                    for k in 0..Wide::DIRECTIONS.min(n - first) {
                        self.jacobian[(row, first + k)] = SystemScalar::derivative(value, k);
                    }
                    row += 1;
                }
            }
        }
    }

    fn read_schedule(&mut self, measured: &[f64], states: &[f64]) -> (f64, f64) {
        let at = self.scheduled(measured, states);
        self.table.at(at, &mut self.row);
        at
    }
}

/// The first state whose rate is not finite, or the first one where a command is not.
fn checked(answer: &Answer<'_>) -> Result<(), EvalError> {
    match answer.rates.iter().position(|r| !r.is_finite()) {
        Some(equation) => Err(EvalError::Recoverable { equation }),
        None if answer.commands.iter().any(|c| !c.is_finite()) => Err(EvalError::Recoverable { equation: 0 }),
        None => Ok(()),
    }
}

impl Controller for Rider {
    fn measured(&self) -> &[String] {
        &self.measured
    }
    fn commanded(&self) -> &[String] {
        &self.commanded
    }
    fn states(&self) -> &[Unknown] {
        &self.states
    }
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn breaks(&self) -> Vec<f64> {
        self.course.breaks()
    }
    fn answer(&mut self, time: f64, measured: &[f64], states: &[f64], answer: Answer<'_>) -> Result<(), EvalError> {
        let at = self.read_schedule(measured, states);
        let reply = self.law(time, measured, states, &self.row, at);
        answer.commands.copy_from_slice(&reply.commands[..self.commanded.len()]);
        answer.rates.copy_from_slice(&reply.rates[..self.states.len()]);
        answer.outputs.copy_from_slice(&reply.outputs[..self.outputs.len()]);
        checked(&answer)
    }
    fn answer_along(
        &mut self,
        time: f64,
        (measured, states): (&[f64], &[f64]),
        (by_measured, by_states): (&Matrix, &Matrix),
        answer: Answer<'_>,
        along: AnswerAlong<'_>,
    ) -> Result<(), EvalError> {
        self.answer(time, measured, states, answer)?;
        self.differentiate(time, measured, states);
        along_directions(&self.jacobian, (by_measured, by_states), along);
        Ok(())
    }
}

const _: () = assert!(MOST >= 7, "seven outputs");
