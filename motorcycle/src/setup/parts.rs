//! What a vehicle stands on and is steered by, read from its elements.
//!
//! An element of the kind `single_track` or `multi_track` says which wheels are in front and at the rear, and which joint steers. Without one,
//! the joint `steer` is the steering, wheels are all bodies that roll, and the foremost and the rearmost in the design pose are the axles.

use crate::signal::turning_axis;
use crate::steering::{self, MultiTrack, SingleTrack};
use mbody::contact::{Contact, Plane, Profile, Surface};
use mbody::dynamics::System;
use mbody::model::{BodyIndex, Outline};
use mbody::spatial::{Pose, Vec3};
use mbody::stage::Workspace;

/// Distance along the vehicle within which wheels are on one axle, m.
const SAME_AXLE: f64 = 0.05;

/// A wheel.
#[derive(Clone, Debug)]
pub struct Wheel {
    /// The body that rolls.
    pub body: BodyIndex,
    /// Its center in the frame of the body, m.
    pub center: Vec3<f64>,
    /// Unit axis of the spin, to the left, in the frame of the body.
    pub axis: Vec3<f64>,
    /// Shape of the tire.
    pub profile: Profile,
}

impl Wheel {
    /// Where the undeformed tire touches the level road.
    pub(super) fn contact(&self, poses: &[Pose<f64>]) -> Contact<f64> {
        let X = &poses[self.body.get()];
        let center = X.point(self.center);
        Contact::with_plane(&self.profile, center, X.R * self.axis, &Plane::LEVEL.tangent_plane(center.x, center.y))
    }

    /// Center in the world, m.
    pub(super) fn center(&self, poses: &[Pose<f64>]) -> Vec3<f64> {
        poses[self.body.get()].point(self.center)
    }
}

/// Wheels and steering of a vehicle.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The body that moves on the vehicle base.
    pub base: BodyIndex,
    /// The body carried by the steering joint, and the unit axis of the steering in it, upward; none where nothing steers.
    pub steer: Option<(BodyIndex, Vec3<f64>)>,
    /// Front wheels, at least one.
    pub front: Vec<Wheel>,
    /// Rear wheels, at least one.
    pub rear: Vec<Wheel>,
    /// Other wheels.
    pub side: Vec<Wheel>,
}

impl Parts {
    /// The parts of a vehicle; none where the system has no two axles that roll, or nothing that moves over the road.
    pub fn of(system: &System) -> Option<Self> {
        let observer = system.elements().iter().find_map(|e| {
            let track = e.force.law::<SingleTrack>().map(|course| (course, [].as_slice()));
            track.or_else(|| e.force.law::<MultiTrack>().map(|track| (&track.course, track.side.as_slice())))
        });
        match observer {
            Some((course, side)) => {
                let wheels = |wheels: &[steering::Wheel]| wheels.iter().map(wheel).collect();
                let steer = Some((course.steer, course.steer_axis));
                Some(Self { base: course.base, steer, front: wheels(&course.front), rear: wheels(&course.rear), side: wheels(side) })
            }
            None => Self::seen(system),
        }
    }

    /// The parts without an observer: what rolls, by its place.
    fn seen(system: &System) -> Option<Self> {
        let model = system.model();
        let base = model.moving().find(|&b| model.body(b).joint.velocities().first().is_some_and(|v| v.name == "forward_speed"))?;
        let mut w = Workspace::<f64>::new(model);
        w.to_coordinates(model, system.unknowns()[..model.layout().nq()].iter().map(|u| u.design));
        let steer = model.joint("steer").filter(|&b| model.body(b).joint.rotation_axis().is_some());
        let steer = steer.map(|body| {
            let axis = turning_axis(model, body);
            (body, if (w.world.X_WB[body.get()].R * axis).z < 0.0 { -axis } else { axis })
        });
        let elements = system.elements().iter().flat_map(|e| e.force.outlines(model));
        let mut wheels: Vec<Wheel> = Vec::new();
        for outline in elements.chain(system.constraints().iter().filter_map(|c| c.outline().cloned())) {
            if let Outline::Round { at: (body, center), axis, profile } = outline
                && wheels.iter().all(|w| w.body != body)
            {
                wheels.push(Wheel { body, center, axis, profile });
            }
        }
        let x = |wheel: &Wheel| wheel.center(&w.world.X_WB).x;
        let most = wheels.iter().map(x).fold(f64::NEG_INFINITY, f64::max);
        let least = wheels.iter().map(x).fold(f64::INFINITY, f64::min);
        if most - least <= SAME_AXLE || !most.is_finite() {
            return None;
        }
        let (front, others): (Vec<_>, Vec<_>) = wheels.into_iter().partition(|wheel| x(wheel) > most - SAME_AXLE);
        let (rear, side) = others.into_iter().partition(|wheel| x(wheel) < least + SAME_AXLE);
        Some(Self { base, steer, front, rear, side })
    }

    /// All wheels.
    pub(super) fn wheels(&self) -> impl Iterator<Item = &Wheel> {
        self.front.iter().chain(&self.rear).chain(&self.side)
    }

    /// Axes of the heading on the level road: forward, to the left, and the origin below the middle of the rear contact points.
    pub(super) fn heading(&self, poses: &[Pose<f64>]) -> Pose<f64> {
        let left = poses[self.base.get()].R.columns[1];
        let flat = f64::hypot(left.x, left.y);
        let y = Vec3::new(left.x / flat, left.y / flat, 0.0);
        let up = Vec3::new(0.0, 0.0, 1.0);
        let rear = mean(self.rear.iter().map(|w| w.contact(poses).point));
        Pose::new(mbody::spatial::Rotation::from_columns(y.cross(up), y, up), Vec3::new(rear.x, rear.y, 0.0))
    }
}

fn wheel(w: &steering::Wheel) -> Wheel {
    Wheel { body: w.body, center: Vec3::zero(), axis: w.axis, profile: w.profile.clone() }
}

/// Mean of points, of which there is at least one.
pub(super) fn mean(points: impl Iterator<Item = Vec3<f64>>) -> Vec3<f64> {
    let (sum, count) = points.fold((Vec3::zero(), 0.0), |(sum, n), p| (sum + p, n + 1.0));
    sum * (1.0 / count)
}
