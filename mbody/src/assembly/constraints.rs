//! Written forms of constraints, and their table.

use super::elements::FrameDescription;
use super::{PointDescription, Site};
use crate::constraint::{
    Constraint, ConstraintLaw, CutJoint, CutKind, Distance, HeldPoint, Place, PrescribedMotion, Rolling, SurfaceContact,
};
use crate::contact::Profile;
use crate::description::finding::Finding;
use crate::description::quantity::dimension::{Angle, AngularSpeed, Length, Speed};
use crate::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use crate::model::{BodyIndex, BuildError, ModelBuilder};
use crate::spatial::{Pose, Rotation, Vec3};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// The written form of one kind of constraint. Implement it on a `deny_unknown_fields` struct whose doc comments become the
/// documentation of the keys.
pub trait ConstraintDescription: DeserializeOwned + JsonSchema {
    /// Name in descriptions.
    const KIND: &'static str;
    /// One sentence.
    const ABOUT: &'static str;
    /// Parameters as a user would write them, in the tree of the examples.
    const EXAMPLE: &'static str;
    /// Ties joints of the tree to each other while it is built.
    ///
    /// # Errors
    /// Joints that do not exist or cannot follow.
    fn couple(&self, _builder: &mut ModelBuilder) -> Result<(), BuildError> {
        Ok(())
    }
    /// Turns names into frames and numbers into a law. `None` where a finding was made, or where no multiplier is needed.
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint>;
}

/// A row of the table of kinds.
#[derive(Clone, Copy)]
pub struct ConstraintKind {
    /// Name in descriptions.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Parameters as a user would write them.
    pub example: &'static str,
    /// JSON Schema of the parameters.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Ties joints while the tree is built.
    pub couple: fn(&Value, &mut ModelBuilder) -> Result<(), BuildError>,
    /// Reads the parameters and makes the constraint.
    pub build: fn(&mut Site<'_>, &Value) -> Option<Constraint>,
}

impl ConstraintKind {
    /// The row of a written form.
    pub const fn of<T: ConstraintDescription>() -> Self {
        Self {
            name: T::KIND,
            about: T::ABOUT,
            example: T::EXAMPLE,
            schema: |generator| generator.subschema_for::<T>(),
            couple: |value, builder| T::deserialize(value).map_or(Ok(()), |description| description.couple(builder)),
            build: build::<T>,
        }
    }
}

impl std::fmt::Debug for ConstraintKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn build<T: ConstraintDescription>(site: &mut Site<'_>, value: &Value) -> Option<Constraint> {
    match serde_path_to_error::deserialize::<_, T>(value) {
        Ok(description) => description.assemble(site),
        Err(error) => {
            // the schema check comes first; this is reached where a rule is not expressible in the schema
            let path = error.path().to_string();
            let path = if path == "." { String::new() } else { path };
            site.find(&path, Finding::error("invalid_entry", error.into_inner().to_string()));
            None
        }
    }
}

/// The constraint kinds of this crate.
pub const STANDARD_CONSTRAINTS: &[ConstraintKind] = &[
    ConstraintKind::of::<CutJointDescription>(),
    ConstraintKind::of::<DistanceDescription>(),
    ConstraintKind::of::<CoincidentPointDescription>(),
    ConstraintKind::of::<PointOnLineDescription>(),
    ConstraintKind::of::<PointOnPlaneDescription>(),
    ConstraintKind::of::<GearDescription>(),
    ConstraintKind::of::<RackDescription>(),
    ConstraintKind::of::<RollingDescription>(),
    ConstraintKind::of::<SurfaceContactDescription>(),
    ConstraintKind::of::<PrescribedMotionDescription>(),
    ConstraintKind::of::<PrescribedSlideDescription>(),
];

fn held<L: ConstraintLaw>(site: &Site<'_>, from: (BodyIndex, Pose<f64>), to: (BodyIndex, Pose<f64>), law: L) -> Constraint {
    let place = |(body, X_BF): (BodyIndex, Pose<f64>)| Place { body, X_BF };
    Constraint::new(site.element(), place(from), place(to), law)
}

fn at_point((body, p): (BodyIndex, Vec3<f64>)) -> (BodyIndex, Pose<f64>) {
    (body, Pose::new(Rotation::identity(), p))
}

/// A direction from three numbers; a finding where they are all zero.
fn direction(site: &mut Site<'_>, key: &str, axis: [f64; 3]) -> Option<Vec3<f64>> {
    let unit = Vec3::from(axis).normalized();
    if unit.is_none() {
        site.refuse(key, "zero_axis", "the direction is zero; it needs a length");
    }
    unit
}

/// Two places of one body cannot be held to each other.
fn distinct(site: &mut Site<'_>, from: BodyIndex, to: BodyIndex) -> Option<()> {
    if from != to {
        return Some(());
    }
    let name = site.model().body(from).name.clone();
    site.refuse("", "one_body", format!("both ends are on the body `{name}`, which is rigid: nothing is left to constrain"));
    None
}

/// Joints that can close a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CutKindDescription {
    /// No relative motion.
    Fixed,
    /// Rotation about the axis.
    Revolute,
    /// Translation along the axis.
    Prismatic,
    /// Rotation about the axis with a proportional advance along it.
    Screw,
    /// Rotation about x of the parent frame and y of the child frame.
    Universal,
    /// Free rotation.
    Spherical,
    /// Translation across the axis and rotation about it.
    Planar,
}

/// A joint that closes a loop.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutJointDescription {
    /// Kind of joint.
    kind: CutKindDescription,
    /// Frame of the joint on the first link.
    parent: FrameDescription,
    /// Frame of the joint on the second link.
    child: FrameDescription,
    /// Axis, in both frames; z where left out.
    axis: Option<[f64; 3]>,
    /// Advance of a screw per radian.
    pitch: Option<Quantity<Length>>,
}

impl ConstraintDescription for CutJointDescription {
    const KIND: &'static str = "cut_joint";
    const ABOUT: &'static str = "a joint of any kind that closes a loop";
    const EXAMPLE: &'static str =
        "{ kind: revolute, parent: { link: frame, at: [0.4, 0, 0.35] }, child: { link: arm, at: [-0.16, 0, -0.05] }, axis: [0, 1, 0] }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let (from, to) = (self.parent.place("parent", site), self.child.place("child", site));
        let axis = direction(site, "axis", self.axis.unwrap_or([0.0, 0.0, 1.0]));
        let kind = match self.kind {
            CutKindDescription::Fixed => CutKind::Fixed,
            CutKindDescription::Revolute => CutKind::Revolute,
            CutKindDescription::Prismatic => CutKind::Prismatic,
            CutKindDescription::Universal => CutKind::Universal,
            CutKindDescription::Spherical => CutKind::Spherical,
            CutKindDescription::Planar => CutKind::Planar,
            CutKindDescription::Screw => match self.pitch.map(Quantity::si) {
                Some(pitch) if pitch != 0.0 => CutKind::Screw(pitch),
                _ => {
                    site.refuse("pitch", "missing_pitch", "a screw needs a pitch other than zero");
                    return None;
                }
            },
        };
        let (from, to, axis) = (from?, to?, axis?);
        distinct(site, from.0, to.0)?;
        Some(held(site, from, to, CutJoint::new(kind, axis)))
    }
}

/// A massless rod.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DistanceDescription {
    /// First end.
    from: PointDescription,
    /// Second end.
    to: PointDescription,
    /// Length; the distance in the pose before loops are closed where left out.
    length: Option<PositiveQuantity<Length>>,
}

impl ConstraintDescription for DistanceDescription {
    const KIND: &'static str = "distance";
    const ABOUT: &'static str = "a massless rod with ball joints at its ends";
    const EXAMPLE: &'static str = "{ from: { link: frame, at: [0.4, 0, 0.35] }, to: { link: arm, at: [0, 0, 0.1] }, length: 0.25 m }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let (from, to) = (site.point("from", &self.from), site.point("to", &self.to));
        let (from, to) = (from?, to?);
        distinct(site, from.0, to.0)?;
        let apart = (site.design_position(to.0, to.1) - site.design_position(from.0, from.1)).norm();
        let length = self.length.map_or(apart, Quantity::si);
        if apart < 1e-6 {
            site.refuse("to", "points_coincide", "the two points coincide, so the rod between them has no direction");
            return None;
        }
        Some(held(site, at_point(from), at_point(to), Distance { length }))
    }
}

/// Two points that stay together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoincidentPointDescription {
    /// First point; the multipliers are written in the axes of its link.
    from: PointDescription,
    /// Second point.
    to: PointDescription,
}

impl ConstraintDescription for CoincidentPointDescription {
    const KIND: &'static str = "coincident_point";
    const ABOUT: &'static str = "two points that stay together";
    const EXAMPLE: &'static str = "{ from: { link: frame, at: [0.4, 0, 0.35] }, to: { link: arm, at: [-0.16, 0, -0.05] } }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let (from, to) = (site.frame_at("from", &self.from), site.frame_at("to", &self.to));
        let (from, to) = (from?, to?);
        distinct(site, from.0, to.0)?;
        Some(held(site, from, to, HeldPoint::at_point()))
    }
}

/// A point on a line.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointOnLineDescription {
    /// The point.
    point: PointDescription,
    /// A point of the line.
    line: PointDescription,
    /// Direction of the line in the frame of its link.
    direction: [f64; 3],
}

impl ConstraintDescription for PointOnLineDescription {
    const KIND: &'static str = "point_on_line";
    const ABOUT: &'static str = "a point that stays on a line of another link: a planar pin where the line is the axis of the pin";
    const EXAMPLE: &'static str =
        "{ point: { link: arm, at: [-0.16, 0, -0.05] }, line: { link: frame, at: [0.4, 0, 0.35] }, direction: [0, 1, 0] }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let (point, line) = (site.frame_at("point", &self.point), site.frame_at("line", &self.line));
        let direction = direction(site, "direction", self.direction);
        let (point, line, direction) = (point?, line?, direction?);
        distinct(site, line.0, point.0)?;
        Some(held(site, line, point, HeldPoint::on_line(direction)))
    }
}

/// A point on a plane.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointOnPlaneDescription {
    /// The point.
    point: PointDescription,
    /// A point of the plane.
    plane: PointDescription,
    /// Normal of the plane in the frame of its link.
    normal: [f64; 3],
}

impl ConstraintDescription for PointOnPlaneDescription {
    const KIND: &'static str = "point_on_plane";
    const ABOUT: &'static str = "a point that stays on a plane of another link";
    const EXAMPLE: &'static str =
        "{ point: { link: arm, at: [-0.16, 0, -0.05] }, plane: { link: frame, at: [0, 0, 0.35] }, normal: [0, 0, 1] }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let (point, plane) = (site.frame_at("point", &self.point), site.frame_at("plane", &self.plane));
        let normal = direction(site, "normal", self.normal);
        let (point, plane, normal) = (point?, plane?, normal?);
        distinct(site, plane.0, point.0)?;
        Some(held(site, plane, point, HeldPoint::on_plane(normal)))
    }
}

/// A joint that follows another one of its kind.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GearDescription {
    /// The joint that follows; it turns.
    joint: String,
    /// The joint that leads; it turns.
    leader: String,
    /// Speed of the follower per speed of the leader, negative where they turn against each other.
    ratio: f64,
    /// Angle of the follower where the leader is at zero.
    offset: Option<Quantity<Angle>>,
}

impl ConstraintDescription for GearDescription {
    const KIND: &'static str = "gear";
    const ABOUT: &'static str = "a joint that turns with another one at a fixed ratio, without a multiplier";
    const EXAMPLE: &'static str = "{ joint: front_axle, leader: rear_axle, ratio: 1.05 }";
    fn couple(&self, builder: &mut ModelBuilder) -> Result<(), BuildError> {
        builder.follow(&self.joint, &self.leader, self.ratio, self.offset.map_or(0.0, Quantity::si))
    }
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let both = (site.joint_with("joint", &self.joint, "rad"), site.joint_with("leader", &self.leader, "rad"));
        both.0.and(both.1).and(None)
    }
}

/// A rack on a pinion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RackDescription {
    /// The joint that follows; it slides.
    joint: String,
    /// The joint that leads; it turns.
    leader: String,
    /// Travel of the follower per radian of the leader: the radius of the pinion.
    advance: Quantity<Length>,
    /// Travel of the follower where the leader is at zero.
    offset: Option<Quantity<Length>>,
}

impl ConstraintDescription for RackDescription {
    const KIND: &'static str = "rack";
    const ABOUT: &'static str = "a joint that slides as another one turns (rack and pinion, spindle), without a multiplier";
    const EXAMPLE: &'static str = "{ joint: slider, leader: pivot, advance: 20 mm }";
    fn couple(&self, builder: &mut ModelBuilder) -> Result<(), BuildError> {
        builder.follow(&self.joint, &self.leader, self.advance.si(), self.offset.map_or(0.0, Quantity::si))
    }
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let both = (site.joint_with("joint", &self.joint, "m"), site.joint_with("leader", &self.leader, "rad"));
        both.0.and(both.1).and(None)
    }
}

/// A round body and where its axle is.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RollingDescription {
    /// The link that rolls.
    link: String,
    /// Center of the round body in the frame of the link.
    at: [Quantity<Length>; 3],
    /// Spin axis in the frame of the link, to the left of forward.
    axis: [f64; 3],
    /// Radius.
    radius: PositiveQuantity<Length>,
    /// Radius of the cross-section of a torus; 0 for a sharp edge.
    crown_radius: Option<NonNegativeQuantity<Length>>,
}

/// A round body on a link.
struct RoundBody {
    center: (BodyIndex, Pose<f64>),
    profile: Profile,
    axis: Vec3<f64>,
}

impl RollingDescription {
    fn round_body(self, site: &mut Site<'_>) -> Option<RoundBody> {
        let place =
            site.link("link", &self.link).map(|(body, X)| (body, X * Pose::new(Rotation::identity(), self.at.map(Quantity::si).into())));
        let axis = direction(site, "axis", self.axis);
        let profile = match Profile::torus(self.radius.si(), self.crown_radius.map_or(0.0, Quantity::si)) {
            Ok(profile) => Some(profile),
            Err(error) => {
                site.refuse("crown_radius", "invalid_entry", error.to_string());
                None
            }
        };
        let (center, axis, profile) = (place?, axis?, profile?);
        distinct(site, BodyIndex::WORLD, center.0)?;
        Some(RoundBody { center, profile, axis })
    }
}

impl ConstraintDescription for RollingDescription {
    const KIND: &'static str = "rolling";
    const ABOUT: &'static str = "a disc or torus that rolls without slip on the plane z = 0 of the world";
    const EXAMPLE: &'static str = "{ link: arm, at: [0, 0, 0], axis: [0, 1, 0], radius: 0.3 m, crown_radius: 60 mm }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let RoundBody { center, profile, axis } = self.round_body(site)?;
        Some(held(site, (BodyIndex::WORLD, Pose::identity()), center, Rolling::new(profile, axis)))
    }
}

/// A round body that touches.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct SurfaceContactDescription(RollingDescription);

impl ConstraintDescription for SurfaceContactDescription {
    const KIND: &'static str = "surface_contact";
    const ABOUT: &'static str = "a disc or torus that touches the plane z = 0 of the world and slides on it without friction";
    const EXAMPLE: &'static str = "{ link: arm, at: [0, 0, 0], axis: [0, 1, 0], radius: 0.3 m }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let RoundBody { center, profile, axis } = self.0.round_body(site)?;
        Some(held(site, (BodyIndex::WORLD, Pose::identity()), center, SurfaceContact::new(profile, axis)))
    }
}

/// Prescribed angle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrescribedMotionDescription {
    /// Name of a joint that turns.
    joint: String,
    /// Angle at the start; 0 where left out.
    position: Option<Quantity<Angle>>,
    /// Constant speed; 0 where left out.
    speed: Option<Quantity<AngularSpeed>>,
}

impl ConstraintDescription for PrescribedMotionDescription {
    const KIND: &'static str = "prescribed_motion";
    const ABOUT: &'static str =
        "a joint that turns as prescribed: at constant speed, plus the inputs `<name>.position`, `.speed`, `.acceleration`";
    const EXAMPLE: &'static str = "{ joint: hinge, position: 0.1 rad, speed: 2 rad/s }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let joint = site.joint_with("joint", &self.joint, "rad")?;
        let drive =
            PrescribedMotion { joint, position: self.position.map_or(0.0, Quantity::si), speed: self.speed.map_or(0.0, Quantity::si) };
        Some(Constraint::drive(site.element(), site.model(), drive))
    }
}

/// Prescribed travel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrescribedSlideDescription {
    /// Name of a joint that slides.
    joint: String,
    /// Travel at the start; 0 where left out.
    position: Option<Quantity<Length>>,
    /// Constant speed; 0 where left out.
    speed: Option<Quantity<Speed>>,
}

impl ConstraintDescription for PrescribedSlideDescription {
    const KIND: &'static str = "prescribed_slide";
    const ABOUT: &'static str =
        "a joint that slides as prescribed: at constant speed, plus the inputs `<name>.position`, `.speed`, `.acceleration`";
    const EXAMPLE: &'static str = "{ joint: slider, position: 10 mm, speed: 0.2 m/s }";
    fn assemble(self, site: &mut Site<'_>) -> Option<Constraint> {
        let joint = site.joint_with("joint", &self.joint, "m")?;
        let drive =
            PrescribedMotion { joint, position: self.position.map_or(0.0, Quantity::si), speed: self.speed.map_or(0.0, Quantity::si) };
        Some(Constraint::drive(site.element(), site.model(), drive))
    }
}
