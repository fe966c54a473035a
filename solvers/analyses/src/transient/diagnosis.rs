//! What stands behind the end of an integration, in signal and equation names.

use super::SharedPlant;
use super::ending::{Cause, Moving, equation};
use super::implicit::Implicit;
use crate::trim::diagnosis::moving_together;
use crate::{Variable, Variables};
use nalgebra::DMatrix;
use problem::{DaeProblem, Equation, EvalError, IntegrationOptions, Matrix, Off};

/// Number of signals or rows that a sentence names.
pub(super) const TOLD: usize = 3;

/// The equation that failed, by its name.
pub(super) fn not_finite(error: EvalError, plant: &SharedPlant<'_>) -> Cause {
    Cause::NotFinite { equation: equation(error, plant.borrow().equations()) }
}

/// A violated row in mechanical words.
pub(super) fn off(equation: &Equation, by: f64) -> Off {
    Off { row: equation.name.clone(), by: by.abs(), unit: equation.unit.to_string() }
}

/// Rows that are off most at a point, worst first; nothing where it cannot be evaluated.
pub(super) fn off_at(problem: &mut Implicit<'_, '_>, time: f64, (y, yd): (&[f64], &[f64])) -> Vec<Off> {
    let mut residual = vec![0.0; y.len()];
    match problem.residual(time, y, yd, &mut residual) {
        Ok(()) => problem.worst(),
        Err(_) => Vec::new(),
    }
}

/// The signals that change fastest in units of their tolerances.
pub(super) fn fastest(plant: &SharedPlant<'_>, options: &IntegrationOptions, (y, yd): (&[f64], &[f64])) -> Vec<Moving> {
    let plant = plant.borrow();
    let unknowns = plant.unknowns();
    let tolerance = |i: usize| options.relative_tolerance * y[i].abs() + options.absolute_tolerance_factor * unknowns[i].absolute_tolerance;
    let pace = |i: usize| (yd[i] / tolerance(i)).abs();
    let mut moving: Vec<usize> = (0..y.len()).filter(|&i| unknowns[i].differential && pace(i) > 0.0).collect();
    moving.sort_by(|&a, &b| pace(b).total_cmp(&pace(a)));
    let named = |&i: &usize| {
        let signal = &unknowns[i].signal;
        Moving { signal: signal.name.clone(), rate: yd[i], unit: signal.unit.to_string() }
    };
    moving.iter().take(TOLD).map(named).collect()
}

/// The signals in the direction that ∂F/∂y + c ∂F/∂ẏ changes least.
pub(super) fn undetermined(
    plant: &SharedPlant<'_>,
    problem: &mut Implicit<'_, '_>,
    (time, c): (f64, f64),
    (y, yd): (&[f64], &[f64]),
) -> Vec<String> {
    let n = problem.size();
    let mut matrix = Matrix::zeros(n, n);
    let known = problem.jacobian(time, c, y, yd, &mut matrix);
    if known.is_err() || !matrix.as_slice().iter().all(|e| e.is_finite()) {
        return Vec::new();
    }
    let plant = plant.borrow();
    // columns of one length: a multiplier and a velocity over a short step count alike
    let length = |j: usize| matrix.column(j).iter().map(|e| e * e).sum::<f64>().sqrt();
    let scale: Vec<f64> = (0..n).map(|j| if length(j) > 0.0 { 1.0 / length(j) } else { plant.unknowns()[j].nominal }).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] * scale[j]);
    let unknowns: Vec<Variable> = (0..n).map(Variable::Unknown).collect();
    moving_together(&scaled, &unknowns, &scale, &Variables::of(&**plant))
}
