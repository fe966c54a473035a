//! Puts the road of a maneuver under the wheels of a vehicle.

use crate::Failure;
use crate::base::base_name;
use mbody::description::finding::Finding;
use mbody::dynamics::{System, TreePlant};
use motorcycle::maneuver::Path;
use motorcycle::road::footing::QUANTITIES;
use motorcycle::road::{Passing, Relief, Tracks};
use problem::{At, Dae, Outputs, Plant};
use std::sync::Arc;

/// Names of the roads under the front and under the rear wheel.
pub const ROADS: [&str; 2] = ["front_road", "rear_road"];

/// A road under both wheels of a vehicle.
///
/// # Errors
/// It has no vehicle base, its tires know of no road, or it has no wheelbase.
pub fn under_wheels(reliefs: &[Arc<dyn Relief>], path: &Path, system: &Arc<System>) -> Result<Passing, Failure> {
    let mut plant = TreePlant::new(system.clone());
    let none = || Finding::error("no_vehicle_base", "this model has no vehicle base, so no road passes under it");
    let base = base_name(&plant).ok_or_else(none)?;
    felt(&plant, "it feels no uneven road", "; `road: { flat: {} }` is a level road")?;
    let wheelbase = known_wheelbase(&mut plant)?;
    let base = ["x", "y", "yaw", "forward_speed", "lateral_speed", "yaw_rate"].map(|name| format!("{base}.{name}"));
    Ok(Passing::new(Tracks { base, roads: ROADS.map(str::to_owned), wheelbase }, path.clone(), reliefs.to_vec()))
}

/// Refuses models whose tires know of no road, with what follows and a further hint.
///
/// # Errors
/// An input is missing.
pub fn felt(plant: &dyn Plant, so: &str, hint: &str) -> Result<(), Failure> {
    let names = ROADS.iter().flat_map(|road| QUANTITIES.map(|quantity| format!("{road}.{quantity}")));
    let Some(missing) = names.into_iter().find(|name| !plant.inputs().iter().any(|i| i.signal.name == *name)) else { return Ok(()) };
    let finding = Finding::error("missing_input", format!("this model has no input `{missing}`, so {so}"));
    Err(finding.with_hint(format!("elements `tire` with `road: front_road` and `road: rear_road` have it{hint}")).into())
}

/// Distance of the wheels, m.
///
/// # Errors
/// The model has no such signal.
pub fn known_wheelbase(plant: &mut TreePlant) -> Result<f64, Failure> {
    wheelbase(plant).ok_or_else(|| {
        let finding = Finding::error("missing_output", "this model has no signal `wheelbase`, so it is not known where its front wheel is");
        finding.with_hint("an element of the kind `single_track` has it").into()
    })
}

/// Distance of the contact points in the design pose, m.
fn wheelbase(plant: &mut TreePlant) -> Option<f64> {
    let at = plant.outputs().iter().position(|s| s.name == "wheelbase")?;
    let y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
    let u: Vec<f64> = plant.inputs().iter().map(|i| i.default).collect();
    let (mut residual, mut outputs) = (vec![0.0; plant.equations().len()], vec![0.0; plant.outputs().len()]);
    plant.evaluate(At { time: 0.0, y: &y, yd: &vec![0.0; y.len()], u: &u }, &mut residual, &mut outputs).ok()?;
    Some(outputs[at]).filter(|w| w.is_finite() && *w > 0.0)
}
