//! Maneuvers that the virtual rider rode: the way of the command line without its text.

use crate::vehicle::{Vehicle, running};
use fastbike::output::History;
use fastbike::{Failure, maneuver, motion};
use motorcycle::maneuver::Maneuver;
use problem::{Derivatives, LinearSolver};

/// A ride that was computed.
#[derive(Debug)]
pub struct Rode {
    /// Signals over time, and how it ended.
    pub history: History,
}

/// How closely it is computed, and how often told.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// Name of the backend.
    pub backend: &'static str,
    /// Relative tolerance.
    pub tolerance: f64,
    /// Samples per second.
    pub rate: f64,
}

impl Care {
    /// As the command does where nobody chooses.
    pub const USUAL: Self = Self { backend: "ida", tolerance: 1e-6, rate: 100.0 };
}

/// A bundled maneuver with changed entries, as by `--change`.
///
/// # Panics
/// It cannot be read.
pub fn read(name: &str, changes: &[String]) -> Maneuver {
    maneuver::read(name, changes).unwrap_or_else(|failure| panic!("{name} {changes:?}: {failure}"))
}

impl Rode {
    /// A vehicle rides a maneuver; only some signals are recorded, or all where none is named.
    ///
    /// # Panics
    /// It cannot be ridden.
    pub fn of(vehicle: &Vehicle, maneuver: Maneuver, care: Care, record: &[&str]) -> Self {
        let name = maneuver.name.clone();
        Self::tried(vehicle, maneuver, care, record).unwrap_or_else(|failure| panic!("{name}: {failure}"))
    }

    /// The same of a maneuver that perhaps cannot be ridden.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn tried(vehicle: &Vehicle, maneuver: Maneuver, care: Care, record: &[&str]) -> Result<Self, Failure> {
        let duration = maneuver.longest();
        let count = (duration * care.rate).ceil();
        let request = motion::Request {
            times: (0..=count as usize).map(|k| k as f64 / care.rate).collect(),
            relative_tolerance: care.tolerance,
            backend: care.backend.to_owned(),
            formulation: None,
            derivatives: Derivatives::Exact,
            linear_solver: LinearSolver::Direct,
            fixed_step: motion::USUAL_STEP,
            steady: Some(running(&[maneuver.course.speed.first()])),
            given: Vec::new(),
            signals: None,
            until: maneuver.until.clone(),
            interrupt: None,
            record: record.iter().map(|name| (*name).to_owned()).collect(),
            keep: None,
        };
        let ride = maneuver::ride("", maneuver, &vehicle.system)?;
        Ok(Self { history: motion::run(&request, &vehicle.system, "", Some(ride))? })
    }

    /// A recorded signal.
    ///
    /// # Panics
    /// There is no such signal.
    pub fn signal(&self, name: &str) -> Vec<f64> {
        let column = self.history.column(name).unwrap_or_else(|failure| panic!("{failure}"));
        column.unwrap_or_else(|| panic!("no signal `{name}`"))
    }

    /// Times of the samples, s.
    pub fn time(&self) -> &[f64] {
        self.history.recording.time()
    }

    /// Largest absolute value of a signal.
    pub fn peak(&self, name: &str) -> f64 {
        self.signal(name).iter().fold(0.0, |most, value| value.abs().max(most))
    }

    /// Name of the ending.
    pub fn ending(&self) -> &str {
        &self.history.outcome.ending
    }
}
