//! What ends a motion: conditions of the user, and a vehicle that lies on its side.

use super::start::quantity;
use crate::Failure;
use crate::arguments::{argument, unknown_name};
use crate::base::base_name;
use analyses::Variables;
use problem::{Limit, Plant, Side};

/// Roll at which a vehicle has fallen, rad: 85°. Nothing but its tires touches the road.
const FALLEN: f64 = 1.483_529_864_195_180_2;
/// Pitch at which a vehicle has turned over, rad: 120°. It will not come down on its wheels.
const OVERTURNED: f64 = 2.094_395_102_393_195_3;
/// Name of the ending of a fallen vehicle.
pub const FALL: &str = "fallen";
/// Name of the ending by a condition of the user.
pub const UNTIL: &str = "until";

/// The conditions `SIGNAL>VALUE` or `SIGNAL<VALUE` of the user, then the fall where there is a vehicle.
///
/// # Errors
/// A condition of another form, a signal that is not there, a value that cannot be read.
pub fn conditions(until: &[String], plant: &dyn Plant) -> Result<Vec<Limit>, Failure> {
    let variables = Variables::of(plant);
    let mut conditions = until.iter().map(|text| condition(text, &variables)).collect::<Result<Vec<_>, _>>()?;
    if let Some(base) = base_name(plant) {
        // wheels that cannot lift roll on, and a bicycle that lies down pitches with them
        let lifts = plant.limits().iter().any(|limit| limit.name == "wheel_lifted");
        let ways = if lifts { 2 } else { 1 };
        let angles = [("roll", FALLEN, "the vehicle lies on its side"), ("pitch", OVERTURNED, "the vehicle has turned over")];
        for (angle, most, about) in angles.into_iter().take(ways) {
            for (side, threshold) in [(Side::Above, most), (Side::Below, -most)] {
                let signal = format!("{base}.{angle}");
                conditions.push(Limit { name: FALL.into(), signal, threshold, side, nominal: 1.0, about: about.into() });
            }
        }
    }
    Ok(conditions)
}

fn condition(text: &str, variables: &Variables) -> Result<Limit, Failure> {
    let Some(at) = text.find(['<', '>']) else {
        let finding = argument("until", text, "bad_argument", "this is not of the form SIGNAL>VALUE or SIGNAL<VALUE");
        return Err(finding.with_hint("for example `--until 'chassis.forward_speed<5'`").into());
    };
    let side = if text[at..].starts_with('>') { Side::Above } else { Side::Below };
    let (name, value) = (text[..at].trim(), text[at + 1..].trim());
    let Some(variable) = variables.find(name) else {
        return Err(unknown_name("until", text, ("signal", name), variables.names()).into());
    };
    let threshold = quantity(value, &variables.unit(variable))
        .map_err(|(code, why, hint)| Failure::from(argument("until", text, code, why).with_hint_from(hint)))?;
    Ok(Limit { name: UNTIL.into(), signal: name.to_owned(), threshold, side, nominal: 1.0, about: "asked for".into() })
}
