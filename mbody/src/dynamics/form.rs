//! In which form constraints enter the residual, and the unknowns and equations of that form.
//!
//! ```text
//! position      Φ(q) = 0, s(q, v) = 0                          index 3: steady states
//! velocity      J v = 0                                        index 2: drifts slowly
//! ggl           J v = 0, Φ = 0 with q̇ = N (v + Jᵀ μ)           index 2, stabilized: integration in time
//! acceleration  J v̇ + γ + 2 a J v + a² Φ = 0                   index 1: a = 0 for explicit methods, else Baumgarte's stabilization
//! ```
//!
//! Sources: C. W. Gear, B. Leimkuhler, G. K. Gupta, J. Comput. Appl. Math. 12 (1985) 77–90 (GGL); J. Baumgarte, Comput. Methods Appl. Mech.
//! Eng. 1 (1972) 1–16.

use super::System;
use super::system::Multiplier;
use crate::constraint::{Level, RowValue};
use crate::scalar::Real;
use problem::{Equation, EquationKind, Signal, Unknown, UnknownKind};

/// How constraints enter the residual.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Formulation {
    /// Constraints on coordinates as they are (index 3).
    #[default]
    Position,
    /// Their rates (index 2).
    Velocity,
    /// Both, with a second set of multipliers (index 2, stabilized).
    Ggl,
    /// Their second rates (index 1), with Baumgarte's stabilization.
    Acceleration {
        /// Rate at which an error decays, 1/s; 0 for none.
        decay: f64,
    },
}

impl Formulation {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Ggl => "ggl",
            Self::Acceleration { .. } => "acceleration",
        }
    }

    /// The row of a multiplier.
    #[inline]
    pub(super) fn row<S: Real>(self, level: Level, row: &RowValue<S>) -> S {
        match (self, level) {
            (Self::Position, Level::Position) => row.error,
            (Self::Position, Level::Velocity) | (Self::Velocity | Self::Ggl, _) => row.rate,
            (Self::Acceleration { decay: a }, Level::Position) => row.acceleration + row.rate * (2.0 * a) + row.error * (a * a),
            (Self::Acceleration { decay: a }, Level::Velocity) => row.acceleration + row.rate * a,
        }
    }

    fn kind(self, level: Level) -> EquationKind {
        match (self, level) {
            (Self::Position, Level::Position) => EquationKind::Constraint,
            (Self::Position, Level::Velocity) | (Self::Velocity | Self::Ggl, _) => EquationKind::VelocityConstraint,
            (Self::Acceleration { .. }, _) => EquationKind::AccelerationConstraint,
        }
    }
}

/// Unknowns `(q, v, s, λ, μ)` and rows of one formulation.
#[derive(Clone, Debug)]
pub struct Form {
    /// Which.
    pub formulation: Formulation,
    /// The entries of y.
    pub unknowns: Vec<Unknown>,
    /// The rows of F.
    pub equations: Vec<Equation>,
    /// \[elements\] which are silent: they add no force, their rows and outputs stay 0. Empty where none is.
    pub(super) silent: Vec<bool>,
    /// Index of the first multiplier in y; its row has the same index.
    pub(super) first_multiplier: usize,
    /// Index of the first stabilizing multiplier in y, where there are some.
    pub(super) first_correction: usize,
}

/// Unit of the rate of a quantity.
fn rate_unit(unit: &str, times: usize) -> String {
    match (unit.strip_suffix("/s"), times) {
        (_, 0) => unit.to_owned(),
        (Some(base), 1) => format!("{base}/s^2"),
        (Some(base), n) => format!("{base}/s^{}", n + 1),
        (None, 1) => format!("{unit}/s"),
        (None, n) => format!("{unit}/s^{n}"),
    }
}

impl Form {
    /// The form of a system in a formulation.
    pub fn new(system: &System, formulation: Formulation) -> Self {
        let (mut unknowns, mut equations) = (system.base_unknowns.clone(), system.base_equations.clone());
        let first_multiplier = unknowns.len();
        for m in &system.multipliers {
            unknowns.push(m.unknown.clone());
            equations.push(constraint_row(m, formulation.kind(m.level)));
        }
        let first_correction = unknowns.len();
        if formulation == Formulation::Ggl {
            for m in system.multipliers.iter().filter(|m| m.level == Level::Position) {
                unknowns.push(correction(m));
                equations.push(constraint_row(m, EquationKind::Constraint));
            }
        }
        Self { formulation, unknowns, equations, first_multiplier, first_correction, silent: Vec::new() }
    }
}

fn constraint_row(m: &Multiplier, kind: EquationKind) -> Equation {
    let level = match kind {
        EquationKind::AccelerationConstraint => 2,
        EquationKind::VelocityConstraint => 1,
        _ => 0,
    };
    // a row on velocities is measured in a speed already
    let (times, below) = match m.level {
        Level::Position => (level, ["", "rate of ", "acceleration of "][level]),
        Level::Velocity => (level - 1, ["", "", "rate of "][level]),
    };
    let nominal = if times == 0 { m.nominal } else { 1.0 };
    Equation { name: format!("{below}{}", m.error), unit: rate_unit(m.error_unit, times).into(), nominal, kind }
}

/// The multiplier that keeps a coordinate constraint closed while its rate is integrated.
fn correction(m: &Multiplier) -> Unknown {
    let unit = if m.error_unit == "rad" { "rad/s" } else { "m/s" };
    let about = "speed that keeps the constraint closed; zero up to the tolerance of the integration";
    Unknown {
        signal: Signal::new(format!("{}_correction", m.unknown.signal.name), unit, about),
        kind: UnknownKind::Algebraic,
        cyclic: false,
        differential: false,
        nominal: 1e-3,
        // rounding of coordinates over the shortest steps is all that can be known of it
        absolute_tolerance: 1e-3,
        design: 0.0,
        start: None,
    }
}
