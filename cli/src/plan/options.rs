//! Options of steady states as typed, and what they ask for.

use super::{Prescribed, Request, Turn};
use crate::Failure;
use crate::arguments::{argument, sweep};
use crate::incline::Incline;
use clap::Args;
use mbody::description::finding::Finding;
use mbody::description::quantity::Dimensioned;
use mbody::description::quantity::dimension::{Acceleration, Angle, AngularSpeed, Curvature, Length, Number, Speed, Torque};
use std::f64::consts::FRAC_PI_2;

/// Points of a grid; more would fill the memory before the first of them is reached.
const MOST_POINTS: f64 = 1e6;

/// Options that prescribe a steady motion.
#[derive(Clone, Debug, Default, Args)]
#[command(allow_negative_numbers = true)]
pub struct SteadyArguments {
    /// Forward speed; left out: the static pose
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    pub speed: Option<String>,
    /// Lean, positive to the right
    #[arg(long, value_name = "ANGLE", group = "turn", allow_hyphen_values = true)]
    pub lean: Option<String>,
    /// Lateral acceleration (speed times yaw rate), positive to the left
    #[arg(long, value_name = "ACCELERATION", group = "turn", allow_hyphen_values = true)]
    pub lateral_acceleration: Option<String>,
    /// Curvature of the path, positive to the left
    #[arg(long, value_name = "CURVATURE", group = "turn", allow_hyphen_values = true)]
    pub curvature: Option<String>,
    /// Radius of the path, positive to the left
    #[arg(long, value_name = "RADIUS", group = "turn", allow_hyphen_values = true)]
    pub radius: Option<String>,
    /// Yaw rate, positive to the left
    #[arg(long, value_name = "RATE", group = "turn", allow_hyphen_values = true)]
    pub yaw_rate: Option<String>,
    /// Steering torque; every lean that holds itself with it is searched
    #[arg(long, value_name = "TORQUE", group = "turn", allow_hyphen_values = true)]
    pub steer_torque: Option<String>,
    /// Acceleration along the heading; negative: braking
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true)]
    pub acceleration: Option<String>,
    /// Slope of the road along the path, positive uphill: `5%`, or an angle, `3deg`
    #[arg(long, value_name = "SLOPE", allow_hyphen_values = true)]
    pub grade: Option<String>,
    /// Inclination of the road across the path, positive where it leans to the right: `-8deg` helps a turn to the left; or a slope, `-14%`
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pub bank: Option<String>,
    /// Share of the front brake in the braking torque, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0.7")]
    pub front_brake_share: String,
    /// Speed at full throttle
    #[arg(long, conflicts_with_all = ["speed", "acceleration"])]
    pub top_speed: bool,
    /// Gear, for models with an engine
    #[arg(long, value_name = "NUMBER")]
    pub gear: Option<u32>,
}

/// Options of a steady state.
#[derive(Clone, Debug, Default, Args)]
#[command(allow_negative_numbers = true)]
pub struct TrimArguments {
    #[command(flatten)]
    steady: SteadyArguments,
    /// Give a signal a value or a formula of other signals: `drive.torque=0`, `rear_brake.torque=0.4*front_brake.torque` (repeatable)
    #[arg(long, value_name = "SIGNAL=VALUE", allow_hyphen_values = true)]
    pub given: Vec<String>,
    /// Let a signal be found, with an optional first guess: `chassis.roll=0.1` (repeatable)
    #[arg(long, value_name = "SIGNAL")]
    pub free: Vec<String>,
    /// Solver: kinsol or newton
    #[arg(long, default_value = "kinsol")]
    pub backend: String,
}

fn prescribed<D: Dimensioned>(option: &str, name: &'static str, text: &Option<String>) -> Result<Option<Prescribed>, Failure> {
    let Some(text) = text else { return Ok(None) };
    Ok(Some(Prescribed { name, unit: D::DIMENSION.unit, values: sweep::<D>(option, text)? }))
}

impl TrimArguments {
    /// `--gear` as an override: a parameter of the element `engine`.
    pub fn gear_override(&self) -> Option<String> {
        self.steady.gear_override()
    }

    /// Reads all values.
    ///
    /// # Errors
    /// Names the option, the text and what was expected.
    pub fn request(&self) -> Result<Request, Failure> {
        self.steady.request(&self.given, &self.free)
    }
}

impl SteadyArguments {
    /// `--gear` as an override: a parameter of the element `engine`.
    pub fn gear_override(&self) -> Option<String> {
        self.gear.map(|gear| format!("engine.gear={gear}"))
    }

    /// Whether a motion on the road is asked for, or something that needs one.
    pub fn moving(&self) -> bool {
        let other = [&self.lean, &self.lateral_acceleration, &self.curvature, &self.radius, &self.yaw_rate, &self.steer_torque];
        let other = other.into_iter().chain([&self.grade, &self.bank]);
        self.top_speed || self.speed.is_some() || self.acceleration.is_some() || other.into_iter().any(|option| option.is_some())
    }

    /// Reads all values; `given` and `free` are `--given` and `--free` of a steady state.
    ///
    /// # Errors
    /// Names the option, the text and what was expected.
    pub fn request(&self, given: &[String], free: &[String]) -> Result<Request, Failure> {
        let (turn, speed) = (self.turn()?, self.forward_speed()?);
        let acceleration = prescribed::<Acceleration>("acceleration", "acceleration", &self.acceleration)?;
        let incline = Incline::read(self.grade.as_deref(), self.bank.as_deref())?;
        if speed.is_none() && !self.top_speed && (turn.is_some() || acceleration.is_some() || incline != Incline::default()) {
            let finding = Finding::error("missing_speed", "a turn, an acceleration or an inclined road needs a speed");
            return Err(finding.with_hint("add `--speed`, for example `--speed 30`").into());
        }
        let counts = [speed.as_ref(), turn.as_ref().map(|t| &t.1), acceleration.as_ref()].map(|p| p.map_or(1.0, |p| p.values.len() as f64));
        let points: f64 = counts.iter().product();
        if points > MOST_POINTS {
            let message = format!("the sweeps make {points:.0} points together; at most {MOST_POINTS:.0} are accepted");
            return Err(Finding::error("too_many_points", message).with_hint("take larger steps").into());
        }
        Ok(Request {
            speed,
            turn,
            acceleration,
            front_brake_share: self.share()?,
            top_speed: self.top_speed,
            incline,
            given: given.iter().map(|text| pair(text)).collect::<Result<_, _>>()?,
            free: free.iter().map(|text| guessed(text)).collect::<Result<_, _>>()?,
        })
    }

    /// How the turn is prescribed, and by which values.
    fn turn(&self) -> Result<Option<(Turn, Prescribed)>, Failure> {
        let turns = [
            (Turn::Lean, prescribed::<Angle>("lean", "lean", &self.lean)?),
            (
                Turn::LateralAcceleration,
                prescribed::<Acceleration>("lateral-acceleration", "lateral_acceleration", &self.lateral_acceleration)?,
            ),
            (Turn::Curvature, prescribed::<Curvature>("curvature", "curvature", &self.curvature)?),
            (Turn::Radius, prescribed::<Length>("radius", "radius", &self.radius)?),
            (Turn::YawRate, prescribed::<AngularSpeed>("yaw-rate", "yaw_rate", &self.yaw_rate)?),
            (Turn::SteerTorque, prescribed::<Torque>("steer-torque", "steer_torque", &self.steer_torque)?),
        ];
        let turn = turns.into_iter().find_map(|(turn, p)| p.map(|p| (turn, p)));
        if let Some((Turn::Lean, p)) = &turn
            && let Some(flat) = p.values.iter().find(|v| v.abs() >= FRAC_PI_2)
        {
            let text = self.lean.as_deref().unwrap_or_default();
            let message = format!("a lean of {flat} rad is out of range: it must be between -90 deg and 90 deg");
            let finding = argument("lean", text, "out_of_range", message);
            return Err(finding.with_hint("angles without unit are in radians; write `35deg`").into());
        }
        if let Some((Turn::Radius, p)) = &turn
            && p.values.contains(&0.0)
        {
            let text = self.radius.as_deref().unwrap_or_default();
            let finding = argument("radius", text, "out_of_range", "a radius of `0 m` is out of range");
            return Err(finding.with_hint("straight running is `--curvature 0`").into());
        }
        Ok(turn)
    }

    /// Speeds, all of them forward.
    fn forward_speed(&self) -> Result<Option<Prescribed>, Failure> {
        let speed = prescribed::<Speed>("speed", "speed", &self.speed)?;
        if let Some(s) = &speed
            && let Some(slow) = s.values.iter().find(|&&v| v <= 0.0)
        {
            let text = self.speed.as_deref().unwrap_or_default();
            let finding = argument("speed", text, "out_of_range", format!("`{slow} m/s` is out of range: it must be greater than 0 m/s"));
            return Err(finding.with_hint("leave `--speed` out for the static pose").into());
        }
        Ok(speed)
    }

    /// Share of the front brake: one value from 0 to 1.
    fn share(&self) -> Result<f64, Failure> {
        let wrong = |code, why: String| argument("front-brake-share", &self.front_brake_share, code, why);
        let [share] = sweep::<Number>("front-brake-share", &self.front_brake_share)?[..] else {
            return Err(wrong("wrong_count", "this takes one value".to_owned()).into());
        };
        if !(0.0..=1.0).contains(&share) {
            return Err(wrong("out_of_range", format!("`{share}` is out of range: it must be from 0 to 1")).into());
        }
        Ok(share)
    }
}

/// `SIGNAL=VALUE` of `--given`.
fn pair(text: &str) -> Result<(String, String), Failure> {
    let Some((name, value)) = text.split_once('=') else {
        let finding = argument("given", text, "bad_argument", "this is not of the form SIGNAL=VALUE");
        return Err(finding.with_hint("to leave a signal open, write `--free SIGNAL`").into());
    };
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// `SIGNAL` or `SIGNAL=GUESS` of `--free`.
fn guessed(text: &str) -> Result<(String, Option<f64>), Failure> {
    let Some((name, guess)) = text.split_once('=') else { return Ok((text.trim().to_owned(), None)) };
    match guess.trim().parse() {
        Ok(guess) => Ok((name.trim().to_owned(), Some(guess))),
        Err(_) => Err(argument("free", text, "bad_number", format!("the guess `{guess}` is not a number")).into()),
    }
}
