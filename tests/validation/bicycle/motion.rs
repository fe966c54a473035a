//! The bicycle in motion: the uncontrolled run M1 of the IFToMM library.

use super::signs::m1;
use analyses::transient::evenly;
use validation::agreement::{Agreement, absolute, relative};
use validation::course::{By, Course};
use validation::evidence::Row;
use validation::reference::Table;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_uncontrolled_bicycle_moves_as_published => (
        "`whipple`: 16 coordinates and velocities of the uncontrolled motion M1, 51 samples over 5 s, by ERK; energy and rolling hold",
        "Kane's equations with symbrim, `bicycle/iftomm_m1.csv`",
        "1e-10 m, rad, per second: both integrate at 1e-12; energy relative 1e-12, drift 1e-9"
    ),
    an_implicit_method_finds_the_same_motion => (
        "the same by IDA in the stabilized form of index 2",
        "Kane's equations with symbrim, `bicycle/iftomm_m1.csv`",
        "1e-8 m, rad, per second, energy relative 1e-8, drift 1e-9: tolerance 1e-11 of a method of order 5 at most"
    ),
];

fn uncontrolled(by: By, error: f64, energy: f64) {
    let table = Table::read("bicycle/iftomm_m1.csv");
    let start = [("chassis.forward_speed", 4.0), ("chassis.roll_rate", 0.05), ("steer.rate", 0.0)];
    let mut course = Course::of("whipple", &start, &evenly(5.0, table.len()), by);
    let mut agreement = Agreement::on(format!("whipple: M1 by {by:?}"));
    course.holds(&mut agreement, "M1");
    let integrated = absolute(error).because("tolerances of both integrations");
    for row in 0..table.len() {
        let motion = m1(&table, row);
        for (name, expected) in motion.coordinates.iter().chain(&motion.velocities) {
            // angles of wheels are not recorded
            if !["rear_wheel.angle", "front_wheel.angle"].contains(name) {
                agreement.near(&format!("{name}, sample {row}"), course.signal(name)[row], *expected, &integrated);
            }
        }
    }
    let kept = relative(energy).because("tolerance of the integration");
    let energies = course.energies();
    for (row, found) in energies.iter().enumerate() {
        agreement.near(&format!("energy, sample {row}"), *found, energies[0], &kept);
    }
    agreement.assert();
}

#[test]
fn the_uncontrolled_bicycle_moves_as_published() {
    uncontrolled(By::Erk(1e-12, 1e-6), 1e-10, 1e-12);
}

#[test]
fn an_implicit_method_finds_the_same_motion() {
    uncontrolled(By::Ida(1e-11, 1e-5), 1e-8, 1e-8);
}
