//! Accelerations of the bicycle rolling without slip, from the explicit form of the whole system.

use super::signs::basu_mandal;
use mbody::dynamics::{Formulation, TreePlant};
use problem::{At, Dae, Explicit, Projection};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::instant::Instant;
use validation::tree::Named;
use validation::vehicle::Vehicle;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    accelerations_of_a_published_state_are_met => (
        "`whipple`: nine accelerations of the bicycle at a general state, contact forces eliminated",
        "Basu-Mandal et al. (2007), table 1",
        "1e-10 of 10: thirteen printed digits of state and accelerations"
    ),
    wheels_carry_the_weight_at_rest => (
        "`whipple`: loads of both wheels, upright",
        "statics from the parameters of Meijaard et al. (2007)",
        "1e-10 N: double precision"
    ),
];

/// Values by name in the order of the unknowns; the others are zero.
fn placed(plant: &TreePlant, values: &[Named]) -> Vec<f64> {
    let mut y = vec![0.0; plant.unknowns().len()];
    for (name, value) in values {
        let at = plant.unknowns().iter().position(|u| u.signal.name == *name).unwrap_or_else(|| panic!("no unknown `{name}`"));
        y[at] = *value;
    }
    y
}

#[test]
fn accelerations_of_a_published_state_are_met() {
    let mut plant = TreePlant::in_formulation(Vehicle::bundled("whipple").system, Formulation::Ggl);
    let motion = basu_mandal();
    let mut y = placed(&plant, &[motion.coordinates, motion.velocities].concat());
    let before = y.clone();
    plant.project(0.0, &mut y, &[0.0], &[]).expect("the published state rolls");
    let mut agreement = Agreement::on("whipple: accelerations of Basu-Mandal");
    let digits = absolute(1e-11).because("thirteen printed digits");
    agreement.all_near("the projection leaves the state", &y, &before, &digits);
    let mut yd = vec![0.0; y.len()];
    plant.solve_rates(0.0, &mut y, &[0.0], &mut yd).expect("accelerations");
    let printed = absolute(1e-10).because("thirteen printed digits of state and accelerations, amplified by the mass matrix");
    for (name, expected) in motion.accelerations {
        let at = plant.unknowns().iter().position(|u| u.signal.name == name).expect("a velocity");
        agreement.near(name, yd[at], expected, &printed);
    }
    // multipliers and rates satisfy the residual in every formulation
    let mut residual = vec![0.0; plant.equations().len()];
    plant.residual(At { time: 0.0, y: &y, yd: &yd, u: &[0.0] }, &mut residual).expect("a residual");
    agreement.all_near("residual", &residual, &vec![0.0; residual.len()], &absolute(1e-9).because("rounding of forces up to 1e3 N"));
    agreement.assert();
}

#[test]
fn wheels_carry_the_weight_at_rest() {
    let bicycle = Instant::of("whipple");
    // 85, 4, 3 kg at 0.3, 0.9, 1.02 m of 1.02 m
    let front = 9.81 * (85.0 * 0.3 + 4.0 * 0.9 + 3.0 * 1.02) / 1.02;
    let mut agreement = Agreement::on("whipple: static loads");
    let double = absolute(1e-10).because("double precision");
    agreement.near("front", bicycle.get("front_contact.normal_force"), front, &double);
    agreement.near("rear", bicycle.get("rear_contact.normal_force"), 94.0 * 9.81 - front, &double);
    agreement.assert();
}
