//! What a description file may say, and its JSON Schema.

use super::Kinds;
use crate::description::parameter::{AdjustableDescription, ParameterDescription};
use crate::description::quantity::dimension::{Acceleration, Angle, Inertia, Length, Mass, Number};
use crate::description::quantity::{NonNegativeQuantity, Quantity};
use schemars::{JsonSchema, Schema, generate::SchemaSettings};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// A description: a URDF tree and everything that URDF cannot say.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Version of this format: 1.
    #[schemars(range(min = 1, max = 1))]
    pub fastbike: u32,
    /// Name for headings and figures.
    pub name: String,
    /// A sentence or two: what it is and where the numbers come from.
    pub about: Option<String>,
    /// URDF file with links and joints, beside this file; or several of them, by the name of the part.
    pub urdf: TreeFiles,
    /// Joint between the world and the root link.
    pub base: BaseDescription,
    /// Acceleration of free fall, downward; 9.81 m/s² where left out.
    pub gravity: Option<NonNegativeQuantity<Acceleration>>,
    /// Named quantities, from which other entries follow by formulas: `= 0.5 * spring_rate`.
    #[serde(default)]
    pub parameters: BTreeMap<String, ParameterDescription>,
    /// What is changed on the finished machine, with its range; a setup file holds values of these only.
    #[serde(default)]
    pub adjustables: BTreeMap<String, AdjustableDescription>,
    /// Other mass properties for links of the URDF.
    #[serde(default)]
    pub links: BTreeMap<String, LinkOptions>,
    /// Joints of the URDF at another place, locked, or of a kind that URDF does not know.
    #[serde(default)]
    pub joints: BTreeMap<String, JointOptions>,
    /// Values of signals from which assembly, steady states and motions start: `crank.angle: 30 deg`. What is stated here is held while
    /// loops are closed; everything else may move.
    #[serde(default)]
    pub start: Map<String, Value>,
    /// Constraints, by name: `rod: { distance: { … } }`.
    #[serde(default)]
    pub constraints: Map<String, Value>,
    /// Force elements, by name: `rear_shock: { spring_damper: { … } }`.
    #[serde(default)]
    pub elements: Map<String, Value>,
}

/// Joint between the world and the root link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BaseDescription {
    /// Welded to the world.
    Fixed,
    /// Free, with a quaternion; velocities in axes of the root link.
    Free,
    /// Motion in the horizontal plane.
    Planar,
    /// Planar motion in the yawed frame, then heave, roll and pitch; the root link's origin is the base point.
    VehicleBase,
}

/// The tree: one file, or parts that joints connect.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TreeFiles {
    /// The whole tree.
    One(String),
    /// Parts by name: a joint of one may carry its link on a link of another.
    Parts(BTreeMap<String, String>),
}

/// Mass properties of a link in place of those in the URDF, in the axes written there.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkOptions {
    /// Mass.
    pub mass: Option<Quantity<Mass>>,
    /// Mass center in the frame of the link.
    pub com: Option<Coordinates>,
    /// Moments and products of inertia about the mass center (products with their sign, `ixy` = −∫ x y dm).
    pub inertia: Option<InertiaOptions>,
}

/// A point by its coordinates; those that are left out stay.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coordinates {
    /// Forward.
    pub x: Option<Quantity<Length>>,
    /// To the left.
    pub y: Option<Quantity<Length>>,
    /// Up.
    pub z: Option<Quantity<Length>>,
}

/// Entries of an inertia tensor; those that are left out stay.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InertiaOptions {
    /// Moment about x.
    pub ixx: Option<Quantity<Inertia>>,
    /// Moment about y.
    pub iyy: Option<Quantity<Inertia>>,
    /// Moment about z.
    pub izz: Option<Quantity<Inertia>>,
    /// Product of x and y.
    pub ixy: Option<Quantity<Inertia>>,
    /// Product of x and z.
    pub ixz: Option<Quantity<Inertia>>,
    /// Product of y and z.
    pub iyz: Option<Quantity<Inertia>>,
}

/// Angles of the fixed axes x, y, z, one after the other; those that are left out stay.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AngleOptions {
    /// Roll.
    pub r: Option<Quantity<Angle>>,
    /// Pitch.
    pub p: Option<Quantity<Angle>>,
    /// Yaw.
    pub y: Option<Quantity<Angle>>,
}

/// Components of a direction; those that are left out stay.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionOptions {
    /// Forward.
    pub x: Option<Quantity<Number>>,
    /// To the left.
    pub y: Option<Quantity<Number>>,
    /// Up.
    pub z: Option<Quantity<Number>>,
}

/// What URDF cannot say about a joint, and what is to be otherwise than it says.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointOptions {
    /// Locks the joint at zero: its link is welded, and elements that act on the joint are left out.
    #[serde(default)]
    pub locked: bool,
    /// Kind of joint that URDF does not know, in place of the one written there.
    pub kind: Option<JointKindDescription>,
    /// Advance of a screw per radian.
    pub pitch: Option<Quantity<Length>>,
    /// Origin of the joint in its parent link, in place of that in the URDF.
    pub origin: Option<Coordinates>,
    /// Orientation of the joint in its parent link, in place of that in the URDF.
    pub rpy: Option<AngleOptions>,
    /// Axis of the joint, in place of that in the URDF.
    pub axis: Option<DirectionOptions>,
}

/// Kinds of joints that URDF does not know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKindDescription {
    /// Rotation about x of the joint frame, then about y of the link.
    Universal,
    /// Rotation about the axis with a proportional advance along it.
    Screw,
}

/// An entry of one kind with its parameters.
fn choice(name: &str, about: &str, parameters: Schema) -> Value {
    json!({
        "type": "object",
        "description": about,
        "properties": { name: parameters },
        "required": [name],
        "additionalProperties": false
    })
}

/// The JSON Schema (draft 2020-12) of descriptions with the given kinds.
pub fn schema(kinds: &Kinds) -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let elements = kinds.elements().iter().map(|k| choice(k.name, k.about, (k.schema)(&mut generator))).collect::<Vec<_>>();
    let constraints = kinds.constraints().iter().map(|k| choice(k.name, k.about, (k.schema)(&mut generator))).collect::<Vec<_>>();
    let mut root = generator.root_schema_for::<Description>().to_value();
    root["title"] = json!("FastBike description");
    root["properties"]["elements"] = json!({
        "type": "object",
        "description": "Force elements, by name; each is one kind with its parameters.",
        "additionalProperties": { "oneOf": elements }
    });
    root["properties"]["constraints"] = json!({
        "type": "object",
        "description": "Constraints, by name; each is one kind with its parameters.",
        "additionalProperties": { "oneOf": constraints }
    });
    root["properties"]["start"]["additionalProperties"] = json!({ "type": ["number", "string"] });
    // `root_schema_for` collects the definitions that the kinds refer to as well
    root
}
