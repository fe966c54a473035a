//! All derivatives of a plant at a point as one matrix, from which columns are eliminated by the rows that determine them.
//!
//! Rows: the equations of the plant, its outputs, then one row `1 · δ` for every algebraic unknown, so that these can be watched like
//! outputs. Columns: rates, differential unknowns, algebraic states, multipliers, inputs, cyclic coordinates.

use super::layout::Layout;
use super::{LinearizeError, ROUNDING};
use crate::condition::condition;
use nalgebra::DMatrix;
use problem::{At, EvalError, Matrix, Plant, Seeds, UnknownKind};
use std::ops::Range;

/// The derivatives.
#[derive(Clone, Debug)]
pub(super) struct Tableau {
    pub(super) M: DMatrix<f64>,
    /// Columns of δẋ.
    pub(super) rates: Range<usize>,
    /// Columns of δx.
    pub(super) states: Range<usize>,
    /// Columns of the algebraic states.
    pub(super) algebraic: Range<usize>,
    /// Columns of the multipliers.
    pub(super) multipliers: Range<usize>,
    /// Columns of δu.
    pub(super) inputs: Range<usize>,
    /// Columns of the cyclic coordinates.
    pub(super) cyclic: Range<usize>,
    /// Rows of the outputs.
    pub(super) outputs: Range<usize>,
    /// Rows of the algebraic unknowns themselves.
    pub(super) inner: Range<usize>,
    /// Typical magnitude of every column.
    column_scale: Vec<f64>,
    /// Typical magnitude of the equations.
    row_scale: Vec<f64>,
}

/// The range of a length after another one.
fn after(before: &Range<usize>, length: usize) -> Range<usize> {
    before.end..before.end + length
}

impl Tableau {
    /// Differentiates along every unknown, rate and input; returns the residual too.
    pub(super) fn at(plant: &mut dyn Plant, at: At<'_>, layout: &Layout) -> Result<(Self, Vec<f64>), EvalError> {
        let (nf, nz, nu) = (plant.equations().len(), plant.outputs().len(), plant.inputs().len());
        let nx = layout.differential.len();
        let rates = 0..nx;
        let states = after(&rates, nx);
        let algebraic = after(&states, layout.algebraic.len());
        let multipliers = after(&algebraic, layout.multipliers.len());
        let inputs = after(&multipliers, nu);
        let cyclic = after(&inputs, layout.cyclic.len());
        let unknowns = [
            (&states, &layout.differential),
            (&algebraic, &layout.algebraic),
            (&multipliers, &layout.multipliers),
            (&cyclic, &layout.cyclic),
        ];

        let mut seeds = Seeds::zeros(plant.unknowns().len(), nu, cyclic.end);
        let mut column_scale = vec![1.0; cyclic.end];
        for (column, &i) in layout.differential.iter().enumerate() {
            seeds.yd[(i, column)] = 1.0;
            column_scale[column] = plant.unknowns()[i].nominal;
        }
        for (columns, indices) in unknowns {
            for (column, &i) in columns.clone().zip(indices) {
                seeds.y[(i, column)] = 1.0;
                column_scale[column] = plant.unknowns()[i].nominal;
            }
        }
        for (i, column) in inputs.clone().enumerate() {
            seeds.u[(i, column)] = 1.0;
            column_scale[column] = plant.inputs()[i].nominal;
        }
        let (mut f, mut z) = (vec![0.0; nf], vec![0.0; nz]);
        let (mut df, mut dz) = (Matrix::zeros(nf, cyclic.end), Matrix::zeros(nz, cyclic.end));
        plant.along(at, &seeds, (&mut f, &mut z), &mut df, &mut dz)?;

        let outputs = nf..nf + nz;
        let inner = after(&outputs, algebraic.len() + multipliers.len());
        let mut M = DMatrix::zeros(inner.end, cyclic.end);
        M.rows_mut(0, nf).copy_from_slice(df.as_slice());
        M.rows_mut(nf, nz).copy_from_slice(dz.as_slice());
        for (row, column) in inner.clone().zip(algebraic.start..) {
            M[(row, column)] = 1.0;
        }
        let row_scale = plant.equations().iter().map(|e| e.nominal).collect();
        Ok((Self { M, rates, states, algebraic, multipliers, inputs, cyclic, outputs, inner, column_scale, row_scale }, f))
    }

    /// Some rows and a range of columns.
    pub(super) fn block(&self, rows: &[usize], columns: &Range<usize>) -> DMatrix<f64> {
        self.M.columns_range(columns.clone()).select_rows(rows)
    }

    /// Entry of an equation in units of its scales.
    pub(super) fn scaled(&self, row: usize, column: usize) -> f64 {
        self.M[(row, column)] * self.column_scale[column] / self.row_scale[row]
    }

    /// Typical magnitude of a differential unknown.
    pub(super) fn state_scale(&self, k: usize) -> f64 {
        self.column_scale[self.states.start + k]
    }

    /// The first entry of some rows and columns that is more than rounding.
    fn first_entry(&self, rows: impl Iterator<Item = usize>, columns: Range<usize>) -> Option<(usize, usize)> {
        rows.flat_map(|row| columns.clone().map(move |column| (row, column)))
            .find(|&(row, column)| self.scaled(row, column).abs() > ROUNDING)
    }

    /// Nothing but the rates of cyclic coordinates may depend on cyclic coordinates.
    pub(super) fn check_cyclic(&self, plant: &dyn Plant, layout: &Layout) -> Result<(), LinearizeError> {
        let rows = (0..plant.equations().len()).filter(|row| !layout.cyclic_rows.contains(row));
        match self.first_entry(rows, self.cyclic.clone()) {
            None => Ok(()),
            Some((row, column)) => Err(LinearizeError::NotCyclic {
                signal: plant.unknowns()[layout.cyclic[column - self.cyclic.start]].signal.name.clone(),
                equation: plant.equations()[row].name.clone(),
            }),
        }
    }

    /// Constraints may depend on coordinates and velocities only (and on inputs, see [`Tableau::bound_inputs`]).
    pub(super) fn check_constraints(&self, plant: &dyn Plant, layout: &Layout) -> Result<(), LinearizeError> {
        let wrong = |row: usize, what: String| {
            let because = format!("the {} depends on {what}", plant.equations()[row].name);
            Err(LinearizeError::Formulation { because })
        };
        if let Some((row, column)) = self.first_entry(layout.constraints().into_iter(), self.rates.clone()) {
            return wrong(row, format!("the rate of `{}`", plant.unknowns()[layout.differential[column]].signal.name));
        }
        let inner = self.algebraic.start..self.multipliers.end;
        if let Some((row, column)) = self.first_entry(layout.constraints().into_iter(), inner.clone()) {
            let unknown = layout.algebraic.iter().chain(&layout.multipliers).nth(column - inner.start);
            return wrong(row, unknown.map_or_else(String::new, |&i| format!("`{}`", plant.unknowns()[i].signal.name)));
        }
        Ok(())
    }

    /// Inputs that move a constraint, each with the first one that it moves.
    pub(super) fn bound_inputs(&self, plant: &dyn Plant, layout: &Layout) -> Vec<(usize, usize)> {
        let moved = |i: usize| self.first_entry(layout.constraints().into_iter(), self.inputs.start + i..self.inputs.start + i + 1);
        (0..plant.inputs().len()).filter_map(|i| moved(i).map(|(row, _)| (i, row))).collect()
    }

    /// The cyclic coordinate that an output depends on, if there is one.
    pub(super) fn output_sees_cyclic(&self, output: usize) -> Option<usize> {
        let entry = |column: usize| (self.M[(self.outputs.start + output, column)] * self.column_scale[column]).abs();
        let largest = (0..self.cyclic.end).map(entry).fold(0.0, f64::max);
        self.cyclic.clone().find(|&column| entry(column) > ROUNDING * largest + 1e-12).map(|column| column - self.cyclic.start)
    }

    /// For every coordinate among the differential unknowns the velocity that its rate depends on most.
    pub(super) fn pairs(&self, layout: &Layout, plant: &dyn Plant) -> Vec<Option<usize>> {
        let kind = |k: usize| plant.unknowns()[layout.differential[k]].kind;
        let n = layout.differential.len();
        let rate_of = |k: usize| {
            let share = |j: &usize| self.scaled(layout.rows[k], self.states.start + j).abs();
            let velocities = (0..n).filter(|&j| kind(j) == UnknownKind::Velocity);
            velocities.max_by(|a, b| share(a).total_cmp(&share(b))).filter(|j| share(j) > 0.0)
        };
        (0..n).map(|k| if kind(k) == UnknownKind::Position { rate_of(k) } else { None }).collect()
    }

    /// Puts `Σ share δx` in place of a differential unknown, and the same for the rates: to be removed afterwards.
    pub(super) fn express(&mut self, unknown: usize, shares: &[(usize, f64)]) {
        for part in [self.rates.start, self.states.start] {
            let column = self.M.column(part + unknown).into_owned();
            for &(k, share) in shares {
                self.M.column_mut(part + k).axpy(share, &column, 1.0);
            }
        }
    }

    /// Removes differential unknowns and their rates.
    pub(super) fn remove(&mut self, unknowns: &[usize]) {
        let (rates, states) = (self.rates.start, self.states.start);
        let gone = |column: usize| unknowns.iter().any(|k| column == rates + k || column == states + k);
        let kept: Vec<usize> = (0..self.M.ncols()).filter(|&column| !gone(column)).collect();
        self.M = self.M.select_columns(&kept);
        self.column_scale = kept.iter().map(|&column| self.column_scale[column]).collect();
        self.rates = 0..self.rates.len() - unknowns.len();
        self.states = after(&self.rates, self.states.len() - unknowns.len());
        self.algebraic = after(&self.states, self.algebraic.len());
        self.multipliers = after(&self.algebraic, self.multipliers.len());
        self.inputs = after(&self.multipliers, self.inputs.len());
        self.cyclic = after(&self.inputs, self.cyclic.len());
    }

    /// Expresses columns by the rows that determine them: `M ← M − M[:, c] M[r, c]⁻¹ M[r, :]`.
    ///
    /// # Errors
    /// The columns (counted from the first of these) that the rows do not determine, largest share first.
    pub(super) fn eliminate(&mut self, rows: &[usize], columns: Range<usize>) -> Result<(), Vec<usize>> {
        if columns.is_empty() {
            return Ok(());
        }
        let block = self.block(rows, &columns);
        let expressed = solve(&block, &self.M.select_rows(rows), &self.column_scale[columns.clone()])?;
        let by = self.M.columns_range(columns).into_owned();
        self.M -= by * expressed;
        Ok(())
    }
}

/// Solves `block · x = right` on equilibrated rows and scaled columns.
///
/// # Errors
/// The columns with a share in the direction that the rows do not determine, largest first.
pub(super) fn solve(block: &DMatrix<f64>, right: &DMatrix<f64>, column_scale: &[f64]) -> Result<DMatrix<f64>, Vec<usize>> {
    let (mut block, mut right) = (block.clone(), right.clone());
    if block.is_empty() {
        return Ok(right);
    }
    for (mut column, scale) in block.column_iter_mut().zip(column_scale) {
        column *= *scale;
    }
    for (mut row, mut other) in block.row_iter_mut().zip(right.row_iter_mut()) {
        let largest = row.amax();
        if largest > 0.0 {
            row /= largest;
            other /= largest;
        }
    }
    // far from singular, singular values have nothing to add
    if condition(&block) < 1e9 {
        right = block.lu().solve(&right).ok_or_else(Vec::new)?;
        scale_rows(&mut right, column_scale);
        return Ok(right);
    }
    // 1e-13: what rounding leaves of a singular matrix of some tens of rows
    let svd = block.clone().svd(false, true);
    let largest = svd.singular_values.iter().fold(0.0, |a: f64, b| a.max(*b));
    let smallest = (0..block.ncols()).min_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b]));
    let determined = smallest.is_none_or(|k| svd.singular_values[k] > 1e-13 * largest);
    match block.lu().solve(&right).filter(|_| determined) {
        Some(mut solution) => {
            scale_rows(&mut solution, column_scale);
            Ok(solution)
        }
        None => Err(shares(svd.v_t.as_ref().zip(smallest).map(|(v, k)| v.row(k).iter().copied().collect()).unwrap_or_default())),
    }
}

fn scale_rows(solution: &mut DMatrix<f64>, scale: &[f64]) {
    for (mut row, scale) in solution.row_iter_mut().zip(scale) {
        row *= *scale;
    }
}

/// Indices of the entries above a twentieth, largest first.
fn shares(direction: Vec<f64>) -> Vec<usize> {
    let mut shares: Vec<usize> = (0..direction.len()).filter(|&k| direction[k].abs() > 0.05).collect();
    shares.sort_by(|&a, &b| direction[b].abs().total_cmp(&direction[a].abs()));
    shares.truncate(6);
    shares
}
