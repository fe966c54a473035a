//! Mechanisms in motion over time, by both methods: problems of the IFToMM library and of the literature.
//!
//! Positions and velocities of all loops hold to 1e-9 the whole way. IDA solves the stabilized form of index 2; where it reaches less than ERK, the tolerance
//! says so.

use crate::mechanisms::{SQUEEZER_TORQUE, four_bars, squeezer, top};
use analyses::transient::evenly;
use validation::agreement::{Agreement, Tolerance, absolute, relative};
use validation::course::{By, Course};
use validation::evidence::Row;
use validation::reference::Table;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    a_pendulum_swings_by_elliptic_functions => (
        "`pendulum`: position over 10 s",
        "exact: Jacobi's elliptic functions, `mbs/pendulum.csv`",
        "ERK 1e-11 m, IDA 1e-8 m: tolerances 1e-12 and 1e-11 over three periods and more"
    ),
    four_bars_pass_their_singular_poses => (
        "`n_four_bar`: angles and rates over 10 s, ten times through the pose where all rods lie in one line, by ERK",
        "exact reduction to one degree of freedom, `mbs/n_four_bar.csv`",
        "1e-6 rad, rad/s at tolerance 1e-9: in the singular poses accelerations are not determined; steps must be long enough to pass over them"
    ),
    andrews_squeezer_turns_as_published => (
        "`andrews_squeezer`: seven angles and rates every millisecond up to 0.03 s; energy is the work of the drive",
        "separate program, `mbs/andrews_squeezer.csv`, converged to 1e-13; IVP test set",
        "ERK relative 1e-11, IDA relative 1e-6: tolerances 1e-12 and 1e-10"
    ),
    the_ring_of_bricard_falls_as_published => (
        "`bricard`: point P3 at 1, 5 and 10 s, five rows of which four are independent",
        "IFToMM A04, two programs; `mbs/bricard.csv`",
        "1.5e-8 m: eight decimals, programs agree within 1e-8; energy relative 1e-9"
    ),
    the_governor_rises_as_published => (
        "`flyball_governor`: height of the slider at full seconds, springs of 800 kN/m",
        "IFToMM A05, two programs; `mbs/flyball_governor.csv`",
        "half a unit of the eighth decimal"
    ),
    the_heavy_top_precesses_as_published => (
        "`heavy_top`: quaternion and angular velocity over 2 s",
        "separate program, `mbs/heavy_top.csv`; EXUDYN",
        "ERK 1e-10, IDA 1e-6, rates relative to 150 rad/s: twelve digits of the source; 48 turns at tolerances 1e-12 and 1e-10"
    ),
    a_steady_disc_stays_steady => (
        "`rolling_disc`: steady precession stays steady over 10 s",
        "Routh, art. 244",
        "1e-11 rad, rad/s: the start is rounded, and small motions about it are oscillations"
    ),
];

fn times(table: &Table) -> Vec<f64> {
    (0..table.len()).map(|row| table.number(row, "t")).collect()
}

/// Energy, less the work done on the way, is that of the start.
fn keeps_energy(agreement: &mut Agreement, what: &str, course: &mut Course, work: impl Fn(&Course, usize) -> f64, tolerance: &Tolerance) {
    let energies = course.energies();
    for (k, energy) in energies.iter().enumerate() {
        agreement.near(&format!("{what}: energy, sample {k}"), energy - work(course, k), energies[0], tolerance);
    }
}

#[test]
fn a_pendulum_swings_by_elliptic_functions() {
    let table = Table::read("mbs/pendulum.csv");
    let mut agreement = Agreement::on("pendulum: motion");
    for (by, error) in [(By::Erk(1e-12, 1e-6), 1e-11), (By::Ida(1e-11, 1e-5), 1e-8)] {
        let mut course = Course::of("pendulum", &[], &times(&table), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        let integrated = absolute(error).because("tolerance of the integration");
        for row in 0..table.len() {
            let tip = course.position(row, "rod", [0.0, 0.0, -1.0]);
            let expected = ["x", "y"].map(|column| table.number(row, column));
            agreement.all_near(&format!("{by:?}, row {row}"), &[tip.x, tip.z], &expected, &integrated);
        }
        keeps_energy(&mut agreement, &format!("{by:?}"), &mut course, |_, _| 0.0, &absolute(9.81 * error).because("m g times the error"));
    }
    agreement.assert();
}

/// In the line of all rods the loops may go on as parallelograms or crossed. Coordinates of sixteen digits fix the branch only some distance s away from there: to
/// 1e-16/s, velocities to 1e-16/s², accelerations to 1e-16/s³. An error control finer than that sees noise, shortens its steps in it, and ends on some branch
/// (at 1e-10 and below) or nowhere (where a step happens to end there: at 1e-6).
#[test]
fn four_bars_pass_their_singular_poses() {
    let table = Table::read("mbs/n_four_bar.csv");
    let mut agreement = Agreement::on("n_four_bar: motion");
    let by = By::Erk(1e-9, 1e-3);
    let mut course = Course::of("n_four_bar", &[], &times(&table), by);
    course.holds(&mut agreement, "motion");
    let integrated = absolute(1e-6).because("tolerance 1e-9 through ten singular poses");
    for row in 0..table.len() {
        for (name, expected) in four_bars(table.number(row, "theta"), table.number(row, "theta_dot")) {
            agreement.near(&format!("row {row}: {name}"), course.signal(name)[row], expected, &integrated);
        }
    }
    keeps_energy(&mut agreement, "motion", &mut course, |_, _| 0.0, &relative(1e-8).because("tolerance 1e-9"));
    agreement.assert();
}

#[test]
fn andrews_squeezer_turns_as_published() {
    let table = Table::read("mbs/andrews_squeezer.csv");
    let mut agreement = Agreement::on("andrews_squeezer: motion");
    for (by, error) in [(By::Erk(1e-12, 1e-6), 1e-11), (By::Ida(1e-10, 1e-2), 1e-6)] {
        let mut course = Course::of("andrews_squeezer", &[("motor.torque", SQUEEZER_TORQUE)], &times(&table), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        for row in 0..table.len() {
            for (name, expected) in squeezer(&table, row) {
                // in units of one radian, and of the fastest rate
                let unit = if name.ends_with("rate") { 1424.0 } else { 1.0 };
                let integrated = absolute(error * unit).because("tolerance of the integration");
                agreement.near(&format!("{by:?}, row {row}: {name}"), course.signal(name)[row], expected, &integrated);
            }
        }
        let work = |course: &Course, row: usize| SQUEEZER_TORQUE * (course.signal("beta.angle")[row] - course.signal("beta.angle")[0]);
        keeps_energy(&mut agreement, &format!("{by:?}"), &mut course, work, &relative(error).because("tolerance of the integration"));
    }
    agreement.assert();
}

#[test]
fn the_ring_of_bricard_falls_as_published() {
    let table = Table::read("mbs/bricard.csv");
    let mut agreement = Agreement::on("bricard: motion");
    let digits = absolute(1.5e-8).because("eight decimals; the programs agree within 1e-8");
    for by in [By::Erk(1e-12, 1e-6), By::Ida(1e-11, 1e-5)] {
        let mut course = Course::of("bricard", &[], &evenly(10.0, 11), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        for (row, second) in [1, 5, 10].into_iter().enumerate() {
            let P3 = course.position(second, "p3", [0.0; 3]);
            let expected = ["X", "Y", "Z"].map(|column| table.number(row, column));
            agreement.all_near(&format!("{by:?}, {second} s"), &[P3.x, P3.z, -P3.y], &expected, &digits);
        }
        keeps_energy(&mut agreement, &format!("{by:?}"), &mut course, |_, _| 0.0, &relative(1e-9).because("tolerance of the integration"));
    }
    agreement.assert();
}

#[test]
fn the_governor_rises_as_published() {
    let table = Table::read("mbs/flyball_governor.csv");
    let mut agreement = Agreement::on("flyball_governor: motion");
    for by in [By::Erk(1e-10, 1e-4), By::Ida(1e-11, 1e-5)] {
        let course = Course::of("flyball_governor", &[], &times(&table), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        for row in 0..table.len() {
            agreement.printed(&format!("{by:?}, {row} s"), course.signal("slider.travel")[row], table.cell(row, "s"));
        }
    }
    agreement.assert();
}

#[test]
fn the_heavy_top_precesses_as_published() {
    let table = Table::read("mbs/heavy_top.csv");
    let mut agreement = Agreement::on("heavy_top: motion");
    for (by, error) in [(By::Erk(1e-12, 1e-6), 1e-10), (By::Ida(1e-10, 1e-4), 1e-6)] {
        let mut course = Course::of("heavy_top", &[], &times(&table), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        for row in 0..table.len() {
            for (name, expected) in top(&table, row) {
                let unit = if name.contains("velocity") { 150.0 } else { 1.0 };
                let integrated = absolute(error * unit).because("tolerances of both integrations");
                agreement.near(&format!("{by:?}, row {row}: {name}"), course.signal(name)[row], expected, &integrated);
            }
        }
        keeps_energy(&mut agreement, &format!("{by:?}"), &mut course, |_, _| 0.0, &relative(error).because("tolerance of the integration"));
    }
    agreement.assert();
}

#[test]
fn a_steady_disc_stays_steady() {
    let mut agreement = Agreement::on("rolling_disc: steady precession over time");
    let steady = absolute(1e-11).because("tolerance of the integration, rounding of the start");
    for by in [By::Erk(1e-12, 1e-6), By::Ida(1e-11, 1e-5)] {
        let mut course = Course::of("rolling_disc", &[], &evenly(10.0, 21), by);
        course.holds(&mut agreement, &format!("{by:?}"));
        for name in ["disc.roll", "disc.roll_rate", "disc.yaw_rate", "disc.pitch_rate", "disc.forward_speed"] {
            let values = course.signal(name);
            for (k, value) in values.iter().enumerate() {
                agreement.near(&format!("{by:?}, sample {k}: {name}"), *value, values[0], &steady);
            }
        }
        keeps_energy(&mut agreement, &format!("{by:?}"), &mut course, |_, _| 0.0, &relative(1e-12).because("tolerance of the integration"));
    }
    agreement.assert();
}
