//! The result of an analysis at one or several points, before it becomes text.

use super::axes::Axes;
use super::{Kind, Results, Writer, comfort, handling, linear, modes, responses, rider};
use problem::{Effort, Ending, Signal};
use serde_json::json;
use std::borrow::Cow;

/// A quantity that the user prescribed: `speed`, `lean`, or a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// Name as in the JSON output, for example `lateral_acceleration`.
    pub name: String,
    /// SI unit.
    pub unit: Cow<'static, str>,
}

impl Given {
    /// A prescribed quantity.
    pub fn new(name: impl Into<String>, unit: impl Into<Cow<'static, str>>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// The result at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// One value per prescribed quantity of the report.
    pub given: Vec<f64>,
    /// How the analysis ended here.
    pub ending: Ending,
    /// What the method did.
    pub effort: Effort,
    /// Largest scaled residual at the end.
    pub residual: f64,
    /// One value per signal of the report; empty where nothing was computed.
    pub values: Vec<f64>,
    /// Rates of the unknowns, which are the first signals; always in ISO axes. Empty where nothing was computed.
    pub rates: Vec<f64>,
}

impl Point {
    /// Value of the signal with this index; NaN where there is none.
    pub fn value(&self, signal: usize) -> f64 {
        self.values.get(signal).copied().unwrap_or(f64::NAN)
    }
}

/// The same analysis for a variant of the model.
#[derive(Clone, Debug)]
pub struct Variant {
    /// What the user wrote after `--versus`.
    pub name: String,
    /// Its points, in the order of the report's, with the values of the report's signals (NaN where the variant has no such signal).
    pub points: Vec<Point>,
    /// What the analysis found beside the signals.
    pub beside: Beside,
}

/// What an analysis found at the points beside their signals.
#[derive(Clone, Debug, Default)]
pub enum Beside {
    /// Nothing: steady states are all there is.
    #[default]
    Nothing,
    /// A linear model at every point.
    Linear(linear::Linear),
    /// The modes at every point.
    Modes(modes::ModesAlong),
    /// Frequency responses at every point.
    Responses(responses::Responses),
    /// Weighted accelerations at every point.
    Comfort(comfort::ComfortAlong),
    /// The design of a rider at every point.
    Rider(rider::RiderAlong),
    /// Handling indices at every point.
    Handling(handling::HandlingAlong),
}

/// Everything that a command such as `trim` or `map` found out. Values are SI.
#[derive(Clone, Debug)]
pub struct Report {
    /// Name of the command.
    pub command: String,
    /// Name of the model.
    pub model: String,
    /// Axes to which the values refer.
    pub axes: Axes,
    /// What was prescribed.
    pub given: Vec<Given>,
    /// The signals of the plant.
    pub signals: Vec<Signal>,
    /// Indices of the signals that the table shows; empty for its own choice. The other formats hold all signals.
    pub shown: Vec<usize>,
    /// The points in the order of the sweep.
    pub points: Vec<Point>,
    /// Last points before a limit, between the points of a grid.
    pub limits: Vec<Point>,
    /// The same analysis for variants.
    pub variants: Vec<Variant>,
    /// What the analysis found beside the signals.
    pub beside: Beside,
    /// What the reader should know beside the results. The table leaves them to standard error.
    pub warnings: Vec<String>,
}

impl Report {
    /// An empty report in ISO axes.
    pub fn new(command: impl Into<String>, model: impl Into<String>, given: Vec<Given>, signals: Vec<Signal>) -> Self {
        Self {
            command: command.into(),
            model: model.into(),
            axes: Axes::Iso,
            given,
            signals,
            shown: Vec::new(),
            points: Vec::new(),
            limits: Vec::new(),
            variants: Vec::new(),
            beside: Beside::Nothing,
            warnings: Vec::new(),
        }
    }

    /// Index of a signal.
    pub fn signal(&self, name: &str) -> Option<usize> {
        self.signals.iter().position(|s| s.name == name)
    }
}

impl Results for Report {
    /// Given values and thresholds included.
    fn in_axes(mut self, axes: Axes) -> Self {
        if axes == self.axes {
            return self;
        }
        for point in self.points.iter_mut().chain(&mut self.limits).chain(self.variants.iter_mut().flat_map(|v| &mut v.points)) {
            let given = self.given.iter().map(|g| g.name.as_str());
            let signals = self.signals.iter().map(|s| s.name.as_str());
            point.given.iter_mut().zip(given).chain(point.values.iter_mut().zip(signals)).for_each(|(v, name)| *v = turned(*v, name));
            if let Ending::Limit { signal, value, threshold, .. } = &mut point.ending {
                (*value, *threshold) = (turned(*value, signal), turned(*threshold, signal));
            }
        }
        for beside in std::iter::once(&mut self.beside).chain(self.variants.iter_mut().map(|v| &mut v.beside)) {
            match beside {
                Beside::Nothing => {}
                Beside::Linear(linear) => linear.turn(&|name| super::axes::factor(name)),
                Beside::Modes(modes) => modes.turn(&self.given, &|name| super::axes::factor(name)),
                Beside::Responses(responses) => responses.turn(&|name| super::axes::factor(name)),
                Beside::Handling(along) => along.turn(&|name| super::axes::factor(name)),
                // root mean squares have no sense, and gains belong to the signals of the model
                Beside::Comfort(_) | Beside::Rider(_) => {}
            }
        }
        self.axes = axes;
        self
    }

    fn writer(kind: &Kind) -> Writer<Self> {
        kind.write
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn statistics(&self) -> serde_json::Value {
        let iterations: usize = self.points.iter().map(|p| p.effort.iterations).sum();
        json!({ "points": self.points.len(), "iterations": iterations })
    }

    fn reached(&self) -> bool {
        let found = |k: usize| match &self.beside {
            Beside::Nothing => true,
            Beside::Linear(linear) => linear.points.get(k).is_some_and(Result::is_ok),
            Beside::Modes(modes) => modes.points.get(k).is_some_and(Result::is_ok),
            Beside::Responses(responses) => responses.points.get(k).is_some_and(Result::is_ok),
            Beside::Comfort(comfort) => comfort.points.get(k).is_some_and(Result::is_ok),
            Beside::Rider(rider) => rider.points.get(k).is_some_and(Result::is_ok),
            Beside::Handling(along) => along.points.get(k).is_some_and(|p| p.iter().any(|v| v.is_finite())),
        };
        self.points.iter().enumerate().any(|(k, p)| p.ending == Ending::Reached && found(k))
    }
}

/// The value in the other axes; zero keeps its sign, so that no `-0` is printed.
pub(super) fn turned(value: f64, name: &str) -> f64 {
    if value == 0.0 { value } else { value * super::axes::factor(name) }
}
