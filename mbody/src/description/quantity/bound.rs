//! Ranges of quantities, under the keywords that JSON Schema has for them.

use super::Dimension;
use serde_json::{Map, Value};

/// Bounds of a value in SI; `None` where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Smallest value.
    pub minimum: Option<f64>,
    /// Value that must be exceeded.
    pub exclusive_minimum: Option<f64>,
    /// Largest value.
    pub maximum: Option<f64>,
    /// Value that must not be reached.
    pub exclusive_maximum: Option<f64>,
}

impl Bounds {
    /// No bound at all.
    pub const NONE: Self = Self { minimum: None, exclusive_minimum: None, maximum: None, exclusive_maximum: None };

    /// The bounds that a schema states.
    pub fn of_schema(schema: &Map<String, Value>) -> Self {
        let bound = |keyword: &str| schema.get(keyword).and_then(Value::as_f64);
        Self {
            minimum: bound("minimum"),
            exclusive_minimum: bound("exclusiveMinimum"),
            maximum: bound("maximum"),
            exclusive_maximum: bound("exclusiveMaximum"),
        }
    }

    /// The bounds as keywords of a schema.
    pub fn keywords(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("minimum", self.minimum),
            ("exclusiveMinimum", self.exclusive_minimum),
            ("maximum", self.maximum),
            ("exclusiveMaximum", self.exclusive_maximum),
        ];
        all.into_iter().filter_map(|(keyword, bound)| Some((keyword, bound?)))
    }

    /// What a value would have to be, where it is not: `greater than 0 N/m`.
    pub fn violated_by(&self, value: f64, dimension: &Dimension) -> Option<String> {
        let shown = |bound: f64| if dimension.unit == "1" { format!("{bound}") } else { format!("{bound} {}", dimension.unit) };
        let below = |bound: Option<f64>, words: &str, broken: fn(f64, f64) -> bool| {
            bound.filter(|b| broken(value, *b)).map(|b| format!("{words} {}", shown(b)))
        };
        below(self.exclusive_minimum, "greater than", |v, b| v <= b)
            .or_else(|| below(self.minimum, "at least", |v, b| v < b))
            .or_else(|| below(self.exclusive_maximum, "less than", |v, b| v >= b))
            .or_else(|| below(self.maximum, "at most", |v, b| v > b))
    }
}

/// A type that stands for a range; see [`super::Quantity`].
pub trait Range {
    /// The bounds, in SI.
    const BOUNDS: Bounds;
}

/// Any finite value.
#[derive(Clone, Copy, Debug)]
pub struct Any;
/// Greater than zero.
#[derive(Clone, Copy, Debug)]
pub struct Positive;
/// Zero or greater.
#[derive(Clone, Copy, Debug)]
pub struct AtLeastZero;
/// From zero to one.
#[derive(Clone, Copy, Debug)]
pub struct Fraction;

impl Range for Any {
    const BOUNDS: Bounds = Bounds::NONE;
}
impl Range for Positive {
    const BOUNDS: Bounds = Bounds { exclusive_minimum: Some(0.0), ..Bounds::NONE };
}
impl Range for AtLeastZero {
    const BOUNDS: Bounds = Bounds { minimum: Some(0.0), ..Bounds::NONE };
}
impl Range for Fraction {
    const BOUNDS: Bounds = Bounds { minimum: Some(0.0), maximum: Some(1.0), ..Bounds::NONE };
}
