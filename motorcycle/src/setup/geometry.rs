//! Geometry of a vehicle in a pose: rake, trails, wheelbase.
//!
//! ```text
//! ε = atan2(−s·x, s·u)     a = (G − P_f)·x_f     a_n = ((P_f − O) × s)·n_f     d = ((C_f − O) × s)·(−n_f)     p = |P_f − P_r|
//! a_n = a cos ε and d = R sin ε − a_n for an upright vehicle whose tire is a disc of radius R
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | ε | rad | rake (caster angle): inclination of the steering axis in the middle plane of the chassis, positive when its upper end is behind |
//! | x, u | | forward along the heading, upward in the middle plane |
//! | a, a_n | m | trail on the road, positive where the axis meets the road ahead of the contact; normal (mechanical) trail |
//! | d | m | offset of the front axle from the steering axis, positive ahead of it |
//! | p, b | m | wheelbase; width of the track |
//! | O, s, G | m | point of the steering axis, its upward direction, its intersection with the road |
//! | P, C, n, x_f | m | contact point of the undeformed tire, wheel center, axis to the left, forward along the front contact |
//!
//! Several wheels of an axle count as their mean. Source: V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 1. Range: level road.

use super::Quantity;
use super::parts::{Parts, mean};
use mbody::spatial::{Pose, Vec3};

/// Geometry in the pose in which bodies stand as given.
pub(super) fn geometry(parts: &Parts, poses: &[Pose<f64>]) -> Vec<Quantity> {
    let heading = parts.heading(poses);
    let contacts: Vec<_> = parts.front.iter().map(|w| w.contact(poses)).collect();
    let front = mean(contacts.iter().map(|c| c.point));
    let rear = mean(parts.rear.iter().map(|w| w.contact(poses).point));
    let mut found = Vec::new();
    if let Some((body, axis)) = parts.steer {
        let X = &poses[body.get()];
        let s = X.R * axis;
        // upward in the middle plane of the chassis, which leans
        let side = poses[parts.base.get()].R.columns[1];
        let up = (Vec3::new(0.0, 0.0, 1.0) - side.scaled(side.z)).normalized().unwrap_or(Vec3::new(0.0, 0.0, 1.0));
        let rake = (-s.dot(heading.R.columns[0])).atan2(s.dot(up));
        let forward = mean(contacts.iter().map(|c| c.frame.x)).normalized().unwrap_or(Vec3::new(1.0, 0.0, 0.0));
        let left = mean(parts.front.iter().map(|w| poses[w.body.get()].R * w.axis)).normalized().unwrap_or(Vec3::new(0.0, 1.0, 0.0));
        let on_road = X.p - s.scaled(X.p.z / s.z);
        let center = mean(parts.front.iter().map(|w| w.center(poses)));
        found.extend([
            Quantity::new("rake", "rad", rake, "inclination of the steering axis in the middle plane, positive backward"),
            Quantity::new(
                "trail",
                "m",
                (on_road - front).dot(forward),
                "from the front contact point forward to the steering axis, on the road",
            ),
            Quantity::new(
                "normal_trail",
                "m",
                (front - X.p).cross(s).dot(left),
                "distance of the front contact point from the steering axis",
            ),
            Quantity::new(
                "fork_offset",
                "m",
                -(center - X.p).cross(s).dot(left),
                "distance of the front axle from the steering axis, positive ahead of it",
            ),
        ]);
    }
    found.push(Quantity::new("wheelbase", "m", (front - rear).norm(), "distance of the contact points"));
    let across: Vec<f64> = parts.wheels().map(|w| heading.inverse().point(w.contact(poses).point).y).collect();
    if parts.front.len() + parts.rear.len() + parts.side.len() > 2 {
        let (low, high) = across.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
        found.push(Quantity::new("track_width", "m", high - low, "distance of the outermost contact points across the heading"));
    }
    found
}
