//! What reads signals of a plant and commands its inputs: a rider, a road under the wheels, a controller.

use crate::{EvalError, Limit, Matrix, Signal, Unknown};

/// What a controller answers at one instant: receivers of its values.
#[derive(Debug)]
pub struct Answer<'a> {
    /// Values of the commanded inputs.
    pub commands: &'a mut [f64],
    /// Rates of the controller's own states.
    pub rates: &'a mut [f64],
    /// Values of its outputs.
    pub outputs: &'a mut [f64],
}

/// Derivatives of an answer, one column per direction.
#[derive(Debug)]
pub struct AnswerAlong<'a> {
    /// Of the commanded inputs.
    pub commands: &'a mut Matrix,
    /// Of the rates of the controller's own states.
    pub rates: &'a mut Matrix,
    /// Of its outputs.
    pub outputs: &'a mut Matrix,
}

/// A law `u = c(t, z, x)`, `ẋ = f(t, z, x)` of measured signals z and states x of its own.
///
/// Measured are differential unknowns of the plant only (coordinates, velocities, states), so that plant and controller form no algebraic
/// loop. A plant and its controllers are a plant again, whose commanded inputs have become outputs.
pub trait Controller: Send {
    /// Names of the unknowns that it reads.
    fn measured(&self) -> &[String];
    /// Names of the inputs that it commands.
    fn commanded(&self) -> &[String];
    /// Its own states: all differential, `start` is where they begin.
    fn states(&self) -> &[Unknown];
    /// Signals that it computes beside the commands.
    fn outputs(&self) -> &[Signal];
    /// Limits that it declares on signals of the plant or of its own.
    fn limits(&self) -> &[Limit] {
        &[]
    }
    /// Times at which its answer jumps or has a corner, s, in any order: an integration starts anew there, and steps over nothing that is short.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
    /// Writes commands, rates and outputs. The index of an error is that of a state.
    fn answer(&mut self, time: f64, measured: &[f64], states: &[f64], answer: Answer<'_>) -> Result<(), EvalError>;
    /// Writes them with their derivatives along directions of (measured, states), one column per direction.
    fn answer_along(
        &mut self,
        time: f64,
        at: (&[f64], &[f64]),
        directions: (&Matrix, &Matrix),
        answer: Answer<'_>,
        along: AnswerAlong<'_>,
    ) -> Result<(), EvalError>;
}
