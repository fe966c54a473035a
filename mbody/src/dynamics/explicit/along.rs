//! Derivatives of the explicit form, from those of the residual and one factorization.
//!
//! With x = (v̇, ṡ, λ) and F(y, x, u) = 0 in the formulation of accelerations, `∂x = −(∂F/∂x)⁻¹ (∂F/∂y ∂y + ∂F/∂u ∂u)`; rates of coordinates
//! follow from their own rows. The theorem of implicit functions: W. Rudin, *Principles of Mathematical Analysis* (1976), theorem 9.28.

use super::super::TreePlant;
use nalgebra::DMatrix;
use problem::{At, Dae, Differentiable, EvalError, Matrix, Seeds};

/// Work arrays for the number of directions asked for last.
pub(super) struct Along {
    /// Typical magnitudes of the rows and of x.
    rows: Vec<f64>,
    columns: Vec<f64>,
    seeds: Seeds,
    residual: Vec<f64>,
    outputs: Vec<f64>,
    d_residual: Matrix,
    d_outputs: Matrix,
    right: DMatrix<f64>,
}

impl Along {
    pub(super) fn new(plant: &TreePlant) -> Self {
        let first = plant.system().model.layout.nq();
        Self {
            rows: plant.equations()[first..].iter().map(|e| e.nominal).collect(),
            columns: plant.unknowns()[first..].iter().map(|k| k.nominal).collect(),
            seeds: Seeds::zeros(0, 0, 0),
            residual: vec![0.0; plant.equations().len()],
            outputs: vec![0.0; plant.system().outputs.len()],
            d_residual: Matrix::zeros(0, 0),
            d_outputs: Matrix::zeros(0, 0),
            right: DMatrix::zeros(0, 0),
        }
    }

    /// Room for so many directions, followed by one per entry of x where ∂F/∂x is not known otherwise.
    fn room(&mut self, plant: &TreePlant, given: usize, solved: usize) {
        if (self.right.ncols(), self.seeds.columns()) == (given, given + solved) {
            return;
        }
        let (n, first) = (plant.unknowns().len(), plant.system().model.layout.nq());
        self.seeds = Seeds::zeros(n, plant.inputs().len(), given + solved);
        for (j, i) in (first..n).take(solved).enumerate() {
            match plant.unknowns()[i].differential {
                true => self.seeds.yd[(i, given + j)] = 1.0,
                false => self.seeds.y[(i, given + j)] = 1.0,
            }
        }
        self.d_residual = Matrix::zeros(n, given + solved);
        self.d_outputs = Matrix::zeros(self.outputs.len(), given + solved);
        self.right = DMatrix::zeros(n - first, given);
    }

    /// Writes the derivatives along all seeds; `mass` is ∂F/∂x where that is known.
    pub(super) fn solve(
        &mut self,
        plant: &mut TreePlant,
        at: At<'_>,
        seeds: &Seeds,
        mass: Option<&DMatrix<f64>>,
        solved: &mut Matrix,
    ) -> Result<(), EvalError> {
        let (n, first, given) = (plant.unknowns().len(), plant.system().model.layout.nq(), seeds.columns());
        self.room(plant, given, if mass.is_some() { 0 } else { n - first });
        for k in 0..given {
            for i in (0..n).filter(|&i| plant.unknowns()[i].differential) {
                self.seeds.y[(i, k)] = seeds.y[(i, k)];
            }
            self.seeds.u.column_mut(k).copy_from_slice(seeds.u.column(k));
        }
        let at = At { y: &at.y[..n], yd: &at.yd[..n], ..at };
        plant.along(at, &self.seeds, (&mut self.residual, &mut self.outputs), &mut self.d_residual, &mut self.d_outputs)?;
        let (d, rows, columns) = (&self.d_residual, &self.rows, &self.columns);
        let matrix = DMatrix::from_fn(n - first, n - first, |i, j| {
            let entry = mass.map_or_else(|| d[(first + i, given + j)], |mass| mass[(i, j)]);
            entry * columns[j] / rows[i]
        });
        for k in 0..given {
            for (i, row) in rows.iter().enumerate() {
                self.right[(i, k)] = -d[(first + i, k)] / row;
            }
        }
        if !matrix.lu().solve_mut(&mut self.right) || self.right.iter().any(|x| !x.is_finite()) {
            return Err(EvalError::Recoverable { equation: first });
        }
        solved.fill(0.0);
        for k in 0..given {
            let column = solved.column_mut(k);
            for i in 0..first {
                column[i] = -d[(i, k)];
            }
            for (j, unit) in columns.iter().enumerate() {
                column[first + j] = self.right[(j, k)] * unit;
            }
        }
        Ok(())
    }
}
