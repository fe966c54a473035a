//! The vocabulary between engines, solvers and analyses.
//!
//! Engines *implement* [`Dae`] and its optional capabilities, solver packages *implement*
//! [`AlgebraicMethod`], analyses *consume* both. This crate holds no numerics and depends on nobody.
//!
//! Everything that enters or leaves a plant is a named [`Signal`] with unit and one sentence.

mod algebraic;
pub mod contract;
mod controller;
mod error;
mod family;
mod integration;
mod matrix;
mod mode;
mod motion;
mod outcome;
mod plant;
mod signal;

pub use algebraic::{AlgebraicEnding, AlgebraicMethod, AlgebraicOptions, AlgebraicOutcome, AlgebraicProblem, Bound, Effort};
pub use controller::{Answer, AnswerAlong, Controller};
pub use error::EvalError;
pub use family::{Family, Member, NoMember, Parameter, ParameterId};
pub use integration::{
    AlgebraicErrors, DaeMethod, DaeProblem, Derivatives, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, LinearSolver,
    OdeMethod, OdeProblem, Sink,
};
pub use matrix::Matrix;
pub use mode::{ModeRule, Nature, Occurs};
pub use motion::{Explicit, Integrable, Off, Projection, ProjectionError};
pub use outcome::Ending;
pub use plant::{At, Dae, Differentiable, Equation, EquationKind, Input, Limit, Limits, Outputs, Plant, Seeds, Side, Unknown, UnknownKind};
pub use signal::Signal;
