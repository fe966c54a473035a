//! The published states and motions in our model: its geometry keeps both wheels on the road and without slip, its inertias give the energies.

use super::signs::{FRONT_RADIUS, REAR_RADIUS, basu_mandal, m1};
use mbody::assembly::BaseDescription;
use mbody::contact::{Contact, Plane, Profile, Surface};
use mbody::spatial::Vec3;
use nalgebra::{Matrix2, Matrix4};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::reference::Table;
use validation::tree::Tree;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    published_motions_roll_without_slip => (
        "`whipple`: in 51 samples of the motion M1 and in the state of Basu-Mandal both wheels of our model touch the road and roll without slip",
        "Kane's equations with symbrim (`bicycle/iftomm_m1.csv`); Basu-Mandal et al. (2007), table 1",
        "1e-11 m, m/s: digits of the sources"
    ),
    energies_of_a_published_motion_are_met => (
        "`whipple`: kinetic and potential energy in 51 samples of the motion M1",
        "Kane's equations with symbrim, `bicycle/iftomm_m1.csv`",
        "1e-8 J of 1575 J: thirteen digits of the source, speeds of wheels times their inertia"
    ),
    printed_eigenvalues_follow_from_the_matrices => (
        "the eigenvalues printed for the benchmark bicycle are those of its matrices, signs as we read them",
        "Meijaard et al. (2007), table 2 and appendix A",
        "2e-12 1/s: double precision on matrices with entries up to 1e3 (the source prints fourteen decimals)"
    ),
];

fn whipple() -> Tree {
    Tree::of("models/vehicles/whipple/whipple.urdf", BaseDescription::VehicleBase, 9.81)
}

/// Height of the lowest point of a wheel over the road, and velocity of the material there.
fn touching(tree: &Tree, link: &str, radius: f64) -> (f64, Vec3<f64>) {
    let center = tree.position(link, [0.0; 3]);
    let profile = Profile::disc(radius).expect("a radius");
    let axis = tree.orientation(link).columns[1];
    let contact = Contact::with_plane(&profile, center, axis, &Plane::LEVEL.tangent_plane(center.x, center.y));
    let slip = tree.velocity(link, [0.0; 3]) + tree.angular_velocity(link).cross(contact.arm);
    (-contact.penetration, slip)
}

#[test]
fn published_motions_roll_without_slip() {
    let table = Table::read("bicycle/iftomm_m1.csv");
    let samples = (0..table.len()).map(|row| (format!("M1, sample {row}"), m1(&table, row)));
    let mut tree = whipple();
    let mut agreement = Agreement::on("whipple: published motions roll without slip");
    let digits = absolute(1e-11).because("thirteen digits of both sources");
    for (what, motion) in samples.chain([("Basu-Mandal".to_owned(), basu_mandal())]) {
        tree.put(&motion.coordinates);
        tree.put(&motion.velocities);
        for (link, radius) in [("rear_wheel_rim", REAR_RADIUS), ("front_wheel_rim", FRONT_RADIUS)] {
            let (height, slip) = touching(&tree, link, radius);
            agreement.near(&format!("{what}: {link} height"), height, 0.0, &digits);
            agreement.all_near(&format!("{what}: {link} slip"), &[slip.x, slip.y, slip.z], &[0.0; 3], &digits);
        }
    }
    agreement.assert();
}

#[test]
fn energies_of_a_published_motion_are_met() {
    let table = Table::read("bicycle/iftomm_m1.csv");
    let mut tree = whipple();
    let mut agreement = Agreement::on("whipple: energies of the motion M1");
    let digits = absolute(1e-8).because("thirteen digits of speeds that carry 781 J");
    for row in 0..table.len() {
        let motion = m1(&table, row);
        tree.put(&motion.coordinates);
        tree.put(&motion.velocities);
        agreement.near(&format!("kinetic, sample {row}"), tree.kinetic(), table.number(row, "kinetic_J"), &digits);
        agreement.near(&format!("potential, sample {row}"), tree.potential(), table.number(row, "potential_J"), &digits);
    }
    agreement.assert();
}

/// A matrix of the linear equations, in the signs of the paper.
pub fn matrix(table: &Table, name: &str) -> Matrix2<f64> {
    let row = |row: &str| table.find(&[("matrix", name), ("row", row)]);
    let entry = |i: &str, j: &str| table.number(row(i), j);
    Matrix2::new(entry("lean", "lean"), entry("lean", "steer"), entry("steer", "lean"), entry("steer", "steer"))
}

/// `q̈ = −M⁻¹ (v C₁ q̇ + (g K₀ + v² K₂) q)` as a matrix on (lean, steer, lean rate, steer rate).
pub fn state_matrix(speed: f64) -> Matrix4<f64> {
    let table = Table::read("bicycle/matrices.csv");
    let [M, C1, K0, K2] = ["M", "C1", "K0", "K2"].map(|name| matrix(&table, name));
    let inverse = M.try_inverse().expect("a mass matrix");
    let mut A = Matrix4::zeros();
    A.fixed_view_mut::<2, 2>(0, 2).copy_from(&Matrix2::identity());
    A.fixed_view_mut::<2, 2>(2, 0).copy_from(&(-inverse * (K0 * 9.81 + K2 * (speed * speed))));
    A.fixed_view_mut::<2, 2>(2, 2).copy_from(&(-inverse * C1 * speed));
    A
}

/// Eigenvalues of a row of table 2, sorted by real part, then by imaginary part.
pub fn printed_eigenvalues(table: &Table, row: usize) -> Vec<(f64, f64)> {
    let get = |column: &str| table.number(row, column);
    let weave = match table.cell(row, "weave_second_real") {
        "" => [(get("weave_re"), get("weave_im")), (get("weave_re"), -get("weave_im"))],
        _ => [(get("weave_re"), 0.0), (get("weave_second_real"), 0.0)],
    };
    sorted([(get("castering"), 0.0), (get("capsize"), 0.0), weave[0], weave[1]].to_vec())
}

/// Sorted by real part, equal ones by imaginary part.
pub fn sorted(mut values: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let rounded = |x: f64| (x * 1e8).round();
    values.sort_by(|a, b| rounded(a.0).total_cmp(&rounded(b.0)).then(a.1.total_cmp(&b.1)));
    values
}

#[test]
fn printed_eigenvalues_follow_from_the_matrices() {
    let table = Table::read("bicycle/table_2.csv");
    let mut agreement = Agreement::on("benchmark bicycle: table 2 from the matrices");
    let digits = absolute(2e-12).because("double precision on matrices with entries up to 1e3");
    for row in 0..table.len() {
        let speed = table.number(row, "v_m_s");
        let found = state_matrix(speed).complex_eigenvalues();
        let found = sorted(found.iter().map(|z| (z.re, z.im)).collect());
        for (k, (found, expected)) in found.iter().zip(printed_eigenvalues(&table, row)).enumerate() {
            agreement.near(&format!("{speed} m/s, real part {k}"), found.0, expected.0, &digits);
            agreement.near(&format!("{speed} m/s, imaginary part {k}"), found.1, expected.1, &digits);
        }
    }
    agreement.assert();
}
