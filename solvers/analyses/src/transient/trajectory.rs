//! What a simulation leaves: signals over time, and how well the constraints held.

use crate::{Variable, Variables};
use problem::{Off, Signal};

/// Signals over time, SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Sampling times, s. A simulation that ended early has the time reached as its last one.
    pub time: Vec<f64>,
    /// The recorded signals.
    pub signals: Vec<Signal>,
    /// One column per signal, one value per time. An output without a value there, as a curvature at standstill, is not finite.
    pub columns: Vec<Vec<f64>>,
}

impl Trajectory {
    /// An empty trajectory with room for `samples` samples.
    pub(super) fn with_room(variables: &Variables, record: &[Variable], samples: usize) -> Self {
        Self {
            time: Vec::with_capacity(samples),
            signals: record.iter().map(|&v| variables.signal(v)).collect(),
            columns: record.iter().map(|_| Vec::with_capacity(samples)).collect(),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// The values of the signal called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.signals.iter().position(|s| s.name == name).map(|k| self.columns[k].as_slice())
    }
}

/// A largest violation and when it occurred.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// The row and by how much it was off.
    pub off: Off,
    /// When, s.
    pub time: f64,
}

/// Largest violation of the constraints over the samples, judged in units of the rows' nominal values.
///
/// Only rows that stand in the equations are seen: a plant in a form without constraints on coordinates reports none there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drift {
    /// Of the constraints on coordinates.
    pub position: Option<Worst>,
    /// Of the constraints on velocities.
    pub velocity: Option<Worst>,
}

/// The sample nearest to a singular position, where constraints depend on each other: what comes after it may be another branch of the
/// motion, and finer tolerances need not agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearSingular {
    /// Independence of the constraints there, as a share of that at the start.
    pub independence: f64,
    /// When, s.
    pub time: f64,
}

/// A declared limit that was violated at some sample; the simulation went on.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitMet {
    /// Stable name of the limit: `wheel_lifted`.
    pub name: String,
    /// The signal it watches.
    pub signal: String,
    /// Its value at the first such sample.
    pub value: f64,
    /// The declared threshold.
    pub threshold: f64,
    /// Time of the first such sample, s.
    pub time: f64,
}

/// A declared limit that was crossed on the way, at the time found by the method.
///
/// Violated at the threshold, respected again once a thousandth of the nominal value of the signal is between them; a thousand crossings of
/// one limit are told.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// Stable name of the limit: `wheel_lifted`.
    pub name: String,
    /// The signal it watches.
    pub signal: String,
    /// The declared threshold.
    pub threshold: f64,
    /// Whether it is violated from now on, or respected again.
    pub violated: bool,
    /// When, s.
    pub time: f64,
}
