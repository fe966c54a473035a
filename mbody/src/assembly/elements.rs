//! Written forms of the force elements of this crate.

use super::characteristic::{
    AirDescription, DamperDescription, FrictionDescription, LawDescription, Motion, Sliding, SpringDescription, StopsDescription, Turning,
};
use super::{ElementDescription, ElementKind, PointDescription, Site};
use crate::description::quantity::dimension::{Angle, AngularDamping, AngularStiffness, Damping, Force, Length, Stiffness, Torque};
use crate::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use crate::force::{AppliedWrench, Bushing, JointEffort, JointEffortUnit, JointSpring, PointSensor, SpringDamper, WrenchAxes};
use crate::model::BodyIndex;
use crate::spatial::{Pose, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

/// The element kinds of this crate.
pub const STANDARD: &[ElementKind] = &[
    ElementKind::of::<JointSpringDescription>(),
    ElementKind::of::<JointTorsionSpringDescription>(),
    ElementKind::of::<JointForceDescription>(),
    ElementKind::of::<JointTorqueDescription>(),
    ElementKind::of::<SpringDamperDescription>(),
    ElementKind::of::<BushingDescription>(),
    ElementKind::of::<AppliedWrenchDescription>(),
    ElementKind::of::<PointSensorDescription>(),
];

/// Full name of the signal of a joint's only coordinate.
fn coordinate_signal(site: &Site<'_>, joint: BodyIndex) -> String {
    let body = site.model().body(joint);
    format!("{}.{}", body.joint_name, body.joint.coordinates()[0].name)
}

fn joint_spring<M: Motion>(site: &mut Site<'_>, joint: &str, unit: &str, law: LawDescription<M>) -> Option<JointSpring> {
    let body = site.joint_with("joint", joint, unit);
    let law = law.law(site);
    let (joint, law) = (body?, law?);
    let effort = if unit == "m" { JointEffortUnit::Force } else { JointEffortUnit::Torque };
    Some(JointSpring { joint, law, effort, stop: Some(("joint_stop", coordinate_signal(site, joint))) })
}

/// Spring, damper, air column, stops and friction on a joint that slides.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSpringDescription {
    /// Name of the joint.
    joint: String,
    /// Elastic part; positive force opposes a positive coordinate.
    spring: Option<SpringDescription<Sliding>>,
    /// Viscous part.
    damper: Option<DamperDescription<Sliding>>,
    /// Air column.
    air: Option<AirDescription>,
    /// End stops.
    stops: Option<StopsDescription<Sliding>>,
    /// Dry friction.
    friction: Option<FrictionDescription<Sliding>>,
}

impl ElementDescription for JointSpringDescription {
    const KIND: &'static str = "joint_spring";
    const ABOUT: &'static str = "spring, damper, air column, stops and friction on a joint that slides";
    const EXAMPLE: &'static str = "{ joint: slider, spring: { stiffness: 18 kN/m, preload: 800 N }, damper: { bump: 900 N s/m, rebound: 1500 N s/m }, \
        air: { force: 60 N, length: 0.3 m, exponent: 1.2 }, stops: { lower: -60 mm, upper: 60 mm, stiffness: 300 kN/m, width: 10 mm }, \
        friction: { effort: 40 N, rounding: 10 mm/s } }";
    type Law = JointSpring;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointSpring> {
        let Self { joint, spring, damper, air, stops, friction } = self;
        joint_spring(site, &joint, "m", LawDescription { spring, damper, air, stops, friction })
    }
}

/// Spring, damper, stops and friction on a joint that turns.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTorsionSpringDescription {
    /// Name of the joint.
    joint: String,
    /// Elastic part; positive torque opposes a positive coordinate.
    spring: Option<SpringDescription<Turning>>,
    /// Viscous part.
    damper: Option<DamperDescription<Turning>>,
    /// End stops.
    stops: Option<StopsDescription<Turning>>,
    /// Dry friction.
    friction: Option<FrictionDescription<Turning>>,
}

impl ElementDescription for JointTorsionSpringDescription {
    const KIND: &'static str = "joint_torsion_spring";
    const ABOUT: &'static str = "spring, damper, stops and friction on a joint that turns";
    const EXAMPLE: &'static str = "{ joint: hinge, spring: { table: { deflection: [-10 deg, 0 deg, 10 deg], force: [-600, 500, 2000] } }, \
        damper: { coefficient: 450 N m s/rad }, stops: { lower: -8 deg, upper: 8 deg, stiffness: 20 kN m/rad, width: 1 deg }, \
        friction: { effort: 5 N m, rounding: 0.02 } }";
    type Law = JointSpring;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointSpring> {
        let Self { joint, spring, damper, stops, friction } = self;
        joint_spring(site, &joint, "rad", LawDescription { spring, damper, air: None, stops, friction })
    }
}

/// An input force on a joint that slides.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointForceDescription {
    /// Name of the joint.
    joint: String,
    /// Force where nobody says otherwise; 0 where left out.
    force: Option<Quantity<Force>>,
}

impl ElementDescription for JointForceDescription {
    const KIND: &'static str = "joint_force";
    const ABOUT: &'static str = "input `<element>.force` on a joint that slides";
    const EXAMPLE: &'static str = "{ joint: slider, force: 20 N }";
    type Law = JointEffort;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointEffort> {
        let joint = site.joint_with("joint", &self.joint, "m")?;
        Some(JointEffort { joint, unit: JointEffortUnit::Force, default: self.force.map_or(0.0, Quantity::si) })
    }
}

/// An input torque on a joint that turns.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTorqueDescription {
    /// Name of the joint.
    joint: String,
    /// Torque where nobody says otherwise; 0 where left out.
    torque: Option<Quantity<Torque>>,
}

impl ElementDescription for JointTorqueDescription {
    const KIND: &'static str = "joint_torque";
    const ABOUT: &'static str = "input `<element>.torque` on a joint that turns";
    const EXAMPLE: &'static str = "{ joint: pivot, torque: 3 N m }";
    type Law = JointEffort;
    fn assemble(self, site: &mut Site<'_>) -> Option<JointEffort> {
        let joint = site.joint_with("joint", &self.joint, "rad")?;
        Some(JointEffort { joint, unit: JointEffortUnit::Torque, default: self.torque.map_or(0.0, Quantity::si) })
    }
}

/// Spring and damper between two points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringDamperDescription {
    /// First point.
    from: PointDescription,
    /// Second point.
    to: PointDescription,
    /// Length at which the compression is zero; the distance in the design pose where left out.
    free_length: Option<PositiveQuantity<Length>>,
    /// Elastic part; the deflection is the compression, positive force pushes the points apart.
    spring: Option<SpringDescription<Sliding>>,
    /// Viscous part.
    damper: Option<DamperDescription<Sliding>>,
    /// Air column.
    air: Option<AirDescription>,
    /// End stops, in terms of the compression.
    stops: Option<StopsDescription<Sliding>>,
    /// Dry friction.
    friction: Option<FrictionDescription<Sliding>>,
}

impl ElementDescription for SpringDamperDescription {
    const KIND: &'static str = "spring_damper";
    const ABOUT: &'static str = "spring and damper between two points";
    const EXAMPLE: &'static str = "{ from: { link: frame, at: [0.4, 0, 0.7] }, to: { link: arm, at: [-0.2, 0, -0.02] }, free_length: 0.36 m, \
        spring: { stiffness: 58 kN/m, preload: 300 N }, damper: { coefficient: 4 kN s/m }, \
        stops: { lower: -50 mm, upper: 60 mm, stiffness: 500 kN/m, width: 10 mm } }";
    type Law = SpringDamper;
    fn assemble(self, site: &mut Site<'_>) -> Option<SpringDamper> {
        let (from, to) = (site.point("from", &self.from), site.point("to", &self.to));
        let Self { spring, damper, air, stops, friction, .. } = self;
        let law = LawDescription { spring, damper, air, stops, friction }.law(site);
        let (from, to) = (from?, to?);
        let distance = (site.design_position(to.0, to.1) - site.design_position(from.0, from.1)).norm();
        if distance < 1e-6 {
            site.refuse("to", "points_coincide", "the two points coincide in the design pose, so the line between them has no direction");
            return None;
        }
        Some(SpringDamper { from, to, free_length: self.free_length.map_or(distance, Quantity::si), law: law?, stop: "spring_stop" })
    }
}

/// A frame of a link.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrameDescription {
    /// Name of the link.
    link: String,
    /// Origin in the frame of the link.
    at: [Quantity<Length>; 3],
    /// Roll, pitch and yaw of the frame in the link, as in URDF.
    rpy: Option<[Quantity<Angle>; 3]>,
}

impl FrameDescription {
    /// The body the link belongs to, and the frame there.
    pub(super) fn place(&self, key: &str, site: &mut Site<'_>) -> Option<(BodyIndex, Pose<f64>)> {
        let (body, X) = site.link(&format!("{key}.link"), &self.link)?;
        let rpy = self.rpy.map_or([0.0; 3], |rpy| rpy.map(Quantity::si));
        Some((body, X * Pose::from_xyz_rpy(self.at.map(Quantity::si), rpy)))
    }
}

/// Elastic bushing between two frames.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BushingDescription {
    /// First frame; stiffness and damping are along and about its axes.
    from: FrameDescription,
    /// Second frame.
    to: FrameDescription,
    /// Stiffness along x, y, z.
    stiffness: [NonNegativeQuantity<Stiffness>; 3],
    /// Damping along x, y, z.
    damping: [NonNegativeQuantity<Damping>; 3],
    /// Stiffness about x, y, z.
    rotational_stiffness: [NonNegativeQuantity<AngularStiffness>; 3],
    /// Damping about x, y, z.
    rotational_damping: [NonNegativeQuantity<AngularDamping>; 3],
}

impl ElementDescription for BushingDescription {
    const KIND: &'static str = "bushing";
    const ABOUT: &'static str = "elastic bushing between two frames: three translations, three rotations";
    const EXAMPLE: &'static str = "{ from: { link: frame, at: [0.4, 0, 0.35] }, to: { link: arm, at: [-0.16, 0, -0.05] }, \
        stiffness: [900 N/mm, 500 N/mm, 900 N/mm], damping: [200, 200, 200], \
        rotational_stiffness: [300 N m/rad, 100 N m/rad, 300 N m/rad], rotational_damping: [1, 1, 1] }";
    type Law = Bushing;
    fn assemble(self, site: &mut Site<'_>) -> Option<Bushing> {
        let (from, to) = (self.from.place("from", site), self.to.place("to", site));
        Some(Bushing {
            from: from?,
            to: to?,
            stiffness: self.stiffness.map(Quantity::si).into(),
            damping: self.damping.map(Quantity::si).into(),
            rotational_stiffness: self.rotational_stiffness.map(Quantity::si).into(),
            rotational_damping: self.rotational_damping.map(Quantity::si).into(),
        })
    }
}

/// Axes in which a wrench is given.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AxesDescription {
    /// Axes of the world.
    World,
    /// Axes of the link.
    Link,
}

/// Force and moment on a link, as inputs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AppliedWrenchDescription {
    /// Point of application.
    point: PointDescription,
    /// Axes of the inputs.
    axes: AxesDescription,
}

impl ElementDescription for AppliedWrenchDescription {
    const KIND: &'static str = "applied_wrench";
    const ABOUT: &'static str = "inputs `<element>.force_x` to `<element>.moment_z` at a point of a link";
    const EXAMPLE: &'static str = "{ point: { link: frame, at: [0.7, 0, 1.1] }, axes: world }";
    type Law = AppliedWrench;
    fn assemble(self, site: &mut Site<'_>) -> Option<AppliedWrench> {
        let (body, point): (BodyIndex, Vec3<f64>) = site.point("point", &self.point)?;
        let axes = match self.axes {
            AxesDescription::World => WrenchAxes::World,
            AxesDescription::Link => WrenchAxes::Body,
        };
        Some(AppliedWrench { body, point, axes })
    }
}

/// Motion of a point: height, speed, velocity, acceleration.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSensorDescription {
    /// The point.
    point: PointDescription,
}

impl ElementDescription for PointSensorDescription {
    const KIND: &'static str = "point_sensor";
    const ABOUT: &'static str = "outputs height, speed, velocity and acceleration of a point";
    const EXAMPLE: &'static str = "{ point: { link: frame, at: [0.45, 0, 0.85] } }";
    type Law = PointSensor;
    fn assemble(self, site: &mut Site<'_>) -> Option<PointSensor> {
        let (body, point) = site.point("point", &self.point)?;
        Some(PointSensor { body, point })
    }
}
