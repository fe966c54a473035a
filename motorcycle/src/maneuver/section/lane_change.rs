//! Lane change: `y = w (10 q³ − 15 q⁴ + 6 q⁵)`, `q = x/L`.
//!
//! Symbols: w width, m, positive to the left; L length, m. The peak of the lateral acceleration at the speed V is `10 w V²/(√3 L²)`.
//! Source: theory manual 10.7 (the seed paper's Fig. 4: 3.6 m in 40 m at 25 m/s).

use super::{Layout, SectionDescription, quintic};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::{PositiveQuantity, Quantity, dimension::Length};
use schemars::JsonSchema;
use serde::Deserialize;

/// Change to a lane beside.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LaneChange {
    /// Distance of the lanes, positive to the left.
    width: Quantity<Length>,
    /// Length over which the change takes place.
    length: PositiveQuantity<Length>,
}

impl SectionDescription for LaneChange {
    const KIND: &'static str = "lane_change";
    const ABOUT: &'static str = "change to a lane beside";
    const EXAMPLE: &'static str = "{ width: 3.6 m, length: 40 m }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        let (width, length) = (self.width.si(), self.length.si());
        path.offset(length, |x| quintic(x / length) * width);
        Ok(())
    }
}
