//! Sensitivities of plants written by hand, against derivatives of closed forms.

#![allow(non_snake_case)]

mod written;

use analyses::Sensitivity;
use analyses::sensitivity::Derivatives;
use analyses::trim::Trim;
use nalgebra::Complex;
use problem::{At, Family, ParameterId};
use written::family::Numbers;
use written::{Dual, Law, Written};

const G: f64 = 9.81;

/// Sensitivities at a rest with given values of the inputs; `y` is the rest.
fn at_rest<'f>(family: &'f Numbers, y: &[f64], u: &[f64], states: &[&str]) -> Sensitivity<'f> {
    let plant = family.with(&[]).expect("the member itself").steady;
    let mut trim = Trim::at_rest(plant.as_ref());
    for (input, value) in plant.inputs().iter().zip(u) {
        trim.give(&input.signal.name, *value).expect("an input");
    }
    let states: Vec<String> = states.iter().map(|s| (*s).to_owned()).collect();
    let at = At { time: 0.0, y, yd: &vec![0.0; y.len()], u };
    Sensitivity::at(family, &trim, at, &states).unwrap_or_else(|error| panic!("{error}"))
}

fn by(sensitivity: &Sensitivity<'_>, k: usize) -> Derivatives {
    sensitivity.by(ParameterId(k)).unwrap_or_else(|error| panic!("{error}"))
}

/// The eigenvalue with the positive imaginary part, and its derivatives by all parameters.
fn slopes(sensitivity: &Sensitivity<'_>, count: usize) -> (Complex<f64>, Vec<Complex<f64>>) {
    let slope = |k: usize| {
        let found = by(sensitivity, k).eigenvalues[0].expect("an eigenvalue of its own");
        assert!(found.error < 1e-7 * found.value.norm().max(1.0), "{found:?}");
        found.value
    };
    (sensitivity.spectrum.values[0], (0..count).map(slope).collect())
}

fn near(found: Complex<f64>, expected: Complex<f64>) {
    assert!((found - expected).norm() < 1e-9 * expected.norm().max(1.0), "{found} instead of {expected}");
}

/// `m q̈ + c q̇ + k q = 0`.
fn oscillator() -> Written {
    Written::new(|y, yd, u| (vec![yd[0] - y[1], u[0] * yd[1] + u[1] * y[1] + u[2] * y[0]], vec![u[2] * y[0]]))
        .coordinates("q", "v")
        .inputs("m c k")
        .outputs("force")
}

#[test]
fn a_damped_oscillator_moves_as_its_characteristic_polynomial_says() {
    let (m, c, k) = (3.0, 2.0, 700.0);
    let family = Numbers::of(oscillator(), oscillator(), &[m, c, k]);
    let (s, found) = slopes(&at_rest(&family, &[0.0, 0.0], &[], &[]), 3);
    // d(m s² + c s + k) = 0
    let by_s = s * 2.0 * m + c;
    for (slope, by_parameter) in found.iter().zip([s * s, s, Complex::new(1.0, 0.0)]) {
        near(*slope, -by_parameter / by_s);
    }
}

#[test]
fn double_eigenvalues_have_no_derivative() {
    // critical damping: one vector for two eigenvalues
    let family = Numbers::of(oscillator(), oscillator(), &[1.0, 4.0, 4.0]);
    let found = by(&at_rest(&family, &[0.0, 0.0], &[], &[]), 1);
    assert!(found.eigenvalues.iter().all(Option::is_none), "{:?}", found.eigenvalues);
}

/// A point mass on a rod of length l, pushed aside by a force F; mass, length and field of gravity are parameters. One law for both
/// forms: without the multiplier μ the rod's length is a constraint on coordinates, with it there is one on velocities too.
fn pendulum(stabilized: bool) -> Written {
    const STABILIZED: Law = |y, yd, u| {
        let (mut f, z) = swings(y, yd, u, y[5]);
        f.insert(4, y[0] * y[2] + y[1] * y[3]);
        (f, z)
    };
    const AS_IT_IS: Law = |y, yd, u| swings(y, yd, u, 0.0.into());
    let plant = Written::new(if stabilized { STABILIZED } else { AS_IT_IS }).coordinates("x z", "vx vz");
    let plant = match stabilized {
        true => plant.constraints("lambda mu", "rate_of_the_rod", "length_of_the_rod"),
        false => plant.constraints("lambda", "", "length_of_the_rod"),
    };
    plant.inputs("push m l g").outputs("tension")
}

fn swings(y: &[Dual], yd: &[Dual], u: &[Dual], mu: Dual) -> (Vec<Dual>, Vec<Dual>) {
    let [x, z, vx, vz, lambda] = [y[0], y[1], y[2], y[3], y[4]];
    let [push, m, l, g] = [u[0], u[1], u[2], u[3]];
    let f = vec![
        yd[0] - vx - x * mu,
        yd[1] - vz - z * mu,
        m * yd[2] - x * lambda - push,
        m * yd[3] + m * g - z * lambda,
        0.5 * (x * x + z * z - l * l),
    ];
    (f, vec![-(lambda * l)])
}

/// The rest moves with every parameter: with the push F the rod hangs at `tan θ = F / m g`, and `s² = −g / (l cos θ)`.
#[test]
fn a_pendulum_pushed_aside_takes_its_rest_along() {
    let (push, m, l, g) = (30.0, 2.0, 0.7, G);
    let family = Numbers::of(pendulum(false), pendulum(true), &[m, l, g]);
    let angle = (push / (m * g)).atan();
    let pull = m * g / angle.cos();
    let rest = [l * angle.sin(), -l * angle.cos(), 0.0, 0.0, -pull / l];
    for state in ["x", "z"] {
        let sensitivity = at_rest(&family, &rest, &[push], &[state]);
        let (s, found) = slopes(&sensitivity, 3);
        near(s, Complex::new(0.0, (g / (l * angle.cos())).sqrt()));
        // ω² = √(g² + F²/m²) / l
        let root = (g * g + (push / m).powi(2)).sqrt();
        let squared = [-push * push / m.powi(3) / root / l, -root / (l * l), g / root / l];
        for (slope, squared) in found.iter().zip(squared) {
            near(*slope, Complex::new(0.0, squared / (2.0 * s.im)));
        }
        // x = l F / √(F² + m² g²), tension = √(F² + m² g²)
        let size = push.hypot(m * g);
        let by_length = by(&sensitivity, 1);
        assert!((by_length.unknowns[0].value - push / size).abs() < 1e-9);
        let by_mass = by(&sensitivity, 0);
        assert!((by_mass.unknowns[0].value + l * push * m * g * g / size.powi(3)).abs() < 1e-9);
        assert!((by_mass.outputs[0].value - m * g * g / size).abs() < 1e-9);
        assert_eq!(by_mass.inputs.len(), 1);
    }
}

#[test]
fn values_that_are_no_rest_are_refused() {
    let family = Numbers::of(pendulum(false), pendulum(true), &[2.0, 0.7, 0.0]);
    let plant = family.with(&[]).expect("the member itself").steady;
    let mut trim = Trim::at_rest(plant.as_ref());
    trim.give("push", 0.0).expect("an input");
    // without gravity and push every angle is a rest
    let at = At { time: 0.0, y: &[0.0, -0.7, 0.0, 0.0, 0.0], yd: &[0.0; 5], u: &[0.0] };
    assert!(Sensitivity::at(&family, &trim, at, &[]).is_err());
}
