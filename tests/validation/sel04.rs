//! The motorcycle Magic Formula against tables computed by two independent third-party programs.

use motorcycle::tire::magic_formula_motorcycle::{MagicFormulaMotorcycle, MagicFormulaMotorcycleParameters, ResidualSlope};
use motorcycle::tire::{Slip, TireLaw};
use serde::Deserialize;
use validation::agreement::{Agreement, Tolerance, absolute};
use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    front_120_70 => (
        "motorcycle Magic Formula, tire 120/70: forces, aligning moment and stiffnesses at 150 points",
        "madsym (aerotinez) run in Octave, formulas of TUMFTM/motorcycle_model; `tests/reference/tire/sel04_120_70.csv`",
        "half of 1e-6 N, 1e-8 N m: ten printed digits"
    ),
    rear_160_70 => (
        "the same, tire 160/70",
        "the same programs; `tests/reference/tire/sel04_160_70.csv`",
        "half of 1e-6 N, 1e-8 N m: ten printed digits"
    ),
    rear_180_55 => (
        "the same, tire 180/55",
        "the same programs; `tests/reference/tire/sel04_180_55.csv`",
        "half of 1e-6 N, 1e-8 N m: ten printed digits"
    ),
];

const FORCE: Tolerance = absolute(0.5e-6 + 1e-9).because("ten digits of some thousand N");
const MOMENT: Tolerance = absolute(0.5e-8 + 1e-10).because("ten digits of less than a hundred N m");
const STIFFNESS: Tolerance = absolute(0.5e-5 + 1e-9).because("ten digits of some ten thousand N");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TireFile {
    magic_formula_motorcycle: MagicFormulaMotorcycleParameters,
}

/// One point: load, slip, camber, longitudinal slip, then the expected values.
struct Point {
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

fn rows(table: &str) -> Vec<Point> {
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [load, lateral, camber, longitudinal, fx, fx_curvature_one, fy, mz_at_camber, mz_upright, cornering, camber_stiffness] =
            cells.try_into().expect("eleven columns");
        Point { load, lateral, camber, longitudinal, fx, fx_curvature_one, fy, mz_at_camber, mz_upright, cornering, camber_stiffness }
    })
    .collect()
}

fn compare(name: &str, tire: &str, table: &str) {
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
    let mut agreement = Agreement::on(format!("Magic Formula {name}"));
    for row in &rows {
        let Point { load, lateral, camber, longitudinal, .. } = row;
        let mut close = |value: f64, expected: f64, tolerance: &Tolerance, what: &str| {
            let what = format!("{what} at N = {load}, a = {lateral}, camber {camber}, kappa {longitudinal}");
            agreement.near(&what, value, expected, tolerance);
        };
        // the publication has y to the right
        let slip = Slip { load: row.load, lateral: row.lateral, longitudinal: row.longitudinal, camber: -row.camber, speed: 20.0 };
        let f = as_published.friction(&slip);
        close(f.longitudinal, row.fx, &FORCE, "Fx");
        close(f.lateral, row.fy, &FORCE, "Fy");
        close(f.aligning_moment, row.mz_at_camber, &MOMENT, "Mz");
        close(curvature_one.friction(&slip).longitudinal, row.fx_curvature_one, &FORCE, "Fx with pEx4 = 1");
        close(upright.friction(&slip).aligning_moment, row.mz_upright, &MOMENT, "Mz with the upright slope");
        close(as_published.cornering_stiffness(row.load, -row.camber), row.cornering, &STIFFNESS, "cornering stiffness");
        close(as_published.camber_stiffness(row.load), row.camber_stiffness, &STIFFNESS, "camber stiffness");
    }
    agreement.assert();
}

#[test]
fn front_120_70() {
    compare("120_70", include_str!("../../models/tires/sel04_120_70.yaml"), include_str!("../reference/tire/sel04_120_70.csv"));
}

#[test]
fn rear_160_70() {
    compare("160_70", include_str!("../../models/tires/sel04_160_70.yaml"), include_str!("../reference/tire/sel04_160_70.csv"));
}

#[test]
fn rear_180_55() {
    compare("180_55", include_str!("../../models/tires/sel04_180_55.yaml"), include_str!("../reference/tire/sel04_180_55.csv"));
}
