//! Accelerations, rates of element states and multipliers by Newton's method on all rows, with exact derivatives.
//!
//! Accelerations and multipliers enter linearly, rates of states nearly so: a matrix serves many points, and one residual per point is the
//! rule. Source: J. E. Dennis, R. B. Schnabel, *Numerical Methods for Unconstrained Optimization and Nonlinear Equations* (1996), section 5.4.

use super::super::TreePlant;
use super::super::closure::least_norm;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use problem::{At, Dae, Differentiable, EvalError, Matrix, Seeds};

/// Scaled step at which Newton's method has converged.
const CONVERGED: f64 = 1e-13;
/// Scaled step below which rounding may be all that is left: stiff rows move accelerations by much for little.
const ROUNDING: f64 = 1e-9;
/// Most iterations.
const MOST_ITERATIONS: usize = 40;
/// Share of the step before to which a kept matrix must reduce the next one.
const FAST: f64 = 0.05;

/// Work arrays of the iteration.
pub(super) struct Newton {
    /// Typical magnitudes of the rows and of what is solved for.
    pub(super) rows: Vec<f64>,
    pub(super) columns: Vec<f64>,
    /// Derivatives at some earlier point, in these, and their factors.
    matrix: DMatrix<f64>,
    factors: Option<LU<f64, Dyn, Dyn>>,
    right: DVector<f64>,
    x: DVector<f64>,
    off: DVector<f64>,
    seeds: Seeds,
    residual: Vec<f64>,
    outputs: Vec<f64>,
    pub(super) d_residual: Matrix,
    d_outputs: Matrix,
}

impl Newton {
    /// Columns: accelerations, then for each state its rate (or its value, where it has none), then multipliers.
    pub(super) fn new(plant: &TreePlant) -> Self {
        let layout = &plant.system().model.layout;
        let (first, n) = (layout.nq(), plant.unknowns().len());
        let (inputs, outputs) = (plant.inputs().len(), plant.system().outputs.len());
        let mut seeds = Seeds::zeros(n, inputs, n - first);
        for (column, i) in (first..n).enumerate() {
            match plant.unknowns()[i].differential {
                true => seeds.yd[(i, column)] = 1.0,
                false => seeds.y[(i, column)] = 1.0,
            }
        }
        let zeros = || DVector::zeros(n - first);
        Self {
            rows: plant.equations()[first..].iter().map(|e| e.nominal).collect(),
            columns: plant.unknowns()[first..].iter().map(|k| k.nominal).collect(),
            matrix: DMatrix::zeros(n - first, n - first),
            factors: None,
            right: zeros(),
            x: zeros(),
            off: zeros(),
            residual: vec![0.0; n],
            outputs: vec![0.0; outputs],
            d_residual: Matrix::zeros(n, n - first),
            d_outputs: Matrix::zeros(outputs, n - first),
            seeds,
        }
    }

    pub(super) fn derivatives(&mut self, plant: &mut TreePlant, at: At<'_>) -> Result<(), EvalError> {
        plant.along(at, &self.seeds, (&mut self.residual, &mut self.outputs), &mut self.d_residual, &mut self.d_outputs)
    }

    /// Newton's method with the matrix of an earlier point as long as that converges fast: accelerations enter linearly, rates of states nearly so.
    pub(super) fn solve(&mut self, plant: &mut TreePlant, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let (first, n) = (plant.system().model.layout.nq(), y.len());
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let at = At { time, y, yd, u };
            match self.factors {
                Some(_) => self.residual.copy_from_slice(&plant.residual_at(at).residual),
                None => {
                    self.derivatives(plant, at)?;
                    self.factorize(first);
                }
            }
            let size = self.step(first).ok_or(EvalError::Recoverable { equation: first })?;
            let mut longest = 0.0_f64;
            for (j, i) in (first..n).enumerate() {
                let entry = if plant.unknowns()[i].differential { &mut yd[i] } else { &mut y[i] };
                *entry += self.x[j] * self.columns[j];
                longest = longest.max(self.x[j].abs() / (1.0 + (*entry / self.columns[j]).abs()));
            }
            for i in (first..n).filter(|&i| !plant.unknowns()[i].differential) {
                yd[i] = 0.0;
            }
            // steps with a kept matrix shrink as a geometric series: the next one would be this long
            let next = if before.is_finite() { longest * (longest / before) } else { longest };
            // beside convergence: small steps that shrink no more are rounding
            if next <= CONVERGED || (longest <= ROUNDING && longest > 0.5 * before) {
                break;
            }
            // a matrix that does not take off a digit and a half is that of another point
            if longest.is_nan() || size.is_nan() || longest > FAST * before {
                self.factors = None;
            }
            before = longest;
        }
        // rows of coordinates depend on no acceleration: those of the last iteration are those of the solution
        if let Some(equation) = self.residual.iter().position(|r| !r.is_finite()) {
            self.factors = None;
            return Err(EvalError::Recoverable { equation });
        }
        for (rate, residual) in yd[..first].iter_mut().zip(&self.residual) {
            *rate -= residual;
        }
        Ok(())
    }

    /// Factors of the derivatives as they stand, rows and columns in nominal values.
    fn factorize(&mut self, first: usize) {
        let n = self.columns.len();
        self.matrix = DMatrix::from_fn(n, n, |i, j| self.d_residual[(first + i, j)] * self.columns[j] / self.rows[i]);
        self.factors = Some(self.matrix.clone().lu());
    }

    /// Writes the step from the residual; the shortest one where the matrix is singular. Returns its size.
    fn step(&mut self, first: usize) -> Option<f64> {
        for (i, row) in self.rows.iter().enumerate() {
            self.right[i] = -self.residual[first + i] / row;
        }
        self.x.copy_from(&self.right);
        let solved = self.factors.as_ref().is_some_and(|lu| lu.solve_mut(&mut self.x));
        self.off.gemv(1.0, &self.matrix, &self.x, 0.0);
        self.off -= &self.right;
        let size = self.matrix.amax() * self.x.amax() + self.right.amax();
        if !(solved && self.off.amax() <= 1e-9 * size && size.is_finite()) {
            let shortest = least_norm(self.matrix.clone(), &self.right, &[]);
            self.x.copy_from(&shortest);
            // near such a position no matrix is worth keeping
            self.factors = None;
        }
        self.x.iter().all(|x| x.is_finite()).then(|| self.x.amax())
    }
}
