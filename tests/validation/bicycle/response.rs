//! Small oscillations of the bicycle under a steering torque: the frequency response of the linear model against the motion of the nonlinear one.

use super::linear::straight;
use analyses::{Excitation, FrequencyResponse};
use nalgebra::Complex;
use std::f64::consts::TAU;
use validation::agreement::{Agreement, absolute};
use validation::course::{By, Course, system};
use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    small_oscillations_over_time_are_the_frequency_response => (
        "`whipple` at 5 m/s, where it is stable: roll and steer under a steering torque of 0.01 N m that oscillates at 0.3 to 2.4 Hz, by ERK of the \
         nonlinear equations",
        "two routes through the same model: Fourier coefficients of the motion over four periods, linear model",
        "1e-4: small amplitudes (the error of the linear model grows with their square)"
    ),
];

const SPEED: f64 = 5.0;
/// N m.
const TORQUE: f64 = 0.01;
/// The states that answer; the speed does not, to first order.
const STATES: [&str; 4] = ["chassis.roll", "steer.angle", "chassis.roll_rate", "steer.rate"];

#[test]
fn small_oscillations_over_time_are_the_frequency_response() {
    const PERIODS: usize = 4;
    const SAMPLES: usize = 64;
    let states = STATES.map(str::to_owned);
    let torque = [Excitation::input("steer.torque")];
    let mut response = FrequencyResponse::of(&straight(SPEED), &torque, &states).unwrap_or_else(|e| panic!("{e}"));
    let mut agreement = Agreement::on("whipple: frequency response over time");
    let small = absolute(1e-4).because("amplitudes small enough for the linear model; tolerance 1e-10 of the integration");
    for omega in [2.0, 4.5, 8.0, 15.0] {
        let mut answers = [Complex::new(0.0, 0.0); STATES.len()];
        response.at(omega, &mut answers);
        // the motion starts as the forced one, so that nothing has to die away
        let mut start = vec![("chassis.forward_speed", SPEED)];
        start.extend(STATES.iter().zip(&answers).map(|(name, answer)| (*name, TORQUE * answer.re)));
        let period = TAU / omega;
        let times: Vec<f64> = (0..=PERIODS * SAMPLES).map(|k| period * k as f64 / SAMPLES as f64).collect();
        let torque = |time: f64, u: &mut [f64]| u[0] = TORQUE * (omega * time).cos();
        let course = Course::driven(system("whipple"), &start, &times, By::Erk(1e-10, 1e-6), Some(&torque));
        agreement.holds("the end is reached", course.simulation.ending.reached());
        for (name, expected) in STATES.into_iter().zip(&answers).take(2) {
            let last = course.signal(name).len() - 1;
            let coefficient: Complex<f64> =
                (0..last).map(|k| Complex::from_polar(2.0 * course.signal(name)[k] / (last as f64 * TORQUE), -omega * times[k])).sum();
            agreement.near(&format!("{name} at {omega} rad/s"), (coefficient - expected).norm() / expected.norm(), 0.0, &small);
        }
    }
    agreement.assert();
}
