//! The bicycle in motion: the uncontrolled run M1 of the IFToMM library.

use super::signs::m1;
use analyses::transient::evenly;
use validation::agreement::{Agreement, Tolerance, absolute, relative};
use validation::course::{By, Course};
use validation::evidence::Row;
use validation::reference::Table;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_uncontrolled_bicycle_moves_as_published => (
        "`whipple`: the uncontrolled motion M1 over 5 s",
        "Kane's equations",
        "x"
    ),
];

/// The motion from 4 m/s and a roll rate of 0.05 rad/s.
fn uncontrolled(by: By) -> Course {
    let start = [("chassis.forward_speed", 4.0), ("chassis.roll_rate", 0.05), ("steer.rate", 0.0)];
    Course::of("whipple", &start, &evenly(5.0, 51), by)
}

fn compare(by: By) {
    let table = Table::read("bicycle/iftomm_m1.csv");
    let mut course = uncontrolled(by);
    println!("{:?}", course.simulation.statistics);
    println!("{:?}", course.simulation.drift);
    let mut worst = std::collections::BTreeMap::new();
    for row in 0..table.len() {
        let motion = m1(&table, row);
        for (name, expected) in motion.coordinates.iter().chain(&motion.velocities) {
            if ["rear_wheel.angle", "front_wheel.angle"].contains(name) { continue; }
            let d = (course.signal(name)[row] - expected).abs();
            let e: &mut f64 = worst.entry(*name).or_insert(0.0);
            *e = e.max(d);
        }
    }
    println!("{worst:#?}");
    let e = course.energies();
    println!("energy {:e}", e.iter().map(|x| (x - e[0]).abs()).fold(0.0, f64::max) / e[0]);
}

#[test]
fn the_uncontrolled_bicycle_moves_as_published() {
    for by in [By::Erk(1e-12, 1e-6), By::Erk(1e-13, 1e-7), By::Ida(1e-10, 1e-4), By::Ida(1e-11, 1e-5), By::Ida(1e-12, 1e-6)] {
        println!("{by:?}");
        let t = std::time::Instant::now();
        compare(by);
        println!("{:?}", t.elapsed());
    }
}
