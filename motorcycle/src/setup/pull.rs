//! What thrust and braking do to the suspension: squat and dive, from the path of the contact point.
//!
//! With the chassis held and the drive (or the brake) locked, the point of the tire at the contact K moves by (x', z') per travel. A force of the
//! road does no work on the spring along
//!
//! ```text
//! tan σ = −x'/z'     thrust     R = (h/p)/tan σ          tan β = x'/z'     braking     D = tan β/(h/p)
//! ```
//!
//! | symbol | | |
//! |---|---|---|
//! | σ, β | rad | squat angle at the rear; angle of the braking force at the front, negative where braking itself compresses the fork |
//! | R | - | squat ratio: 1 – the spring does not move under thrust, above 1 – it is compressed, below – extended |
//! | D | - | share of the load transfer that does not compress the front, when the front wheel alone brakes (anti-dive) |
//! | h, p | m | height of the mass center, wheelbase |
//!
//! Locked means: a chain does not run, `t·(v_C + ω × (X2 − C)) = 0` on its tight run with the direction t and the point X2 on the rear sprocket;
//! with a shaft, a motor in the arm or a brake the wheel turns with the body that takes the reaction.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 6 (squat line, squat angle and ratio), of which this is the kinematic
//! statement: for a chain it agrees with [`crate::drivetrain::squat`]. Range: straight running, wheels in the middle plane.

use super::Quantity;
use super::parts::{Parts, Wheel};
use super::suspension::Suspension;
use crate::Planar;
use crate::brake::Brake;
use crate::drivetrain::{Chain, ChainRun, Run, ShaftDrive, Sprocket, squat};
use mbody::dynamics::System;
use mbody::force::JointEffort;
use mbody::model::BodyIndex;
use mbody::spatial::{Pose, Vec3};

/// Lines of a side view, points (x, z) in the heading from the rear contact, m.
#[derive(Clone, Debug, Default)]
pub struct SquatLines {
    /// Upper run of the chain: on the rear and on the front sprocket.
    pub chain: Option<[[f64; 2]; 2]>,
    /// Centers and pitch radii of rear and front sprocket.
    pub sprockets: Option<[([f64; 2], f64); 2]>,
    /// Rear axle and pivot of the arm.
    pub arm: Option<[[f64; 2]; 2]>,
    /// Where run and arm meet.
    pub squat_point: Option<[f64; 2]>,
    /// Slope of the squat line through the rear contact.
    pub slope: f64,
}

/// How the driven wheel is held when its drive is locked.
enum Drive<'s> {
    Chain(&'s Chain),
    With(BodyIndex),
}

fn drive<'s>(system: &'s System, wheel: &Wheel) -> Option<Drive<'s>> {
    let laws = || system.elements().iter().map(|e| &e.force);
    let chain = laws().find_map(|f| f.law::<Chain>().filter(|c| c.wheel == wheel.body)).map(Drive::Chain);
    let shaft = || laws().find_map(|f| f.law::<ShaftDrive>().filter(|s| s.wheel == wheel.body)).map(|s| Drive::With(s.reaction));
    let motor = || laws().find_map(|f| f.law::<JointEffort>().filter(|j| j.joint == wheel.body));
    chain.or_else(shaft).or_else(|| motor().map(|_| Drive::With(system.model().body(wheel.body).parent)))
}

/// Rate of the point of a tire at its contact, forward and up in the heading, for a wheel that turns by ω per travel.
fn contact_rate(wheel: &Wheel, poses: &[Pose<f64>], heading: &Pose<f64>, center: Vec3<f64>, omega: Vec3<f64>) -> Planar<f64> {
    let arm = wheel.contact(poses).point - wheel.center(poses);
    let rate = heading.R.inverse_times(center + omega.cross(arm));
    Planar::new(rate.x, rate.z)
}

/// Turn per travel of a wheel whose chain does not run.
fn locked_by_chain(chain: &Chain, wheel: &Wheel, poses: &[Pose<f64>], center: Vec3<f64>) -> Vec3<f64> {
    let X_WC = poses[chain.chassis.get()] * chain.front;
    let run = upper_run(chain, poses);
    let space = |p: Planar<f64>| Vec3::new(p.x, 0.0, p.z);
    let (t, on_rear) = (X_WC.R * space(run.direction), X_WC.point(space(run.rear)));
    let axis = poses[wheel.body.get()].R * wheel.axis;
    let lever = axis.cross(on_rear - wheel.center(poses)).dot(t);
    axis.scaled(-center.dot(t) / lever)
}

/// The upper run in the plane of the chain.
fn upper_run(chain: &Chain, poses: &[Pose<f64>]) -> ChainRun<f64> {
    let axle = (poses[chain.chassis.get()] * chain.front).inverse().point(poses[chain.wheel.get()].p);
    let front = Sprocket { center: Planar::new(0.0, 0.0), radius: chain.front_radius };
    ChainRun::between(front, Sprocket { center: Planar::new(axle.x, axle.z), radius: chain.rear_radius }, Run::Upper)
}

/// Squat of the rear axle; a reason where there is none. `transfer` is h/p.
pub(super) fn squat(
    (system, parts): (&System, &Parts),
    suspension: &Suspension,
    poses: &[Pose<f64>],
    transfer: f64,
) -> Result<(Vec<Quantity>, SquatLines), String> {
    let [wheel] = parts.rear.as_slice() else { return Err("the rear axle has several wheels".to_owned()) };
    let drive = drive(system, wheel).ok_or("no chain, shaft or motor drives the rear wheel")?;
    let heading = parts.heading(poses);
    let center = suspension.motion.center(wheel);
    let omega = match drive {
        Drive::Chain(chain) => locked_by_chain(chain, wheel, poses, center),
        Drive::With(body) => suspension.motion.turn(body),
    };
    let rate = contact_rate(wheel, poses, &heading, center, omega);
    let slope = -rate.x / rate.z;
    let mut found = vec![
        Quantity::new(
            "squat_angle",
            "rad",
            slope.atan(),
            "slope of the line along which the road pushes the rear wheel without moving its spring",
        ),
        Quantity::new("squat_ratio", "-", transfer / slope, "above 1 thrust compresses the rear, below 1 it extends it"),
    ];
    let mut lines = SquatLines { slope, ..SquatLines::default() };
    let flat = |p: Vec3<f64>| {
        let p = heading.inverse().point(p);
        [p.x, p.z]
    };
    let pivot = pivot(system, parts, wheel).map(|body| poses[body.get()].p);
    lines.arm = pivot.map(|pivot| [flat(wheel.center(poses)), flat(pivot)]);
    if let Drive::Chain(chain) = drive {
        let X_WC = poses[chain.chassis.get()] * chain.front;
        let run = upper_run(chain, poses);
        let space = |p: Planar<f64>| flat(X_WC.point(Vec3::new(p.x, 0.0, p.z)));
        lines.chain = Some([space(run.rear), space(run.front)]);
        lines.sprockets = Some([(flat(wheel.center(poses)), chain.rear_radius), (flat(X_WC.p), chain.front_radius)]);
        let radius = heading.inverse().point(wheel.center(poses)).z;
        let per_thrust = radius / chain.rear_radius;
        found.push(Quantity::new("chain_force_per_thrust", "-", per_thrust, "tension of the tight run over the thrust of the rear wheel"));
        if let Some([axle, pivot]) = lines.arm {
            let [rear, front] = [space(run.rear), space(run.front)].map(Planar::from);
            let direction = front - rear;
            let flat_run = ChainRun { front, rear, direction: direction.scaled(1.0 / direction.norm()), length: run.length };
            let A = squat::squat_point(&flat_run, pivot.into(), axle.into());
            lines.squat_point = Some([A.x, A.z]).filter(|p| p.iter().all(|v| v.is_finite()));
            if lines.squat_point.is_some() {
                let about = "where the upper run of the chain meets the line from axle to pivot, ahead of the rear contact";
                found.push(Quantity::new("squat_point_forward", "m", A.x, about));
                found.push(Quantity::new("squat_point_height", "m", A.z, "height of that point above the road"));
            }
        }
    }
    Ok((found, lines))
}

/// The body on the arm's side of the pivot: the last one between wheel and chassis whose joint turns about the lateral axis.
fn pivot(system: &System, parts: &Parts, wheel: &Wheel) -> Option<BodyIndex> {
    let model = system.model();
    let arm = model.body(wheel.body).parent;
    let (mut at, mut found) = (arm, None);
    while at != parts.base && at != BodyIndex::WORLD {
        if model.body(at).joint.rotation_axis().is_some_and(|axis| axis.y.abs() > 0.9) {
            found = Some(at);
        }
        at = model.body(at).parent;
    }
    found
}

/// Dive of the front axle; a reason where there is none. `transfer` is h/p.
pub(super) fn dive(
    (system, parts): (&System, &Parts),
    suspension: &Suspension,
    poses: &[Pose<f64>],
    transfer: f64,
) -> Result<Vec<Quantity>, String> {
    let [wheel] = parts.front.as_slice() else { return Err("the front axle has several wheels".to_owned()) };
    let brake = system.elements().iter().find_map(|e| e.force.law::<Brake>().filter(|b| b.wheel == wheel.body));
    let brake = brake.ok_or("no brake acts on the front wheel")?;
    let reaction = brake.floating.map_or(system.model().body(wheel.body).parent, |(body, _)| body);
    let heading = parts.heading(poses);
    let rate = contact_rate(wheel, poses, &heading, suspension.motion.center(wheel), suspension.motion.turn(reaction));
    let slope = rate.x / rate.z;
    Ok(vec![
        Quantity::new(
            "braking_angle",
            "rad",
            slope.atan(),
            "slope of the line along which braking the front wheel would not move its spring; negative: braking itself compresses it",
        ),
        Quantity::new(
            "anti_dive",
            "-",
            slope / transfer,
            "share of the load transfer that does not compress the front when the front wheel alone brakes",
        ),
    ])
}
