//! Setup of a vehicle: what a workshop measures and adjusts, computed in a steady pose.
//!
//! | file | group |
//! |---|---|
//! | `parts` | wheels and steering, read from the elements |
//! | `geometry` | rake, trails, wheelbase |
//! | `mass` | mass center, inertia, loads at rest |
//! | `stand` | the vehicle on a stand with a jack under one axle |
//! | `suspension` | sag, wheel rate, motion ratios, reduced damping |
//! | `pull` | squat and dive |
//!
//! Everything is read from the assembled system, so any topology has what applies to it; the rest is left out with a reason. Travel is against
//! a chassis that stands as in the given pose.

mod geometry;
mod mass;
mod parts;
mod pull;
mod stand;
mod suspension;

pub use mass::Component;
pub use parts::{Parts, Wheel};
pub use pull::SquatLines;
pub use suspension::{SpringAt, Suspension, TravelPoint};

use mbody::assembly::Assembled;
use mbody::spatial::MassProperties;
use mbody::stage::Workspace;
use problem::AlgebraicMethod;

/// Sine of the lean up to which a vehicle counts as upright.
const UPRIGHT: f64 = 0.02;

/// A number of the setup.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Name, a stable public key.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Value, SI.
    pub value: f64,
    /// One sentence.
    pub about: &'static str,
}

impl Quantity {
    fn new(name: &'static str, unit: &'static str, value: f64, about: &'static str) -> Self {
        Self { name, unit, value, about }
    }
}

/// A wheel in a side view, in the heading from the rear contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Center (x, z), m.
    pub center: [f64; 2],
    /// Radius, m.
    pub radius: f64,
}

/// The side view of a vehicle.
#[derive(Clone, Debug, Default)]
pub struct SideView {
    /// Wheels.
    pub wheels: Vec<Disc>,
    /// Mass center (x, z), m.
    pub mass_center: [f64; 2],
    /// Contact point of the front axle (x, z), m.
    pub front_contact: [f64; 2],
    /// The steering axis: where it meets the road, and its point at the head.
    pub steering_axis: Option<[[f64; 2]; 2]>,
    /// Lines of the squat.
    pub squat: Option<SquatLines>,
}

/// The setup of a vehicle in a pose.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Geometry.
    pub geometry: Vec<Quantity>,
    /// Mass center, inertia, loads.
    pub mass: Vec<Quantity>,
    /// Squat and dive.
    pub pull: Vec<Quantity>,
    /// Links with mass.
    pub components: Vec<Component>,
    /// The whole.
    pub whole: MassProperties,
    /// Suspensions, from front to rear.
    pub suspensions: Vec<Suspension>,
    /// What does not apply, and why.
    pub left_out: Vec<(&'static str, String)>,
    /// The side view.
    pub side_view: SideView,
}

/// The setup of a vehicle whose coordinates are the first of `pose`; equilibria of the suspensions are found by `method`.
///
/// # Errors
/// The system is no vehicle with two axles.
///
/// Held by `tests/validation/setup.rs`.
pub fn setup(assembled: &Assembled, pose: &[f64], method: &mut dyn AlgebraicMethod) -> Result<Setup, String> {
    let system = &assembled.system;
    let model = system.model();
    let parts = Parts::of(system).ok_or("a setup needs a vehicle that moves on the road on wheels of at least two axles")?;
    let mut w = Workspace::<f64>::new(model);
    w.to_coordinates(model, pose[..model.layout().nq()].iter().copied());
    let poses = w.world.X_WB;
    let geometry = geometry::geometry(&parts, &poses);
    let (components, whole) = mass::masses(&parts, (&assembled.robot, model), &poses);
    let mass = mass::quantities(&parts, &whole, model.gravity().norm(), &poses);
    let front = parts.heading(&poses).inverse().point(parts::mean(parts.front.iter().map(|w| w.contact(&poses).point)));
    let transfer = whole.center.z / front.x;
    let leaning = poses[parts.base.get()].R.columns[1].z.abs() > UPRIGHT;
    let (mut suspensions, mut pull, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    let mut lines = None;
    for (axle, wheels) in [("front", &parts.front), ("rear", &parts.rear), ("side", &parts.side)] {
        if wheels.is_empty() {
            continue;
        }
        let what = |axle| match axle {
            "front" => "front suspension",
            "rear" => "rear suspension",
            _ => "side suspension",
        };
        let found = match suspension::suspension((system, &parts), (axle, wheels), pose, method) {
            Ok(found) => found,
            Err(because) => {
                left_out.push((what(axle), because));
                continue;
            }
        };
        if found.sag.is_none() {
            let because = "no equilibrium was found between this pose and a wheel that hangs; travel counts from the lowest one";
            left_out.push(("sag", format!("{axle}: {because}")));
        }
        let of_axle = match axle {
            "front" | "rear" if leaning => Err("they are defined in straight running, and the vehicle leans".to_owned()),
            "rear" => pull::squat((system, &parts), &found, &poses, transfer).map(|(quantities, squat)| {
                lines = Some(squat);
                quantities
            }),
            "front" => pull::dive((system, &parts), &found, &poses, transfer),
            _ => Ok(Vec::new()),
        };
        match of_axle {
            Ok(quantities) => pull.extend(quantities),
            Err(because) => left_out.push((if axle == "rear" { "squat" } else { "dive" }, because)),
        }
        suspensions.push(found);
    }
    let side_view = side_view(&parts, &poses, (&whole, front.x), lines);
    Ok(Setup { geometry, mass, pull, components, whole, suspensions, left_out, side_view })
}

fn side_view(
    parts: &Parts,
    poses: &[mbody::spatial::Pose<f64>],
    (whole, front): (&MassProperties, f64),
    squat: Option<SquatLines>,
) -> SideView {
    let from_world = parts.heading(poses).inverse();
    let flat = |p| {
        let p = from_world.point(p);
        [p.x, p.z]
    };
    let wheels = parts.wheels().map(|w| Disc { center: flat(w.center(poses)), radius: w.profile.radius() });
    let steering_axis = parts.steer.map(|(body, axis)| {
        let X = &poses[body.get()];
        let s = X.R * axis;
        [flat(X.p - s.scaled(X.p.z / s.z)), flat(X.p)]
    });
    SideView { wheels: wheels.collect(), mass_center: [whole.center.x, whole.center.z], front_contact: [front, 0.0], steering_axis, squat }
}
