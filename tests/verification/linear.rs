//! Linear models: structure that symmetry demands, and the steady states next to a steady state.

use analyses::linearize::Options;
use analyses::{LinearModel, eigen, linearize};
use mbody::dynamics::{System, TreePlant};
use mbody::joint::{Joint, Spherical};
use mbody::model::{BodyIndex, ModelBuilder};
use mbody::spatial::{MassProperties, Pose, Vec3};
use nalgebra::{DMatrix, DVector};
use problem::{At, UnknownKind};
use std::sync::Arc;
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::vehicle::{BUNDLED, State, Vehicle, leaning, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    straight_running_falls_into_two_blocks => (
        "E and A of straight running fall into a block in the plane of symmetry and one out of it, for every bundled vehicle",
        "symmetry of the vehicles",
        "1e-12 of the largest entry of the row, in nominal states: double precision"
    ),
    neighboring_steady_states_are_predicted => (
        "A, B, C and D at a steady turn predict the steady states next to it: `0 = A δx + B δu`, `δz = C δx + D δu`, with neighbors from the trim",
        "central differences of steady states, extrapolated (Richardson)",
        "relative 1e-6 of the largest term: tolerance of the method over the step"
    ),
    the_norm_of_a_quaternion_is_no_mode => (
        "a rigid body that hangs from a spherical joint at any heading has two oscillations and an indifferent heading, six states; `scooter` with its engine on a spherical link has as many coordinates as velocities among its states",
        "ω² = m g l/(I + m l²) about both horizontal axes",
        "1e-12 of each frequency: double precision"
    ),
];

/// Whether a state of a motorcycle belongs to motion out of its plane of symmetry.
fn lateral(signal: &str) -> bool {
    ["lateral", "roll", "yaw", "steer."].iter().any(|part| signal.contains(part))
}

#[test]
fn straight_running_falls_into_two_blocks() {
    let mut agreement = Agreement::on("linear models: blocks of straight running");
    let rounding = absolute(1e-12).because("double precision, in units of the largest entry of the row");
    for name in BUNDLED {
        let model = Vehicle::bundled(name).state(&running(&[30.0])).linear();
        for (matrix, letter) in [(&model.E, "E"), (&model.A, "A")] {
            for (i, row) in model.states.iter().enumerate() {
                let entry = |k: usize| matrix[(i, k)] * model.states[k].nominal;
                let largest = (0..model.states.len()).map(|k| entry(k).abs()).fold(0.0, f64::max);
                for (k, column) in model.states.iter().enumerate() {
                    if lateral(&row.signal.name) != lateral(&column.signal.name) {
                        let what = format!("{name}: {letter}, row of {}, {}", row.signal.name, column.signal.name);
                        agreement.near(&what, entry(k) / largest, 0.0, &rounding);
                    }
                }
            }
        }
    }
    agreement.assert();
}

/// Values of some signals at a state.
fn at<'a>(state: &State, names: impl Iterator<Item = &'a str>) -> DVector<f64> {
    DVector::from_iterator(names.size_hint().0, names.map(|name| state.get(name)))
}

/// Sums of this size are zero up to rounding: the height of a level road does not change.
const ZERO: f64 = 1e-6;

/// A term and the sizes of the terms of the sum that it is part of.
fn product(M: &DMatrix<f64>, x: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
    (M * x, M.abs() * x.abs())
}

#[test]
fn neighboring_steady_states_are_predicted() {
    let mut agreement = Agreement::on("linear models: neighboring steady states");
    let tolerance = absolute(1e-6).because("1e-10 of the method over a step of 1e-3, cancelled once more by the extrapolation");
    for name in BUNDLED {
        let vehicle = Vehicle::bundled(name);
        for (speed, lean) in [(25.0, 0.4), (40.0, -0.2)] {
            let model = vehicle.state(&leaning(&[speed], &[lean])).linear();
            let signals = |model: &LinearModel| -> [Vec<String>; 3] {
                [
                    model.states.iter().map(|s| s.signal.name.clone()).collect(),
                    model.inputs.iter().map(|i| i.signal.name.clone()).collect(),
                    model.outputs.iter().map(|o| o.name.clone()).collect(),
                ]
            };
            let names = signals(&model);
            // along the lean, and along the speed
            for (by_speed, by_lean) in [(0.0, 1e-3), (1e-2, 0.0)] {
                let slope = |h: f64| {
                    let [up, down] = [h, -h].map(|h| vehicle.state(&leaning(&[speed + h * by_speed], &[lean + h * by_lean])));
                    let difference = |names: &Vec<String>| {
                        let of = |state: &State| at(state, names.iter().map(String::as_str));
                        (of(&up) - of(&down)) / (2.0 * h)
                    };
                    names.each_ref().map(difference)
                };
                let (whole, half) = (slope(1.0), slope(0.5));
                let [x, u, z] = [0, 1, 2].map(|k| (4.0 * &half[k] - &whole[k]) / 3.0);
                let (Ax, Bu, Cx, Du) = (product(&model.A, &x), product(&model.B, &u), product(&model.C, &x), product(&model.D, &u));
                let what = format!("{name} at {speed} m/s, {lean} rad");
                for (i, state) in model.states.iter().enumerate() {
                    let off = (Ax.0[i] + Bu.0[i]) / (Ax.1[i] + Bu.1[i]).max(ZERO);
                    agreement.near(&format!("{what}: row of {}", state.signal.name), off, 0.0, &tolerance);
                }
                for (i, output) in names[2].iter().enumerate() {
                    let off = (Cx.0[i] + Du.0[i] - z[i]) / (Cx.1[i] + Du.1[i] + z[i].abs()).max(ZERO);
                    agreement.near(&format!("{what}: {output}"), off, 0.0, &tolerance);
                }
            }
        }
    }
    agreement.assert();
}

#[test]
fn the_norm_of_a_quaternion_is_no_mode() {
    let (m, l, I, g) = (3.0, 0.4, [0.05, 0.11, 0.02], 9.81);
    let mut agreement = Agreement::on("spherical pendulum: states and frequencies");
    for heading in [0.0, 0.7, 2.5, -3.0] {
        let mut builder = ModelBuilder::new();
        let mass = MassProperties { mass: m, center: Vec3::new(0.0, 0.0, -l), inertia: [I[0], I[1], I[2], 0.0, 0.0, 0.0] };
        builder.body("bob", BodyIndex::WORLD, "ball", Joint::new(Spherical), Pose::identity(), mass).expect("a body");
        let system = System::new(builder.finish().expect("a tree"), Vec::new()).expect("a system");
        let mut plant = TreePlant::new(Arc::new(system));
        let half: f64 = 0.5 * heading;
        let y = [0.0, 0.0, half.sin(), half.cos(), 0.0, 0.0, 0.0];
        let at = At { time: 0.0, y: &y, yd: &[0.0; 7], u: &[] };
        let model = linearize(&mut plant, at, &Options::default()).expect("a linear model");
        agreement.holds(&format!("heading {heading}: {} states", model.states.len()), model.states.len() == 6);
        // the coordinate that is left out follows the others along the sphere
        let follows = DVector::from_iterator(4, y[..4].iter().copied()).transpose() * model.unknowns.rows(0, 4);
        agreement.holds(&format!("heading {heading}: {follows}"), follows.amax() < 1e-15);
        let spectrum = eigen(&model).expect("eigenvalues");
        let mut expected = [I[0], I[1]].map(|I| (m * g * l / (I + m * l * l)).sqrt());
        expected.sort_by(|a, b| b.total_cmp(a));
        for (pair, frequency) in spectrum.values.chunks(2).zip(expected) {
            agreement.near(&format!("heading {heading}: {}", pair[0]), pair[0].im, frequency, &relative(1e-12).because("double precision"));
        }
        agreement.holds("the heading is indifferent", spectrum.values[4..].iter().all(|v| v.norm() < 1e-7));
    }
    let scooter = Vehicle::bundled("scooter").state(&running(&[20.0])).linear();
    let count = |kind: UnknownKind| scooter.states.iter().filter(|s| s.kind == kind).count();
    // of the velocities the speed, two rates and two spins have cyclic coordinates
    let cyclic = scooter.states.iter().filter(|s| s.kind == UnknownKind::Velocity && s.cyclic).count();
    agreement.holds("coordinates and velocities of the scooter", count(UnknownKind::Position) == count(UnknownKind::Velocity) - cyclic);
    agreement.assert();
}
