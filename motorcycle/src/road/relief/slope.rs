//! A road that goes uphill and downhill: its slope over the stations of the path.
//!
//! `z(s) = ∫ g ds`, g slope along the path (rise over horizontal distance), by smooth steps between its points: [`super::shape`]. The same from edge to edge; heights are those over the start of the path.
//! Source: elementary. Range: radii of crests and dips far above those of wheels.

use super::shape::{Shape, Steps};
use super::{Relief, ReliefDescription, over_stations};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::dimension::{Length, Number};
use mbody::description::quantity::{Dimensioned, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// A road uphill and downhill.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Slope {
    /// Stations on the path and slopes, positive uphill: `[40 m, 6%]`; level at each point of the curve of slopes, constant before and behind. Give these or `file`.
    points: Option<Vec<(Quantity<Length>, Quantity<Number>)>>,
    /// CSV file beside the maneuver with the columns `station` and `slope`. Give this or `points`.
    file: Option<String>,
}

#[derive(Debug)]
struct Hill {
    slope: Steps,
    /// Integral of the slope at the start of the path, m.
    below: f64,
}

impl Relief for Hill {
    fn shape(&self, s: f64, _: f64) -> Shape {
        let at = self.slope.at(s);
        Shape {
            height: at.integral - self.below,
            first: [at.value, 0.0],
            second: [at.slope, 0.0, 0.0],
            third: [at.curvature, 0.0, 0.0, 0.0],
        }
    }
}

impl ReliefDescription for Slope {
    const KIND: &'static str = "slope";
    const ABOUT: &'static str = "a road uphill and downhill, by its slope at stations along the path";
    const EXAMPLE: &'static str = "{ points: [[10 m, 0], [20 m, 6%], [30 m, 6%], [45 m, -3%]] }";
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let points = self.points.map(|points| points.iter().map(|p| (p.0.si(), p.1.si())).unzip());
        let (key, x, y) = over_stations(points, self.file, library, ("slope", Number::DIMENSION))?;
        let slope = Steps::new(x, y).map_err(|e| super::bad_curve(key, &e))?;
        let below = slope.at(0.0).integral;
        Ok(Some(Arc::new(Hill { slope, below })))
    }
}
