//! Friction of the road over the stations of the path, left and right alike or not.
//!
//! `μ(s, n) = μ_l(s) + (μ_r(s) − μ_l(s)) W(n)`, W a smooth step over 0.2 m across the path; each side by smooth steps between its points: [`super::shape`]. μ stands over the friction of the road on which
//! tires were measured: 1 where nothing is said; what tires make of it: [`crate::tire::similarity`]. The road is level.
//! Source: ours. Range: 0.01 to 3.

use super::shape::Steps;
use super::{Onset, Relief, ReliefDescription, over_stations};
use crate::road::footing::LEAST_FRICTION;
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::{Length, Number};
use mbody::description::quantity::{Dimensioned, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// Greatest friction.
const MOST: f64 = 3.0;
/// Where across the path the left side gives way to the right one.
const MIDDLE: Onset = Onset { begin: -0.1, length: 0.2 };

/// Friction of the road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Friction {
    /// Stations on the path and friction, 1 on the road on which tires were measured: `[30 m, 1], [31 m, 0.4]`; constant before and behind. Give these or `file`.
    points: Option<Vec<(Quantity<Length>, Quantity<Number>)>>,
    /// CSV file beside the maneuver with the columns `station` and `friction`. Give this or `points`.
    file: Option<String>,
    /// The same on the right of the path, where it is another than on the left.
    right: Option<Vec<(Quantity<Length>, Quantity<Number>)>>,
}

#[derive(Debug)]
struct Patches {
    left: Steps,
    right: Option<Steps>,
}

impl Relief for Patches {
    fn friction(&self, s: f64, n: f64) -> [f64; 3] {
        let left = self.left.at(s);
        let Some(right) = self.right.as_ref().map(|right| right.at(s)) else { return [left.value, left.slope, 0.0] };
        // from the right edge to the left one
        let [_, share, slope, ..] = MIDDLE.share(n);
        let mixed = |l: f64, r: f64| r + (l - r) * share;
        [mixed(left.value, right.value), mixed(left.slope, right.slope), (left.value - right.value) * slope]
    }

    fn shortest(&self) -> f64 {
        self.right.iter().map(Steps::shortest).fold(self.left.shortest(), f64::min)
    }
}

impl ReliefDescription for Friction {
    const KIND: &'static str = "friction";
    const ABOUT: &'static str = "friction at stations along the path, the same on both sides or not";
    const EXAMPLE: &'static str = "{ points: [[30 m, 1], [31 m, 0.4], [40 m, 0.4], [41 m, 1]] }";
    fn relief(self, library: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let pairs = |points: Vec<(Quantity<Length>, Quantity<Number>)>| points.iter().map(|p| (p.0.si(), p.1.si())).unzip();
        let (key, x, y) = over_stations(self.points.map(pairs), self.file, library, ("friction", Number::DIMENSION))?;
        let steps = |key: &str, x: Vec<f64>, y: Vec<f64>| -> Result<Steps, Findings> {
            let steps = Steps::new(x, y).map_err(|e| super::bad_curve(key, &e))?;
            match steps.values().iter().find(|mu| !(LEAST_FRICTION..=MOST).contains(*mu)) {
                Some(mu) => {
                    let why = format!("a friction of {mu} is out of range: it must be from {LEAST_FRICTION} to {MOST}");
                    let finding = Finding::error("out_of_range", why).at_path(key);
                    Err(finding.with_hint("1 is the road on which the tires were measured, half of it wet stone, 0.1 ice").into())
                }
                None => Ok(steps),
            }
        };
        let left = steps(key, x, y)?;
        let right = self.right.map(pairs).map(|(x, y): (Vec<f64>, Vec<f64>)| steps("right", x, y)).transpose()?;
        Ok(Some(Arc::new(Patches { left, right })))
    }
}
