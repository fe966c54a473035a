//! Inputs over time: a gust, a step of a torque, a recorded history, each added to the value that its input has at the start.
//!
//! Which inputs there are, and in which unit, is a matter of the vehicle: amounts stay as written until it is known.

use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::dimension::Time;
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::borrow::Cow;
use std::fmt;

/// A number with an optional unit, as written.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Amount {
    /// A bare number, SI.
    Number(f64),
    /// A number with its unit.
    Text(String),
}

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl JsonSchema for Amount {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Amount".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "description": "in the unit of the input" })
    }
}

/// How an input changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// `peak sin²(π (t − start)/duration)` while it lasts.
    Pulse {
        /// Largest value.
        peak: Amount,
        /// Begin, s.
        start: f64,
        /// Length, s.
        duration: f64,
    },
    /// Another value from a time on.
    Step {
        /// By how much.
        height: Amount,
        /// When, s.
        start: f64,
    },
    /// A straight line to another value, which stays.
    Ramp {
        /// By how much.
        height: Amount,
        /// Begin, s.
        start: f64,
        /// Length, s.
        duration: f64,
    },
    /// Times, s, and values, joined smoothly.
    Table(Vec<(f64, Amount)>),
}

/// An input and how it changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// Name of the input.
    pub input: String,
    /// How it changes.
    pub piece: Piece,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PulseDescription {
    /// Largest value.
    peak: Amount,
    /// When it begins.
    start: NonNegativeQuantity<Time>,
    /// How long it lasts.
    duration: PositiveQuantity<Time>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StepDescription {
    /// By how much the input changes.
    height: Amount,
    /// When.
    start: NonNegativeQuantity<Time>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RampDescription {
    /// By how much the input changes.
    height: Amount,
    /// When it begins to.
    start: NonNegativeQuantity<Time>,
    /// How long that takes.
    duration: PositiveQuantity<Time>,
}

/// An input over time: one of `pulse`, `step`, `ramp` and `table`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct InputDescription {
    /// Name of the input: one of `fastbike info MODEL`.
    input: String,
    /// One bell with a continuous rate: a gust, a knock.
    pulse: Option<PulseDescription>,
    /// A sudden change.
    step: Option<StepDescription>,
    /// An even change.
    ramp: Option<RampDescription>,
    /// Points of time and value, joined smoothly; constant before the first and after the last; two of one time are a jump.
    #[schemars(length(min = 1))]
    table: Option<Vec<(NonNegativeQuantity<Time>, Amount)>>,
}

impl InputDescription {
    /// The input with its only piece.
    ///
    /// # Errors
    /// There is none, or there are several, or times of a table decrease.
    pub(super) fn moving(self) -> Result<Moving, Findings> {
        let pulse = self.pulse.map(|p| Piece::Pulse { peak: p.peak, start: p.start.si(), duration: p.duration.si() });
        let step = self.step.map(|p| Piece::Step { height: p.height, start: p.start.si() });
        let ramp = self.ramp.map(|p| Piece::Ramp { height: p.height, start: p.start.si(), duration: p.duration.si() });
        if let Some(k) = self.table.iter().flat_map(|t| t.windows(2)).position(|w| w[1].0.si() < w[0].0.si()) {
            return Err(Finding::error("bad_curve", format!("the time of point {} is before that of the point before it", k + 2))
                .at_path("table")
                .into());
        }
        let table = self.table.map(|points| Piece::Table(points.into_iter().map(|(t, v)| (t.si(), v)).collect()));
        let mut pieces = [pulse, step, ramp, table].into_iter().flatten();
        match (pieces.next(), pieces.next()) {
            (Some(piece), None) => Ok(Moving { input: self.input, piece }),
            (None, _) => Err(Finding::error("missing_entry", "one of `pulse`, `step`, `ramp` and `table` is needed").into()),
            _ => Err(Finding::error("given_twice", "only one of `pulse`, `step`, `ramp` and `table` says how an input changes")
                .with_hint("several entries may act on one input: they add up")
                .into()),
        }
    }
}
