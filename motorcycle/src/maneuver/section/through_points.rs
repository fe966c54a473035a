//! A path through points, or one given by its curvature: what was measured or drawn elsewhere.
//!
//! Through points: splines x(t), y(t) over the length of the chords; curvature `(x′y″ − y′x″)/(x′² + y′²)^{3/2}` over its arc length. The first point is where the section
//! begins, the first chord gives its direction.
//!
//! Source: differential geometry; C. de Boor, *A Practical Guide to Splines* (chordal parameter). Range: points denser than the radii they turn by.

use super::{Layout, SectionDescription};
use crate::maneuver::{below, columns};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::{Curvature, Length};
use mbody::description::quantity::{Dimensioned, Quantity};
use mbody::scalar::spline::{CubicSpline, Ends};
use schemars::JsonSchema;
use serde::Deserialize;

/// Least distance of points from a file, m.
const APART: f64 = 1.0;

/// Through given points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ThroughPoints {
    /// Points x, y; the path goes through them in this order. Give these or `curvature`.
    points: Option<Vec<(Quantity<Length>, Quantity<Length>)>>,
    /// Arc length and curvature, positive to the left. Give this or `points`.
    curvature: Option<Vec<(Quantity<Length>, Quantity<Curvature>)>>,
    /// CSV file beside the maneuver, that of an earlier run for example, whose columns are the points. Give this or `points`.
    file: Option<String>,
    /// Names of its columns; `chassis.x` and `chassis.y` where left out.
    columns: Option<(String, String)>,
}

impl SectionDescription for ThroughPoints {
    const KIND: &'static str = "through_points";
    const ABOUT: &'static str = "a path through points, or by its curvature over arc length";
    const EXAMPLE: &'static str = "{ points: [[0 m, 0 m], [20 m, 0.2 m], [40 m, 1.5 m], [60 m, 3 m], [80 m, 3.4 m]] }";
    fn lay(self, path: &mut Layout, library: &dyn Library) -> Result<(), Findings> {
        let wrong = |key: &str, why: String| Findings::from(Finding::error("bad_curve", why).at_path(key));
        match (self.points, self.curvature, self.file) {
            (None, None, Some(file)) => {
                let (x, y) = self.columns.unwrap_or_else(|| ("chassis.x".to_owned(), "chassis.y".to_owned()));
                let length = Some(Length::DIMENSION);
                let read = columns(library, &file, &[(&x, length), (&y, length)]).map_err(|e| below("file", &e))?;
                let curve = by_points(&thinned(&read[0], &read[1])).map_err(|e| wrong("file", e))?;
                path.curve(curve);
            }
            (Some(points), None, None) => {
                let xy: Vec<(f64, f64)> = points.iter().map(|p| (p.0.si(), p.1.si())).collect();
                let curve = by_points(&xy).map_err(|e| wrong("points", e))?;
                path.curve(curve);
            }
            (None, Some(samples), None) => {
                let (s, k): (Vec<f64>, Vec<f64>) = samples.iter().map(|p| (p.0.si(), p.1.si())).unzip();
                if s.first().is_some_and(|first| *first != 0.0) {
                    return Err(wrong("curvature", "arc length begins at zero".to_owned()));
                }
                let curve = CubicSpline::new(&s, &k, Ends::Natural).map_err(|e| wrong("curvature", e.to_string()))?;
                path.curve(curve);
            }
            _ => return Err(Finding::error("missing_entry", "one of `points`, `curvature` and `file` is needed").at_path("").into()),
        }
        Ok(())
    }
}

/// Points at least [`APART`] apart: what was sampled finely carries more rounding than curvature.
fn thinned(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (&x, &y) in x.iter().zip(y) {
        if points.last().is_none_or(|p| (x - p.0).hypot(y - p.1) >= APART) {
            points.push((x, y));
        }
    }
    points
}

/// Curvature over arc length of the spline through points.
fn by_points(points: &[(f64, f64)]) -> Result<CubicSpline, String> {
    let mut t = vec![0.0];
    for pair in points.windows(2) {
        let chord = (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        t.push(t.last().copied().unwrap_or_default() + chord);
    }
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let spline = |v: &[f64]| CubicSpline::new(&t, v, Ends::Natural).map_err(|e| e.to_string());
    if points.len() < 3 {
        return Err(format!("a path needs at least 3 points, not {}", points.len()));
    }
    let (x, y) = (spline(&x)?, spline(&y)?);
    let end = t.last().copied().unwrap_or_default();
    let count = (end / 0.05).ceil().max(8.0) as usize;
    let h = end / count as f64;
    let speed = |t: f64| x.at(t).slope.hypot(y.at(t).slope);
    let (mut s, mut arcs, mut curvatures) = (0.0, Vec::with_capacity(count + 1), Vec::with_capacity(count + 1));
    for k in 0..=count {
        let at = (h * k as f64).min(end);
        if k > 0 {
            // Simpson's rule
            s += h / 6.0 * (speed(at - h) + 4.0 * speed(at - 0.5 * h) + speed(at));
        }
        let (a, b) = (x.at(at), y.at(at));
        arcs.push(s);
        curvatures.push((a.slope * b.curvature - b.slope * a.curvature) / speed(at).powi(3));
    }
    CubicSpline::new(&arcs, &curvatures, Ends::Natural).map_err(|e| e.to_string())
}
