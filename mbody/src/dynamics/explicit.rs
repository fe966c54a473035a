//! The explicit form: accelerations, multipliers and rates of element states from coordinates, velocities and states.
//!
//! ```text
//! [ M  −Jᵀ ] [ v̇ ]   [ −F₀ ]          F₀ = RNEA(q, v, 0) − τ,   γ = rates of the rows with v̇ = 0
//! [ J   0  ] [ λ ] = [ −γ  ]
//! ```
//!
//! Without element states, and where no element depends on accelerations or multipliers, M comes from CRBA and J from the wrenches of unit
//! multipliers. Else the whole is solved by Newton's method with exact derivatives, rows of elements included.
//! Source: Featherstone (2008), section 8.2; E. J. Haug (1989), section 11.2.

use super::closure::{least_norm, tree_row};
use super::{Formulation, System, TreePlant};
use crate::algorithm::crba::crba;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use problem::{At, Dae, Differentiable, EvalError, Matrix, Seeds};
use std::sync::Arc;

/// Scaled step at which Newton's method has converged.
const CONVERGED: f64 = 1e-13;
/// Scaled step below which rounding may be all that is left: stiff rows move accelerations by much for little.
const ROUNDING: f64 = 1e-9;
/// Most iterations.
const MOST_ITERATIONS: usize = 40;
/// Share of the step before to which a kept matrix must reduce the next one.
const FAST: f64 = 0.05;

/// Solves for what an explicit method needs. Owns a plant in the formulation of accelerations.
pub(super) struct ExplicitSolver {
    plant: TreePlant,
    way: Way,
    /// Rates that are zero where accelerations are.
    still: Vec<f64>,
}

/// How accelerations are found.
enum Way {
    /// Mass matrix and Jacobian of the constraints.
    Direct(Box<Direct>),
    /// Newton's method on all rows.
    Newton(Box<Newton>),
}

struct Direct {
    tree_mass: Vec<f64>,
    tree_row: Vec<f64>,
    row: Vec<f64>,
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

struct Newton {
    /// Typical magnitudes of the rows and of what is solved for.
    rows: Vec<f64>,
    columns: Vec<f64>,
    /// Derivatives at some earlier point, in these, and their factors.
    matrix: DMatrix<f64>,
    factors: Option<LU<f64, Dyn, Dyn>>,
    right: DVector<f64>,
    x: DVector<f64>,
    off: DVector<f64>,
    seeds: Seeds,
    residual: Vec<f64>,
    outputs: Vec<f64>,
    d_residual: Matrix,
    d_outputs: Matrix,
}

impl ExplicitSolver {
    pub(super) fn new(system: &Arc<System>) -> Self {
        let mut plant = TreePlant::in_formulation(system.clone(), Formulation::Acceleration { decay: 0.0 });
        let reads = system.elements.iter().any(|e| !e.multipliers.is_empty());
        let way = match system.state_count == 0 && !reads && !depends_on_accelerations(&mut plant) {
            true => Way::Direct(Box::new(Direct::new(system))),
            false => Way::Newton(Box::new(Newton::new(&plant))),
        };
        let still = vec![0.0; plant.unknowns().len()];
        Self { plant, way, still }
    }

    /// Overwrites the algebraic entries of y (states without a rate, multipliers) and all rates.
    pub(super) fn solve(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let n = self.plant.unknowns().len();
        let (y, rest) = y.split_at_mut(n);
        // multipliers that stabilize are zero on the constraints
        rest.fill(0.0);
        yd[n..].fill(0.0);
        match &mut self.way {
            Way::Direct(direct) => direct.solve(&mut self.plant, &self.still, time, y, u, &mut yd[..n]),
            Way::Newton(newton) => newton.solve(&mut self.plant, time, y, u, &mut yd[..n]),
        }
    }
}

/// Whether an element's forces depend on accelerations: the mass matrix from derivatives is not that of the tree.
fn depends_on_accelerations(plant: &mut TreePlant) -> bool {
    let system = plant.system().clone();
    let layout = &system.model.layout;
    let (nq, nv, n) = (layout.nq(), layout.nv(), plant.unknowns().len());
    let mut newton = Newton::new(plant);
    let spread = |i: usize| ((i + 1) as f64 * 0.618_034).fract() - 0.5;
    let y: Vec<f64> =
        plant.unknowns().iter().enumerate().map(|(i, k)| k.design + if i < nq + nv { 0.1 * k.nominal * spread(i) } else { 0.0 }).collect();
    let u: Vec<f64> = plant.inputs().iter().map(|i| i.default).collect();
    if newton.derivatives(plant, At { time: 0.0, y: &y, yd: &vec![0.0; n], u: &u }).is_err() {
        return true;
    }
    let mut direct = Direct::new(&system);
    plant.evaluate_at(At { time: 0.0, y: &y, yd: &vec![0.0; n], u: &u });
    direct.mass(plant);
    let largest = direct.matrix.amax().max(1e-12);
    (0..nv).any(|i| (0..nv).any(|j| (direct.matrix[(i, j)] - newton.d_residual[(nq + i, j)]).abs() > 1e-9 * largest))
}

impl Direct {
    fn new(system: &System) -> Self {
        let (tree, nv, m) = (system.model.layout.tree_nv, system.model.layout.nv(), system.multipliers.len());
        Self {
            tree_mass: vec![0.0; tree * tree],
            tree_row: vec![0.0; tree],
            row: vec![0.0; nv],
            matrix: DMatrix::zeros(nv + m, nv + m),
            right: DVector::zeros(nv + m),
        }
    }

    /// Writes the mass matrix of the independent velocities at the last evaluated point of the plant.
    fn mass(&mut self, plant: &mut TreePlant) {
        let system = plant.system().clone();
        let layout = &system.model.layout;
        let tree = &mut plant.evaluation_mut().tree;
        crba(&system.model, &tree.position, &mut tree.composite, &mut self.tree_mass);
        let (n, nv) = (layout.tree_nv, layout.nv());
        // Zᵀ M Z: rows first, then columns
        let mut half = DMatrix::zeros(nv, n);
        for j in 0..n {
            self.tree_row.copy_from_slice(&self.tree_mass[j * n..(j + 1) * n]);
            layout.reduce(&mut self.tree_row, &mut self.row);
            half.column_mut(j).copy_from_slice(&self.row);
        }
        for i in 0..nv {
            self.tree_row.iter_mut().zip(half.row(i).iter()).for_each(|(t, h)| *t = *h);
            layout.reduce(&mut self.tree_row, &mut self.row);
            for (j, entry) in self.row.iter().enumerate() {
                self.matrix[(i, j)] = *entry;
            }
        }
    }

    fn solve(
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
        plant.evaluate_at(At { time, y, yd: still, u });
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

impl Newton {
    /// Columns: accelerations, then for each state its rate (or its value, where it has none), then multipliers.
    fn new(plant: &TreePlant) -> Self {
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

    fn derivatives(&mut self, plant: &mut TreePlant, at: At<'_>) -> Result<(), EvalError> {
        plant.along(at, &self.seeds, (&mut self.residual, &mut self.outputs), &mut self.d_residual, &mut self.d_outputs)
    }

    /// Newton's method with the matrix of an earlier point as long as that converges fast: accelerations enter linearly, rates of states nearly so.
    fn solve(&mut self, plant: &mut TreePlant, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let (first, n) = (plant.system().model.layout.nq(), y.len());
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let at = At { time, y, yd, u };
            match self.factors {
                Some(_) => self.residual.copy_from_slice(&plant.evaluate_at(at).residual),
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
            // beside convergence: small steps that shrink no more are rounding
            if longest <= CONVERGED || (longest <= ROUNDING && longest > 0.5 * before) {
                break;
            }
            // a matrix that does not take off a digit and a half is that of another point
            if longest.is_nan() || size.is_nan() || longest > FAST * before {
                self.factors = None;
            }
            before = longest;
        }
        let at = At { time, y, yd, u };
        self.residual.copy_from_slice(&plant.evaluate_at(at).residual);
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
