//! Difference quotients in place of exact derivatives, where they are asked for.
//!
//! `∂f/∂yⱼ ≈ (f(y + δⱼ eⱼ) − f(y)) / δⱼ` with `δⱼ = √ε max(|yⱼ|, nominal)`: rounding and truncation are of the same size there.
//!
//! A product `∂f/∂y v ≈ (f(y + δ v) − f(y)) / δ` takes one evaluation per group of entries, none of which moves by more than √ε of its size.
//! Source: C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations*, SIAM 1995, section 5.4.4.

use problem::{EvalError, Matrix};

/// Work arrays of difference quotients, one per column.
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

/// Work arrays of difference quotients along one direction.
///
/// The direction is taken apart by groups of entries, for a step that suits the largest of them drowns the others in rounding: in a step of an
/// integrator multipliers may change by thousands of newtons while coordinates move by nanometers, which constraints must feel.
pub(super) struct Directional {
    sizes: Vec<f64>,
    /// The group of each entry.
    groups: Vec<usize>,
    beside: Vec<f64>,
    base: Vec<f64>,
    value: Vec<f64>,
    /// Evaluations so far.
    pub(super) evaluations: usize,
}

impl Directional {
    /// For points with as many entries as there are nominal values and groups, and as many rows.
    pub(super) fn new(nominal: Vec<f64>, groups: Vec<usize>, rows: usize) -> Self {
        let beside = nominal.clone();
        Self { sizes: nominal, groups, beside, base: vec![0.0; rows], value: vec![0.0; rows], evaluations: 0 }
    }

    /// Writes the product of the derivative of `evaluate` with a direction.
    pub(super) fn product(
        &mut self,
        point: &[f64],
        along: &[f64],
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), EvalError>,
        product: &mut [f64],
    ) -> Result<(), EvalError> {
        let Self { sizes, groups, beside, base, value, evaluations } = self;
        product.fill(0.0);
        *evaluations += 1;
        evaluate(point, base)?;
        for group in 0..=groups.iter().copied().max().unwrap_or_default() {
            let share = |i: usize| if groups[i] == group { (along[i] / point[i].abs().max(sizes[i])).abs() } else { 0.0 };
            let longest = (0..point.len()).map(share).fold(0.0, f64::max);
            if longest == 0.0 {
                continue;
            }
            let step = f64::EPSILON.sqrt() / longest;
            beside.copy_from_slice(point);
            for i in (0..point.len()).filter(|&i| groups[i] == group) {
                beside[i] += step * along[i];
            }
            *evaluations += 1;
            evaluate(beside, value)?;
            for ((sum, value), base) in product.iter_mut().zip(&*value).zip(&*base) {
                *sum += (value - base) / step;
            }
        }
        Ok(())
    }
}
