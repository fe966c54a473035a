//! Entries of a URDF that can be changed by name: `link.<name>.mass`, `joint.<name>.rpy.p`, ….

use super::{JointKind, Link, Robot, UrdfJoint};
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::quantity::dimension::{
    Angle, AngularDamping, Damping, Dimension, Dimensioned, Force, Inertia, Length, Mass, Number, Torque,
};
use crate::spatial::{MassProperties, Pose, Vec3};

pub(super) const LINK_ENTRIES: usize = 10;
pub(super) const JOINT_ENTRIES: usize = 11;

/// `com` and `inertia` in the axes of the `<inertial>` element, as they are written there.
const OF_LINK: [(&str, &Dimension); LINK_ENTRIES] = [
    ("mass", Mass::DIMENSION),
    ("com.x", Length::DIMENSION),
    ("com.y", Length::DIMENSION),
    ("com.z", Length::DIMENSION),
    ("inertia.ixx", Inertia::DIMENSION),
    ("inertia.iyy", Inertia::DIMENSION),
    ("inertia.izz", Inertia::DIMENSION),
    ("inertia.ixy", Inertia::DIMENSION),
    ("inertia.ixz", Inertia::DIMENSION),
    ("inertia.iyz", Inertia::DIMENSION),
];

/// The dimensions of the last two are those of a rotation.
const OF_JOINT: [(&str, &Dimension); JOINT_ENTRIES] = [
    ("origin.x", Length::DIMENSION),
    ("origin.y", Length::DIMENSION),
    ("origin.z", Length::DIMENSION),
    ("rpy.r", Angle::DIMENSION),
    ("rpy.p", Angle::DIMENSION),
    ("rpy.y", Angle::DIMENSION),
    ("axis.x", Number::DIMENSION),
    ("axis.y", Number::DIMENSION),
    ("axis.z", Number::DIMENSION),
    ("damping", AngularDamping::DIMENSION),
    ("friction", Torque::DIMENSION),
];

fn dimension_of_joint_entry(kind: JointKind, entry: usize) -> &'static Dimension {
    match (kind, OF_JOINT[entry].0) {
        (JointKind::Prismatic, "damping") => Damping::DIMENSION,
        (JointKind::Prismatic, "friction") => Force::DIMENSION,
        _ => OF_JOINT[entry].1,
    }
}

/// The numbers of an `<inertial>` element as they are written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inertial {
    pub rpy: [f64; 3],
    /// In the order of `OF_LINK`.
    pub written: [f64; LINK_ENTRIES],
}

impl Inertial {
    /// Mass, center and inertia about it, turned into the axes of the link.
    pub fn mass_properties(&self) -> MassProperties {
        let [mass, x, y, z, inertia @ ..] = self.written;
        let own = MassProperties { mass, center: Vec3 { x: 0.0, y: 0.0, z: 0.0 }, inertia };
        own.in_parent(&Pose::from_xyz_rpy([x, y, z], self.rpy))
    }
}

impl UrdfJoint {
    /// Takes over what is written.
    pub(super) fn refresh(&mut self) {
        let [x, y, z, roll, pitch, yaw, ax, ay, az, damping, friction] = self.written;
        self.origin = Pose::from_xyz_rpy([x, y, z], [roll, pitch, yaw]);
        let axis = Vec3 { x: ax, y: ay, z: az };
        // an axis without direction is reported by the check
        self.axis = axis.normalized().unwrap_or(axis);
        (self.damping, self.friction) = (damping, friction);
    }
}

/// An entry that [`Robot::set`] can change.
#[derive(Clone, Debug, PartialEq)]
pub struct Settable {
    /// `link.<name>.mass`, `joint.<name>.origin.x`, ….
    pub path: String,
    /// What it measures.
    pub dimension: &'static Dimension,
    /// Present value in SI.
    pub value: f64,
}

/// Which number a path names: the body or joint, and the entry of it.
enum Place {
    Link(usize, usize),
    Joint(usize, usize),
}

impl Robot {
    /// Every entry that can be changed.
    pub fn settable(&self) -> Vec<Settable> {
        let links = self.links.iter().flat_map(|link| {
            OF_LINK.iter().enumerate().map(|(k, (entry, dimension))| Settable {
                path: format!("link.{}.{entry}", link.name),
                dimension,
                value: link.inertial.map_or(0.0, |i| i.written[k]),
            })
        });
        let joints = self.joints.iter().flat_map(|joint| {
            OF_JOINT.iter().enumerate().map(|(k, (entry, _))| Settable {
                path: format!("joint.{}.{entry}", joint.name),
                dimension: dimension_of_joint_entry(joint.kind, k),
                value: joint.written[k],
            })
        });
        links.chain(joints).collect()
    }

    /// What the entry of this path measures.
    ///
    /// # Errors
    /// There is no such entry; the nearest known one is named.
    pub fn dimension_of(&self, path: &str) -> Result<&'static Dimension, Findings> {
        match self.place(path)? {
            Place::Link(_, entry) => Ok(OF_LINK[entry].1),
            Place::Joint(joint, entry) => Ok(dimension_of_joint_entry(self.joints[joint].kind, entry)),
        }
    }

    /// Changes one entry to a value in SI. After the last change, [`Robot::check`] tells whether the result is possible.
    ///
    /// # Errors
    /// There is no such entry (the nearest known one is named), or the value is not finite.
    pub fn set(&mut self, path: &str, value: f64) -> Result<(), Findings> {
        if !value.is_finite() {
            return Err(Finding::error("bad_number", format!("`{path}` cannot be {value}")).at_path(path).into());
        }
        match self.place(path)? {
            Place::Link(link, entry) => self.links[link].set(entry, value),
            Place::Joint(joint, entry) => {
                self.joints[joint].written[entry] = value;
                self.joints[joint].refresh();
            }
        }
        Ok(())
    }

    fn place(&self, path: &str) -> Result<Place, Findings> {
        // names may contain points, so the known names are tried, not the path cut
        let entry_of = |rest: &str, name: &str, entries: &[(&str, &Dimension)]| {
            let entry = rest.strip_prefix(name)?.strip_prefix('.')?;
            entries.iter().position(|(known, _)| *known == entry)
        };
        let link = path
            .strip_prefix("link.")
            .and_then(|rest| self.links.iter().enumerate().find_map(|(k, l)| Some(Place::Link(k, entry_of(rest, &l.name, &OF_LINK)?))));
        let joint = path
            .strip_prefix("joint.")
            .and_then(|rest| self.joints.iter().enumerate().find_map(|(k, j)| Some(Place::Joint(k, entry_of(rest, &j.name, &OF_JOINT)?))));
        link.or(joint).ok_or_else(|| self.unknown_path(path).into())
    }

    fn unknown_path(&self, path: &str) -> Finding {
        let finding = Finding::error("unknown_path", format!("there is no entry `{path}`")).at_path(path);
        let all = self.settable();
        let known = all.iter().map(|s| s.path.as_str());
        // a right name with a wrong entry gets the entries of that name, everything else the nearest path
        let owners = self.links.iter().map(|l| (format!("link.{}.", l.name), &OF_LINK[..]));
        let owners = owners.chain(self.joints.iter().map(|j| (format!("joint.{}.", j.name), &OF_JOINT[..])));
        let entries = owners.into_iter().find(|(owner, _)| path.starts_with(owner.as_str()));
        finding.with_hint_from(match entries {
            Some((owner, entries)) => suggestion(&path[owner.len()..], entries.iter().map(|(name, _)| *name)),
            None => suggestion(path, known),
        })
    }
}

impl Link {
    /// A link without `<inertial>` gets one.
    fn set(&mut self, entry: usize, value: f64) {
        let inertial = self.inertial.get_or_insert(Inertial { rpy: [0.0; 3], written: [0.0; LINK_ENTRIES] });
        inertial.written[entry] = value;
        self.mass = Some(inertial.mass_properties());
    }
}
