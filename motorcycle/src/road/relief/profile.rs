//! A measured or drawn road: heights at stations, joined by a cubic spline.
//!
//! `z` has two continuous derivatives between the first and the last station; before and behind them the road goes on level, and z' is zero there. Heights are those
//! over the first one, so that a ride begins on the road.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, Springer 1978 (complete cubic spline). Range: stations as dense as the road is uneven.

use super::{Relief, ReliefDescription};
use crate::maneuver::{below, columns};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::Length;
use mbody::description::quantity::{Dimensioned, Quantity};
use mbody::scalar::spline::{CubicSpline, CurvePoint, Ends};
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
}

#[derive(Debug)]
struct Track {
    curve: CubicSpline,
    shortest: f64,
}

impl Relief for Track {
    fn at(&self, s: f64) -> CurvePoint<f64> {
        self.curve.at(s)
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
        let (key, stations, heights): (_, Vec<f64>, Vec<f64>) = match (self.points, self.file) {
            (Some(points), None) => {
                let (stations, heights) = points.iter().map(|p| (p.0.si(), p.1.si())).unzip();
                ("points", stations, heights)
            }
            (None, Some(file)) => {
                let length = Some(Length::DIMENSION);
                let read = columns(library, &file, &[("station", length), ("height", length)]).map_err(|e| below("file", &e))?;
                ("file", read[0].clone(), read[1].clone())
            }
            _ => return Err(Finding::error("missing_entry", "one of `points` and `file` is needed").at_path("").into()),
        };
        let first = heights.first().copied().unwrap_or_default();
        let heights: Vec<f64> = heights.iter().map(|h| h - first).collect();
        let curve = CubicSpline::new(&stations, &heights, Ends::Clamped { first: 0.0, last: 0.0 });
        let curve = curve.map_err(|e| Finding::error("bad_curve", e.to_string()).at_path(key))?;
        let shortest = stations.windows(2).map(|s| s[1] - s[0]).fold(f64::INFINITY, f64::min);
        Ok(Some(Arc::new(Track { curve, shortest })))
    }
}
