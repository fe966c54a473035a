//! Into a curve, along it, and out of it where that is asked for: clothoid, arc, clothoid.
//!
//! Over a transition of length L_c the curvature changes evenly to 1/R; it turns by `L_c/(2R)`. Symbols: R radius, m, positive to the left.
//! Source: clothoids of road design (theory manual 10.7).

use super::{Layout, SectionDescription};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::{Angle, Length};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Into a curve, along it, and out of it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Curve {
    /// Radius of the arc, positive to the left.
    radius: Quantity<Length>,
    /// Length over which the curvature comes up.
    transition: NonNegativeQuantity<Length>,
    /// Angle by which the whole section turns; give this or `length`.
    angle: Option<PositiveQuantity<Angle>>,
    /// Length of the arc between the transitions; give this or `angle`.
    length: Option<NonNegativeQuantity<Length>>,
    /// Length over which the curvature goes back to zero; left out: the path stays in the curve.
    exit: Option<NonNegativeQuantity<Length>>,
}

impl SectionDescription for Curve {
    const KIND: &'static str = "curve";
    const ABOUT: &'static str = "into a curve by a clothoid, along it, and out of it again where `exit` says so";
    const EXAMPLE: &'static str = "{ radius: 100 m, transition: 30 m, angle: 90 deg, exit: 30 m }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        let (radius, entry) = (self.radius.si(), self.transition.si());
        if radius == 0.0 {
            return Err(Finding::error("out_of_range", "a radius of `0 m` is out of range")
                .at_path("radius")
                .with_hint("a straight is its own section")
                .into());
        }
        let exit = self.exit.map(|e| e.si());
        let arc = match (self.angle, self.length) {
            (None, Some(length)) => length.si(),
            (Some(angle), None) => {
                // a transition turns by half of what an arc of its length does
                let arc = angle.si() * radius.abs() - 0.5 * (entry + exit.unwrap_or(0.0));
                if arc < 0.0 {
                    let message = format!("the transitions alone turn by more than the angle: the arc would be {arc:.3} m long");
                    return Err(Finding::error("out_of_range", message)
                        .at_path("angle")
                        .with_hint("take shorter transitions or a larger angle")
                        .into());
                }
                arc
            }
            (None, None) => return Err(Finding::error("missing_entry", "one of `angle` and `length` is needed").at_path("").into()),
            (Some(_), Some(_)) => {
                return Err(Finding::error("given_twice", "`angle` and `length` say the same; give one of them").at_path("length").into());
            }
        };
        path.bend(entry, path.last_curvature(), 1.0 / radius);
        path.bend(arc, 1.0 / radius, 1.0 / radius);
        if let Some(exit) = exit {
            path.bend(exit, 1.0 / radius, 0.0);
        }
        Ok(())
    }
}
