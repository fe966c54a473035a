//! URDF: links, joints and looks of a tree of bodies.
//!
//! The data come from `urdf-rs`, which is silent about most mistakes and knows no positions; positions and checks come from a
//! second reading of the same text with `roxmltree`. Every mistake of one text is reported at once, except that numbers are
//! judged (mass, inertia, axis) only once all of them can be read.
//!
//! Source: the URDF/XML specification, <http://wiki.ros.org/urdf/XML>.

mod convert;
mod entry;
mod grammar;
mod place;
mod plausible;
mod skeleton;

pub use entry::Settable;

use super::finding::{Finding, Findings};
use crate::spatial::{MassProperties, Pose, Vec3};
use place::Places;
use std::sync::Arc;

/// A tree of bodies as URDF describes it, in tree order: a joint comes after the joint that carries its parent,
/// and `joints[k]` moves `links[k + 1]`; `links[0]` is the root.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Name of the whole.
    pub name: String,
    /// Bodies.
    pub links: Vec<Link>,
    /// Joints.
    pub joints: Vec<UrdfJoint>,
    /// Name of the link that no joint moves.
    pub root: String,
    places: Arc<Places>,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name, unique among links.
    pub name: String,
    /// Mass, center of mass and inertia about it in the axes of the link; `None` without `<inertial>`.
    pub mass: Option<MassProperties>,
    /// What it looks like.
    pub visuals: Vec<Visual>,
    inertial: Option<entry::Inertial>,
}

/// A shape to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Its geometry.
    pub shape: Shape,
    /// Pose of the shape in the link.
    pub origin: Pose<f64>,
    /// Red, green, blue and opacity, 0 to 1.
    pub color: Option<[f64; 4]>,
}

/// Geometry of a visual, lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A mesh, by the name written in the file; it is not opened.
    Mesh {
        /// File name or address.
        file: String,
        /// Factors along the axes.
        scale: [f64; 3],
    },
    /// A box around the origin.
    Box {
        /// Edges along x, y and z.
        size: [f64; 3],
    },
    /// A cylinder along z around the origin.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length.
        length: f64,
    },
    /// A cylinder along z with hemispheres at its ends.
    Capsule {
        /// Radius.
        radius: f64,
        /// Length of the cylinder.
        length: f64,
    },
    /// A sphere around the origin.
    Sphere {
        /// Radius.
        radius: f64,
    },
}

/// What a joint lets move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointKind {
    /// Nothing.
    Fixed,
    /// Rotation about the axis within limits.
    Revolute,
    /// Rotation about the axis.
    Continuous,
    /// Translation along the axis.
    Prismatic,
    /// Translation in the plane normal to the axis, and rotation about the axis.
    Planar,
    /// Everything.
    Floating,
    /// Every rotation.
    Spherical,
}

impl JointKind {
    /// Whether the axis means anything.
    pub fn has_axis(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous | Self::Prismatic | Self::Planar)
    }
}

/// A joint.
#[derive(Clone, Debug)]
pub struct UrdfJoint {
    /// Name, unique among joints.
    pub name: String,
    /// What it lets move.
    pub kind: JointKind,
    /// Name of the link that carries it.
    pub parent: String,
    /// Name of the link that it moves.
    pub child: String,
    /// Pose of the child in the parent at the zero position.
    pub origin: Pose<f64>,
    /// Unit vector in the child.
    pub axis: Vec3<f64>,
    /// Stops and ratings, where they are written.
    pub limits: Option<Limits>,
    /// Position follows another joint, where that is written.
    pub mimic: Option<Mimic>,
    /// Viscous damping, N m s/rad or N s/m.
    pub damping: f64,
    /// Dry friction, N m or N.
    pub friction: f64,
    written: [f64; entry::JOINT_ENTRIES],
}

/// Stops and ratings of a joint; infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lower stop, rad or m.
    pub lower: f64,
    /// Upper stop, rad or m.
    pub upper: f64,
    /// Largest effort, N m or N.
    pub effort: f64,
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
}

/// Position = multiplier · position of another joint + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic {
    /// Name of the other joint.
    pub joint: String,
    /// Factor.
    pub multiplier: f64,
    /// Offset, rad or m.
    pub offset: f64,
}

/// Reads a URDF text; `file` is its name in messages.
///
/// Gives the robot wherever its tree and its numbers can be read, even where [`Robot::check`] finds numbers that are physically
/// impossible: ask the findings for errors. Changes are made with [`Robot::set`], and judged by [`Robot::check`].
pub fn read(file: &str, text: &str) -> (Option<Robot>, Findings) {
    read_parts(&[(file, text)])
}

/// Name and text of a part of a tree.
pub type Part<'a> = (&'a str, &'a str);

/// Reads several texts as one tree: joints of one may name links of another. The first one gives the name; children of a link come in
/// the order of the texts. Everything else as in [`read`].
pub fn read_parts(texts: &[Part<'_>]) -> (Option<Robot>, Findings) {
    let (mut places, mut findings) = (Places::default(), Findings::new());
    let mut skeleton = skeleton::Skeleton::default();
    let mut readable = true;
    for (file, text) in texts {
        match place::parse(file, text) {
            Ok(document) => {
                places.begin(file, text);
                findings.extend(grammar::check(&document, &mut places));
                skeleton.add(&document, &mut places);
            }
            Err(errors) => {
                readable = false;
                findings.extend(errors);
            }
        }
    }
    // with a part missing, parents would be missed that are there
    if !readable {
        return (None, findings.sorted());
    }
    let order = skeleton.check(&places, &mut findings);
    let Some(order) = order.filter(|_| !findings.has_errors()) else {
        return (None, findings.sorted());
    };
    let robot = match convert::robot(texts, &skeleton, order, places) {
        Ok(robot) => robot,
        Err(refusal) => {
            findings.extend(refusal);
            return (None, findings.sorted());
        }
    };
    findings.extend(robot.check());
    (Some(robot), findings.sorted())
}

impl Robot {
    /// The link of this name.
    pub fn link(&self, name: &str) -> Option<&Link> {
        self.links.iter().find(|l| l.name == name)
    }

    /// The joint of this name.
    pub fn joint(&self, name: &str) -> Option<&UrdfJoint> {
        self.joints.iter().find(|j| j.name == name)
    }

    /// What is physically impossible: negative mass, inertia of no body, an axis of no direction, a moving link without mass behind it.
    pub fn check(&self) -> Findings {
        plausible::check(self).into_iter().map(|finding| self.located(finding)).collect()
    }

    /// The finding, with the line of the URDF that its path (`link.<name>.…` or `joint.<name>.…`) names.
    pub fn located(&self, finding: Finding) -> Finding {
        self.places.located(finding)
    }
}

#[cfg(test)]
mod tests;
