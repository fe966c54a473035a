//! Numbers that can be read but describe no machine.
//!
//! The principal moments of a body are integrals of y²+z², z²+x², x²+y² over its mass: none is negative, and none exceeds
//! the sum of the two others.

use super::{JointKind, Link, Robot, UrdfJoint};
use crate::description::finding::{Finding, Findings, Severity};
use crate::spatial::{MassProperties, Pose};
use std::collections::HashMap;

/// Share of the largest principal moment by which rounding may break the inequalities: tables print two or three digits.
const ROUNDING: f64 = 0.01;

/// Radius of gyration in sizes of the machine from which on it is suspicious.
const MOST_SIZES: f64 = 10.0;

pub(super) fn check(robot: &Robot) -> Findings {
    let links = robot.links.iter().filter_map(mass);
    let joints = robot.joints.iter().flat_map(|joint| [axis(joint), limits(joint)]).flatten();
    links.chain(joints).chain(inertia(robot)).chain(gyration(robot)).chain(massless(robot)).collect()
}

fn mass(link: &Link) -> Option<Finding> {
    let mass = link.mass?.mass;
    (mass < 0.0).then(|| {
        Finding::error("negative_mass", format!("link `{}` has a negative mass of {mass} kg", link.name))
            .at_path(format!("link.{}.inertial.mass.value", link.name))
    })
}

/// What no body can have, of the links one by one and of those that fixed joints keep together.
///
/// Only the whole that is kept together enters the equations of motion, so an impossible part of a possible whole is a warning.
fn inertia(robot: &Robot) -> Vec<Finding> {
    let whole = wholes(robot);
    let judge = |(link, whole): (&Link, &MassProperties)| {
        let own = link.mass?;
        let reason = impossible(&own)?;
        let severity = if impossible(whole).is_some() { Severity::Error } else { Severity::Warning };
        let [a, b, c] = rounded_moments(&own);
        let message = format!("link `{}` has principal moments of inertia of {a:.3e}, {b:.3e}, {c:.3e} kg m²: {reason}", link.name);
        let path = format!("link.{}.inertial.inertia", link.name);
        let hint = match severity {
            Severity::Error => "products of inertia are entered with their sign, `ixy` = −∫ x y dm",
            _ => "together with what is fixed to it, it is a possible body",
        };
        Some(Finding::new(severity, "impossible_inertia", message).at_path(path).with_hint(hint))
    };
    robot.links.iter().zip(&whole).filter_map(judge).collect()
}

/// Radii of gyration that no part of a machine of this size has: mostly a unit of inertia or mass that is another one.
///
/// The size is the largest distance of a joint or mass center from the frame in which it is given; √(I/m) of a part of the machine is of that
/// order at most.
fn gyration(robot: &Robot) -> Vec<Finding> {
    let of_joints = robot.joints.iter().map(|j| j.origin.p.norm());
    let size = of_joints.chain(robot.links.iter().filter_map(|l| l.mass).map(|m| m.center.norm())).fold(0.0, f64::max);
    let judge = |link: &Link| {
        let own = link.mass.filter(|m| m.mass > 0.0)?;
        let radius = (rounded_moments(&own)[2] / own.mass).sqrt();
        if radius <= MOST_SIZES * size {
            return None;
        }
        let message = format!(
            "link `{}` has inertia as if its {} kg were {radius:.3} m away, in a machine whose parts are {size:.3} m apart",
            link.name, own.mass
        );
        let finding = Finding::warning("suspicious_inertia", message).at_path(format!("link.{}.inertial.inertia", link.name));
        Some(finding.with_hint("a URDF has kg and kg m²: 1 kg mm² is 1e-6 kg m²"))
    };
    // a machine of one point has no size to compare with
    if size > 0.0 { robot.links.iter().filter_map(judge).collect() } else { Vec::new() }
}

/// Why no body has these principal moments.
fn impossible(body: &MassProperties) -> Option<&'static str> {
    let [a, b, c] = rounded_moments(body);
    let allowed = ROUNDING * c.abs();
    if a < -allowed {
        Some("a moment of inertia cannot be negative")
    } else if a + b < c - allowed {
        Some("the largest exceeds the sum of the others, which no body can have")
    } else {
        None
    }
}

/// Principal moments without what the arithmetic leaves of a zero.
fn rounded_moments(body: &MassProperties) -> [f64; 3] {
    let moments = body.principal_moments();
    let scale = moments.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    moments.map(|m| if m.abs() < 1e-12 * scale { 0.0 } else { m })
}

/// For each link, everything that fixed joints keep together with it, described in some common frame.
fn wholes(robot: &Robot) -> Vec<MassProperties> {
    let number = numbers(robot);
    // the link that stands for the group, and the pose of each link in it
    let mut group: Vec<(usize, Pose<f64>)> = vec![(0, Pose::identity())];
    for (k, joint) in robot.joints.iter().enumerate() {
        let (leader, pose) = group[number[joint.parent.as_str()]];
        let fixed = joint.kind == JointKind::Fixed;
        group.push(if fixed { (leader, pose * joint.origin) } else { (k + 1, Pose::identity()) });
    }
    let mut whole = vec![MassProperties::NONE; robot.links.len()];
    for (link, (leader, pose)) in robot.links.iter().zip(&group) {
        if let Some(own) = link.mass {
            whole[*leader] = whole[*leader].welded_with(&own.in_parent(pose));
        }
    }
    group.iter().map(|(leader, _)| whole[*leader]).collect()
}

fn numbers(robot: &Robot) -> HashMap<&str, usize> {
    robot.links.iter().enumerate().map(|(k, l)| (l.name.as_str(), k)).collect()
}

fn axis(joint: &UrdfJoint) -> Option<Finding> {
    (joint.kind.has_axis() && joint.axis.normalized().is_none()).then(|| {
        Finding::error("zero_axis", format!("the axis of joint `{}` has no direction", joint.name))
            .at_path(format!("joint.{}.axis.xyz", joint.name))
    })
}

fn limits(joint: &UrdfJoint) -> Option<Finding> {
    let limits = joint.limits?;
    let limited = matches!(joint.kind, JointKind::Revolute | JointKind::Prismatic);
    (limited && limits.lower > limits.upper).then(|| {
        let (lower, upper) = (limits.lower, limits.upper);
        Finding::error("bad_limit", format!("joint `{}` has a lower limit of {lower} above its upper limit of {upper}", joint.name))
            .at_path(format!("joint.{}.limit", joint.name))
    })
}

/// Joints that move nothing with mass; of several in a row, the one nearest to the root.
fn massless(robot: &Robot) -> Vec<Finding> {
    let number = numbers(robot);
    // tree order: children come after their parents, so one pass backwards adds everything up
    let mut has_mass: Vec<bool> = robot.links.iter().map(has_mass).collect();
    for (k, joint) in robot.joints.iter().enumerate().rev() {
        has_mass[number[joint.parent.as_str()]] |= has_mass[k + 1];
    }
    // whether a moving joint on the way to each link was reported already
    let mut reported = vec![false; robot.links.len()];
    let mut findings = Vec::new();
    for (k, joint) in robot.joints.iter().enumerate() {
        let covered = reported[number[joint.parent.as_str()]];
        let bad = !has_mass[k + 1] && joint.kind != JointKind::Fixed;
        reported[k + 1] = covered || bad;
        if bad && !covered {
            let (name, child) = (&joint.name, &joint.child);
            let message = format!("joint `{name}` moves link `{child}`, but neither `{child}` nor anything behind it has mass");
            let finding = Finding::error("massless_tip", message).at_path(format!("link.{child}"));
            findings.push(finding.with_hint(format!("give `{child}` an `<inertial>` element, or make `{name}` a `fixed` joint")));
        }
    }
    findings
}

fn has_mass(link: &Link) -> bool {
    link.mass.is_some_and(|m| m.mass > 0.0 || m.inertia.iter().any(|i| *i != 0.0))
}
