//! What is shown: bodies with their shapes, springs and rods between them, contacts.

use super::contact::Rolling;
use super::shape::{Shapes, quaternion, travels, vector};
use mbody::assembly::Assembled;
use mbody::dynamics::System;
use mbody::model::{Attachment, BodyIndex, Outline};
use mbody::spatial::{Pose, Vec3};
use mbody::stage::Workspace;
use serde_json::{Value, json};
use std::sync::Arc;

/// Numbers of the pose of one body: position, quaternion (x, y, z, w).
const NUMBERS: usize = 7;

/// The scene of a model.
pub struct Scene {
    pub(super) system: Arc<System>,
    pub(super) rolling: Vec<Rolling>,
    description: Value,
    /// The body that the camera follows, where one travels.
    pub(super) follows: Option<BodyIndex>,
    /// Points that are to be seen where no body travels.
    points: Vec<Attachment>,
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.description)
    }
}

impl Scene {
    /// The scene of a model.
    pub fn of(assembled: &Assembled) -> Self {
        let system = assembled.system.clone();
        let model = system.model();
        let rolling = Rolling::all(&system);
        let mut w = Workspace::<f64>::new(model);
        let nq = model.layout().nq();
        w.to_coordinates(model, system.unknowns()[..nq].iter().map(|u| u.design));
        let follows = model.moving().find(|&b| travels(model.body(b)));
        let mut points = Vec::new();
        for b in model.moving() {
            let body = model.body(b);
            points.push((b, body.mass.center));
            if !travels(body) {
                points.extend([(b, Vec3::zero()), (body.parent, body.X_PF.p)]);
            }
        }
        for r in &rolling {
            let up = Vec3::new(0.0, 0.0, r.profile.radius());
            points.extend([(r.at.0, r.at.1 + up), (r.at.0, r.at.1 - up)]);
        }
        for outline in outlines(&system) {
            if let Outline::Spring { from, to } | Outline::Rod { from, to } = outline {
                points.extend([from, to]);
            }
        }
        let (low, high) = bounds(points.iter().map(|(b, p)| w.world.X_WB[b.get()].point(*p)));
        let size = (high - low).norm().max(1e-3);
        let shapes = Shapes { system: &system, robot: &assembled.robot, rolling: &rolling, size };
        let bodies: Vec<Value> = (std::iter::once(BodyIndex::WORLD).chain(model.moving()))
            .map(|b| json!({ "name": model.body(b).name, "shapes": shapes.of(b) }))
            .collect();
        let description = json!({
            "size": size,
            "ground": !rolling.is_empty(),
            "weightless": model.gravity().norm() == 0.0,
            "bodies": bodies,
            "links": links(&system),
            "contacts": rolling.iter().map(Rolling::json).collect::<Vec<_>>(),
            "follows": follows.map(BodyIndex::get),
        });
        Self { system: system.clone(), rolling, description, follows, points }
    }

    /// Names of the signals from which contacts are drawn; not all of them need exist.
    pub fn signals(&self) -> Vec<String> {
        self.rolling.iter().flat_map(Rolling::signals).collect()
    }

    /// As the viewer reads it, with the box in which everything happens.
    pub(super) fn json(&self, frames: &[Vec<Pose<f64>>]) -> Value {
        let everywhere = frames.iter().flat_map(|poses| self.points.iter().map(|(b, p)| poses[b.get()].point(*p)));
        let (low, high) = bounds(everywhere);
        let mut scene = self.description.clone();
        scene["box"] = json!([vector(low), vector(high)]);
        scene
    }

    /// Poses of all bodies, world included, at the given independent coordinates.
    pub(super) fn poses(&self, w: &mut Workspace<f64>, q: impl Iterator<Item = f64>) -> Vec<Pose<f64>> {
        w.to_coordinates(self.system.model(), q);
        w.world.X_WB.clone()
    }
}

/// Numbers of the poses of all bodies but the world.
pub(super) fn numbers(poses: &[Pose<f64>]) -> impl Iterator<Item = f64> {
    poses.iter().skip(1).flat_map(|pose| -> [f64; NUMBERS] {
        let ([x, y, z], [i, j, k, w]) = (vector(pose.p), quaternion(&pose.R));
        [x, y, z, i, j, k, w]
    })
}

/// Least and largest coordinates of the points that are finite.
fn bounds(points: impl Iterator<Item = Vec3<f64>>) -> (Vec3<f64>, Vec3<f64>) {
    let (mut low, mut high) = (Vec3::new(f64::MAX, f64::MAX, f64::MAX), Vec3::new(f64::MIN, f64::MIN, f64::MIN));
    for p in points.filter(|p| p.norm().is_finite()) {
        low = Vec3::new(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        high = Vec3::new(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    }
    if low.x > high.x { (Vec3::zero(), Vec3::zero()) } else { (low, high) }
}

/// What elements and constraints show of themselves.
fn outlines(system: &System) -> impl Iterator<Item = Outline> {
    let elements = system.elements().iter().flat_map(|e| e.force.outlines(system.model()));
    elements.chain(system.constraints().iter().filter_map(|c| c.outline().cloned()))
}

/// Springs and rods between points of two bodies.
fn links(system: &System) -> Vec<Value> {
    let end = |(body, p): Attachment| json!([body.get(), p.x, p.y, p.z]);
    let link = |kind: &str, from, to| json!({ "kind": kind, "from": end(from), "to": end(to) });
    let drawn = outlines(system).filter_map(|outline| match outline {
        Outline::Round { .. } => None,
        Outline::Spring { from, to } => Some(link("spring", from, to)),
        Outline::Rod { from, to } => Some(link("rod", from, to)),
    });
    drawn.collect()
}
