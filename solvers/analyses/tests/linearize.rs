//! Linear models of plants written by hand, against what follows from their equations by hand.

#![allow(non_snake_case)]

mod written;

use analyses::linearize::{BoundInputs, OffTrim, Options};
use analyses::{LinearModel, LinearizeError, eigen, linearize};
use problem::At;
use written::{Dual, Written};

const G: f64 = 9.81;

fn model_at(plant: &Written, y: &[f64], yd: &[f64], u: &[f64], options: &Options) -> Result<LinearModel, LinearizeError> {
    linearize(&mut plant.clone(), At { time: 0.0, y, yd, u }, options)
}

fn model(plant: &Written, y: &[f64], u: &[f64]) -> LinearModel {
    model_at(plant, y, &vec![0.0; y.len()], u, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn names(model: &LinearModel) -> Vec<&str> {
    model.states.iter().map(|s| s.signal.name.as_str()).collect()
}

/// Eigenvalues with their real and imaginary parts, in the order of the spectrum.
fn values(model: &LinearModel) -> Vec<(f64, f64)> {
    eigen(model).unwrap_or_else(|error| panic!("{error}")).values.iter().map(|s| (s.re, s.im)).collect()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12 * expected.abs().max(1.0), "{found} instead of {expected}");
}

fn oscillates_at(model: &LinearModel, frequencies: &[f64]) {
    let found = values(model);
    assert_eq!(found.len(), 2 * frequencies.len());
    for (pair, expected) in found.chunks(2).zip(frequencies) {
        near(pair[0].0, 0.0);
        near(pair[0].1, *expected);
        near(pair[1].1, -expected);
    }
}

/// A point mass on a rod, in Cartesian coordinates: Φ = (x² + z² − l²)/2, J = (x, z). `push` is a horizontal force.
fn pendulum() -> Written {
    const MASS: f64 = 2.0;
    const LENGTH: f64 = 0.7;
    Written::new(|y, yd, u| {
        let [x, z, vx, vz, lambda, mu] = [y[0], y[1], y[2], y[3], y[4], y[5]];
        let f = vec![
            yd[0] - vx - x * mu,
            yd[1] - vz - z * mu,
            MASS * yd[2] - x * lambda - u[0],
            MASS * yd[3] + (MASS * G).into() - z * lambda,
            x * vx + z * vz,
            0.5 * (x * x + z * z - (LENGTH * LENGTH).into()),
        ];
        (f, vec![yd[2], lambda])
    })
    .coordinates("x z", "vx vz")
    .constraints("lambda mu", "rate_of_the_rod", "length_of_the_rod")
    .inputs("push")
    .outputs("acceleration tension")
}

#[test]
fn a_pendulum_in_cartesian_coordinates_swings_with_g_over_l() {
    let (m, l) = (2.0, 0.7);
    let hanging = model(&pendulum(), &[0.0, -l, 0.0, 0.0, -m * G / l, 0.0], &[0.0]);
    assert_eq!(names(&hanging), ["x", "vx"]);
    assert_eq!(hanging.states[0].partner, Some(1));
    assert_eq!(hanging.states[1].partner, Some(0));
    oscillates_at(&hanging, &[(G / l).sqrt()]);
    // the mass itself, and δv̇ = −(g/l) δx + δF/m
    near(hanging.E[(1, 1)], m);
    near(hanging.C[(0, 0)], -G / l);
    near(hanging.D[(0, 0)], 1.0 / m);
    // to first order the tension does not change
    near(hanging.C[(1, 0)], 0.0);
}

#[test]
fn a_pendulum_pushed_aside_swings_in_the_tilted_field() {
    let (m, l) = (2.0, 0.7);
    let angle = 1.2_f64;
    let (push, pull) = (m * G * angle.tan(), m * G / angle.cos());
    let aside = model(&pendulum(), &[l * angle.sin(), -l * angle.cos(), 0.0, 0.0, -pull / l, 0.0], &[push]);
    // beyond 45° the height moves more than the side: it becomes the state, and its rate with it
    assert_eq!(names(&aside), ["z", "vz"]);
    oscillates_at(&aside, &[(G / angle.cos() / l).sqrt()]);
    // reduced mass Sᵀ M S with S = (−z/x, 1)
    near(aside.E[(1, 1)], m * (1.0 + 1.0 / angle.tan().powi(2)));
    // the dependent coordinate follows along the circle
    near(aside.unknowns[(0, 0)], 1.0 / angle.tan());
    let options = Options { independent: vec!["x".to_owned()], ..Options::default() };
    let y = [l * angle.sin(), -l * angle.cos(), 0.0, 0.0, -pull / l, 0.0];
    let preferred = model_at(&pendulum(), &y, &[0.0; 6], &[push], &options).expect("a trim");
    assert_eq!(names(&preferred), ["x", "vx"]);
    oscillates_at(&preferred, &[(G / angle.cos() / l).sqrt()]);
}

/// Two equal point masses on two equal rods, in four Cartesian coordinates.
fn double_pendulum() -> Written {
    Written::new(|y, yd, _| {
        let (q, v, l, m) = (&y[..4], &y[4..8], &y[8..10], &y[10..12]);
        let (dx, dz) = (q[2] - q[0], q[3] - q[1]);
        let by_rods = |force: &[Dual]| {
            let (a, b) = (force[0], force[1]);
            [q[0] * a - dx * b, q[1] * a - dz * b, dx * b, dz * b]
        };
        let (rates, forces) = (by_rods(m), by_rods(l));
        let weight = [0.0, G, 0.0, G];
        let mut f: Vec<Dual> = (0..4).map(|i| yd[i] - v[i] - rates[i]).collect();
        f.extend((0..4).map(|i| yd[4 + i] + weight[i].into() - forces[i]));
        f.push(q[0] * v[0] + q[1] * v[1]);
        f.push(dx * (v[2] - v[0]) + dz * (v[3] - v[1]));
        f.push(0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0.into()));
        f.push(0.5 * (dx * dx + dz * dz - 1.0.into()));
        (f, Vec::new())
    })
    .coordinates("x1 z1 x2 z2", "vx1 vz1 vx2 vz2")
    .constraints("lambda1 lambda2 mu1 mu2", "rate_of_rod_1 rate_of_rod_2", "length_of_rod_1 length_of_rod_2")
}

#[test]
fn a_double_pendulum_in_redundant_coordinates_has_its_two_frequencies() {
    let hanging = [0.0, -1.0, 0.0, -2.0, 0.0, 0.0, 0.0, 0.0, -2.0 * G, -G, 0.0, 0.0];
    let model = model(&double_pendulum(), &hanging, &[]);
    assert_eq!(names(&model), ["x1", "x2", "vx1", "vx2"]);
    // equal masses and lengths: ω² = (2 ± √2) g/l
    oscillates_at(&model, &[((2.0 + 2f64.sqrt()) * G).sqrt(), ((2.0 - 2f64.sqrt()) * G).sqrt()]);
    assert!(eigen(&model).expect("eigenvalues").residual < 1e-14);
}

/// A mass on two springs in series; the place of the knot between them is algebraic.
fn knot() -> Written {
    Written::new(|y, yd, u| {
        let [q, v, s] = [y[0], y[1], y[2]];
        (vec![yd[0] - v, 3.0 * yd[1] + 40.0 * s - u[0], 10.0 * (q - s) - 40.0 * s + u[1]], vec![s, yd[1] + v])
    })
    .coordinates("q", "v")
    .states("s", false)
    .inputs("push pull")
    .outputs("knot mixed")
}

#[test]
fn an_algebraic_state_is_eliminated() {
    let model = model(&knot(), &[0.0; 3], &[0.0; 2]);
    assert_eq!(names(&model), ["q", "v"]);
    // springs in series: k = k₁ k₂ / (k₁ + k₂) = 8
    oscillates_at(&model, &[(8f64 / 3.0).sqrt()]);
    for (found, expected) in [
        // s = (10 q + u₁)/50, v̇ = (u₀ − 40 s)/3
        (model.C[(0, 0)], 0.2),
        (model.D[(0, 0)], 0.0),
        (model.D[(0, 1)], 0.02),
        (model.C[(1, 0)], -8.0 / 3.0),
        (model.C[(1, 1)], 1.0),
        (model.D[(1, 0)], 1.0 / 3.0),
        (model.D[(1, 1)], -0.8 / 3.0),
        (model.unknowns[(2, 0)], 0.2),
    ] {
        near(found, expected);
    }
}

#[test]
fn without_constraints_nothing_is_transformed() {
    let plant = Written::new(|y, yd, u| (vec![yd[0] - y[1], 2.0 * yd[1] + 3.0 * y[1] + 5.0 * y[0] - u[0]], Vec::new()));
    let model = model(&plant.coordinates("q", "v").inputs("push"), &[0.0; 2], &[0.0]);
    assert_eq!(model.E.as_slice(), [1.0, 0.0, 0.0, 2.0]);
    assert_eq!(model.A.as_slice(), [0.0, -5.0, 1.0, -3.0]);
    assert_eq!(model.B.as_slice(), [0.0, 1.0]);
    assert_eq!(model.unknowns, nalgebra::DMatrix::identity(2, 2));
}

/// A block that is pressed on a plane: friction `f = c N v` with the normal force N a multiplier and f an algebraic state.
/// Downforce grows with speed, N = m g + a v.
fn block() -> Written {
    Written::new(|y, yd, u| {
        let [_x, z, vx, vz, f, N, mu] = [y[0], y[1], y[2], y[3], y[4], y[5], y[6]];
        let rows = vec![
            yd[0] - vx,
            yd[1] - vz - mu,
            2.0 * yd[2] + f - u[0],
            2.0 * yd[3] + (2.0 * G).into() + 0.5 * vx - N,
            f - 0.1 * (N * vx),
            vz,
            z,
        ];
        (rows, vec![N])
    })
    .coordinates("x z", "vx vz")
    .cyclic("x vx")
    .states("f", false)
    .constraints("N mu", "rate_of_the_gap", "gap")
    .inputs("push")
    .outputs("load")
}

#[test]
fn forces_may_depend_on_the_force_of_a_constraint() {
    let v: f64 = 3.0;
    let load = 2.0 * G + 0.5 * v;
    let push = 0.1 * load * v;
    let sliding = model(&block(), &[0.0, 0.0, v, 0.0, push, load, 0.0], &[push]);
    assert_eq!(names(&sliding), ["vx"]);
    // d/dv (c (m g + a v) v) = c (N + a v)
    near(values(&sliding)[0].0, -0.1 * (load + 0.5 * v) / 2.0);
    near(sliding.C[(0, 0)], 0.5);
    // the place follows: δẋ = δv
    assert_eq!(sliding.cyclic.unknowns, [0]);
    near(sliding.cyclic.by_states[(0, 0)], 1.0);
}

/// A wheel that rolls on a radius R = 1 + h/2; h is the stroke of a spring. The wheel is driven by a force.
fn cone() -> Written {
    Written::new(|y, yd, u| {
        let [_x, _angle, h, v, omega, hd, lambda] = [y[0], y[1], y[2], y[3], y[4], y[5], y[6]];
        let R = Dual::from(1.0) + 0.5 * h;
        let rows = vec![
            yd[0] - v,
            yd[1] - omega,
            yd[2] - hd,
            2.0 * yd[3] - lambda - u[0],
            0.3 * yd[4] + R * lambda,
            yd[5] + 0.1 * hd + 7.0 * h,
            v - R * omega,
        ];
        (rows, Vec::new())
    })
    .coordinates("x angle h", "v omega hd")
    .cyclic("x angle v omega")
    .constraints("lambda", "rolling", "")
    .inputs("drive")
}

#[test]
fn a_rolling_wheel_keeps_one_of_its_speeds() {
    let v = 4.0;
    let plant = cone();
    let y = [0.0, 0.0, 0.0, v, v, 0.0, 0.0];
    let rolling = model(&plant, &y, &[0.0]);
    assert_eq!(names(&rolling), ["h", "omega", "hd"]);
    let options = Options { independent: vec!["v".to_owned()], ..Options::default() };
    let rolling = model_at(&plant, &y, &[0.0; 7], &[0.0], &options).expect("a trim");
    assert_eq!(names(&rolling), ["h", "v", "hd"]);
    // m + I/R²
    near(rolling.E[(1, 1)], 2.3);
    near(rolling.unknowns[(4, 1)], 1.0);
    near(rolling.unknowns[(4, 0)], -0.5 * v);
}

#[test]
fn constraints_that_move_with_the_acceleration_are_followed() {
    // by hand, with ω = v/R: (m + I/R²) v̇ − I v R' ḣ/R³ = F
    let (v, a) = (4.0, 1.5);
    let plant = cone();
    let options = Options { independent: vec!["v".to_owned()], ..Options::default() };
    let (y, yd) = ([0.0, 0.0, 0.0, v, v, 0.0, -0.3 * a], [0.0, 0.0, 0.0, a, a, 0.0, 0.0]);
    let driven = model_at(&plant, &y, &yd, &[2.3 * a], &options).expect("a frozen point");
    near(driven.E[(1, 1)], 2.3);
    near(driven.A[(1, 0)], 2.0 * 0.3 * 0.5 * a);
    near(driven.E[(1, 0)], -0.3 * 0.5 * v);
    near(driven.A[(1, 1)], 0.0);
}

#[test]
fn points_off_the_trim_are_refused() {
    let off = [0.1, 0.0, 0.0];
    let refused = model_at(&knot(), &off, &[0.0; 3], &[0.0; 2], &Options::default()).expect_err("no trim");
    assert_eq!(refused.to_string(), "this point is no steady state: the row_of_s is off by 1.000000e0 -");
    let options = Options { off_trim: OffTrim::Proceed, ..Options::default() };
    let model = model_at(&knot(), &off, &[0.0; 3], &[0.0; 2], &options).expect("a linear plant is the same everywhere");
    oscillates_at(&model, &[(8f64 / 3.0).sqrt()]);
}

#[test]
fn what_does_not_fit_is_told_in_signal_names() {
    let told = |plant: Written, y: &[f64], u: &[f64]| {
        model_at(&plant, y, &vec![0.0; y.len()], u, &Options::default()).expect_err("a refusal").to_string()
    };
    let cyclic = Written::new(|y, yd, _| (vec![yd[0] - y[1], yd[1] + y[0]], Vec::new())).coordinates("x", "v").cyclic("x v");
    assert_eq!(told(cyclic, &[0.0; 2], &[]), "`x` is declared cyclic, but the force_along_v depends on it");

    let idle =
        Written::new(|y, yd, _| (vec![yd[0] - y[1], yd[1] + y[2], y[0] + y[1]], Vec::new())).coordinates("x", "v").states("s", false);
    assert_eq!(told(idle, &[0.0; 3], &[]), "no row of an element determines `s`");

    let light = Written::new(|y, yd, _| (vec![yd[0] - y[1], y[1] + y[0]], Vec::new())).coordinates("x", "v");
    assert_eq!(told(light, &[0.0; 2], &[]), "no inertia: no equation determines the rate of `v`");

    let twice = Written::new(|y, yd, _| {
        let [x, v, a, b] = [y[0], y[1], y[2], y[3]];
        (vec![yd[0] - v, yd[1] + x - a - b, v, 2.0 * v], Vec::new())
    });
    let twice = twice.coordinates("x", "v").constraints("a b", "first second", "");
    assert_eq!(told(twice, &[0.0; 4], &[]), "the second adds nothing to the other constraints here");

    let odd = Written::new(|y, yd, _| (vec![yd[0] - y[1], yd[1] - y[2]], Vec::new())).coordinates("x", "v").constraints("a", "", "");
    let expected = "constraints are expected on coordinates and velocities, with as many multipliers: there are 1 multipliers and 0 rows of constraints";
    assert_eq!(told(odd, &[0.0; 3], &[]), expected);

    let options = Options { independent: vec!["w".to_owned()], ..Options::default() };
    let refused = model_at(&pendulum(), &[0.0; 6], &[0.0; 6], &[0.0], &options).expect_err("no such state");
    assert_eq!(refused.to_string(), "`w` is no coordinate, velocity or state of this model");
}

/// A mass on a road whose height and rate of height are inputs.
fn on_a_road() -> Written {
    Written::new(|y, yd, u| {
        let [x, z, vx, vz, N, mu] = [y[0], y[1], y[2], y[3], y[4], y[5]];
        (vec![yd[0] - vx, yd[1] - vz - mu, yd[2] + x - u[2], yd[3] + G.into() - N, vz - u[1], z - u[0]], vec![z, x])
    })
    .coordinates("x z", "vx vz")
    .constraints("N mu", "rate_of_the_gap", "gap")
    .inputs("height height_rate push")
    .outputs("z_seen x_seen")
}

#[test]
fn inputs_that_move_a_constraint_are_refused_or_left_out() {
    let y = [0.0, 0.0, 0.0, 0.0, G, 0.0];
    let refused = model_at(&on_a_road(), &y, &[0.0; 6], &[0.0; 3], &Options::default()).expect_err("a road that moves");
    assert_eq!(refused.to_string(), "the input `height` moves the gap: its second rate would have to be an input too");
    let options = Options { bound_inputs: BoundInputs::LeaveOut, ..Options::default() };
    let model = model_at(&on_a_road(), &y, &[0.0; 6], &[0.0; 3], &options).expect("a model without the road");
    assert_eq!(model.inputs.iter().map(|i| i.signal.name.as_str()).collect::<Vec<_>>(), ["push"]);
    assert_eq!(model.left_out.iter().map(|l| l.signal.as_str()).collect::<Vec<_>>(), ["height", "height_rate"]);
    near(model.B[(1, 0)], 1.0);
}

#[test]
fn outputs_that_see_a_cyclic_coordinate_are_left_out() {
    let plant = Written::new(|y, yd, _| (vec![yd[0] - y[1], yd[1] + y[1]], vec![y[0], y[1]]));
    let plant = plant.coordinates("x", "v").cyclic("x v").outputs("place speed");
    let model = model(&plant, &[0.0; 2], &[]);
    assert_eq!(model.outputs.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(), ["speed"]);
    assert_eq!(model.left_out[0].because, "it depends on `x`, which is no state");
    assert_eq!(values(&model), [(-1.0, 0.0)]);
}
