//! Inputs over time of a maneuver, in the units of the vehicle.

use super::start::quantity;
use crate::Failure;
use analyses::transient::{Driven, Pulse, Ramp, Step, Table, Track};
use mbody::description::finding::{Finding, suggestion};
use motorcycle::maneuver::{Amount, Moving, Piece};
use problem::Plant;

/// Lets the inputs of a maneuver act on top of the values that they have.
///
/// # Errors
/// An input that this model does not have, or that somebody commands; a value of another dimension.
pub fn act(moving: &[Moving], plant: &dyn Plant, inputs: &mut Driven) -> Result<(), Failure> {
    for (k, Moving { input, piece }) in moving.iter().enumerate() {
        let Some(at) = plant.inputs().iter().position(|i| i.signal.name == *input) else { return Err(missing(input, k, plant).into()) };
        let unit = &plant.inputs()[at].signal.unit;
        let si = |amount: &Amount, key: &str| {
            quantity(&amount.to_string(), unit).map_err(|(code, why, hint)| {
                Failure::from(Finding::error(code, why).at_path(format!("inputs.{k}.{key}")).with_hint_from(hint))
            })
        };
        let track: Box<dyn Track> = match piece {
            Piece::Pulse { peak, start, duration } => {
                Box::new(Pulse { begin: *start, duration: *duration, height: si(peak, "pulse.peak")? })
            }
            Piece::Step { height, start } => Box::new(Step { time: *start, height: si(height, "step.height")? }),
            Piece::Ramp { height, start, duration } => {
                Box::new(Ramp { begin: *start, end: start + duration, height: si(height, "ramp.height")? })
            }
            Piece::Table(points) => {
                let values =
                    points.iter().enumerate().map(|(i, (_, amount))| si(amount, &format!("table.{i}.1"))).collect::<Result<_, _>>()?;
                let table = Table::new(points.iter().map(|p| p.0).collect(), values);
                Box::new(table.ok_or_else(|| Finding::error("bad_curve", "times must not decrease").at_path(format!("inputs.{k}.table")))?)
            }
        };
        inputs.add(plant, at, track);
    }
    Ok(())
}

/// Why an input cannot be moved.
fn missing(input: &str, k: usize, plant: &dyn Plant) -> Finding {
    let path = format!("inputs.{k}.input");
    // what is commanded has become an output
    if plant.outputs().iter().any(|o| o.name == *input) {
        let finding =
            Finding::error("wrong_role", format!("`{input}` is no free input of this ride: rider or road command it")).at_path(path);
        return finding.with_hint("`torque_pulses` disturb the steering of a rider; with `control: none` nobody commands inputs");
    }
    let finding = Finding::error("unknown_input", format!("this model has no input `{input}`")).at_path(path);
    match (input, suggestion(input, plant.inputs().iter().map(|i| i.signal.name.as_str()))) {
        ("wind.lateral", _) => finding.with_hint("an element `aero: { aerodynamics: … }` has it"),
        (_, hint) => finding.with_hint_from(hint),
    }
}
