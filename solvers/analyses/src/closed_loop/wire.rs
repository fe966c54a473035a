//! One controller and where its signals stand in plant and closed loop.

use super::LoopError;
use crate::{Variable, Variables};
use problem::{Answer, AnswerAlong, Controller, EvalError, Matrix, Plant, Signal};
use std::ops::Range;

/// A controller between unknowns and inputs of a plant.
pub(super) struct Wire {
    pub(super) controller: Box<dyn Controller>,
    /// Unknowns of the plant that it reads.
    pub(super) measured: Vec<usize>,
    /// Inputs of the plant that it commands.
    pub(super) commanded: Vec<usize>,
    /// Its states among the unknowns of the closed loop.
    states: Range<usize>,
    /// Its first state among those of all controllers.
    offset: usize,
    /// Its first row among the equations of the closed loop.
    first_row: usize,
    /// Its first command among the outputs of the closed loop.
    pub(super) first_command: usize,
    /// Its first output there.
    pub(super) first_output: usize,
    /// What it read and answered last.
    z: Vec<f64>,
    commands: Vec<f64>,
    rates: Vec<f64>,
    outputs: Vec<f64>,
    /// The same along directions, for the number of columns asked for last.
    along: Along,
}

/// Directions of what is read, and derivatives of what is answered.
#[derive(Default)]
struct Along {
    z: Matrix,
    x: Matrix,
    commands: Matrix,
    rates: Matrix,
    outputs: Matrix,
}

impl Wire {
    /// Connects a controller whose first state and row in the closed loop are `first`.
    pub(super) fn new(controller: Box<dyn Controller>, first: (usize, usize), plant: &dyn Plant) -> Result<Self, LoopError> {
        let variables = Variables::of(plant);
        let names = |signals: &mut dyn Iterator<Item = &Signal>| signals.map(|s| s.name.clone()).collect();
        let measured = controller.measured().iter().map(|name| match variables.find(name) {
            Some(Variable::Unknown(i)) if plant.unknowns()[i].differential => Ok(i),
            Some(_) => Err(LoopError::Unmeasurable { signal: name.clone() }),
            None => Err(LoopError::UnknownMeasured {
                signal: name.clone(),
                known: names(&mut plant.unknowns().iter().filter(|u| u.differential).map(|u| &u.signal)),
            }),
        });
        let measured = measured.collect::<Result<Vec<_>, _>>()?;
        let commanded = controller.commanded().iter().map(|name| match variables.find(name) {
            Some(Variable::Input(i)) => Ok(i),
            _ => Err(LoopError::UnknownCommanded { input: name.clone(), known: names(&mut plant.inputs().iter().map(|i| &i.signal)) }),
        });
        let commanded = commanded.collect::<Result<Vec<_>, _>>()?;
        if let Some(k) = (1..commanded.len()).find(|&k| commanded[..k].contains(&commanded[k])) {
            return Err(LoopError::CommandedTwice { input: controller.commanded()[k].clone() });
        }
        let (nx, nz) = (controller.states().len(), controller.outputs().len());
        Ok(Self {
            z: vec![0.0; measured.len()],
            commands: vec![0.0; commanded.len()],
            rates: vec![0.0; nx],
            outputs: vec![0.0; nz],
            along: Along::default(),
            states: first.0..first.0 + nx,
            offset: first.0 - plant.unknowns().len(),
            first_row: first.1,
            first_command: 0,
            first_output: 0,
            measured,
            commanded,
            controller,
        })
    }

    /// Whether one of its states or outputs has this name.
    pub(super) fn calls(&self, name: &str) -> bool {
        let states = self.controller.states().iter().map(|s| &s.signal);
        states.chain(self.controller.outputs()).any(|s| s.name == name)
    }

    fn read(&mut self, y: &[f64]) {
        for (z, &i) in self.z.iter_mut().zip(&self.measured) {
            *z = y[i];
        }
    }

    /// A row of the closed loop for a state of the controller.
    fn of_row(first_row: usize, error: EvalError) -> EvalError {
        match error {
            EvalError::Recoverable { equation } => EvalError::Recoverable { equation: first_row + equation },
            EvalError::Fatal { equation } => EvalError::Fatal { equation: first_row + equation },
        }
    }

    /// Lets the controller answer at a point of the closed loop.
    pub(super) fn answer(&mut self, time: f64, y: &[f64]) -> Result<(), EvalError> {
        self.read(y);
        let answer = Answer { commands: &mut self.commands, rates: &mut self.rates, outputs: &mut self.outputs };
        let answered = self.controller.answer(time, &self.z, &y[self.states.clone()], answer);
        answered.map_err(|e| Self::of_row(self.first_row, e))
    }

    /// The same along directions of the unknowns of the closed loop.
    pub(super) fn answer_along(&mut self, time: f64, y: &[f64], directions: &Matrix) -> Result<(), EvalError> {
        self.read(y);
        let columns = directions.columns();
        if self.along.z.columns() != columns {
            let of = |rows: usize| Matrix::zeros(rows, columns);
            let (z, x, commands) = (of(self.z.len()), of(self.states.len()), of(self.commands.len()));
            self.along = Along { z, x, commands, rates: of(self.rates.len()), outputs: of(self.outputs.len()) };
        }
        let d = &mut self.along;
        for k in 0..columns {
            let column = directions.column(k);
            d.x.column_mut(k).copy_from_slice(&column[self.states.clone()]);
            for (z, &i) in d.z.column_mut(k).iter_mut().zip(&self.measured) {
                *z = column[i];
            }
        }
        let answer = Answer { commands: &mut self.commands, rates: &mut self.rates, outputs: &mut self.outputs };
        let along = AnswerAlong { commands: &mut d.commands, rates: &mut d.rates, outputs: &mut d.outputs };
        let answered = self.controller.answer_along(time, (&self.z, &y[self.states.clone()]), (&d.z, &d.x), answer, along);
        answered.map_err(|e| Self::of_row(self.first_row, e))
    }

    /// Writes its commands among the inputs of the plant.
    pub(super) fn give(&self, u: &mut [f64]) {
        for (&i, &command) in self.commanded.iter().zip(&self.commands) {
            u[i] = command;
        }
    }

    /// The same along directions.
    pub(super) fn give_along(&self, u: &mut Matrix) {
        for k in 0..u.columns() {
            for (&i, &command) in self.commanded.iter().zip(self.along.commands.column(k)) {
                u[(i, k)] = command;
            }
        }
    }

    /// Writes the rates of its states among those of all controllers.
    pub(super) fn rates(&self, xd: &mut [f64]) {
        xd[self.offset..self.offset + self.rates.len()].copy_from_slice(&self.rates);
    }

    /// The same along direction `k`.
    pub(super) fn rates_along(&self, k: usize, xd: &mut [f64]) {
        xd[self.offset..self.offset + self.rates.len()].copy_from_slice(self.along.rates.column(k));
    }

    /// Writes `ẋ − f` among the rows of all controllers.
    pub(super) fn rows(&self, xd: &[f64], rows: &mut [f64]) {
        for (k, f) in (self.offset..).zip(&self.rates) {
            rows[k] = xd[k] - f;
        }
    }

    /// The same along direction `k`.
    pub(super) fn rows_along(&self, k: usize, xd: &[f64], rows: &mut [f64]) {
        for (i, f) in (self.offset..).zip(self.along.rates.column(k)) {
            rows[i] = xd[i] - f;
        }
    }

    /// Writes commands and outputs among the outputs of the closed loop.
    pub(super) fn tell(&self, outputs: &mut [f64]) {
        outputs[self.first_command..self.first_command + self.commands.len()].copy_from_slice(&self.commands);
        outputs[self.first_output..self.first_output + self.outputs.len()].copy_from_slice(&self.outputs);
    }

    /// The same along direction `k`.
    pub(super) fn tell_along(&self, k: usize, outputs: &mut [f64]) {
        outputs[self.first_command..self.first_command + self.commands.len()].copy_from_slice(self.along.commands.column(k));
        outputs[self.first_output..self.first_output + self.outputs.len()].copy_from_slice(self.along.outputs.column(k));
    }
}
