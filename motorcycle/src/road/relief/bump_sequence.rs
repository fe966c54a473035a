//! Equal bumps one after the other: a `cosine_bump` every so many meters.
//!
//! At the speed V they are felt with the frequency V/d, d the spacing: the test by which hops and pitching are found. Source and range: those of `cosine_bump`.

use super::cosine_bump::Bump;
use super::{Relief, ReliefDescription, Uneven};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity, dimension::Length};
use mbody::scalar::spline::CurvePoint;
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// Equal bumps one after the other.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BumpSequence {
    /// Height of each, negative for dips.
    height: Quantity<Length>,
    /// Length of each along the road.
    length: PositiveQuantity<Length>,
    /// Where the first begins on the path.
    station: NonNegativeQuantity<Length>,
    /// From the beginning of one to that of the next; at least their length.
    spacing: PositiveQuantity<Length>,
    /// How many.
    #[schemars(range(min = 1, max = 10000))]
    count: u32,
}

#[derive(Debug)]
struct Bumps {
    first: Bump,
    spacing: f64,
    count: u32,
}

impl Uneven for Bumps {
    fn at(&self, s: f64) -> CurvePoint<f64> {
        let passed = ((s - self.first.begin) / self.spacing).floor().clamp(0.0, f64::from(self.count - 1));
        self.first.at(s - passed * self.spacing)
    }

    fn shortest(&self) -> f64 {
        self.first.length
    }
}

impl ReliefDescription for BumpSequence {
    const KIND: &'static str = "bump_sequence";
    const ABOUT: &'static str = "equal bumps one after the other";
    const EXAMPLE: &'static str = "{ height: 30 mm, length: 0.6 m, station: 20 m, spacing: 3 m, count: 5 }";
    fn relief(self, _: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let first = Bump { height: self.height.si(), length: self.length.si(), begin: self.station.si() };
        let spacing = self.spacing.si();
        if spacing < first.length {
            let why = format!("bumps {} m long would overlap every {spacing} m", first.length);
            return Err(Finding::error("out_of_range", why).at_path("spacing").with_hint("make `spacing` at least `length`").into());
        }
        Ok(Some(Arc::new(Bumps { first, spacing, count: self.count.max(1) })))
    }
}
