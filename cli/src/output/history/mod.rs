//! A motion over time, before it becomes text.

pub(super) mod csv;
pub(super) mod json;
mod recording;
pub(super) mod table;

use super::axes::Axes;
use super::report::turned;
use super::{Given, Kind, Results, Writer};
use crate::Failure;
use analyses::transient::{Crossing, Drift, LimitMet};
use problem::{IntegrationOutcome, Signal};
pub use recording::{Recording, Tape};
use std::io;

/// How an integration went.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the backend.
    pub backend: &'static str,
    /// Name of the formulation of the constraints, or `explicit`.
    pub formulation: &'static str,
    /// Relative tolerance.
    pub relative_tolerance: f64,
    /// Name of the ending.
    pub ending: String,
    /// The cause, where it was not what was asked for.
    pub because: Option<String>,
    /// The condition that was met, where one ended it.
    pub condition: Option<String>,
    /// Time asked for, s.
    pub duration: f64,
    /// Time reached and work done.
    pub statistics: IntegrationOutcome,
    /// Time that passed meanwhile, s.
    pub wall: f64,
    /// Largest errors of the constraints.
    pub drift: Drift,
    /// Limits that were met.
    pub limits: Vec<LimitMet>,
    /// Crossings of limits, in the order of time.
    pub crossings: Vec<Crossing>,
}

/// Signals over time, and how they were found. Values are SI.
#[derive(Clone, Debug)]
pub struct History {
    /// Name of the model.
    pub model: String,
    /// Axes to which the values refer.
    pub axes: Axes,
    /// What was prescribed, with its value.
    pub given: Vec<(Given, f64)>,
    /// The recorded signals.
    pub signals: Vec<Signal>,
    /// Indices of the signals that table and figure show.
    pub shown: Vec<usize>,
    /// One column per signal.
    pub recording: Recording,
    /// How it went.
    pub outcome: Outcome,
    /// The coordinates, and what else was to be kept for an animation; always in ISO axes. Empty where nobody asked.
    pub kept: Kept,
    /// What the reader should know beside the results. The table leaves them to standard error.
    pub warnings: Vec<String>,
}

/// Named columns of a recording.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// Their signals.
    pub signals: Vec<Signal>,
    /// One column per signal.
    pub recording: Recording,
}

impl History {
    /// The values of a signal, SI; `None` where it was not recorded.
    ///
    /// # Errors
    /// What was recorded cannot be read again.
    pub fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        self.signals.iter().position(|s| s.name == name).map(|k| self.recording.column(k)).transpose().map_err(unreadable)
    }
}

/// What to say where a recording cannot be read again.
pub fn unreadable(cause: io::Error) -> Failure {
    Failure::Recording { cause: cause.to_string() }
}

impl Results for History {
    fn in_axes(mut self, axes: Axes) -> Self {
        if axes == self.axes {
            return self;
        }
        for (given, value) in &mut self.given {
            *value = turned(*value, &given.name);
        }
        for (k, signal) in self.signals.iter().enumerate() {
            self.recording.turn(k, turned(1.0, &signal.name));
        }
        for limit in &mut self.outcome.limits {
            (limit.value, limit.threshold) = (turned(limit.value, &limit.signal), turned(limit.threshold, &limit.signal));
        }
        for crossing in &mut self.outcome.crossings {
            crossing.threshold = turned(crossing.threshold, &crossing.signal);
        }
        self.axes = axes;
        self
    }

    fn writer(kind: &Kind) -> Writer<Self> {
        kind.write_history
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn recording(&self) -> Option<&History> {
        Some(self)
    }

    fn statistics(&self) -> serde_json::Value {
        json::statistics(&self.outcome)
    }

    fn reached(&self) -> bool {
        self.outcome.because.is_none()
    }
}
