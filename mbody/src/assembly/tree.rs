//! From a URDF robot to a tree of bodies.
//!
//! Fixed and locked joints weld; the base joint connects the root link to the world and speaks in the root link's name.
//! URDF joint limits are ranges for drawings and ratings, no stops; URDF damping and friction are not used (a note says so).

use super::description::{BaseDescription, JointOptions};
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::urdf::{JointKind, Robot, UrdfJoint};
use crate::joint::{Free, Joint, Planar, Prismatic, Revolute, Screw, Spherical, Universal, VehicleBase};
use crate::model::{BodyIndex, BuildError, Model, ModelBuilder};
use crate::spatial::{MassProperties, Pose, Vec3};
use std::collections::BTreeMap;

/// The joint between the world and the root link; `None` for a root that is welded to the world.
fn base_joint(base: BaseDescription) -> Option<Joint> {
    match base {
        BaseDescription::Fixed => None,
        BaseDescription::Free => Some(Joint::new(Free)),
        BaseDescription::Planar => Some(Joint::new(Planar::new(Vec3::new(0.0, 0.0, 1.0)))),
        BaseDescription::VehicleBase => Some(Joint::new(VehicleBase)),
    }
}

/// The joint of a URDF joint element, or `None` where it welds.
fn moving_joint(joint: &UrdfJoint, options: Option<&JointOptions>) -> Option<Joint> {
    if options.is_some_and(|o| o.locked) {
        return None;
    }
    match options.and_then(|o| o.kind) {
        Some(super::description::JointKindDescription::Universal) => return Some(Joint::new(Universal)),
        Some(super::description::JointKindDescription::Screw) => {
            let pitch = options.and_then(|o| o.pitch).map_or(0.0, |p| p.si());
            return Some(Joint::new(Screw::new(joint.axis, pitch)));
        }
        None => {}
    }
    match joint.kind {
        JointKind::Fixed => None,
        JointKind::Revolute | JointKind::Continuous => Some(Joint::new(Revolute::new(joint.axis))),
        JointKind::Prismatic => Some(Joint::new(Prismatic::new(joint.axis))),
        JointKind::Planar => Some(Joint::new(Planar::new(joint.axis))),
        JointKind::Floating => Some(Joint::new(Free)),
        JointKind::Spherical => Some(Joint::new(Spherical)),
    }
}

/// Builds the tree; `couple` adds what else ties joints to each other. Findings carry paths of the URDF (`joint.<name>…`) or of the description (`joints.<name>…`).
pub(super) fn model(
    robot: &Robot,
    base: BaseDescription,
    options: &BTreeMap<String, JointOptions>,
    gravity: Vec3<f64>,
    couple: &dyn Fn(&mut ModelBuilder, &mut Findings),
    findings: &mut Findings,
) -> Option<Model> {
    for name in options.keys().filter(|n| robot.joint(n).is_none()) {
        let hint = suggestion(name, robot.joints.iter().map(|j| j.name.as_str()));
        findings.push(
            Finding::error("unknown_joint", format!("joint `{name}` does not exist"))
                .at_path(format!("joints.{name}"))
                .with_hint_from(hint),
        );
    }
    let mut builder = ModelBuilder::new();
    builder.gravity(gravity);
    let built = bodies(&mut builder, robot, base, options, findings).and_then(|()| follow(&mut builder, robot, options));
    if built.is_ok() {
        couple(&mut builder, findings);
    }
    match built.and_then(|()| builder.finish()) {
        Ok(model) if !findings.has_errors() => Some(model),
        Ok(_) => None,
        Err(error) => {
            findings.push(Finding::error("impossible_tree", error.to_string()));
            None
        }
    }
}

fn bodies(
    builder: &mut ModelBuilder,
    robot: &Robot,
    base: BaseDescription,
    options: &BTreeMap<String, JointOptions>,
    findings: &mut Findings,
) -> Result<(), BuildError> {
    let mass = |link: &str| robot.link(link).and_then(|l| l.mass).unwrap_or(MassProperties::NONE);
    match base_joint(base) {
        // a root link that is called `world` is the world
        None if robot.root == "world" => {}
        None => builder.weld(&robot.root, BodyIndex::WORLD, Pose::identity(), mass(&robot.root))?,
        Some(joint) => {
            builder.body(&robot.root, BodyIndex::WORLD, &robot.root, joint, Pose::identity(), mass(&robot.root))?;
        }
    }
    for joint in &robot.joints {
        if joint.damping != 0.0 || joint.friction != 0.0 {
            findings.push(
                robot.located(
                    Finding::note("unused_dynamics", format!("damping and friction of joint `{}` are not used", joint.name))
                        .at_path(format!("joint.{}", joint.name))
                        .with_hint("state them as an element: `joint_spring` or `joint_torsion_spring`"),
                ),
            );
        }
        let Some((parent, X_BP)) = builder.find(&joint.parent) else { continue };
        let X = X_BP * joint.origin;
        match moving_joint(joint, options.get(&joint.name)) {
            None => builder.weld(&joint.child, parent, X, mass(&joint.child))?,
            Some(kind) => {
                builder.body(&joint.child, parent, &joint.name, kind, X, mass(&joint.child))?;
            }
        }
    }
    Ok(())
}

fn follow(builder: &mut ModelBuilder, robot: &Robot, options: &BTreeMap<String, JointOptions>) -> Result<(), BuildError> {
    let locked = |name: &str| options.get(name).is_some_and(|o| o.locked);
    for joint in robot.joints.iter().filter(|j| !locked(&j.name)) {
        if let Some(mimic) = joint.mimic.as_ref().filter(|m| !locked(&m.joint)) {
            builder.follow(&joint.name, &mimic.joint, mimic.multiplier, mimic.offset)?;
        }
    }
    Ok(())
}
