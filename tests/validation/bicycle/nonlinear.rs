//! One published state of the bicycle: the accelerations that follow from it.

use super::signs::basu_mandal;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::instant::Instant;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    accelerations_of_basu_mandal_are_met => (
        "`whipple`: all nine accelerations in a state of large lean, steer and rates",
        "Basu-Mandal, Chatterjee, Papadopoulos (2007), table 1",
        "1e-11 in SI: thirteen printed digits of the state, divided by the small inertia of the steering"
    ),
    wheels_carry_the_weight_at_rest => (
        "`whipple`: loads of both wheels, upright",
        "statics from the parameters of Meijaard et al. (2007)",
        "1e-10 N: double precision"
    ),
];

#[test]
fn accelerations_of_basu_mandal_are_met() {
    let state = basu_mandal();
    let mut bicycle = Instant::of("whipple");
    bicycle.put(&[state.coordinates, state.velocities].concat());
    let mut agreement = Agreement::on("whipple: accelerations of Basu-Mandal");
    let digits = absolute(1e-11).because("thirteen printed digits of the state over the small inertia of the steering");
    for (name, expected) in state.accelerations {
        agreement.near(name, bicycle.rate(name), expected, &digits);
    }
    agreement.assert();
}

#[test]
fn wheels_carry_the_weight_at_rest() {
    let bicycle = Instant::of("whipple");
    // 85, 4, 2, 3 kg at 0.3, 0.9, 0, 1.02 m of 1.02 m
    let front = 9.81 * (85.0 * 0.3 + 4.0 * 0.9 + 3.0 * 1.02) / 1.02;
    let mut agreement = Agreement::on("whipple: static loads");
    let double = absolute(1e-10).because("double precision");
    agreement.near("front", bicycle.get("front_contact.normal_force"), front, &double);
    agreement.near("rear", bicycle.get("rear_contact.normal_force"), 94.0 * 9.81 - front, &double);
    agreement.assert();
}
