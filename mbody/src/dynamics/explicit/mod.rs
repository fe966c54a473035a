//! The explicit form: accelerations, multipliers and rates of element states from coordinates, velocities and states.
//!
//! Trees without states by the articulated-body algorithm; systems with constraints and without states by mass matrix and Jacobian; all others,
//! and those whose elements depend on accelerations or multipliers, by Newton's method with exact derivatives, rows of elements included.
//! Source: Featherstone (2008), section 8.2; E. J. Haug (1989), section 11.2.

mod along;
mod articulated;
mod direct;
mod newton;

use super::evaluation::Known;
use super::{Formulation, System, TreePlant};
use along::Along;
use direct::Direct;
use newton::Newton;
use problem::{At, Dae, EvalError, Matrix, Seeds};
use std::sync::Arc;

/// Solves for what an explicit method needs. Owns a plant in the formulation of accelerations.
pub(super) struct ExplicitSolver {
    plant: TreePlant,
    way: Way,
    /// Rates that are zero where accelerations are.
    still: Vec<f64>,
    /// Work arrays of derivatives, made when they are first needed.
    along: Option<Box<Along>>,
}

/// How accelerations are found.
enum Way {
    /// The articulated-body algorithm; the mass matrix for derivatives only.
    Articulated(Box<Direct>),
    /// Mass matrix and Jacobian of the constraints.
    Direct(Box<Direct>),
    /// Newton's method on all rows.
    Newton(Box<Newton>),
}

impl ExplicitSolver {
    pub(super) fn new(system: &Arc<System>) -> Self {
        let mut plant = TreePlant::in_formulation(system.clone(), Formulation::Acceleration { decay: 0.0 });
        let reads = system.elements.iter().any(|e| !e.multipliers.is_empty());
        let way = match system.state_count == 0 && !reads && !depends_on_accelerations(&mut plant) {
            true if articulated::applies(system) => Way::Articulated(Box::new(Direct::new(system))),
            true => Way::Direct(Box::new(Direct::new(system))),
            false => Way::Newton(Box::new(Newton::new(&plant))),
        };
        let still = vec![0.0; plant.unknowns().len()];
        Self { plant, way, still, along: None }
    }

    /// Overwrites the algebraic entries of y (states without a rate, multipliers) and all rates.
    pub(super) fn solve(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let n = self.plant.unknowns().len();
        let (y, rest) = y.split_at_mut(n);
        // multipliers that stabilize are zero on the constraints
        rest.fill(0.0);
        yd[n..].fill(0.0);
        match &mut self.way {
            Way::Articulated(_) => articulated::solve(&mut self.plant, At { time, y, yd: &self.still, u }, &mut yd[..n]),
            Way::Direct(direct) => direct.solve(&mut self.plant, &self.still, time, y, u, &mut yd[..n]),
            Way::Newton(newton) => newton.solve(&mut self.plant, time, y, u, &mut yd[..n]),
        }
    }

    /// Writes the outputs at a point, if it was solved for last.
    pub(super) fn observe_again(&mut self, at: At<'_>, outputs: &mut [f64]) -> bool {
        // of unknowns that only other formulations have, outputs know nothing
        let n = self.plant.unknowns().len();
        let at = At { y: &at.y[..n], yd: &at.yd[..n], ..at };
        let known = self.plant.known_at(at);
        if known == Known::Elements {
            self.plant.observe_at(at, known, outputs);
        }
        known == Known::Elements
    }

    /// Writes derivatives of what [`ExplicitSolver::solve`] overwrites, along all seeds.
    pub(super) fn solve_along(&mut self, at: At<'_>, seeds: &Seeds, solved: &mut Matrix) -> Result<(), EvalError> {
        let along = self.along.get_or_insert_with(|| Box::new(Along::new(&self.plant)));
        let mass = match &mut self.way {
            Way::Articulated(direct) => {
                let n = self.plant.unknowns().len();
                self.plant.evaluate_at(At { y: &at.y[..n], yd: &self.still, ..at });
                direct.mass(&mut self.plant);
                Some(&direct.matrix)
            }
            Way::Direct(_) | Way::Newton(_) => None,
        };
        along.solve(&mut self.plant, at, seeds, mass, solved)
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
