//! Numbers that can be read but describe no machine.
//!
//! The principal moments of a body are integrals of y²+z², z²+x², x²+y² over its mass: none is negative, and none exceeds
//! the sum of the two others.

use super::{JointKind, Link, Robot, UrdfJoint};
use crate::description::finding::{Finding, Findings};
use std::collections::HashMap;

/// Share of the largest principal moment by which rounding may break the inequalities: tables print two or three digits.
const ROUNDING: f64 = 0.01;

pub(super) fn check(robot: &Robot) -> Findings {
    let links = robot.links.iter().flat_map(|link| [mass(link), inertia(link)]);
    let joints = robot.joints.iter().flat_map(|joint| [axis(joint), limits(joint)]);
    links.chain(joints).flatten().chain(massless(robot)).collect()
}

fn mass(link: &Link) -> Option<Finding> {
    let mass = link.mass?.mass;
    (mass < 0.0).then(|| {
        Finding::error("negative_mass", format!("link `{}` has a negative mass of {mass} kg", link.name))
            .at_path(format!("link.{}.inertial.mass.value", link.name))
    })
}

fn inertia(link: &Link) -> Option<Finding> {
    let [a, b, c] = link.mass?.principal_moments();
    let allowed = ROUNDING * c.abs();
    let reason = if a < -allowed {
        "a moment of inertia cannot be negative"
    } else if a + b < c - allowed {
        "the largest exceeds the sum of the others, which no body can have"
    } else {
        return None;
    };
    let message = format!("link `{}` has principal moments of inertia of {a:.4e}, {b:.4e}, {c:.4e} kg m²: {reason}", link.name);
    let finding = Finding::error("impossible_inertia", message).at_path(format!("link.{}.inertial.inertia", link.name));
    Some(finding.with_hint("products of inertia are entered with their sign, `ixy` = −∫ x y dm"))
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
    let number: HashMap<&str, usize> = robot.links.iter().enumerate().map(|(k, l)| (l.name.as_str(), k)).collect();
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
