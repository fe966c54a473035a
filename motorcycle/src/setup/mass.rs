//! Mass center and inertia of a vehicle in a pose, whole and by component.
//!
//! `m c = Σ mᵢ cᵢ`, `I = Σ (Iᵢ − mᵢ [cᵢ − c]×²)`. Axes of the heading, x forward, y left, z up; the origin lies on the road below the
//! rear contact. Tensor entries xx, yy, zz, xy, xz, yz in kg m², `xz = −∫ x z dm`.
//!
//! Source: parallel axes (Steiner); V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 3 (mass center, loads of the wheels at rest).

use super::Quantity;
use super::parts::{Parts, mean};
use mbody::description::urdf::Robot;
use mbody::model::{BodyIndex, Model};
use mbody::spatial::{MassProperties, Pose};

/// A link with its share of the whole.
#[derive(Clone, Debug)]
pub struct Component {
    /// Name of the link.
    pub name: String,
    /// Mass, kg; center, m; inertia about its own center, kg m²; in axes of the heading, from the rear contact.
    pub mass: MassProperties,
    /// Its part of the inertia about the mass center of the whole, kg m²: xx, yy, zz, xy, xz, yz.
    pub share: [f64; 6],
}

/// All links with mass that move, and the whole, in axes of the heading from the rear contact.
pub(super) fn masses(parts: &Parts, (robot, model): (&Robot, &Model), poses: &[Pose<f64>]) -> (Vec<Component>, MassProperties) {
    let from_world = parts.heading(poses).inverse();
    let links = robot.links.iter().filter_map(|link| {
        let (mass, frame) = (link.mass?, model.frame(&link.name)?);
        let moves = frame.body != BodyIndex::WORLD && mass.mass > 0.0;
        moves.then(|| (link.name.clone(), mass.in_parent(&(from_world * poses[frame.body.get()] * frame.X_BF))))
    });
    let links: Vec<(String, MassProperties)> = links.collect();
    let whole = links.iter().fold(MassProperties::NONE, |sum, (_, m)| sum.welded_with(m));
    let components = links.into_iter().map(|(name, mass)| {
        let d = mass.center - whole.center;
        let steiner = [d.y * d.y + d.z * d.z, d.x * d.x + d.z * d.z, d.x * d.x + d.y * d.y, -d.x * d.y, -d.x * d.z, -d.y * d.z];
        let share = std::array::from_fn(|k| mass.inertia[k] + mass.mass * steiner[k]);
        Component { name, mass, share }
    });
    (components.collect(), whole)
}

/// Mass center, inertia and loads at rest.
pub(super) fn quantities(parts: &Parts, whole: &MassProperties, gravity: f64, poses: &[Pose<f64>]) -> Vec<Quantity> {
    let from_world = parts.heading(poses).inverse();
    let front = from_world.point(mean(parts.front.iter().map(|w| w.contact(poses).point))).x;
    let [xx, yy, zz, _, xz, _] = whole.inertia;
    let (c, weight) = (whole.center, whole.mass * gravity);
    let mut found = vec![
        Quantity::new("mass", "kg", whole.mass, "mass of all that moves"),
        Quantity::new("mass_center_forward", "m", c.x, "mass center ahead of the rear contact"),
        Quantity::new("mass_center_left", "m", c.y, "mass center to the left of the rear contact"),
        Quantity::new("mass_center_height", "m", c.z, "mass center above the road"),
        Quantity::new("roll_inertia", "kg m²", xx, "about the forward axis through the mass center"),
        Quantity::new("pitch_inertia", "kg m²", yy, "about the lateral axis through the mass center"),
        Quantity::new("yaw_inertia", "kg m²", zz, "about the vertical axis through the mass center"),
        Quantity::new("roll_yaw_inertia", "kg m²", xz, "product of inertia −∫ x z dm about the mass center"),
    ];
    if parts.side.is_empty() {
        found.extend([
            Quantity::new("front_load", "N", weight * c.x / front, "load of the front axle at rest"),
            Quantity::new("rear_load", "N", weight * (1.0 - c.x / front), "load of the rear axle at rest"),
            Quantity::new("front_load_share", "-", c.x / front, "share of the front axle in the weight at rest"),
        ]);
    }
    let angle = (c.z / front).atan();
    found.push(Quantity::new(
        "load_transfer_angle",
        "rad",
        angle,
        "slope of the line of load transfer: height of the mass center over wheelbase",
    ));
    found
}
