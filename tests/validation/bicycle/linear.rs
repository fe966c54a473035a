//! Small motions of the bicycle about straight running: the matrices and eigenvalues of the benchmark.

use super::source::{printed_eigenvalues, sorted, state_matrix};
use analyses::linearize::{LinearModel, Options, linearize};
use fastbike::small_motions::{Shapes, SmallMotions};
use fastbike::steady;
use mbody::dynamics::{Formulation, TreePlant};
use nalgebra::{DMatrix, Matrix4};
use problem::{At, Dae};
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::instant::Instant;
use validation::reference::Table;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    linear_equations_of_the_benchmark_are_met => (
        "`whipple`: linear equations of lean and steer about straight running, 0 to 10 m/s, steering torque included",
        "Meijaard et al. (2007), matrices M, C₁, K₀, K₂",
        "1e-13 of the largest entry: double precision"
    ),
    printed_eigenvalues_are_met => (
        "`whipple`: castering, capsize and weave eigenvalues, 0 to 10 m/s",
        "Meijaard et al. (2007), table 2",
        "5e-12 1/s: double precision on matrices with entries up to 1e3 (the source prints fourteen decimals)"
    ),
    speeds_of_the_benchmark_are_met => (
        "`whipple`: speeds at which two real eigenvalues meet, weave becomes stable, capsize unstable, by roots of eigenvalues; weave frequency there",
        "Meijaard et al. (2007), section 4 (d)",
        "relative 1e-12: double precision of eigenvalues over their slope (the source prints fifteen digits)"
    ),
    printed_speeds_of_stability_are_found => (
        "`whipple`: weave and capsize speed, between which it stays upright by itself, from a sweep in steps of 1 m/s by the way of `modes`",
        "Meijaard et al. (2007), section 7",
        "1e-8 m/s: the root is enclosed to 1e-10 of the step, eigenvalues are good to 5e-12 1/s (the source prints twelve decimals)"
    ),
];

#[test]
fn printed_speeds_of_stability_are_found() {
    let speeds: Vec<f64> = (1..=10).map(f64::from).collect();
    let (request, system) = (running(&speeds), Vehicle::bundled("whipple").system);
    let steady = steady::run(&request, &system, "kinsol", "modes").unwrap_or_else(|failure| panic!("{failure}"));
    let small = SmallMotions { request: &request, system: &system, backend: "kinsol", residual_tolerance: 1e-6 };
    let modes = small.along(&steady, Shapes::LeftOut).unwrap_or_else(|failure| panic!("{failure}"));
    let mut agreement = Agreement::on("whipple: weave and capsize speed");
    let enclosed = absolute(1e-8).because("double precision of the eigenvalues over their slope of about 0.1 1/m");
    agreement.holds("two changes of stability", modes.critical.len() == 2);
    for (found, (name, printed)) in modes.critical.iter().zip([("weave", 4.292_382_536_341), ("capsize", 6.024_262_015_388)]) {
        agreement.holds(&format!("{name} is called {}", found.name), found.name == name);
        agreement.near(&format!("{name} speed"), found.given[0], printed, &enclosed);
    }
    agreement.assert();
}

/// The bicycle linearized about straight running, lean and steer among the states.
pub(super) fn straight(speed: f64) -> LinearModel {
    let mut bicycle = Instant::of("whipple");
    bicycle.put(&[("chassis.forward_speed", speed), ("steer.rate", 0.0), ("chassis.roll_rate", 0.0)]);
    let mut plant = TreePlant::in_formulation(Vehicle::bundled("whipple").system, Formulation::Ggl);
    // corrections of the stabilized form are zero
    let value = |name: &str| if name.ends_with("_correction") { 0.0 } else { bicycle.get(name) };
    let y: Vec<f64> = plant.unknowns().iter().map(|k| value(&k.signal.name)).collect();
    let independent = ["chassis.roll", "steer.angle", "chassis.roll_rate", "steer.rate"].map(str::to_owned).to_vec();
    let options = Options { independent, ..Options::default() };
    linearize(&mut plant, At { time: 0.0, y: &y, yd: &vec![0.0; y.len()], u: &[0.0] }, &options).unwrap_or_else(|error| panic!("{error}"))
}

/// `E⁻¹ A` and `E⁻¹ B` in the states (lean, steer, their rates) of the paper: our steer is to the left, so its sign changes, and that of the torque.
fn in_signs_of_the_paper(model: &LinearModel) -> (Matrix4<f64>, [f64; 4]) {
    let at = ["chassis.roll", "steer.angle", "chassis.roll_rate", "steer.rate"].map(|name| model.state(name).expect("a state"));
    let sign = [1.0, -1.0, 1.0, -1.0];
    let solved = |right: &DMatrix<f64>| model.E.clone().lu().solve(right).expect("inertia");
    let (A, B) = (solved(&model.A), solved(&model.B));
    let torque = model.input("steer.torque").expect("an input");
    (Matrix4::from_fn(|i, j| sign[i] * A[(at[i], at[j])] * sign[j]), [0, 1, 2, 3].map(|i| -sign[i] * B[(at[i], torque)]))
}

#[test]
fn linear_equations_of_the_benchmark_are_met() {
    let mut agreement = Agreement::on("whipple: linear equations");
    for speed in (0..=10).map(f64::from) {
        let (found, torque) = in_signs_of_the_paper(&straight(speed));
        let expected = state_matrix(speed);
        let double = absolute(1e-13 * expected.amax()).because("double precision of the largest entry");
        agreement.all_near(&format!("{speed} m/s"), found.as_slice(), expected.as_slice(), &double);
        // M⁻¹ (0, 1): the torque acts on steer
        let table = Table::read("bicycle/matrices.csv");
        let M = super::source::matrix(&table, "M").try_inverse().expect("a mass matrix");
        agreement.all_near(&format!("{speed} m/s, torque"), &torque, &[0.0, 0.0, M[(0, 1)], M[(1, 1)]], &double);
    }
    agreement.assert();
}

#[test]
fn printed_eigenvalues_are_met() {
    let table = Table::read("bicycle/table_2.csv");
    let mut agreement = Agreement::on("whipple: table 2");
    let digits = absolute(5e-12).because("double precision on matrices with entries up to 1e3");
    for row in 0..table.len() {
        let speed = table.number(row, "v_m_s");
        let spectrum = analyses::eigen::eigen(&straight(speed)).unwrap_or_else(|error| panic!("{error}"));
        // running on at another speed is no motion of lean and steer
        let found: Vec<_> = spectrum.values.iter().map(|z| (z.re, z.im)).filter(|z| z.0.hypot(z.1) > 1e-6).collect();
        agreement.holds(&format!("{speed} m/s: four eigenvalues besides zero"), found.len() == 4);
        for (k, (found, expected)) in sorted(found).iter().zip(printed_eigenvalues(&table, row)).enumerate() {
            agreement.near(&format!("{speed} m/s, real part {k}"), found.0, expected.0, &digits);
            agreement.near(&format!("{speed} m/s, imaginary part {k}"), found.1, expected.1, &digits);
        }
    }
    agreement.assert();
}

/// The root of a smooth function by secants.
fn root(value: impl Fn(f64) -> f64, mut x: [f64; 2]) -> f64 {
    let mut f = x.map(&value);
    for _ in 0..30 {
        if f[1] == 0.0 || f[0] == f[1] || (x[1] - x[0]).abs() < 1e-15 {
            break;
        }
        let next = x[1] - f[1] * (x[1] - x[0]) / (f[1] - f[0]);
        (x, f) = ([x[1], next], [f[1], value(next)]);
    }
    x[1]
}

/// The two eigenvalues with the largest real parts.
fn weave(speed: f64) -> [(f64, f64); 2] {
    let spectrum = analyses::eigen::eigen(&straight(speed)).unwrap_or_else(|error| panic!("{error}"));
    let mut values: Vec<_> = spectrum.values.iter().map(|z| (z.re, z.im)).filter(|z| z.0.hypot(z.1) > 0.1).collect();
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    [values[0], values[1]]
}

#[test]
fn speeds_of_the_benchmark_are_met() {
    let table = Table::read("bicycle/speeds.csv");
    let printed = |what: &str| table.number(table.find(&[("what", what)]), "printed");
    // (λ₁ − λ₂)² passes zero straight, real before and imaginary behind
    let apart = |speed: f64| {
        let [a, b] = weave(speed);
        (a.0 - b.0).powi(2) - (a.1 - b.1).powi(2)
    };
    let double_root = root(apart, [0.68, 0.69]);
    let weave_speed = root(|speed| weave_pair(speed).0, [4.25, 4.35]);
    // product of the eigenvalues
    let capsize = root(|speed| in_signs_of_the_paper(&straight(speed)).0.determinant(), [6.0, 6.05]);
    let mut agreement = Agreement::on("whipple: speeds of the benchmark");
    let double = relative(1e-12).because("double precision of eigenvalues over their slope");
    agreement.near("double root", double_root, printed("double_root"), &double);
    agreement.near("weave", weave_speed, printed("weave"), &double);
    agreement.near("capsize", capsize, printed("capsize"), &double);
    agreement.near("weave frequency", weave_pair(weave_speed).1, printed("weave_frequency"), &double);
    agreement.assert();
}

/// The oscillating eigenvalue.
fn weave_pair(speed: f64) -> (f64, f64) {
    let spectrum = analyses::eigen::eigen(&straight(speed)).unwrap_or_else(|error| panic!("{error}"));
    spectrum.values.iter().map(|z| (z.re, z.im)).find(|z| z.1 > 1e-3).expect("an oscillation")
}
