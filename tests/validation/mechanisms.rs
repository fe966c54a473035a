//! Mechanisms with loops and tops: problems of the IFToMM library and of the literature.
//!
//! The functions below say how the quantities of the sources are those of our models; the axes and angles are derived in the `SOURCE.md` beside each model.

use analyses::linearize::Options;
use analyses::{eigen, linearize};
use fastbike::plan::Request;
use mbody::assembly::BaseDescription;
use mbody::dynamics::{Formulation, TreePlant};
use mbody::spatial::Vec3;
use problem::{At, Dae};
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::instant::Instant;
use validation::reference::Table;
use validation::tree::{Named, Tree};
use validation::vehicle::Vehicle;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_motion_of_four_bars_fits_the_model => (
        "`n_four_bar`: loops and energy of the model hold along the exact motion",
        "reduction to one degree of freedom, `mbs/n_four_bar.csv`",
        "1e-14 m, 1e-11 of the energy: digits of the source"
    ),
    the_motion_of_andrews_squeezer_fits_the_model => (
        "`andrews_squeezer`: loops, their rates and the energy (spring and drive included) of the model hold along the reference motion; the crank turns the published way",
        "separate program, `mbs/andrews_squeezer.csv`; IVP test set",
        "5e-15 m, 1e-12 m/s, 1e-11 of the work of the drive: fifteen digits of the source"
    ),
    the_motion_of_the_heavy_top_fits_the_model => (
        "`heavy_top`: place of the mass center and energy of the model hold along the reference motion",
        "separate program, `mbs/heavy_top.csv`; EXUDYN",
        "1e-11 m, 1e-9 of the energy: digits and drift of the source"
    ),
    four_bars_accelerate_as_one_degree_of_freedom => (
        "`n_four_bar`: accelerations along the exact motion",
        "exact reduction 3 θ̈ = −3.5 g cos θ",
        "1e-11 rad/s²: double precision, up to six hundred times amplified near the singular poses"
    ),
    andrews_squeezer_starts_and_ends_as_published => (
        "`andrews_squeezer`: accelerations and constraint forces at the published start and at the end",
        "IVP test set (thirty digits); separate program at t = 0.03 s",
        "start 1e-12, end 1e-9 of the largest: sensitivity of the accelerations near the dead center to digits of the angles"
    ),
    the_spring_holds_the_four_bar_at_the_published_angle => (
        "`four_bar_diagonal_spring`: static angle",
        "B. P. Minaker, IFToMM solution 120; closed form",
        "1e-13 rad/s²: double precision"
    ),
    the_four_bar_is_trimmed_and_swings_as_published => (
        "`four_bar_diagonal_spring`: static angle found by the trim, eigenvalues of small motions about it",
        "closed form; B. P. Minaker, IFToMM solution 120",
        "1e-12 rad, 1/s: double precision (printed: ten digits)"
    ),
];

fn tree(name: &str, gravity: f64) -> Tree {
    Tree::of(&format!("models/mechanisms/{name}/{name}.urdf"), BaseDescription::Fixed, gravity)
}

/// Two four-bars: θ of the source is the angle of every crank; couplers stay level, so their angle relative to the crank is −θ.
pub fn four_bars(theta: f64, theta_dot: f64) -> Vec<Named> {
    vec![
        ("crank_0.angle", theta),
        ("coupler_1.angle", -theta),
        ("crank_1.angle", theta),
        ("coupler_2.angle", -theta),
        ("crank_2.angle", theta),
        ("crank_0.rate", theta_dot),
        ("coupler_1.rate", -theta_dot),
        ("crank_1.rate", theta_dot),
        ("coupler_2.rate", -theta_dot),
        ("crank_2.rate", theta_dot),
    ]
}

/// Columns of the files on Andrews' mechanism, with our coordinates and velocities: joint angles are the published ones.
pub const SQUEEZER: [(&str, &str, &str); 7] = [
    ("beta", "beta.angle", "beta.rate"),
    ("Theta", "theta.angle", "theta.rate"),
    ("gamma", "gamma.angle", "gamma.rate"),
    ("Phi", "phi.angle", "phi.rate"),
    ("delta", "delta.angle", "delta.rate"),
    ("Omega", "omega.angle", "omega.rate"),
    ("epsilon", "epsilon.angle", "epsilon.rate"),
];

/// Torque of the drive, N m.
pub const SQUEEZER_TORQUE: f64 = 0.033;

/// Point E on each of the four bodies that meet there: link and coordinates.
const SQUEEZER_E: [(&str, [f64; 3]); 4] =
    [("k2", [-0.028, 0.0, 0.0]), ("k3", [0.0, 0.0, -0.035]), ("k4", [0.0, 0.0, -0.02]), ("k6", [0.02, 0.0, 0.0])];

/// A row of the file on Andrews' mechanism.
pub fn squeezer(table: &Table, row: usize) -> Vec<Named> {
    let values = SQUEEZER
        .iter()
        .flat_map(|(column, angle, rate)| [(*angle, table.number(row, column)), (*rate, table.number(row, &format!("d_{column}")))]);
    values.collect()
}

/// A row of the file on the heavy top: the quaternion turns the top into the world, scalar part first there and last here.
pub fn top(table: &Table, row: usize) -> Vec<Named> {
    let columns = [
        ("pivot.quaternion_x", "e1"),
        ("pivot.quaternion_y", "e2"),
        ("pivot.quaternion_z", "e3"),
        ("pivot.quaternion_w", "e0"),
        ("pivot.angular_velocity_x", "wx"),
        ("pivot.angular_velocity_y", "wy"),
        ("pivot.angular_velocity_z", "wz"),
    ];
    columns.map(|(ours, column)| (ours, table.number(row, column))).to_vec()
}

#[test]
fn the_motion_of_four_bars_fits_the_model() {
    let table = Table::read("mbs/n_four_bar.csv");
    let mut tree = tree("n_four_bar", 9.81);
    let mut agreement = Agreement::on("n_four_bar: the exact motion in the model");
    let closed = absolute(1e-14).because("double precision of sines of angles up to 30 rad");
    let digits = relative(1e-11).because("the source's integration at 1e-13");
    // cranks upright: 3 m g L/2 + 2 m g L, and ½ 3 m L²
    let energy = 9.81 * 3.5 + 1.5;
    for row in 0..table.len() {
        tree.put(&four_bars(table.number(row, "theta"), table.number(row, "theta_dot")));
        for (coupler, crank) in [("coupler_rod_1", "crank_rod_1"), ("coupler_rod_2", "crank_rod_2")] {
            let gap = tree.position(coupler, [1.0, 0.0, 0.0]) - tree.position(crank, [1.0, 0.0, 0.0]);
            agreement.all_near(&format!("row {row}: gap at {coupler}"), &[gap.x, gap.y, gap.z], &[0.0; 3], &closed);
        }
        // the plane (x, y) of the source is (x, z)
        let B0 = tree.position("coupler_rod_1", [0.0; 3]);
        agreement.all_near(&format!("row {row}: B0"), &[B0.x, B0.z], &[table.number(row, "B0x"), table.number(row, "B0y")], &closed);
        agreement.near(&format!("row {row}: energy"), tree.kinetic() + tree.potential(), energy, &digits);
    }
    agreement.assert();
}

#[test]
fn the_motion_of_andrews_squeezer_fits_the_model() {
    let table = Table::read("mbs/andrews_squeezer.csv");
    let mut tree = tree("andrews_squeezer", 0.0);
    let mut agreement = Agreement::on("andrews_squeezer: the reference motion in the model");
    let closed = absolute(5e-15).because("angles up to 16 rad printed to 1e-13 rad, on 35 mm");
    let rates = absolute(1e-12).because("rates up to 1400 rad/s printed to 1e-11 rad/s, on 35 mm");
    let mut start = None;
    for row in 0..table.len() {
        tree.put(&squeezer(&table, row));
        let [E, others @ ..] = SQUEEZER_E;
        for (link, at) in others {
            let gap = tree.position(E.0, E.1) - tree.position(link, at);
            agreement.all_near(&format!("row {row}: gap at {link}"), &[gap.x, gap.y, gap.z], &[0.0; 3], &closed);
            let rate = tree.velocity(E.0, E.1) - tree.velocity(link, at);
            agreement.all_near(&format!("row {row}: its rate at {link}"), &[rate.x, rate.y, rate.z], &[0.0; 3], &rates);
        }
        // spring from C to D, without a force at 0.07785 m
        let C = Vec3::new(0.014, 0.0, 0.072);
        let stretch = (tree.position("k3", [0.02, 0.0, -0.018]) - C).norm() - 0.07785;
        let beta = table.number(row, "beta");
        let energy = tree.kinetic() + 0.5 * 4530.0 * stretch * stretch - SQUEEZER_TORQUE * beta;
        let (first, from) = *start.get_or_insert((energy, beta));
        // work of 0.033 N m over 2.5 turns
        let work = SQUEEZER_TORQUE * (15.8 - from);
        let digits = absolute(1e-11 * work).because("drift of the source, 6e-14, and its digits");
        agreement.near(&format!("row {row}: energy less work"), energy, first, &digits);
    }
    // the published start and end are those of the file, so axes and signs are the published ones, too
    let states = Table::read("mbs/andrews_squeezer_states.csv");
    let printed = absolute(2e-9).because("the published end has about ten correct digits");
    for (what, row) in [("initial_angle", 0), ("published_end_angle", table.len() - 1)] {
        let state = states.find(&[("what", what)]);
        for (column, ..) in SQUEEZER {
            agreement.near(&format!("{what}: {column}"), table.number(row, column), states.number(state, column), &printed);
        }
    }
    agreement.assert();
}

#[test]
fn the_motion_of_the_heavy_top_fits_the_model() {
    let table = Table::read("mbs/heavy_top.csv");
    let mut tree = tree("heavy_top", 9.81);
    let mut agreement = Agreement::on("heavy_top: the reference motion in the model");
    let place = absolute(1e-11).because("twelve digits of the source");
    let drift = relative(1e-9).because("drift of the source, 1.2e-10 J of 5436 J, and thirteen digits of 150 rad/s");
    // ½ (0.46875 · 150² + 15.234375 · 4.61538²) J, the mass center level with the fixed point
    let energy = 0.5 * (0.46875 * 150.0 * 150.0 + 15.234375 * 4.61538 * 4.61538);
    for row in 0..table.len() {
        tree.put(&top(&table, row));
        let c = tree.position("top", [0.0, 1.0, 0.0]);
        let expected = ["x", "y", "z"].map(|column| table.number(row, column));
        agreement.all_near(&format!("row {row}: mass center"), &[c.x, c.y, c.z], &expected, &place);
        agreement.near(&format!("row {row}: energy"), tree.kinetic() + tree.potential(), energy, &drift);
    }
    agreement.assert();
}

#[test]
fn four_bars_accelerate_as_one_degree_of_freedom() {
    let table = Table::read("mbs/n_four_bar.csv");
    let mut model = Instant::of("n_four_bar");
    let mut agreement = Agreement::on("n_four_bar: accelerations along the exact motion");
    for row in 0..table.len() {
        let (theta, rate) = (table.number(row, "theta"), table.number(row, "theta_dot"));
        model.put(&four_bars(theta, rate));
        let expected = -3.5 / 3.0 * 9.81 * theta.cos();
        // rods in one line leave the loops free: constraint rows are regular in proportion to sin θ
        let rounding = absolute(1e-13 / theta.sin().abs()).because("double precision, distance from the singular pose");
        for crank in ["crank_0.rate", "crank_1.rate", "crank_2.rate"] {
            agreement.near(&format!("row {row}: {crank}"), model.rate(crank), expected, &rounding);
        }
        agreement.near(&format!("row {row}: coupler"), model.rate("coupler_1.rate"), -expected, &rounding);
    }
    agreement.assert();
}

/// The six published multipliers from a point of our model: (λ₁, λ₂) is the force of K2 on K3 at E, in the plane of the source (x, z), and so on.
///
/// Our multipliers are the forces of the body with the line (K3, K4, K6) on K2, in axes of that body.
fn squeezer_forces(model: &mut Instant) -> Vec<f64> {
    let mut forces = Vec::new();
    for (pin, link) in [("pin_k3", "k3"), ("pin_k4", "k4"), ("pin_k6", "k6")] {
        let on_k2 = Vec3::new(model.get(&format!("{pin}.force_x")), 0.0, model.get(&format!("{pin}.force_z")));
        let back = -(model.pose(link).R * on_k2);
        forces.extend([back.x, back.z]);
    }
    forces
}

#[test]
fn andrews_squeezer_starts_and_ends_as_published() {
    let states = Table::read("mbs/andrews_squeezer_states.csv");
    let multipliers = Table::read("mbs/andrews_squeezer_multipliers.csv");
    let mut model = Instant::of("andrews_squeezer");
    let mut agreement = Agreement::on("andrews_squeezer: accelerations and forces");
    let double = relative(1e-12).because("double precision");
    let digits = relative(1e-9).because("rounded angles near the dead center");
    for (what, tolerance) in [("initial", double), ("converged_end", digits)] {
        let numbers = |quantity: &str| -> Vec<f64> {
            let row = states.find(&[("what", &format!("{what}_{quantity}"))]);
            SQUEEZER.iter().map(|(column, ..)| states.number(row, column)).collect()
        };
        let (angles, rates) = (numbers("angle"), numbers("rate"));
        let mut point = vec![("motor.torque", SQUEEZER_TORQUE)];
        for (k, (_, angle, rate)) in SQUEEZER.into_iter().enumerate() {
            point.extend([(angle, angles[k]), (rate, rates[k])]);
        }
        model.put(&point);
        let accelerations: Vec<f64> = SQUEEZER.iter().map(|(_, _, rate)| model.rate(rate)).collect();
        agreement.all_near(&format!("{what} accelerations"), &accelerations, &numbers("acceleration"), &tolerance);
        let row = multipliers.find(&[("what", what)]);
        let expected: Vec<f64> = (1..=6).map(|k| multipliers.number(row, &format!("l{k}"))).collect();
        agreement.all_near(&format!("{what} forces"), &squeezer_forces(&mut model), &expected, &tolerance);
    }
    agreement.assert();
}

#[test]
fn the_spring_holds_the_four_bar_at_the_published_angle() {
    let table = Table::read("mbs/four_bar_diagonal_spring.csv");
    let angle = table.number(table.find(&[("quantity", "static_angle")]), "closed_form");
    let mut model = Instant::of("four_bar_diagonal_spring");
    model.put(&[("left_crank.angle", angle), ("coupler.angle", -angle), ("right_crank.angle", angle)]);
    let mut agreement = Agreement::on("four_bar_diagonal_spring: static angle");
    let double = absolute(1e-13).because("double precision of accelerations whose parts are up to 10 rad/s²");
    for name in ["left_crank.rate", "coupler.rate", "right_crank.rate"] {
        agreement.near(name, model.rate(name), 0.0, &double);
    }
    agreement.assert();
}

#[test]
fn the_four_bar_is_trimmed_and_swings_as_published() {
    let table = Table::read("mbs/four_bar_diagonal_spring.csv");
    let expected = |quantity: &str, column: &str| table.number(table.find(&[("quantity", quantity)]), column);
    let state = Vehicle::bundled("four_bar_diagonal_spring").state(&Request::default());
    let mut plant = TreePlant::in_formulation(state.system.clone(), Formulation::Ggl);
    let value = |name: &str| if name.ends_with("_correction") { 0.0 } else { state.get(name) };
    let y: Vec<f64> = plant.unknowns().iter().map(|k| value(&k.signal.name)).collect();
    let at = At { time: 0.0, y: &y, yd: &vec![0.0; y.len()], u: &[] };
    let model = linearize(&mut plant, at, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let spectrum = eigen(&model).unwrap_or_else(|error| panic!("{error}"));
    let mut agreement = Agreement::on("four_bar_diagonal_spring: trim and eigenvalues");
    let double = absolute(1e-12).because("double precision");
    let printed = absolute(5e-10).because("about ten correct digits of the printed ones");
    agreement.holds("one degree of freedom", spectrum.values.len() == 2);
    for (quantity, found) in [
        ("static_angle", state.get("left_crank.angle")),
        ("eigenvalue_real", spectrum.values[0].re),
        ("eigenvalue_imaginary", spectrum.values[0].im),
    ] {
        agreement.near(quantity, found, expected(quantity, "closed_form"), &double);
        agreement.near(&format!("{quantity}, printed"), found, expected(quantity, "printed"), &printed);
    }
    agreement.assert();
}
