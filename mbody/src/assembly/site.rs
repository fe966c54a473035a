//! Where an element is built: names become bodies here, and findings get their place in the file.

use crate::constraint::Constraint;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::quantity::{Quantity, dimension::Length};
use crate::description::{Library, SeenFrom};
use crate::model::{BodyIndex, Model};
use crate::spatial::{Pose, Rotation, Vec3};
use crate::stage::World;
use schemars::JsonSchema;
use serde::Deserialize;

/// A point of a link, in the link's frame.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointDescription {
    /// Name of the link (`world` is allowed).
    pub link: String,
    /// Coordinates in the frame of the link: x forward, y left, z up in the design pose.
    pub at: [Quantity<Length>; 3],
}

/// What an element may ask while it is assembled.
pub struct Site<'a> {
    pub(super) element: &'a str,
    pub(super) path: String,
    pub(super) model: &'a Model,
    pub(super) design: &'a World<f64>,
    pub(super) locked: &'a [String],
    pub(super) constraints: &'a [Constraint],
    pub(super) library: &'a dyn Library,
    pub(super) document: &'a Document,
    pub(super) findings: &'a mut Findings,
    pub(super) left_out: Option<String>,
}

impl<'a> Site<'a> {
    /// Name the user gave to the element.
    pub fn element(&self) -> &str {
        self.element
    }

    /// The tree.
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// Adds a finding at a key of this element (`""` for the element itself).
    pub fn find(&mut self, key: &str, finding: Finding) {
        let path = if key.is_empty() { self.path.clone() } else { format!("{}.{key}", self.path) };
        self.findings.push(finding.at_path(path));
    }

    /// Adds an error at a key of this element.
    pub fn refuse(&mut self, key: &str, code: &'static str, message: impl Into<String>) {
        self.find(key, Finding::error(code, message));
    }

    /// The body carried by a joint.
    pub fn joint(&mut self, key: &str, name: &str) -> Option<BodyIndex> {
        if self.locked.iter().any(|l| l == name) {
            self.left_out = Some(name.to_owned());
            return None;
        }
        if let Some(body) = self.model.joint(name) {
            return Some(body);
        }
        let known = self.model.moving().map(|b| self.model.body(b).joint_name.as_str());
        let hint = suggestion(name, known.chain(self.locked.iter().map(String::as_str)));
        self.find(key, Finding::error("unknown_joint", format!("joint `{name}` does not exist")).with_hint_from(hint));
        None
    }

    /// The body carried by a joint with one coordinate, whose unit must be `unit` (`m` or `rad`).
    pub fn joint_with(&mut self, key: &str, name: &str, unit: &str) -> Option<BodyIndex> {
        let body = self.joint(key, name)?;
        let coordinates = self.model.body(body).joint.coordinates();
        match coordinates {
            [only] if only.unit == unit => Some(body),
            [only] => {
                let (is, needs) = (motion_word(only.unit), motion_word(unit));
                self.refuse(key, "wrong_joint", format!("joint `{name}` {is}, but this element needs a joint that {needs}"));
                None
            }
            _ => {
                let count = coordinates.len();
                self.refuse(key, "wrong_joint", format!("joint `{name}` has {count} coordinates, but this element needs a joint with one"));
                None
            }
        }
    }

    /// A constraint, by the name the user gave; elements see all of them.
    pub fn constraint(&mut self, key: &str, name: &str) -> Option<&'a Constraint> {
        let constraints = self.constraints;
        if let Some(found) = constraints.iter().find(|c| c.name() == name) {
            return Some(found);
        }
        let hint = suggestion(name, constraints.iter().map(Constraint::name));
        self.find(key, Finding::error("unknown_constraint", format!("constraint `{name}` does not exist")).with_hint_from(hint));
        None
    }

    /// The body a link belongs to, and the pose of the link in that body.
    pub fn link(&mut self, key: &str, name: &str) -> Option<(BodyIndex, Pose<f64>)> {
        if let Some(frame) = self.model.frame(name) {
            return Some((frame.body, frame.X_BF));
        }
        let hint = suggestion(name, self.model.frames().iter().map(|f| f.name.as_str()));
        self.find(key, Finding::error("unknown_link", format!("link `{name}` does not exist")).with_hint_from(hint));
        None
    }

    /// The body a point belongs to, and its position in that body.
    pub fn point(&mut self, key: &str, point: &PointDescription) -> Option<(BodyIndex, Vec3<f64>)> {
        let (body, X) = self.link(&format!("{key}.link"), &point.link)?;
        Some((body, X.point(point.at.map(Quantity::si).into())))
    }

    /// The body a point belongs to, and there the frame at the point with the axes of its link.
    pub fn frame_at(&mut self, key: &str, point: &PointDescription) -> Option<(BodyIndex, Pose<f64>)> {
        let (body, X) = self.link(&format!("{key}.link"), &point.link)?;
        Some((body, X * Pose::new(Rotation::identity(), point.at.map(Quantity::si).into())))
    }

    /// Where a point of a body is in the design pose, in the world.
    pub fn design_position(&self, body: BodyIndex, point: Vec3<f64>) -> Vec3<f64> {
        self.design.X_WB[body.get()].point(point)
    }

    /// Pose of a body in the design pose.
    pub fn design_pose(&self, body: BodyIndex) -> Pose<f64> {
        self.design.X_WB[body.get()]
    }

    /// Adds findings about another file, as they are.
    pub fn pass_on(&mut self, findings: Findings) {
        self.findings.extend(findings);
    }

    /// The texts to which entry `key` may refer, by names relative to the file in which it stands.
    pub fn library(&self, key: &str) -> SeenFrom<'a> {
        let entry = self.document.pointer_of(&format!("{}.{key}", self.path)).unwrap_or_default();
        SeenFrom { library: self.library, within: self.document.file_of(&entry).to_owned() }
    }

    /// Text that the description refers to: a table, a data file. Its name is relative to the file in which it is named.
    pub fn text(&mut self, key: &str, name: &str) -> Option<String> {
        let found = self.library(key).text(name).map(|t| t.into_owned());
        if found.is_none() {
            self.refuse(key, "missing_file", format!("file `{name}` was not found"));
        }
        found
    }
}

fn motion_word(unit: &str) -> &'static str {
    if unit == "m" { "slides" } else { "turns" }
}
