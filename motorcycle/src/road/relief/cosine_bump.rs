//! A bump across the road: `z = ½ h (1 − cos 2πq)`, `q = (s − s₀)/l` from 0 to 1.
//!
//! Symbols: h height, m, negative for a dip; l length, m; s₀ where it begins, m. Height and slope are continuous, the second derivative is not.
//! Source: elementary; a full period of a raised cosine. Range: lengths above that of
//! the contact patch, 0.1 m or so, which the road would otherwise be averaged over.

use super::{Relief, ReliefDescription, Uneven};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity, dimension::Length};
use mbody::scalar::spline::CurvePoint;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A bump across the road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CosineBump {
    /// Height, negative for a dip.
    height: Quantity<Length>,
    /// Length along the road.
    length: PositiveQuantity<Length>,
    /// Where it begins on the path, by the wheels; the front wheel starts one wheelbase along it.
    station: NonNegativeQuantity<Length>,
}

/// One bump.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bump {
    pub height: f64,
    pub length: f64,
    pub begin: f64,
}

impl Uneven for Bump {
    fn at(&self, s: f64) -> CurvePoint<f64> {
        let q = (s - self.begin) / self.length;
        if !(0.0..=1.0).contains(&q) {
            return CurvePoint { value: 0.0, slope: 0.0, curvature: 0.0 };
        }
        let (number, half) = (TAU / self.length, 0.5 * self.height);
        let (sine, cosine) = (TAU * q).sin_cos();
        CurvePoint { value: half * (1.0 - cosine), slope: half * number * sine, curvature: half * number * number * cosine }
    }

    fn shortest(&self) -> f64 {
        self.length
    }
}

impl ReliefDescription for CosineBump {
    const KIND: &'static str = "cosine_bump";
    const ABOUT: &'static str = "a bump or a dip across the road";
    const EXAMPLE: &'static str = "{ height: 30 mm, length: 0.6 m, station: 20 m }";
    fn relief(self, _: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        Ok(Some(Arc::new(Bump { height: self.height.si(), length: self.length.si(), begin: self.station.si() })))
    }
}
