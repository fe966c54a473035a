//! A surveyed road: heights over a rectangular grid of the world.
//!
//! `z(x, y)` is the bicubic spline of [`HeightField`], with two continuous derivatives; outside the grid it goes straight on. Heights are those over the start of the path, so that a ride begins on the road; the
//! start is best level and the path must stay on the grid.
//!
//! Source: [`HeightField`]. Range: points as dense as the road is uneven, radii far above those of wheels.

use super::shape::Shape;
use super::{Coordinates, Relief, ReliefDescription};
use crate::maneuver::{Path, below, columns};
use mbody::contact::{HeightField, Surface};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::Dimensioned;
use mbody::description::quantity::dimension::Length;
use mbody::scalar::{Dual, Real};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// Distance along the path at which it is looked whether it is on the grid, m.
const STEP: f64 = 0.5;

/// A surveyed road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Grid {
    /// CSV file beside the maneuver with the columns `x`, `y` and `height`, one row for each point of a rectangular grid in any order. The path begins at the origin, along x.
    file: String,
}

#[derive(Debug)]
struct Field {
    heights: HeightField,
    /// Height of the field at the origin, m.
    below: f64,
    range: [(f64, f64); 2],
    mesh: f64,
}

/// A number with its first and second derivatives by two variables.
type Twice = Dual<Dual<f64, 2>, 2>;

/// A value as one of two variables.
fn variable(value: f64, which: usize) -> Twice {
    let mut at = Twice::from_f64(value);
    at.x.d[which] = 1.0;
    at.d[which].x = 1.0;
    at
}

impl Relief for Field {
    fn shape(&self, x: f64, y: f64) -> Shape {
        let at = self.heights.elevation(variable(x, 0), variable(y, 1));
        let (by_x, by_y) = (at.slope_x, at.slope_y);
        Shape {
            height: at.height.x.x - self.below,
            first: [by_x.x.x, by_y.x.x],
            second: [by_x.d[0].x, by_x.d[1].x, by_y.d[1].x],
            third: [by_x.d[0].d[0], by_x.d[0].d[1], by_x.d[1].d[1], by_y.d[1].d[1]],
        }
    }

    fn coordinates(&self) -> Coordinates {
        Coordinates::World
    }

    fn shortest(&self) -> f64 {
        self.mesh
    }

    fn leaves(&self, path: &Path) -> Option<Finding> {
        let [x, y] = self.range;
        let count = (path.length() / STEP).ceil() as usize;
        let stations = (0..=count).map(|k| (k as f64 * STEP).min(path.length()));
        let outside = stations.map(|s| (s, path.at(s))).find(|(_, p)| p.x < x.0 || p.x > x.1 || p.y < y.0 || p.y > y.1);
        outside.map(|(s, p)| {
            let why = format!("the path leaves the grid {s:.1} m from its start, at x = {:.1} m, y = {:.1} m", p.x, p.y);
            let hint = format!("the grid reaches from {} to {} m along x and from {} to {} m along y", x.0, x.1, y.0, y.1);
            Finding::error("outside_grid", why).at_path("file").with_hint(hint)
        })
    }
}

/// Values that occur, in order.
fn lines(values: &[f64]) -> Vec<f64> {
    let mut lines = values.to_vec();
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    lines
}

impl ReliefDescription for Grid {
    const KIND: &'static str = "grid";
    const ABOUT: &'static str = "a surveyed road: heights over a rectangular grid of the world, from a file";
    const EXAMPLE: &'static str = "{ file: field.csv }";
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let length = Some(Length::DIMENSION);
        let read = columns(library, &self.file, &[("x", length), ("y", length), ("height", length)]).map_err(|e| below("file", &e))?;
        let wrong = |why: String| Finding::error("bad_grid", format!("file `{}`: {why}", self.file)).at_path("file");
        let [x, y] = [lines(&read[0]), lines(&read[1])];
        let mut heights = vec![f64::NAN; x.len() * y.len()];
        let place = |lines: &[f64], at: f64| lines.partition_point(|line| *line < at);
        for ((&at_x, &at_y), &height) in read[0].iter().zip(&read[1]).zip(&read[2]) {
            let node = &mut heights[place(&y, at_y) * x.len() + place(&x, at_x)];
            if node.is_finite() {
                return Err(wrong(format!("the point x = {at_x} m, y = {at_y} m stands twice")).into());
            }
            *node = height;
        }
        if let Some(k) = heights.iter().position(|h| h.is_nan()) {
            let (at_x, at_y) = (x[k % x.len()], y[k / x.len()]);
            let finding = wrong(format!("there is no height at x = {at_x} m, y = {at_y} m"));
            return Err(finding.with_hint("the points must fill a rectangular grid").into());
        }
        let field = HeightField::new(&x, &y, &heights).map_err(|e| wrong(e.to_string()))?;
        let range = |lines: &[f64]| (lines[0], lines[lines.len() - 1]);
        let mesh = [&x, &y].iter().flat_map(|l| l.windows(2)).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let under = field.elevation(0.0, 0.0).height;
        Ok(Some(Arc::new(Field { heights: field, below: under, range: [range(&x), range(&y)], mesh })))
    }
}
