//! Sections of a path: one file and one row each.

mod curve;
mod double_lane_change;
mod lane_change;
mod slalom;
mod straight;
mod through_points;
mod u_turn;

use super::path::{Layout, Twice};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// The written form of one kind of section. Implement it on a `deny_unknown_fields` struct.
pub trait SectionDescription: DeserializeOwned + JsonSchema {
    /// Name in maneuvers.
    const KIND: &'static str;
    /// One sentence.
    const ABOUT: &'static str;
    /// Parameters as a user would write them.
    const EXAMPLE: &'static str;
    /// Lays the section at the end of a path. Files come from the library.
    ///
    /// # Errors
    /// Parameters that do not go together.
    fn lay(self, path: &mut Layout, library: &dyn Library) -> Result<(), Findings>;
}

/// A row of the table.
#[derive(Clone, Copy)]
pub struct SectionKind {
    /// Name in maneuvers.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Parameters as a user would write them.
    pub example: &'static str,
    /// JSON Schema of the parameters.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Reads the parameters and lays the section.
    pub lay: fn(&Value, &mut Layout, &dyn Library) -> Result<(), Findings>,
}

impl SectionKind {
    const fn of<T: SectionDescription>() -> Self {
        Self { name: T::KIND, about: T::ABOUT, example: T::EXAMPLE, schema: |generator| generator.subschema_for::<T>(), lay: lay::<T> }
    }
}

impl std::fmt::Debug for SectionKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn lay<T: SectionDescription>(value: &Value, path: &mut Layout, library: &dyn Library) -> Result<(), Findings> {
    let read: T = serde_path_to_error::deserialize(value).map_err(|e| {
        let at = e.path().to_string();
        let at = if at == "." { String::new() } else { at };
        Findings::from(Finding::error("invalid_entry", e.into_inner().to_string()).at_path(at))
    })?;
    read.lay(path, library)
}

/// All kinds of sections.
pub const KINDS: &[SectionKind] = &[
    SectionKind::of::<straight::Straight>(),
    SectionKind::of::<curve::Curve>(),
    SectionKind::of::<lane_change::LaneChange>(),
    SectionKind::of::<double_lane_change::DoubleLaneChange>(),
    SectionKind::of::<slalom::Slalom>(),
    SectionKind::of::<u_turn::UTurn>(),
    SectionKind::of::<through_points::ThroughPoints>(),
];

/// From 0 to 1 over q from 0 to 1, level with two derivatives at both ends: `10 q³ − 15 q⁴ + 6 q⁵`.
fn quintic(q: Twice) -> Twice {
    q * q * q * (q * (q * 6.0 - 15.0) + 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Nothing;

    impl Library for Nothing {
        fn text(&self, _: &str) -> Option<std::borrow::Cow<'_, str>> {
            None
        }
    }

    /// Every example is laid, in the direction in which it began or turned as it says.
    #[test]
    fn every_example_can_be_laid() {
        for kind in KINDS {
            let value: Value = serde_yaml::from_str(kind.example).unwrap();
            let mut layout = Layout::default();
            layout.straight(5.0);
            (kind.lay)(&value, &mut layout, &Nothing).unwrap_or_else(|e| panic!("{}: {e}", kind.name));
            let path = layout.path();
            assert!(path.length() > 5.0, "{}", kind.name);
            // one unit of arc per unit of arc
            let h = 1e-4;
            for k in 0..100 {
                let s = path.length() * f64::from(k) / 100.0;
                let (a, b) = (path.at(s - h), path.at(s + h));
                let way = (b.x - a.x).hypot(b.y - a.y);
                assert!((way / (2.0 * h) - 1.0).abs() < 1e-6, "{} at {s}", kind.name);
                let turned = (b.heading - a.heading) / (2.0 * h);
                // corners of the curvature are rounded over a knot
                assert!((turned - path.curvature(s)).abs() < 1e-3, "{} at {s}: {turned} {}", kind.name, path.curvature(s));
            }
        }
    }

    /// End of a path of one section.
    fn end(kind: &str, parameters: &str) -> (f64, f64, f64) {
        let kind = KINDS.iter().find(|k| k.name == kind).unwrap();
        let mut layout = Layout::default();
        (kind.lay)(&serde_yaml::from_str(parameters).unwrap(), &mut layout, &Nothing).unwrap();
        let path = layout.path();
        let at = path.at(path.length());
        (at.x, at.y, at.heading)
    }

    #[test]
    fn sections_end_where_their_parameters_say() {
        let near =
            |(x, y, h): (f64, f64, f64), (a, b, c): (f64, f64, f64)| (x - a).abs() < 1e-4 && (y - b).abs() < 1e-4 && (h - c).abs() < 1e-5;
        let change = end("lane_change", "{ width: 3.6 m, length: 40 m }");
        assert!(near(change, (40.0, 3.6, 0.0)), "{change:?}");
        let double = end("double_lane_change", "{ standard: iso_3888_2, vehicle_width: 0.8 m }");
        assert!(double.1.abs() < 1e-4 && double.2.abs() < 1e-6 && (double.0 - 61.0).abs() < 1e-4, "{double:?}");
        let turned = end("u_turn", "{ radius: 6 m, transition: 4 m }");
        assert!((turned.2 - std::f64::consts::PI).abs() < 1e-6, "{turned:?}");
        let curve = end("curve", "{ radius: 100 m, transition: 20 m, angle: 90 deg, exit: 20 m }");
        assert!((curve.2 - std::f64::consts::FRAC_PI_2).abs() < 1e-6, "{curve:?}");
        let right = end("curve", "{ radius: -100 m, transition: 20 m, angle: 90 deg, exit: 20 m }");
        assert!(near(right, (curve.0, -curve.1, -curve.2)), "{right:?}");
    }
}
