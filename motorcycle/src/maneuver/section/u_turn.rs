//! U-turn: clothoid, arc, clothoid, by 180° in all.
//!
//! Source: theory manual 10.7.

use super::{Layout, SectionDescription};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::{PositiveQuantity, Quantity, dimension::Length};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// Back where it came from.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct UTurn {
    /// Radius of the arc, positive to the left.
    radius: Quantity<Length>,
    /// Length of each of the two transitions.
    transition: PositiveQuantity<Length>,
}

impl SectionDescription for UTurn {
    const KIND: &'static str = "u_turn";
    const ABOUT: &'static str = "a turn by 180 degrees: clothoid, arc, clothoid";
    const EXAMPLE: &'static str = "{ radius: 6 m, transition: 4 m }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        let (radius, transition) = (self.radius.si(), self.transition.si());
        let arc = PI * radius.abs() - transition;
        if arc < 0.0 {
            let message = format!("transitions of {transition} m turn by more than 180 degrees at a radius of {} m", radius.abs());
            return Err(Finding::error("out_of_range", message).at_path("transition").into());
        }
        path.bend(transition, 0.0, 1.0 / radius);
        path.bend(arc, 1.0 / radius, 1.0 / radius);
        path.bend(transition, 1.0 / radius, 0.0);
        Ok(())
    }
}
