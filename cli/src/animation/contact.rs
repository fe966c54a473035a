//! Where round bodies touch, and with which force.

use mbody::constraint::Place;
use mbody::contact::{Contact, Profile, TangentPlane};
use mbody::dynamics::System;
use mbody::model::{Attachment, Outline};
use mbody::spatial::{Pose, Vec3};
use serde_json::{Value, json};

/// Quantities of an element or a constraint that a contact is drawn from, where it has them.
const QUANTITIES: [&str; 6] = ["normal_force", "longitudinal_force", "lateral_force", "contact_x", "contact_y", "contact_z"];

/// Numbers of one contact at one time: point, normal force, friction force.
pub(super) const NUMBERS: usize = 9;

/// A round body on a plane.
#[derive(Clone, Debug)]
pub(super) struct Rolling {
    /// Name of the element or the constraint.
    name: String,
    pub(super) at: Attachment,
    axis: Vec3<f64>,
    pub(super) profile: Profile,
    /// The frame whose plane z = 0 it touches; the world where there is none.
    plane: Option<Place>,
}

impl Rolling {
    /// All of a system.
    pub(super) fn all(system: &System) -> Vec<Self> {
        let of = |name: &str, outline: &Outline, plane: Option<Place>| match outline {
            Outline::Round { at, axis, profile } => {
                Some(Self { name: name.to_owned(), at: *at, axis: *axis, profile: profile.clone(), plane })
            }
            _ => None,
        };
        let elements = system.elements().iter().flat_map(|e| {
            let outlines = e.force.outlines(system.model());
            outlines.iter().filter_map(|o| of(e.force.name(), o, None)).collect::<Vec<_>>()
        });
        let constraints = system.constraints().iter().filter_map(|c| of(c.name(), c.outline()?, Some(*c.from())));
        elements.chain(constraints).collect()
    }

    /// Names of the signals it is drawn from, in the order of [`Self::numbers`]; not all of them need exist.
    pub(super) fn signals(&self) -> [String; 6] {
        QUANTITIES.map(|q| format!("{}.{q}", self.name))
    }

    /// Point, normal force and friction force in the world, from the poses of all bodies and the signals that exist.
    pub(super) fn numbers(&self, poses: &[Pose<f64>], signals: [Option<f64>; 6]) -> [f64; NUMBERS] {
        let [normal, forward, left, x, y, z] = signals;
        let pose = &poses[self.at.0.get()];
        let mut plane = TangentPlane { point: Vec3::zero(), normal: Vec3::new(0.0, 0.0, 1.0) };
        if let Some(place) = self.plane {
            let carrier = poses[place.body.get()] * place.X_BF;
            plane = TangentPlane { point: carrier.p, normal: carrier.R.columns[2] };
        }
        let contact = Contact::with_plane(&self.profile, pose.point(self.at.1), pose.R * self.axis, &plane);
        // an elastic body knows better where it touches
        let point = match (x, y, z) {
            (Some(x), Some(y), Some(z)) => Vec3::new(x, y, z),
            _ => contact.point,
        };
        let frame = contact.frame;
        let normal = frame.k * normal.unwrap_or_default();
        let friction = frame.x * forward.unwrap_or_default() + frame.y * left.unwrap_or_default();
        [point.x, point.y, point.z, normal.x, normal.y, normal.z, friction.x, friction.y, friction.z]
    }

    /// As the viewer reads it.
    pub(super) fn json(&self) -> Value {
        let (radius, crown) = (self.profile.radius(), self.profile.curvature_radius(0.0));
        json!({
            "name": self.name,
            "body": self.at.0.get(),
            "center": <[f64; 3]>::from(self.at.1),
            "axis": <[f64; 3]>::from(self.axis),
            "radius": radius,
            "crown": crown.min(0.6 * radius),
        })
    }
}
