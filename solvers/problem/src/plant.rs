//! What an engine offers: `0 = F(t, y, ẏ, u)` and small optional capabilities.

use crate::{EvalError, Matrix, Signal};
use std::borrow::Cow;

/// What an unknown is, as far as an analysis may care.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnknownKind {
    /// A generalized coordinate.
    Position,
    /// A generalized velocity.
    Velocity,
    /// An internal state of an element.
    State,
    /// An algebraic unknown or a multiplier.
    Algebraic,
}

/// One entry of `y`.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Name, unit, meaning.
    pub signal: Signal,
    /// Coordinate, velocity, element state or algebraic unknown.
    pub kind: UnknownKind,
    /// Nothing in the residual depends on a cyclic coordinate; it may grow while everything else is steady.
    /// For a velocity: it is the rate of a cyclic coordinate, so a steady motion may have it non-zero.
    pub cyclic: bool,
    /// Whether its rate appears in the residual.
    pub differential: bool,
    /// Typical magnitude, for scaling.
    pub nominal: f64,
    /// Absolute tolerance for time integration.
    pub absolute_tolerance: f64,
    /// Value in the design pose, in which loops are closed.
    pub design: f64,
    /// Value from which a motion starts, where the description states one.
    pub start: Option<f64>,
}

/// What an equation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EquationKind {
    /// `q̇ − N(q) v`, one per coordinate, in the order of the coordinates.
    Kinematic,
    /// Equation of motion, one per velocity, in the order of the velocities.
    Dynamic,
    /// Row of an element's own state, in the order of the states.
    Element,
    /// Constraint on coordinates: a loop closes, a body touches a surface.
    Constraint,
    /// Constraint on velocities: the rate of a constraint on coordinates, or rolling without slip.
    VelocityConstraint,
    /// Constraint on accelerations: the rate of a constraint on velocities.
    AccelerationConstraint,
}

/// One row of `F`.
#[derive(Clone, Debug)]
pub struct Equation {
    /// What is balanced, in mechanical words: `moment about steer`.
    pub name: String,
    /// Unit of the row.
    pub unit: Cow<'static, str>,
    /// Typical magnitude, for scaling.
    pub nominal: f64,
    /// Which family the row belongs to.
    pub kind: EquationKind,
}

/// One entry of `u`.
#[derive(Clone, Debug)]
pub struct Input {
    /// Name, unit, meaning.
    pub signal: Signal,
    /// Index of the input that is this input's rate, where the residual needs both (road height and its rate).
    pub rate: Option<usize>,
    /// Typical magnitude, for scaling.
    pub nominal: f64,
    /// Value where nobody says otherwise.
    pub default: f64,
}

/// A point at which a plant is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// Time, s.
    pub time: f64,
    /// Unknowns.
    pub y: &'a [f64],
    /// Rates of the unknowns (those of algebraic unknowns are ignored).
    pub yd: &'a [f64],
    /// Inputs.
    pub u: &'a [f64],
}

/// Directions in the space of (y, ẏ, u): one column per direction.
#[derive(Clone, Debug, Default)]
pub struct Seeds {
    /// Directions of y, one column per direction.
    pub y: Matrix,
    /// Directions of ẏ.
    pub yd: Matrix,
    /// Directions of u.
    pub u: Matrix,
}

impl Seeds {
    /// Zero directions for a plant with `ny` unknowns and `nu` inputs.
    pub fn zeros(ny: usize, nu: usize, columns: usize) -> Self {
        Self { y: Matrix::zeros(ny, columns), yd: Matrix::zeros(ny, columns), u: Matrix::zeros(nu, columns) }
    }

    /// Number of directions.
    pub fn columns(&self) -> usize {
        self.y.columns()
    }

    /// Sets every direction to zero.
    pub fn clear(&mut self) {
        self.y.fill(0.0);
        self.yd.fill(0.0);
        self.u.fill(0.0);
    }
}

/// A differential-algebraic system `0 = F(t, y, ẏ, u)`: the only thing every engine must offer.
pub trait Dae {
    /// The entries of y.
    fn unknowns(&self) -> &[Unknown];
    /// The rows of F.
    fn equations(&self) -> &[Equation];
    /// The entries of u.
    fn inputs(&self) -> &[Input];
    /// Writes F.
    fn residual(&mut self, at: At<'_>, residual: &mut [f64]) -> Result<(), EvalError>;
}

/// Signals that a plant computes: z(t, y, ẏ, u).
pub trait Outputs: Dae {
    /// The entries of z.
    fn outputs(&self) -> &[Signal];
    /// Writes F and z in one pass.
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError>;
    /// Writes z alone, where that is cheaper; `residual` is room to work in and means nothing afterwards.
    fn observe(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(at, residual, outputs)
    }
}

/// Exact directional derivatives. The IDA matrix, E, A, B, C, D and trim Jacobians are all choices of seeds.
pub trait Differentiable: Outputs {
    /// Writes F, z and their derivatives along every direction (`dF`: equations × directions, `dz`: outputs × directions).
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError>;
}

/// On which side of its threshold a limit is violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Violated above the threshold.
    Above,
    /// Violated below the threshold.
    Below,
}

/// A physical limit that an element declares on one of the outputs or unknowns.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Stable name: `tire_saturated`, `wheel_lifted`, `suspension_stop`, …
    pub name: Cow<'static, str>,
    /// Name of the signal it watches.
    pub signal: String,
    /// Threshold in the unit of the signal.
    pub threshold: f64,
    /// Which side violates.
    pub side: Side,
    /// Typical magnitude of the signal: the distance to the threshold is judged against it.
    pub nominal: f64,
    /// One sentence: what happens there.
    pub about: Cow<'static, str>,
}

impl Limit {
    /// Distance to the limit in units of `nominal`: positive while respected, negative when violated.
    pub fn margin(&self, value: f64) -> f64 {
        let room = match self.side {
            Side::Above => self.threshold - value,
            Side::Below => value - self.threshold,
        };
        room / self.nominal
    }
}

/// Physical limits that the elements declare; an ending takes its name from here.
pub trait Limits: Dae {
    /// All declared limits.
    fn limits(&self) -> &[Limit];
}

/// Everything the analyses of this workspace ask for.
pub trait Plant: Differentiable + Limits + Send {}

impl<T: Differentiable + Limits + Send> Plant for T {}
