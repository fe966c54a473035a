//! Frequency responses against closed forms, and against the matrices solved as they stand; comfort in closed form.

#![allow(non_snake_case)]

mod written;

use analyses::comfort::{BAND, Direction};
use analyses::linearize::{Cyclic, Options, State};
use analyses::weighting::WK;
use analyses::{Excitation, FrequencyResponse, FrequencyResponseError, LinearModel, comfort, linearize};
use nalgebra::{Complex, DMatrix};
use problem::{At, Input, Signal, UnknownKind};
use written::Written;

const FREQUENCIES: [f64; 7] = [1e-3, 0.3, 2.0, 7.0, 11.0, 90.0, 1e4];

fn model(plant: &Written, y: &[f64], u: &[f64]) -> LinearModel {
    linearize(&mut plant.clone(), At { time: 0.0, y, yd: &vec![0.0; y.len()], u }, &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn names(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// All responses at one frequency.
fn responses(model: &LinearModel, excitations: &[Excitation], outputs: &str, omega: f64) -> Vec<Complex<f64>> {
    let mut response = FrequencyResponse::of(model, excitations, &names(outputs)).unwrap_or_else(|e| panic!("{e}"));
    let mut found = vec![Complex::new(0.0, 0.0); response.inputs.len() * response.outputs.len()];
    response.at(omega, &mut found);
    found
}

fn near(found: Complex<f64>, expected: Complex<f64>, share: f64) {
    assert!((found - expected).norm() <= share * expected.norm(), "{found} instead of {expected}");
}

const MASS: f64 = 3.0;
const STIFFNESS: f64 = 400.0;
const DAMPING: f64 = 11.0;

/// A mass on spring and damper whose foot moves: the foot's height comes with its rate.
fn on_a_moving_foot() -> Written {
    Written::new(|y, yd, u| {
        let force = STIFFNESS * (u[0] - y[0]) + DAMPING * (u[1] - y[1]) + u[2];
        (vec![yd[0] - y[1], MASS * yd[1] - force], vec![yd[1], force])
    })
    .coordinates("x", "v")
    .inputs("foot foot_rate push")
    .rate("foot", "foot_rate")
    .outputs("acceleration force")
}

#[test]
fn a_mass_on_a_moving_foot_transmits_as_by_hand() {
    let model = model(&on_a_moving_foot(), &[0.0; 2], &[0.0; 3]);
    let excitations = ["foot", "foot_rate", "push"].map(Excitation::input);
    for omega in FREQUENCIES {
        let s = Complex::new(0.0, omega);
        let spring = Complex::new(STIFFNESS, 0.0) + s * DAMPING;
        let dynamic = spring + s * s * MASS;
        let found = responses(&model, &excitations, "x rate(v) acceleration force", omega);
        let x = [spring / dynamic, spring / dynamic / s, Complex::new(1.0, 0.0) / dynamic];
        for (found, x) in found.chunks(4).zip(x) {
            near(found[0], x, 1e-12);
            near(found[1], s * s * x, 1e-12);
            // sums of forces that cancel: double precision of their terms
            let terms = (spring * x).norm() * omega.max(1.0) + 1.0;
            for (found, expected) in [(found[2] * MASS, s * s * x * MASS), (found[3], s * s * x * MASS)] {
                assert!((found - expected).norm() < 1e-12 * terms.max(STIFFNESS), "{found} instead of {expected}");
            }
        }
    }
}

#[test]
fn a_cause_reaches_two_inputs_one_after_the_other() {
    let model = model(&on_a_moving_foot(), &[0.0; 2], &[0.0; 3]);
    let (early, late) = (0.0, 0.07);
    let both = Excitation::delayed("both", [("foot".to_owned(), early), ("push".to_owned(), late)]);
    let alone = ["foot", "push"].map(Excitation::input);
    for omega in FREQUENCIES {
        let found = responses(&model, std::slice::from_ref(&both), "x", omega);
        let parts = responses(&model, &alone, "x", omega);
        near(found[0], parts[0] + parts[1] * Complex::from_polar(1.0, -omega * late), 1e-12);
    }
    let response = FrequencyResponse::of(&model, &[both], &names("x")).expect("a response");
    assert_eq!(response.inputs[0].name, "both");
}

/// Reproducible numbers between −1 and 1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A linear model of any matrices; the states are s0, s1, …, inputs u0, u1, …, outputs z0, z1, …
fn of_matrices(E: DMatrix<f64>, A: DMatrix<f64>, B: DMatrix<f64>, C: DMatrix<f64>, D: DMatrix<f64>, nominal: &[f64]) -> LinearModel {
    let signal = |letter: &str, k: usize| Signal::new(format!("{letter}{k}"), "-", "");
    let n = A.nrows();
    let state = |k: usize| State {
        signal: signal("s", k),
        kind: UnknownKind::State,
        cyclic: false,
        nominal: nominal[k],
        unknown: k,
        partner: None,
    };
    let input = |k: usize| Input { signal: signal("u", k), rate: None, nominal: 1.0, default: 0.0 };
    LinearModel {
        states: (0..n).map(state).collect(),
        inputs: (0..B.ncols()).map(input).collect(),
        outputs: (0..C.nrows()).map(|k| signal("z", k)).collect(),
        unknowns: DMatrix::identity(n, n),
        unknowns_by_inputs: DMatrix::zeros(n, B.ncols()),
        unknown_signals: (0..n).map(|k| signal("s", k)).collect(),
        cyclic: Cyclic { unknowns: Vec::new(), by_cyclic: DMatrix::zeros(0, 0), by_states: DMatrix::zeros(0, n) },
        left_out: Vec::new(),
        E,
        A,
        B,
        C,
        D,
    }
}

#[test]
fn large_badly_scaled_models_answer_as_by_a_direct_solution() {
    let n = 19;
    let mut number = numbers(4);
    let mut matrix = |rows: usize, columns: usize| DMatrix::from_fn(rows, columns, |_, _| number());
    // states of very different size, as coordinates and spins are
    let size: Vec<f64> = (0..n).map(|k| 10f64.powi(k as i32 % 7 - 3)).collect();
    let scaled = |m: DMatrix<f64>| DMatrix::from_fn(n, n, |i, k| m[(i, k)] / size[k]);
    let E = scaled(matrix(n, n) + DMatrix::from_diagonal_element(n, n, 5.0));
    let A = scaled(matrix(n, n) * 20.0);
    let (B, C, D) = (matrix(n, 3), matrix(4, n), matrix(4, 3));
    let C = DMatrix::from_fn(4, n, |i, k| C[(i, k)] / size[k]);
    let model = of_matrices(E, A, B, C, D, &size);
    let excitations: Vec<Excitation> = (0..3).map(|k| Excitation::input(format!("u{k}"))).collect();
    let complex = |m: &DMatrix<f64>| m.map(|e| Complex::new(e, 0.0));
    for omega in FREQUENCIES {
        let s = Complex::new(0.0, omega);
        let solved = (complex(&model.E) * s - complex(&model.A)).lu().solve(&complex(&model.B)).expect("regular");
        let direct = complex(&model.C) * solved + complex(&model.D);
        let found = responses(&model, &excitations, "z0 z1 z2 z3", omega);
        for (k, found) in found.iter().enumerate() {
            near(*found, direct[(k % 4, k / 4)], 1e-10);
        }
    }
}

#[test]
fn defective_modes_do_no_harm() {
    // x⁗ chain with one eigenvalue four times: H = 1/(jω + 2)⁴
    let A = DMatrix::from_fn(4, 4, |i, k| if i == k { -2.0 } else { f64::from(i32::from(i + 1 == k)) });
    let B = DMatrix::from_fn(4, 1, |i, _| f64::from(i32::from(i == 3)));
    let C = DMatrix::from_fn(1, 4, |_, k| f64::from(i32::from(k == 0)));
    let model = of_matrices(DMatrix::identity(4, 4), A, B, C, DMatrix::zeros(1, 1), &[1.0; 4]);
    for omega in [0.0, 0.5, 2.0, 30.0] {
        let pole = Complex::new(2.0, omega);
        let expected = Complex::new(1.0, 0.0) / (pole * pole * pole * pole);
        near(responses(&model, &[Excitation::input("u0")], "z0", omega)[0], expected, 1e-13);
    }
}

#[test]
fn cyclic_coordinates_follow_by_integration() {
    // a body on a viscous road: v̇ = (u − c v)/m, ẋ = v with x cyclic
    let plant = Written::new(|y, yd, u| (vec![yd[0] - y[1], 2.0 * yd[1] + 3.0 * y[1] - u[0]], vec![]))
        .coordinates("x", "v")
        .cyclic("x")
        .inputs("push");
    let model = model(&plant, &[0.0; 2], &[0.0]);
    assert_eq!(model.states.len(), 1);
    for omega in FREQUENCIES {
        let s = Complex::new(0.0, omega);
        let v = Complex::new(1.0, 0.0) / (s * 2.0 + 3.0);
        let found = responses(&model, &[Excitation::input("push")], "x v rate(x)", omega);
        [v / s, v, v].into_iter().zip(found).for_each(|(expected, found)| near(found, expected, 1e-12));
    }
}

#[test]
fn multipliers_answer_at_once() {
    // a mass against a wall, which pushes back, beside one on a spring
    let plant = Written::new(|y, yd, u| {
        let [x, z, v, w, lambda, mu] = [y[0], y[1], y[2], y[3], y[4], y[5]];
        let f = vec![yd[0] - v - mu, yd[1] - w, yd[2] - u[0] - lambda, yd[3] + 4.0 * z - u[0], v, x];
        (f, vec![])
    })
    .coordinates("x z", "v w")
    .constraints("lambda mu", "rate_of_the_wall", "wall")
    .inputs("push");
    let model = model(&plant, &[0.0; 6], &[0.0]);
    let found = responses(&model, &[Excitation::input("push")], "lambda z x", 3.0);
    near(found[0], Complex::new(-1.0, 0.0), 1e-13);
    near(found[1], Complex::new(1.0 / (4.0 - 9.0), 0.0), 1e-13);
    assert_eq!(found[2], Complex::new(0.0, 0.0));
}

#[test]
fn a_frequency_allocates_nothing() {
    let model = model(&on_a_moving_foot(), &[0.0; 2], &[0.0; 3]);
    let mut response = FrequencyResponse::of(&model, &["foot", "push"].map(Excitation::input), &names("x force")).expect("a response");
    let mut found = vec![Complex::new(0.0, 0.0); 4];
    let counted = allocation_counter::measure(|| FREQUENCIES.iter().for_each(|&omega| response.at(omega, &mut found)));
    assert_eq!(counted.count_total, 0);
}

#[test]
fn unknown_names_are_refused() {
    let model = model(&on_a_moving_foot(), &[0.0; 2], &[0.0; 3]);
    let refused = |input: &str, output: &str| FrequencyResponse::of(&model, &[Excitation::input(input)], &names(output)).err();
    assert_eq!(refused("pull", "x"), Some(FrequencyResponseError::UnknownInput { name: "pull".to_owned() }));
    assert_eq!(refused("push", "push"), Some(FrequencyResponseError::UnknownOutput { name: "push".to_owned() }));
    assert_eq!(refused("push", "rate(y)"), Some(FrequencyResponseError::UnknownOutput { name: "y".to_owned() }));
}

/// An acceleration that is the excitation itself, of constant density: a_w² = S ∫ |W|² df, so that twice the density is √2 times the value.
#[test]
fn comfort_grows_with_the_root_of_the_density() {
    let plant = Written::new(|y, yd, u| (vec![yd[0] + y[0] - u[0]], vec![u[0]])).states("x", true).inputs("a").outputs("felt");
    let model = model(&plant, &[0.0], &[0.0]);
    let mut response = FrequencyResponse::of(&model, &[Excitation::input("a")], &["felt".to_owned()]).expect("a response");
    let directions = [Direction { weighting: WK, factor: 1.4 }];
    let one = comfort(&mut response, &directions, &|_| 1.0);
    let two = comfort(&mut response, &directions, &|_| 2.0);
    assert!((two.total / one.total - 2f64.sqrt()).abs() < 1e-12);
    assert!((one.total / one.weighted[0] - 1.4).abs() < 1e-12);
    assert!((one.unweighted[0] - (BAND.1 - BAND.0).sqrt()).abs() < 1e-6);
    // by the trapezoidal rule in the frequency itself
    let steps = 400_000;
    let step = (BAND.1 - BAND.0) / f64::from(steps);
    let square = |k: i32| WK.at(BAND.0 + step * f64::from(k)).norm_sqr();
    let sum: f64 = (0..=steps).map(|k| square(k) * if k == 0 || k == steps { 0.5 } else { 1.0 }).sum();
    assert!((one.weighted[0] / (sum * step).sqrt() - 1.0).abs() < 1e-7);
    let above: f64 = (0..=steps).filter(|k| BAND.0 + step * f64::from(*k) > 20.0).map(square).sum();
    assert!((one.share_above - above / sum).abs() < 1e-4, "{} {}", one.share_above, above / sum);
}
