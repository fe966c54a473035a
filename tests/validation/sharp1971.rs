//! Sharp's motorcycle of 1971 as a full multibody model: the eigenvalues of his linear equations, and the speeds at which they change their stability.

use fastbike::small_motions::{Shapes, SmallMotions};
use fastbike::steady;
use nalgebra::Complex;
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::reference::Table;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    eigenvalues_are_met => (
        "`sharp1971`: all eight eigenvalues of the lateral motion, 5 to 60 m/s, from the full multibody model",
        "Sharp's linear equations (1971), three independent routes; `tests/reference/sharp1971.csv`",
        "relative 1e-9: two lengths of the source, rounded to ten decimals, move them by 9e-10"
    ),
    speeds_of_stability_are_found => (
        "`sharp1971`: weave becomes stable, capsize and wobble unstable, found by the way of `modes` in a sweep of 5 m/s; no other mode does",
        "the same equations; `tests/reference/sharp1971_speeds.csv`",
        "5e-8 m/s: 1e-10 of the eigenvalues over their slope of 0.1 1/m"
    ),
    modes_keep_their_names => (
        "`sharp1971`: weave, wobble and rear wobble are recognized at every speed from 5 to 60 m/s, and capsize; no two change places",
        "Sharp (1971): wobble near 9 Hz, weave 0.2 to 4 Hz, rear wobble that turns into two real modes",
        "frequencies within those bands; eigenvalues of a name within 8 1/s from one speed to the next (the rear wobble just before it stops to oscillate)"
    ),
];

#[test]
fn eigenvalues_are_met() {
    let table = Table::read("sharp1971.csv");
    let mut agreement = Agreement::on("sharp1971: eigenvalues");
    let rounded = relative(1e-9).because("two lengths of the source are rounded to ten decimals");
    let speeds: Vec<f64> = (0..table.len()).map(|row| table.number(row, "v_m_s")).collect();
    for (row, point) in along(&speeds).points.iter().enumerate() {
        let point = point.as_ref().expect("modes");
        let pairs = |z: Complex<f64>| if z.im > 0.0 { vec![z, z.conj()] } else { vec![z] };
        let mut left: Vec<Complex<f64>> = point.modes.iter().flat_map(|m| pairs(m.value)).collect();
        for k in 1..=8 {
            let expected = Complex::new(table.number(row, &format!("re{k}")), table.number(row, &format!("im{k}")));
            let off = |z: &Complex<f64>| (z - expected).norm();
            let nearest = (0..left.len()).min_by(|&a, &b| off(&left[a]).total_cmp(&off(&left[b]))).expect("an eigenvalue");
            let found = left.remove(nearest);
            let what = format!("{} m/s, {expected}", speeds[row]);
            agreement.near(&what, expected.norm() + (found - expected).norm(), expected.norm(), &rounded);
        }
        // what is left is not lateral: speed, and two wheels that come up to speed
        agreement.holds(&format!("{} m/s: three more, all real", speeds[row]), left.len() == 3 && left.iter().all(|z| z.im == 0.0));
    }
    agreement.assert();
}

#[test]
fn speeds_of_stability_are_found() {
    let speeds: Vec<f64> = (1..=12).map(|k| 5.0 * f64::from(k)).collect();
    let modes = along(&speeds);
    let table = Table::read("sharp1971_speeds.csv");
    let mut agreement = Agreement::on("sharp1971: critical speeds");
    let slope = absolute(5e-8).because("1e-10 of the eigenvalues over their slope of 0.1 1/m");
    agreement.holds("three changes of stability", modes.critical.len() == table.len());
    for (row, found) in modes.critical.iter().enumerate() {
        let becomes = if found.becomes_stable { "stable" } else { "unstable" };
        agreement.holds(&found.name, (found.name.as_str(), becomes) == (table.cell(row, "mode"), table.cell(row, "becomes")));
        agreement.near(&found.name, found.given[0], table.number(row, "speed"), &slope);
    }
    agreement.assert();
}

#[test]
fn modes_keep_their_names() {
    let speeds: Vec<f64> = (5..=60).map(f64::from).collect();
    let modes = along(&speeds);
    let mut agreement = Agreement::on("sharp1971: names");
    let mut before: [Option<Complex<f64>>; 4] = [None; 4];
    for (speed, point) in speeds.iter().zip(&modes.points) {
        let point = point.as_ref().expect("modes");
        let bands = [("weave", 0.2, 4.0), ("wobble", 8.0, 10.0), ("rear wobble", 2.9, 7.0), ("capsize", 0.0, 0.6)];
        for (k, (name, low, high)) in bands.into_iter().enumerate() {
            let values: Vec<Complex<f64>> = point.modes.iter().filter(|m| m.name == name).map(|m| m.value).collect();
            agreement.holds(&format!("{name} at {speed} m/s: one or, where it does not oscillate, two"), matches!(values.len(), 1 | 2));
            let Some(&value) = values.first() else { continue };
            let frequency = value.norm() / std::f64::consts::TAU;
            agreement.holds(&format!("{name} at {speed} m/s: {frequency} Hz"), (low..=high).contains(&frequency));
            if let Some(last) = before[k] {
                // where a pair falls apart its parts run away from each other
                let apart = (last.im > 0.0) != (value.im > 0.0);
                agreement.holds(&format!("{name} at {speed} m/s: {last} to {value}"), apart || (value - last).norm() < 8.0);
            }
            before[k] = Some(value);
        }
    }
    agreement.assert();
}

/// Modes along speeds, by the way of `modes`.
fn along(speeds: &[f64]) -> fastbike::output::modes::ModesAlong {
    let (request, system) = (running(speeds), Vehicle::bundled("sharp1971").system);
    let steady = steady::run(&request, &system, "kinsol", "modes").unwrap_or_else(|failure| panic!("{failure}"));
    let small = SmallMotions { request: &request, system: &system, backend: "kinsol", residual_tolerance: 1e-6 };
    small.along(&steady, Shapes::LeftOut).unwrap_or_else(|failure| panic!("{failure}"))
}
