//! From the records of `urdf-rs` to bodies and joints in our own terms.

use super::entry::{Inertial, JOINT_ENTRIES};
use super::place::Places;
use super::skeleton::{Skeleton, SkeletonJoint, TreeOrder};
use super::{JointKind, Limits, Link, Mimic, Part, Robot, Shape, UrdfJoint, Visual};
use crate::description::finding::{Finding, Findings};
use crate::spatial::{Pose, Vec3};
use std::sync::Arc;
use urdf_rs::Geometry;

/// What `urdf-rs` reads in some texts together; the first one gives the name.
fn records(texts: &[Part<'_>]) -> Result<urdf_rs::Robot, Findings> {
    let mut whole: Option<urdf_rs::Robot> = None;
    for (file, text) in texts {
        let data = urdf_rs::read_from_string(text).map_err(|e| {
            let reason: String = e.to_string().chars().take(200).map(|c| if c.is_control() { ' ' } else { c }).collect();
            Finding::error("not_urdf", format!("the URDF reader refuses this text: {reason}")).in_file(*file)
        })?;
        match &mut whole {
            None => whole = Some(data),
            Some(whole) => {
                whole.links.extend(data.links);
                whole.joints.extend(data.joints);
                whole.materials.extend(data.materials);
            }
        }
    }
    whole.ok_or_else(|| Finding::error("no_links", "there is no `<link>`").into())
}

/// The robot of texts whose grammar and tree have been checked.
pub(super) fn robot(texts: &[Part<'_>], skeleton: &Skeleton, order: TreeOrder, places: Places) -> Result<Robot, Findings> {
    let data = records(texts)?;
    let file = texts.first().map_or("", |(file, _)| file);
    if data.links.len() != skeleton.links.len() || data.joints.len() != skeleton.joints.len() {
        return Err(Finding::error("not_urdf", "links or joints stand where URDF does not expect them").in_file(file).into());
    }
    let links = order.links.iter().map(|k| link(&data.links[*k], skeleton.links[*k].has_inertial, &data.materials));
    let joints = order.joints.iter().map(|k| joint(&data.joints[*k], &skeleton.joints[*k]));
    let links: Vec<Link> = links.collect();
    let root = links[0].name.clone();
    Ok(Robot { name: data.name, links, joints: joints.collect(), root, places: Arc::new(places) })
}

fn pose(origin: &urdf_rs::Pose) -> Pose<f64> {
    Pose::from_xyz_rpy(*origin.xyz, *origin.rpy)
}

fn link(data: &urdf_rs::Link, has_inertial: bool, materials: &[urdf_rs::Material]) -> Link {
    let urdf_rs::Inertial { origin, mass, inertia } = &data.inertial;
    let xyz = *origin.xyz;
    let inertial = has_inertial.then_some(Inertial {
        rpy: *origin.rpy,
        written: [mass.value, xyz[0], xyz[1], xyz[2], inertia.ixx, inertia.iyy, inertia.izz, inertia.ixy, inertia.ixz, inertia.iyz],
    });
    Link {
        name: data.name.clone(),
        mass: inertial.map(|i| i.mass_properties()),
        visuals: data.visual.iter().map(|v| visual(v, materials)).collect(),
        inertial,
    }
}

fn visual(data: &urdf_rs::Visual, materials: &[urdf_rs::Material]) -> Visual {
    let shape = match &data.geometry {
        Geometry::Box { size } => Shape::Box { size: **size },
        Geometry::Cylinder { radius, length } => Shape::Cylinder { radius: *radius, length: *length },
        Geometry::Capsule { radius, length } => Shape::Capsule { radius: *radius, length: *length },
        Geometry::Sphere { radius } => Shape::Sphere { radius: *radius },
        Geometry::Mesh { filename, scale } => Shape::Mesh { file: filename.clone(), scale: scale.map_or([1.0; 3], |s| *s) },
    };
    // a material without a color of its own refers to one of the robot by name
    let color = data.material.as_ref().and_then(|own| {
        let shared = || materials.iter().find(|m| m.name == own.name).and_then(|m| m.color.as_ref());
        own.color.as_ref().or_else(shared).map(|c| *c.rgba)
    });
    Visual { shape, origin: pose(&data.origin), color }
}

fn joint(data: &urdf_rs::Joint, skeleton: &SkeletonJoint) -> UrdfJoint {
    let kind = skeleton.kind.unwrap_or(JointKind::Fixed);
    let limit = &data.limit;
    let (xyz, rpy, axis) = (*data.origin.xyz, *data.origin.rpy, *data.axis.xyz);
    let (damping, friction) = data.dynamics.as_ref().map_or((0.0, 0.0), |d| (d.damping, d.friction));
    let written: [f64; JOINT_ENTRIES] = [xyz[0], xyz[1], xyz[2], rpy[0], rpy[1], rpy[2], axis[0], axis[1], axis[2], damping, friction];
    let mut joint = UrdfJoint {
        name: data.name.clone(),
        kind,
        parent: data.parent.link.clone(),
        child: data.child.link.clone(),
        origin: Pose::identity(),
        axis: Vec3 { x: 1.0, y: 0.0, z: 0.0 },
        limits: skeleton.has_limit.then_some(Limits {
            lower: limit.lower,
            upper: limit.upper,
            effort: limit.effort,
            velocity: limit.velocity,
        }),
        mimic: data.mimic.as_ref().filter(|_| kind != JointKind::Fixed).map(|m| Mimic {
            joint: m.joint.clone(),
            multiplier: m.multiplier.unwrap_or(1.0),
            offset: m.offset.unwrap_or(0.0),
        }),
        damping,
        friction,
        written,
    };
    joint.refresh();
    joint
}
