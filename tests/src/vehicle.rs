//! Bundled vehicles and their steady states, by the names of their signals: the way of the command line without its text.

use analyses::linearize::Options;
use analyses::{LinearModel, linearize};
use fastbike::library::Source;
use fastbike::output::Point;
use fastbike::plan::{Prescribed, Request, Turn};
use fastbike::{standard_kinds, steady};
use mbody::assembly::assemble;
use mbody::description::Library;
use mbody::dynamics::{System, TreePlant};
use problem::{At, Ending, Signal};
use std::borrow::Cow;
use std::sync::Arc;

/// The bundled vehicles.
pub const BUNDLED: [&str; 3] = ["ref11", "gsxr1000", "moto11"];

/// An assembled vehicle.
#[derive(Clone, Debug)]
pub struct Vehicle {
    /// Its system.
    pub system: Arc<System>,
}

/// A bundled description with more elements at its end.
struct Extended<'a> {
    source: &'a Source,
    elements: &'a str,
}

impl Library for Extended<'_> {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        let text = self.source.text(name)?;
        Some(if name == self.source.file { Cow::Owned(format!("{text}{}", self.elements)) } else { text })
    }

    fn resolve(&self, name: &str, within: &str) -> String {
        self.source.resolve(name, within)
    }
}

/// A bundled description whose files are rewritten.
struct Rewritten<'a> {
    source: &'a Source,
    rewrite: fn(&str) -> String,
}

impl Library for Rewritten<'_> {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        Some(Cow::Owned((self.rewrite)(&self.source.text(name)?)))
    }
}

impl Vehicle {
    /// A bundled vehicle whose files are rewritten before they are read.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn rewritten(name: &str, rewrite: fn(&str) -> String) -> Self {
        let source = Source::find(name).unwrap_or_else(|findings| panic!("{findings}"));
        let (assembled, findings) = assemble(&source.file, &Rewritten { source: &source, rewrite }, &standard_kinds(), &[]);
        Self { system: assembled.unwrap_or_else(|| panic!("{name}: {findings}")).system }
    }

    /// A bundled vehicle.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn bundled(name: &str) -> Self {
        Self::with(name, &[])
    }

    /// A bundled vehicle with changed entries, as by `--set`.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn with(name: &str, changes: &[(&str, &str)]) -> Self {
        Self::extended(name, "", changes)
    }

    /// A bundled vehicle with more elements (indented lines of YAML) and changed entries.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn extended(name: &str, elements: &str, changes: &[(&str, &str)]) -> Self {
        let source = Source::find(name).unwrap_or_else(|findings| panic!("{findings}"));
        let overrides: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
        let (assembled, findings) = assemble(&source.file, &Extended { source: &source, elements }, &standard_kinds(), &overrides);
        let assembled = assembled.unwrap_or_else(|| panic!("{name}: {findings}"));
        Self { system: assembled.system }
    }

    /// A plant of this vehicle.
    pub fn plant(&self) -> TreePlant {
        TreePlant::new(self.system.clone())
    }

    /// Steady states, in the order of the request's grid.
    ///
    /// # Panics
    /// The request as a whole is impossible.
    pub fn steady(&self, request: &Request, backend: &str) -> Vec<State> {
        let found = steady::run(request, &self.system, backend, "steady states").unwrap_or_else(|failure| panic!("{failure}"));
        let signals: Arc<[Signal]> = found.signals.into();
        found.points.into_iter().map(|point| State { signals: signals.clone(), system: self.system.clone(), point }).collect()
    }

    /// The only steady state of a request, by KINSOL.
    ///
    /// # Panics
    /// It is not reached.
    pub fn state(&self, request: &Request) -> State {
        let mut states = self.steady(request, "kinsol");
        assert_eq!(states.len(), 1, "one state was asked for");
        let state = states.remove(0);
        assert_eq!(state.point.ending, Ending::Reached);
        state
    }
}

/// A steady state.
#[derive(Clone, Debug)]
pub struct State {
    /// All signals: unknowns, inputs, outputs.
    pub signals: Arc<[Signal]>,
    /// The system.
    pub system: Arc<System>,
    /// Values and ending.
    pub point: Point,
}

impl State {
    /// Value of a signal.
    ///
    /// # Panics
    /// There is no such signal, or it was not computed.
    pub fn get(&self, name: &str) -> f64 {
        let at = self.signals.iter().position(|s| s.name == name).unwrap_or_else(|| panic!("no signal `{name}`"));
        let value = self.point.value(at);
        assert!(value.is_finite(), "`{name}` was not computed: {:?}", self.point.ending);
        value
    }

    /// Unknowns and inputs.
    pub fn arguments(&self) -> (&[f64], &[f64]) {
        let (y, rest) = self.point.values.split_at(self.system.unknowns().len());
        (y, &rest[..self.system.inputs().len()])
    }

    /// Calls `look` with the point of evaluation.
    pub fn at<T>(&self, look: impl FnOnce(At<'_>) -> T) -> T {
        let (y, u) = self.arguments();
        look(At { time: 0.0, y, yd: &self.point.rates, u })
    }

    /// The linear model of small motions about this state.
    ///
    /// # Panics
    /// The state is no trim.
    pub fn linear(&self) -> LinearModel {
        let mut plant = TreePlant::new(self.system.clone());
        self.at(|at| linearize(&mut plant, at, &Options::default())).unwrap_or_else(|error| panic!("{error}"))
    }
}

fn prescribed(name: &'static str, unit: &'static str, values: &[f64]) -> Prescribed {
    Prescribed { name, unit, values: values.to_vec() }
}

/// Straight running at some speeds, m/s.
pub fn running(speeds: &[f64]) -> Request {
    Request { speed: Some(prescribed("speed", "m/s", speeds)), ..Request::default() }
}

/// Turns at some speeds, m/s, of some sizes, SI.
pub fn turning(speeds: &[f64], turn: Turn, sizes: &[f64]) -> Request {
    Request { turn: Some((turn, prescribed("turn", "", sizes))), ..running(speeds) }
}

/// Leaning at some speeds, m/s, by some angles, rad.
pub fn leaning(speeds: &[f64], leans: &[f64]) -> Request {
    turning(speeds, Turn::Lean, leans)
}

/// The same with acceleration along the heading, m/s².
pub fn accelerating(request: Request, acceleration: f64) -> Request {
    Request { acceleration: Some(prescribed("acceleration", "m/s²", &[acceleration])), ..request }
}

/// The same with a signal given by a value or a formula.
pub fn given(mut request: Request, signal: &str, formula: impl ToString) -> Request {
    request.given.push((signal.to_owned(), formula.to_string()));
    request
}

/// The same with a signal to be found.
pub fn free(mut request: Request, signal: &str) -> Request {
    request.free.push((signal.to_owned(), None));
    request
}
