//! Slalom: `y = A sin(πx/d)` through cones at spacing d, grown and faded over one spacing.
//!
//! Symbols: A amplitude, m; d spacing, m; n number of cones. Length (n + 1) d: one spacing to grow, n − 1 full, one to fade.
//! Source: theory manual 10.7; the blend is the quintic of the lane change.

use super::{Layout, SectionDescription, quintic};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::{PositiveQuantity, Quantity, dimension::Length};
use mbody::scalar::Real;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// Between cones.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Slalom {
    /// Distance from cone to cone.
    spacing: PositiveQuantity<Length>,
    /// Amplitude of the path, positive to the left at first.
    amplitude: Quantity<Length>,
    /// Number of cones; at least 2.
    #[schemars(range(min = 2, max = 200))]
    cones: u32,
}

impl SectionDescription for Slalom {
    const KIND: &'static str = "slalom";
    const ABOUT: &'static str = "between cones";
    const EXAMPLE: &'static str = "{ spacing: 21 m, amplitude: 1.2 m, cones: 6 }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        let (d, amplitude) = (self.spacing.si(), self.amplitude.si());
        let length = f64::from(self.cones + 1) * d;
        path.offset(length, |x| {
            let wave = (x * (PI / d)).sin() * amplitude;
            // the value alone decides which piece holds; they join with two derivatives
            let at = x.value();
            if at < d {
                wave * quintic(x / d)
            } else if at > length - d {
                wave * quintic((-x + length) / d)
            } else {
                wave
            }
        });
        Ok(())
    }
}
