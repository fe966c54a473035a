//! What kind of vehicle a plant is, read from the names of its signals.

use motorcycle::steering::STANDS;
use problem::{Plant, Unknown};

/// The name of the base link: the owner of `<base>.forward_speed`.
pub fn base_name(plant: &dyn Plant) -> Option<String> {
    base_of(plant.unknowns())
}

/// The name of the base link among unknowns.
pub fn base_of(unknowns: &[Unknown]) -> Option<String> {
    unknowns.iter().find_map(|u| u.signal.name.strip_suffix(".forward_speed").map(str::to_owned))
}

/// Whether the vehicle stands on its wheels: then a turn is given and its roll is found, where a leaning one is given its roll.
pub fn stands(plant: &dyn Plant) -> bool {
    plant.outputs().iter().any(|output| output.name == STANDS)
}
