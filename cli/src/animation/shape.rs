//! Shapes of bodies where nobody drew them: struts between the points where something acts, and the ellipsoid of gyration.
//!
//! `a_i² = (I_j + I_k − I_i) / 2m = ∫ x_i² dm / m`: semi-axes, m, along the principal axes of the inertia, for mass m, kg, and principal
//! moments I, kg m². Source: elementary.

use super::contact::Rolling;
use mbody::description::urdf::{Robot, Shape, Visual};
use mbody::dynamics::System;
use mbody::model::{Attachment, Body, BodyIndex, Model, Outline};
use mbody::spatial::{MassProperties, Pose, Rotation, Vec3};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use serde_json::{Value, json};

/// Thickness of a strut over the size of the scene.
const STRUT: f64 = 0.008;
/// Distance below which two points are one, over the size of the scene.
const SAME: f64 = 1e-4;
/// Half the width of a handlebar, m.
const HANDLEBAR: f64 = 0.34;

/// A vector as the viewer reads it.
pub(super) fn vector(v: Vec3<f64>) -> [f64; 3] {
    v.into()
}

/// Quaternion (x, y, z, w) of a rotation.
pub(super) fn quaternion(rotation: &Rotation<f64>) -> [f64; 4] {
    let [x, y, z] = rotation.columns;
    let matrix = Matrix3::new(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
    [q.i, q.j, q.k, q.w]
}

/// Whether a joint lets its body travel freely, so that its origin is no bearing.
pub(super) fn travels(body: &Body) -> bool {
    body.v.len() >= 3 && body.joint.velocities().iter().any(|v| v.unit == "m/s")
}

/// What bodies are drawn from.
pub(super) struct Shapes<'a> {
    pub system: &'a System,
    pub robot: &'a Robot,
    pub rolling: &'a [Rolling],
    /// Size of the scene, m.
    pub size: f64,
}

impl Shapes<'_> {
    fn model(&self) -> &Model {
        self.system.model()
    }

    /// Shapes of one body, in its frame.
    pub(super) fn of(&self, index: BodyIndex) -> Vec<Value> {
        let body = self.model().body(index);
        let mut shapes = self.visuals(index);
        if shapes.is_empty() {
            shapes = self.struts(index);
            if !self.rolling.iter().any(|r| r.at.0 == index) {
                shapes.extend(ellipsoid(&body.mass, 0.02 * self.size));
            }
            if body.joint_name == "steer" && self.carries_rolling(index) {
                let side = Vec3::new(0.0, HANDLEBAR, 0.12);
                let (left, right) = (side, Vec3::new(0.0, -HANDLEBAR, 0.12));
                shapes.push(self.strut(left, right));
            }
        }
        if index != BodyIndex::WORLD && body.mass.mass > 0.0 {
            shapes.push(json!({ "kind": "center", "at": vector(body.mass.center), "mass": body.mass.mass }));
        }
        shapes
    }

    /// Whether a round body hangs on this one.
    fn carries_rolling(&self, index: BodyIndex) -> bool {
        let parents = |mut at: BodyIndex| {
            while at != BodyIndex::WORLD && at != index {
                at = self.model().body(at).parent;
            }
            at == index
        };
        self.rolling.iter().any(|r| parents(r.at.0))
    }

    /// What the URDF shows of the links that are welded together in this body.
    fn visuals(&self, index: BodyIndex) -> Vec<Value> {
        let frames = self.model().frames().iter().filter(|f| f.body == index);
        let links = frames.filter_map(|f| self.robot.links.iter().find(|l| l.name == f.name).map(|l| (f, l)));
        links.flat_map(|(f, l)| l.visuals.iter().filter_map(|v| visual(&(f.X_BF * v.origin), v))).collect()
    }

    fn strut(&self, from: Vec3<f64>, to: Vec3<f64>) -> Value {
        json!({ "kind": "strut", "from": vector(from), "to": vector(to), "radius": STRUT * self.size })
    }

    /// Points of a body where joints, constraints and elements act.
    fn points(&self, index: BodyIndex) -> Vec<Vec3<f64>> {
        let model = self.model();
        let mut points = Vec::new();
        let mut add = |(body, p): Attachment| {
            if body == index && points.iter().all(|q: &Vec3<f64>| (*q - p).norm() > SAME * self.size) {
                points.push(p);
            }
        };
        if index != BodyIndex::WORLD && !travels(model.body(index)) {
            add((index, Vec3::zero()));
        }
        for child in model.moving().map(|b| model.body(b)).filter(|b| !travels(b)) {
            add((child.parent, child.X_PF.p));
        }
        for constraint in self.system.constraints().iter().filter(|c| !matches!(c.outline(), Some(Outline::Round { .. }))) {
            add(constraint.from().origin());
            add(constraint.to().origin());
        }
        for outline in self.system.elements().iter().flat_map(|e| e.force.outlines(model)) {
            if let Outline::Spring { from, to } | Outline::Rod { from, to } = outline {
                add(from);
                add(to);
            }
        }
        points
    }

    /// Struts between all points of a body, or from a single one to the mass center; legs on both sides of a wheel.
    fn struts(&self, index: BodyIndex) -> Vec<Value> {
        let points = self.points(index);
        if index == BodyIndex::WORLD {
            return points.iter().map(|p| json!({ "kind": "bearing", "at": vector(*p), "radius": 2.2 * STRUT * self.size })).collect();
        }
        if self.rolling.iter().any(|r| r.at.0 == index) {
            return Vec::new();
        }
        let body = self.model().body(index);
        let mut shapes = Vec::new();
        let center = body.mass.center;
        match points.as_slice() {
            [] => {}
            [point] if body.mass.mass > 0.0 && (center - *point).norm() > SAME * self.size => shapes.push(self.strut(*point, center)),
            [_] => {}
            [first, .., last] if points.len() > 4 => {
                let hub = if body.mass.mass > 0.0 { center } else { (*first + *last) * 0.5 };
                points.iter().for_each(|p| self.legs(index, *p, hub, &mut shapes));
            }
            _ => {
                for (k, a) in points.iter().enumerate() {
                    points[k + 1..].iter().for_each(|b| self.legs(index, *a, *b, &mut shapes));
                }
            }
        }
        shapes
    }

    /// A strut, or two where one end is the center of a wheel.
    fn legs(&self, index: BodyIndex, a: Vec3<f64>, b: Vec3<f64>, shapes: &mut Vec<Value>) {
        let (wheel, other, side) = match (self.half_axle(index, a), self.half_axle(index, b)) {
            (Some(side), _) => (a, b, side),
            (None, Some(side)) => (b, a, side),
            (None, None) => return shapes.push(self.strut(a, b)),
        };
        for sign in [side, -side] {
            shapes.push(self.strut(wheel + sign, other + sign));
        }
        shapes.push(self.strut(other + side, other - side));
        shapes.push(self.strut(wheel + side, wheel - side));
    }

    /// Half the width that the wheel with its center at this point needs, along its axle.
    fn half_axle(&self, index: BodyIndex, point: Vec3<f64>) -> Option<Vec3<f64>> {
        let carried = |r: &&Rolling| {
            let wheel = self.model().body(r.at.0);
            wheel.parent == index && (wheel.X_PF.point(r.at.1) - point).norm() < SAME * self.size
        };
        let rolling = self.rolling.iter().find(carried)?;
        let wheel = self.model().body(rolling.at.0);
        let axis = wheel.X_PF.R * wheel.joint.rotation_axis()?;
        Some(axis * (rolling.profile.curvature_radius(0.0).min(0.3 * rolling.profile.radius()) + 3.0 * STRUT * self.size))
    }
}

/// The ellipsoid of gyration; a point mass is a ball of the least size.
fn ellipsoid(mass: &MassProperties, least: f64) -> Option<Value> {
    if mass.mass <= 0.0 {
        return None;
    }
    let [xx, yy, zz, xy, xz, yz] = mass.inertia;
    let eigen = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigen();
    let moments = eigen.eigenvalues;
    let semi = [0, 1, 2].map(|i| (0.5 / mass.mass * (moments.sum() - 2.0 * moments[i])).max(0.0).sqrt().max(least));
    let column = |k: usize| Vec3::new(eigen.eigenvectors[(0, k)], eigen.eigenvectors[(1, k)], eigen.eigenvectors[(2, k)]);
    let (x, y) = (column(0), column(1));
    let turn = quaternion(&Rotation::from_columns(x, y, x.cross(y)));
    Some(json!({ "kind": "ellipsoid", "at": vector(mass.center), "turn": turn, "semi": semi }))
}

/// A shape of the URDF; meshes stay out, since a page opens no other file.
fn visual(pose: &Pose<f64>, visual: &Visual) -> Option<Value> {
    let mut shape = match visual.shape {
        Shape::Mesh { .. } => return None,
        Shape::Box { size } => json!({ "kind": "box", "size": size }),
        Shape::Cylinder { radius, length } => json!({ "kind": "cylinder", "radius": radius, "length": length }),
        Shape::Capsule { radius, length } => json!({ "kind": "capsule", "radius": radius, "length": length }),
        Shape::Sphere { radius } => json!({ "kind": "sphere", "radius": radius }),
    };
    shape["at"] = json!(vector(pose.p));
    shape["turn"] = json!(quaternion(&pose.R));
    if let Some(color) = visual.color {
        shape["color"] = json!(color);
    }
    Some(shape)
}
