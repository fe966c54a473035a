//! Energies, powers and errors of constraints along a motion, in all forms alike.

use crate::output::Recording;
use analyses::transient::{Drift, Worst};
use mbody::dynamics::{Formulation, System, TreePlant};
use problem::{At, Dae, EquationKind, Off, Outputs, Signal};
use std::io;
use std::sync::Arc;

/// The total energy, beside the signals of the plant.
pub const ENERGY: &str = "system.energy";
/// Power that comes in through elements.
pub const SUPPLIED: &str = "system.power_in";
/// Power that elements turn into heat.
pub const DISSIPATED: &str = "system.power_dissipated";

/// The signals beside those of the plant.
pub fn signals() -> [Signal; 3] {
    [
        Signal::new(ENERGY, "J", "total energy: of motion, of gravity, stored in elements"),
        Signal::new(SUPPLIED, "W", "power that comes in from outside through elements: torques of engine and rider, a moving road, wind"),
        Signal::new(DISSIPATED, "W", "power that elements turn into heat"),
    ]
}

/// What was computed at every sample.
pub struct Accounts {
    /// Energy, power supplied, power dissipated.
    pub columns: [Vec<f64>; 3],
    /// The largest errors of the constraints on coordinates and on velocities.
    pub drift: Drift,
}

/// Goes through a recording of the unknowns of the system, then their rates, then all inputs.
///
/// # Errors
/// The recording cannot be read.
pub fn account(recording: &Recording, system: &Arc<System>) -> io::Result<Accounts> {
    let mut plant = TreePlant::in_formulation(system.clone(), Formulation::Ggl);
    let (size, n, nu) = (plant.unknowns().len(), system.unknowns().len(), system.inputs().len());
    let (mut y, mut yd, mut u) = (vec![0.0; size], vec![0.0; size], vec![0.0; nu]);
    let (mut residual, mut outputs) = (vec![0.0; size], vec![0.0; plant.outputs().len()]);
    let mut accounts = Accounts { columns: Default::default(), drift: Drift::default() };
    recording.rows(|time, row| {
        y[..n].copy_from_slice(&row[..n]);
        yd[..n].copy_from_slice(&row[n..2 * n]);
        u.copy_from_slice(&row[2 * n..2 * n + nu]);
        let at = At { time, y: &y, yd: &yd, u: &u };
        let account = plant.account_at(at);
        let energy = account.kinetic + account.gravity + account.elements.stored;
        for (column, value) in accounts.columns.iter_mut().zip([energy, account.elements.supplied, account.elements.dissipated]) {
            column.push(value);
        }
        let _ = plant.evaluate(at, &mut residual, &mut outputs);
        for (row, &by) in plant.equations().iter().zip(&residual) {
            let worst = match row.kind {
                EquationKind::Constraint => &mut accounts.drift.position,
                EquationKind::VelocityConstraint => &mut accounts.drift.velocity,
                _ => continue,
            };
            if by.is_finite() && worst.as_ref().is_none_or(|w: &Worst| by.abs() > w.off.by) {
                let off = Off { row: row.name.clone(), by: by.abs(), unit: row.unit.to_string() };
                *worst = Some(Worst { off, time });
            }
        }
        Ok(())
    })?;
    Ok(accounts)
}
