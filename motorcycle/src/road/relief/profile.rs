//! A measured or drawn road: heights at stations, joined by a cubic spline.
//!
//! `z` has two continuous derivatives between the first and the last station; before and behind them the road goes on level, and z' is zero there. Heights are those
//! over the first one, so that a ride begins on the road.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, Springer 1978 (complete cubic spline). Range: stations as dense as the road is uneven.

use super::shape::Shape;
use super::{Relief, ReliefDescription, over_stations};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::dimension::Length;
use mbody::description::quantity::{Dimensioned, Quantity};
use mbody::scalar::Dual;
use mbody::scalar::spline::{CubicSpline, Ends};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// A measured or drawn road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Profile {
    /// Stations on the path and heights. Give these or `file`.
    points: Option<Vec<(Quantity<Length>, Quantity<Length>)>>,
    /// CSV file beside the maneuver with the columns `station` and `height`. Give this or `points`.
    file: Option<String>,
    /// Whether wheels stand on its slopes, as they do where this is left out; `false` for unevenness that tires level out: felt by its height alone.
    slopes: Option<bool>,
}

#[derive(Debug)]
struct Track {
    curve: CubicSpline,
    slopes: bool,
    shortest: f64,
}

impl Relief for Track {
    fn shape(&self, s: f64, _: f64) -> Shape {
        let at = self.curve.at(Dual::<f64, 1> { x: s, d: [1.0] });
        Shape {
            height: at.value.x,
            first: [at.slope.x, 0.0],
            second: [at.curvature.x, 0.0, 0.0],
            third: [at.curvature.d[0], 0.0, 0.0, 0.0],
        }
    }

    fn tilts(&self) -> bool {
        self.slopes
    }

    fn shortest(&self) -> f64 {
        self.shortest
    }
}

impl ReliefDescription for Profile {
    const KIND: &'static str = "profile";
    const ABOUT: &'static str = "a road by its heights at stations along the path";
    const EXAMPLE: &'static str = "{ points: [[10 m, 0 m], [15 m, 20 mm], [20 m, -5 mm], [30 m, 10 mm]] }";
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let points = self.points.map(|points| points.iter().map(|p| (p.0.si(), p.1.si())).unzip());
        let (key, stations, heights) = over_stations(points, self.file, library, ("height", Length::DIMENSION))?;
        let first = heights.first().copied().unwrap_or_default();
        let heights: Vec<f64> = heights.iter().map(|h| h - first).collect();
        let curve = CubicSpline::new(&stations, &heights, Ends::Clamped { first: 0.0, last: 0.0 });
        let curve = curve.map_err(|e| super::bad_curve(key, &e))?;
        let shortest = stations.windows(2).map(|s| s[1] - s[0]).fold(f64::INFINITY, f64::min);
        Ok(Some(Arc::new(Track { curve, slopes: self.slopes.unwrap_or(true), shortest })))
    }
}
