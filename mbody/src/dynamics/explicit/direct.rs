//! Accelerations and multipliers from the mass matrix and the Jacobian of the constraints.
//!
//! ```text
//! [ M  −Jᵀ ] [ v̇ ]   [ −F₀ ]          F₀ = RNEA(q, v, 0) − τ,   γ = rates of the rows with v̇ = 0
//! [ J   0  ] [ λ ] = [ −γ  ]
//! ```
//!
//! M comes from CRBA, J from the wrenches of unit multipliers. For systems without element states whose forces depend neither on
//! accelerations nor on multipliers. Source: E. J. Haug (1989), section 11.2.

use super::super::closure::{least_norm, tree_row};
use super::super::{System, TreePlant};
use crate::algorithm::crba::crba;
use nalgebra::{DMatrix, DVector};
use problem::{At, EvalError};

/// Work arrays of the symmetric form.
pub(super) struct Direct {
    tree_mass: Vec<f64>,
    tree_row: Vec<f64>,
    half: DMatrix<f64>,
    row: Vec<f64>,
    pub(super) matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Direct {
    pub(super) fn new(system: &System) -> Self {
        let (tree, nv, m) = (system.model.layout.tree_nv, system.model.layout.nv(), system.multipliers.len());
        Self {
            tree_mass: vec![0.0; tree * tree],
            tree_row: vec![0.0; tree],
            half: DMatrix::zeros(nv, tree),
            row: vec![0.0; nv],
            matrix: DMatrix::zeros(nv + m, nv + m),
            right: DVector::zeros(nv + m),
        }
    }

    /// Writes the mass matrix of the independent velocities at the last evaluated point of the plant.
    pub(super) fn mass(&mut self, plant: &mut TreePlant) {
        let system = plant.system().clone();
        let layout = &system.model.layout;
        let tree = &mut plant.evaluation_mut().tree;
        crba(&system.model, &tree.position, &mut tree.composite, &mut self.tree_mass);
        let (n, nv) = (layout.tree_nv, layout.nv());
        // Zᵀ M Z: rows first, then columns
        for j in 0..n {
            self.tree_row.copy_from_slice(&self.tree_mass[j * n..(j + 1) * n]);
            layout.reduce(&mut self.tree_row, &mut self.row);
            self.half.column_mut(j).copy_from_slice(&self.row);
        }
        for i in 0..nv {
            self.tree_row.iter_mut().zip(self.half.row(i).iter()).for_each(|(t, h)| *t = *h);
            layout.reduce(&mut self.tree_row, &mut self.row);
            for (j, entry) in self.row.iter().enumerate() {
                self.matrix[(i, j)] = *entry;
            }
        }
    }

    pub(super) fn solve(
        &mut self,
        plant: &mut TreePlant,
        still: &[f64],
        time: f64,
        y: &mut [f64],
        u: &[f64],
        yd: &mut [f64],
    ) -> Result<(), EvalError> {
        let system = plant.system().clone();
        let (nq, nv, m) = (system.model.layout.nq(), system.model.layout.nv(), system.multipliers.len());
        y[nq + nv..].fill(0.0);
        plant.residual_at(At { time, y, yd: still, u });
        self.mass(plant);
        // multipliers in units in which J is as large as M
        let scale = self.matrix.view((0, 0), (nv, nv)).amax().max(1e-300);
        let e = plant.evaluation_mut();
        for (k, multiplier) in system.multipliers.iter().enumerate() {
            let constraint = &system.constraints[multiplier.constraint];
            let first: usize = system.constraints[..multiplier.constraint].iter().map(|c| c.rows().len()).sum();
            let at = first + multiplier.row;
            let X_FM = &e.poses[multiplier.constraint];
            tree_row(&system.model, &e.tree, constraint, X_FM, e.directions[at], &mut self.tree_row);
            system.model.layout.reduce(&mut self.tree_row, &mut self.row);
            for (j, entry) in self.row.iter().enumerate() {
                self.matrix[(nv + k, j)] = scale * entry;
                self.matrix[(j, nv + k)] = -scale * entry;
            }
            self.right[nv + k] = -scale * e.rows[at].acceleration;
        }
        for i in 0..nv {
            self.right[i] = -e.residual[nq + i];
        }
        for (rate, residual) in yd.iter_mut().zip(&e.residual[..nq]) {
            *rate = -residual;
        }
        if let Some(bad) = self.right.iter().position(|x| !x.is_finite()) {
            return Err(EvalError::Recoverable { equation: nq + bad });
        }
        let x = solve_regular(&self.matrix, &self.right).ok_or(EvalError::Recoverable { equation: nq })?;
        yd[nq..nq + nv].copy_from_slice(&x.as_slice()[..nv]);
        for k in 0..m {
            y[nq + nv + k] = scale * x[nv + k];
            yd[nq + nv + k] = 0.0;
        }
        Ok(())
    }
}

/// Solves a square system; the shortest solution where it is singular (in a singular position of a mechanism).
fn solve_regular(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let good = |x: &DVector<f64>| {
        let size = matrix.amax() * x.amax() + right.amax();
        (matrix * x - right).amax() <= 1e-9 * size && size.is_finite()
    };
    if let Some(x) = matrix.clone().lu().solve(right).filter(good) {
        return Some(x);
    }
    Some(least_norm(matrix.clone(), right, &[])).filter(|x| x.iter().all(|x| x.is_finite()))
}
