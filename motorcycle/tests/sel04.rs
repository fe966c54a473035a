//! The motorcycle Magic Formula against tables computed by two independent third-party programs.

use motorcycle::tire::magic_formula_motorcycle::{MagicFormulaMotorcycle, MagicFormulaMotorcycleParameters, ResidualSlope};
use motorcycle::tire::{Slip, TireLaw};
use serde::Deserialize;

/// The tables are printed with ten significant digits: forces of some thousand N to half of 1e-6 N.
const FORCE: f64 = 0.5e-6 + 1e-9;
/// Moments below a hundred N m are printed to half of 1e-8 N m.
const MOMENT: f64 = 0.5e-8 + 1e-10;
/// Stiffnesses of some ten thousand N are printed to 1e-5 N.
const STIFFNESS: f64 = 0.5e-5 + 1e-9;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TireFile {
    magic_formula_motorcycle: MagicFormulaMotorcycleParameters,
}

/// One row: load, slip, camber, longitudinal slip, then the expected values.
struct Row {
    load: f64,
    lateral: f64,
    camber: f64,
    longitudinal: f64,
    fx: f64,
    fx_curvature_one: f64,
    fy: f64,
    mz_at_camber: f64,
    mz_upright: f64,
    cornering: f64,
    camber_stiffness: f64,
}

fn rows(table: &str) -> Vec<Row> {
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [load, lateral, camber, longitudinal, fx, fx_curvature_one, fy, mz_at_camber, mz_upright, cornering, camber_stiffness] =
            cells.try_into().expect("eleven columns");
        Row { load, lateral, camber, longitudinal, fx, fx_curvature_one, fy, mz_at_camber, mz_upright, cornering, camber_stiffness }
    })
    .collect()
}

fn close(value: f64, expected: f64, tolerance: f64, what: &str, at: &Row) {
    let Row { load, lateral, camber, longitudinal, .. } = at;
    assert!(
        (value - expected).abs() <= tolerance,
        "{what}: {value} is not {expected} at N = {load}, a = {lateral}, camber {camber}, kappa {longitudinal}"
    );
}

fn compare(tire: &str, table: &str) {
    let parameters = serde_yaml::from_str::<TireFile>(tire).expect("a tire").magic_formula_motorcycle;
    let law = |change: fn(&mut MagicFormulaMotorcycleParameters)| -> MagicFormulaMotorcycle {
        let mut changed = parameters.clone();
        change(&mut changed);
        changed.law().expect("a valid tire")
    };
    let as_published = law(|_| ());
    let curvature_one = law(|p| p.longitudinal.pEx4 = 1.0);
    let upright = law(|p| p.residual_slope = ResidualSlope::Upright);

    let rows = rows(table);
    assert_eq!(rows.len(), 150);
    for row in &rows {
        // the publication has y to the right
        let slip = Slip { load: row.load, lateral: row.lateral, longitudinal: row.longitudinal, camber: -row.camber, speed: 20.0 };
        let f = as_published.friction(&slip);
        close(f.longitudinal, row.fx, FORCE, "Fx", row);
        close(f.lateral, row.fy, FORCE, "Fy", row);
        close(f.aligning_moment, row.mz_at_camber, MOMENT, "Mz", row);
        close(curvature_one.friction(&slip).longitudinal, row.fx_curvature_one, FORCE, "Fx with pEx4 = 1", row);
        close(upright.friction(&slip).aligning_moment, row.mz_upright, MOMENT, "Mz with the upright slope", row);
        close(as_published.cornering_stiffness(row.load, -row.camber), row.cornering, STIFFNESS, "cornering stiffness", row);
        close(as_published.camber_stiffness(row.load), row.camber_stiffness, STIFFNESS, "camber stiffness", row);
    }
}

#[test]
fn front_120_70() {
    compare(include_str!("../../models/tires/sel04_120_70.yaml"), include_str!("../../tests/reference/tire/sel04_120_70.csv"));
}

#[test]
fn rear_160_70() {
    compare(include_str!("../../models/tires/sel04_160_70.yaml"), include_str!("../../tests/reference/tire/sel04_160_70.csv"));
}

#[test]
fn rear_180_55() {
    compare(include_str!("../../models/tires/sel04_180_55.yaml"), include_str!("../../tests/reference/tire/sel04_180_55.csv"));
}
