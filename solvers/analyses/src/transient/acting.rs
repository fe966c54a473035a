//! Inputs within one piece of time, and the signals that follow from them at a point.

use super::SharedPlant;
use super::inputs::Inputs;
use crate::Variable;
use problem::{At, EvalError};
use std::cell::Cell;

/// Inputs as they are seen from inside of a piece of time, at whose ends they may jump.
pub(super) struct Acting<'a> {
    inputs: &'a dyn Inputs,
    piece: Cell<(f64, f64)>,
}

impl<'a> Acting<'a> {
    pub(super) fn new(inputs: &'a dyn Inputs) -> Self {
        Self { inputs, piece: Cell::new((f64::NEG_INFINITY, f64::INFINITY)) }
    }

    /// Looks at the inputs from `begin` until just before `end`.
    pub(super) fn enter(&self, begin: f64, end: f64) {
        self.piece.set((begin, end.next_down()));
    }

    /// Writes all inputs.
    pub(super) fn at(&self, time: f64, u: &mut [f64]) {
        let (begin, end) = self.piece.get();
        self.inputs.at(time.clamp(begin, end), u);
    }
}

/// All signals at a point.
pub(super) struct Observer<'a, 'p> {
    plant: &'a SharedPlant<'p>,
    acting: &'a Acting<'a>,
    pub(super) u: Vec<f64>,
    pub(super) residual: Vec<f64>,
    outputs: Vec<f64>,
}

impl<'a, 'p> Observer<'a, 'p> {
    pub(super) fn new(plant: &'a SharedPlant<'p>, acting: &'a Acting<'a>) -> Self {
        let p = plant.borrow();
        let zeros = |count: usize| vec![0.0; count];
        Self { plant, acting, u: zeros(p.inputs().len()), residual: zeros(p.equations().len()), outputs: zeros(p.outputs().len()) }
    }

    /// Evaluates inputs, residual and outputs.
    pub(super) fn look(&mut self, time: f64, y: &[f64], yd: &[f64]) -> Result<(), EvalError> {
        self.acting.at(time, &mut self.u);
        let at = At { time, y, yd, u: &self.u };
        self.plant.borrow_mut().evaluate(at, &mut self.residual, &mut self.outputs)
    }

    /// Evaluates inputs and outputs.
    pub(super) fn glance(&mut self, time: f64, y: &[f64], yd: &[f64]) -> Result<(), EvalError> {
        self.acting.at(time, &mut self.u);
        let at = At { time, y, yd, u: &self.u };
        self.plant.borrow_mut().observe(at, &mut self.residual, &mut self.outputs)
    }

    /// All signals at the point looked at last.
    pub(super) fn sample<'s>(&'s self, time: f64, (y, yd): (&'s [f64], &'s [f64])) -> Sample<'s> {
        Sample { time, y, yd, u: &self.u, outputs: &self.outputs }
    }
}

/// All signals of a plant at one time.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'s> {
    /// Time, s.
    pub time: f64,
    y: &'s [f64],
    yd: &'s [f64],
    u: &'s [f64],
    outputs: &'s [f64],
}

impl Sample<'_> {
    /// The value of a variable, SI.
    pub fn value(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Unknown(i) => self.y[i],
            Variable::Rate(i) => self.yd[i],
            Variable::Input(i) => self.u[i],
            Variable::Output(i) => self.outputs[i],
        }
    }
}
