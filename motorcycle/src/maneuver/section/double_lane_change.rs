//! Double lane change and obstacle avoidance of ISO 3888: through the centers of the lanes, by quintic changes between them.
//!
//! Lanes (entry, change, side lane, change, exit) in m: part 1 (double lane change) 15, 30, 25, 25, 15 with an offset of 3.5 m between the lanes' edges taken here
//! as that of their centers; part 2 (obstacle avoidance) 12, 13.5, 11, 12.5, 12, where the entry lane is 1.1 b + 0.25 m wide, the side lane b + 1 m and one
//! meter beyond it, the exit lane the larger of 1.3 b + 0.25 m and 3 m; b width of the vehicle. Centers of part 2, left edges in line at entry and exit on the right:
//! side lane `(1.1 b + 0.25)/2 + 1 + (b + 1)/2` to the left of the entry lane, exit lane back on the line of the entry.
//!
//! Source: ISO 3888-1:2018, ISO 3888-2:2011 as summarized in the theory manual 10.7; the tracks themselves leave the driver free within the lanes.

use super::{Layout, SectionDescription, quintic};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::{PositiveQuantity, dimension::Length};
use schemars::JsonSchema;
use serde::Deserialize;

/// Which track.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Standard {
    /// Double lane change.
    #[serde(rename = "iso_3888_1")]
    DoubleLaneChange,
    /// Obstacle avoidance.
    #[serde(rename = "iso_3888_2")]
    ObstacleAvoidance,
}

/// Out of the lane and back into it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DoubleLaneChange {
    /// Track of ISO 3888: `iso_3888_1` double lane change, `iso_3888_2` obstacle avoidance.
    standard: Standard,
    /// Width of the vehicle; it sets the widths of the lanes of obstacle avoidance.
    vehicle_width: PositiveQuantity<Length>,
    /// Factor on all lengths; 1 where left out.
    stretch: Option<f64>,
}

impl SectionDescription for DoubleLaneChange {
    const KIND: &'static str = "double_lane_change";
    const ABOUT: &'static str = "out of the lane and back into it: the tracks of ISO 3888";
    const EXAMPLE: &'static str = "{ standard: iso_3888_2, vehicle_width: 0.8 m }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        let b = self.vehicle_width.si();
        let stretch = self.stretch.unwrap_or(1.0);
        if !(stretch.is_finite() && stretch > 0.0) {
            return Err(Finding::error("out_of_range", format!("a stretch of `{stretch}` is out of range: it must be positive"))
                .at_path("stretch")
                .into());
        }
        let (lengths, offset) = match self.standard {
            Standard::DoubleLaneChange => ([15.0, 30.0, 25.0, 25.0, 15.0], 3.5),
            Standard::ObstacleAvoidance => ([12.0, 13.5, 11.0, 12.5, 12.0], 0.5 * (1.1 * b + 0.25) + 1.0 + 0.5 * (b + 1.0)),
        };
        let [entry, out, side, back, exit] = lengths.map(|l| l * stretch);
        path.straight(entry);
        path.offset(out, |x| quintic(x / out) * offset);
        path.straight(side);
        path.offset(back, |x| quintic(x / back) * -offset);
        path.straight(exit);
        Ok(())
    }
}
