//! Puts the road of a maneuver under the wheels of a vehicle.

use crate::Failure;
use crate::plan::base_name;
use crate::responses::ROADS;
use mbody::description::finding::Finding;
use mbody::dynamics::{System, TreePlant};
use motorcycle::maneuver::Path;
use motorcycle::road::{Passing, Relief, Tracks};
use problem::{At, Dae, Outputs};
use std::sync::Arc;

/// A road under both wheels of a vehicle.
///
/// # Errors
/// It has no vehicle base, its tires know of no road, or it has no wheelbase.
pub fn under_wheels(relief: &Arc<dyn Relief>, path: &Path, system: &Arc<System>) -> Result<Passing, Failure> {
    let mut plant = TreePlant::new(system.clone());
    let none = || Finding::error("no_vehicle_base", "this model has no vehicle base, so no road passes under it");
    let base = base_name(&plant).ok_or_else(none)?;
    let heights = [ROADS[0].to_owned(), format!("{}_rate", ROADS[0]), ROADS[1].to_owned(), format!("{}_rate", ROADS[1])];
    if let Some(missing) = heights.iter().find(|name| !plant.inputs().iter().any(|i| i.signal.name == **name)) {
        let finding = Finding::error("missing_input", format!("this model has no input `{missing}`, so its wheels feel no uneven road"));
        return Err(finding
            .with_hint("elements `tire` with `road: front_road` and `road: rear_road` have it; `road: { flat: {} }` is a level road")
            .into());
    }
    let wheelbase = wheelbase(&mut plant).ok_or_else(|| {
        let finding = Finding::error("missing_output", "this model has no signal `wheelbase`, so it is not known where its front wheel is");
        finding.with_hint("an element of the kind `single_track` has it")
    })?;
    let base = ["x", "y", "yaw", "forward_speed", "lateral_speed"].map(|name| format!("{base}.{name}"));
    Ok(Passing::new(Tracks { base, heights, wheelbase }, path.clone(), relief.clone()))
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
