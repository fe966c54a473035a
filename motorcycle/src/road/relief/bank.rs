//! A banked road: its inclination across over the stations of the path.
//!
//! `z(s, n) = n tan b`, n offset from the path to the left, m; b bank, rad, **positive where the road leans to the right** as a vehicle with positive roll does: a turn to the left is
//! helped by b < 0. The slope changes by smooth steps between its points: [`super::shape`]. The path itself stays level.
//! Source: superelevation of roads, elementary. Range: offsets far below the radius of the path; banks below 45 degrees or so.

use super::shape::{Shape, Steps};
use super::{Relief, ReliefDescription, over_stations};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::{Angle, Length};
use mbody::description::quantity::{Dimensioned, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// Greatest bank, rad.
const STEEPEST: f64 = 1.0;

/// A banked road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Bank {
    /// Stations on the path and banks, positive where the road leans to the right: `[40 m, -8 deg]` helps a turn to the left; constant before and behind. Give these or `file`.
    points: Option<Vec<(Quantity<Length>, Quantity<Angle>)>>,
    /// CSV file beside the maneuver with the columns `station` and `bank`. Give this or `points`.
    file: Option<String>,
}

#[derive(Debug)]
struct Banked {
    cross_slope: Steps,
}

impl Relief for Banked {
    fn shape(&self, s: f64, n: f64) -> Shape {
        let at = self.cross_slope.at(s);
        Shape {
            height: at.value * n,
            first: [at.slope * n, at.value],
            second: [at.curvature * n, at.slope, 0.0],
            third: [at.third * n, at.curvature, 0.0, 0.0],
        }
    }
}

impl ReliefDescription for Bank {
    const KIND: &'static str = "bank";
    const ABOUT: &'static str = "a banked road, by its inclination across at stations along the path";
    const EXAMPLE: &'static str = "{ points: [[10 m, 0], [25 m, -8 deg], [40 m, -8 deg], [50 m, 3 deg]] }";
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let points = self.points.map(|points| points.iter().map(|p| (p.0.si(), p.1.si())).unzip());
        let (key, x, y) = over_stations(points, self.file, library, ("bank", Angle::DIMENSION))?;
        if let Some(steep) = y.iter().find(|b| b.abs() > STEEPEST) {
            let why = format!("a bank of {steep} rad is out of range: it must be between -{STEEPEST} and {STEEPEST} rad");
            let finding = Finding::error("out_of_range", why).at_path(key);
            return Err(finding.with_hint("angles without unit are in radians; write `8 deg`").into());
        }
        let cross_slope = Steps::new(x, y.iter().map(|b| b.tan()).collect()).map_err(|e| super::bad_curve(key, &e))?;
        Ok(Some(Arc::new(Banked { cross_slope })))
    }
}
