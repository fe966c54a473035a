//! Difference quotients in place of exact derivatives, where they are asked for.
//!
//! `∂f/∂yⱼ ≈ (f(y + δⱼ eⱼ) − f(y)) / δⱼ` with `δⱼ = √ε max(|yⱼ|, nominal)`: rounding and truncation are of the same size there.
//! Source: C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations*, SIAM 1995, section 5.4.4.

use problem::{EvalError, Matrix};

/// Work arrays of difference quotients.
pub(super) struct Differences {
    nominal: Vec<f64>,
    y: Vec<f64>,
    base: Vec<f64>,
    beside: Vec<f64>,
    /// Evaluations so far.
    pub(super) evaluations: usize,
}

impl Differences {
    /// For as many unknowns as there are nominal values, and as many rows.
    pub(super) fn new(nominal: Vec<f64>, rows: usize) -> Self {
        let y = nominal.clone();
        Self { nominal, y, base: vec![0.0; rows], beside: vec![0.0; rows], evaluations: 0 }
    }

    /// Writes the quotients of `evaluate`, which is told the point, the column and its δ (zero for the point itself).
    pub(super) fn quotients(
        &mut self,
        y: &[f64],
        mut evaluate: impl FnMut(&[f64], (usize, f64), &mut [f64]) -> Result<(), EvalError>,
        jacobian: &mut Matrix,
    ) -> Result<(), EvalError> {
        self.y.copy_from_slice(y);
        self.evaluations += 1 + y.len();
        evaluate(&self.y, (0, 0.0), &mut self.base)?;
        for j in 0..y.len() {
            let step = f64::EPSILON.sqrt() * y[j].abs().max(self.nominal[j]);
            // what is really added
            self.y[j] = y[j] + step;
            let step = self.y[j] - y[j];
            evaluate(&self.y, (j, step), &mut self.beside)?;
            self.y[j] = y[j];
            for ((entry, beside), base) in jacobian.column_mut(j).iter_mut().zip(&self.beside).zip(&self.base) {
                *entry = (beside - base) / step;
            }
        }
        Ok(())
    }
}
