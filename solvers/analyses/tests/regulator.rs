//! The regulator that follows a path is the best one: against the discrete problem solved whole, and against what it costs.

#![allow(non_snake_case)]

use analyses::LinearModel;
use analyses::linearize::{Cyclic, State};
use analyses::regulator::{Actuator, Course, Design, Regulator, follow};
use nalgebra::{DMatrix, DVector};
use problem::{Input, Signal, UnknownKind};

const SPEED: f64 = 20.0;

/// A car with lagged side forces: v̇_y = −a v_y − b r + c u, ṙ = d v_y − e r + f u; E is not the identity.
fn model() -> LinearModel {
    let state = |name: &'static str, k: usize| State {
        signal: Signal::new(name, "-", "a velocity"),
        kind: UnknownKind::Velocity,
        cyclic: true,
        nominal: 1.0,
        unknown: k,
        partner: None,
    };
    let input = Input { signal: Signal::new("u", "rad", "steering"), rate: None, nominal: 1.0, default: 0.0 };
    LinearModel {
        states: vec![state("lateral_speed", 0), state("yaw_rate", 1)],
        inputs: vec![input],
        outputs: Vec::new(),
        E: DMatrix::from_row_slice(2, 2, &[1500.0, 0.0, 0.0, 2500.0]),
        A: DMatrix::from_row_slice(2, 2, &[-9000.0, -30500.0, 1500.0, -11000.0]),
        B: DMatrix::from_row_slice(2, 1, &[80000.0, 90000.0]),
        C: DMatrix::zeros(0, 2),
        D: DMatrix::zeros(0, 1),
        unknowns: DMatrix::identity(2, 2),
        unknowns_by_inputs: DMatrix::zeros(2, 1),
        unknown_signals: Vec::new(),
        cyclic: Cyclic { unknowns: Vec::new(), by_cyclic: DMatrix::zeros(0, 0), by_states: DMatrix::zeros(0, 2) },
        left_out: Vec::new(),
    }
}

fn course(curvature: f64) -> Course {
    Course { lateral_speed: 0, yaw_rate: 1, speed: (SPEED, 0.0), curvature }
}

fn design(preview: (f64, usize)) -> Design {
    Design {
        input: "u".to_owned(),
        effort: 0.05,
        deviations: vec![("yaw_rate".to_owned(), 0.5)],
        path: (0.3, 0.05),
        held: Vec::new(),
        preview,
        actuator: Actuator::default(),
    }
}

fn regulator() -> Regulator {
    follow(&model(), &course(0.0), &design((4.0, 160))).unwrap()
}

/// `ẋ = A x + B u + d w` with the path, w = −V Δκ on the heading error.
fn extended() -> (DMatrix<f64>, DVector<f64>) {
    let m = model();
    let own = m.E.clone().lu().solve(&m.A).unwrap();
    let by = m.E.clone().lu().solve(&m.B).unwrap();
    let mut A = DMatrix::zeros(4, 4);
    A.view_mut((0, 0), (2, 2)).copy_from(&own);
    (A[(2, 0)], A[(2, 3)], A[(3, 1)]) = (1.0, SPEED, 1.0);
    (A, DVector::from_vec(vec![by[0], by[1], 0.0, 0.0]))
}

/// A smooth bend.
fn bend(t: f64) -> f64 {
    let x = (t - 0.2) / 1.2;
    if (0.0..=1.0).contains(&x) { 0.01 * (std::f64::consts::PI * x).sin().powi(2) } else { 0.0 }
}

/// The first input of the discrete problem: all inputs over the horizon as one least-squares problem, no Riccati equation and no kernel.
fn best_first_input(step: f64, start: &DVector<f64>) -> f64 {
    let (A, B) = extended();
    let n = 4;
    // exact steps of inputs that are held, curvature taken in the middle of a step
    let mut block = DMatrix::zeros(n + 2, n + 2);
    block.view_mut((0, 0), (n, n)).copy_from(&(A * step));
    block.view_mut((0, n), (n, 1)).copy_from(&(B * step));
    block[(3, n + 1)] = step;
    let e = block.exp();
    let (F, G, D) = (e.view((0, 0), (n, n)).into_owned(), e.column(n).rows(0, n).into_owned(), e.column(n + 1).rows(0, n).into_owned());
    let count = (3.0 / step).round() as usize;
    let weight = [0.0, 1.0 / 0.5, 1.0 / 0.3, 1.0 / 0.05];
    // rows: weighted states after each step, then weighted inputs
    let mut M = DMatrix::zeros(count * (n + 1), count);
    let mut y = DVector::zeros(count * (n + 1));
    let mut free = start.clone();
    let mut response: Vec<DVector<f64>> = Vec::new();
    for k in 0..count {
        free = &F * free - &D * (SPEED * bend((k as f64 + 0.5) * step));
        response.iter_mut().for_each(|r| *r = &F * &*r);
        response.push(G.clone());
        let share = step.sqrt();
        for i in 0..n {
            y[k * (n + 1) + i] = -free[i] * weight[i] * share;
            for (j, r) in response.iter().enumerate() {
                M[(k * (n + 1) + i, j)] = r[i] * weight[i] * share;
            }
        }
        M[(k * (n + 1) + n, k)] = share / 0.05;
    }
    (M.transpose() * &M).cholesky().unwrap().solve(&(M.transpose() * y))[0]
}

#[test]
fn the_input_with_preview_is_that_of_the_discrete_problem_as_its_step_vanishes() {
    let r = regulator();
    let start = DVector::from_vec(vec![0.02, -0.01, 0.04, 0.003]);
    let ahead: f64 = r.preview.weights.iter().enumerate().map(|(k, w)| w * bend(k as f64 * r.preview.interval)).sum();
    let back = r.gains[0] * start[0] + r.gains[1] * start[1] + r.path_gains[0] * start[2] + r.path_gains[1] * start[3];
    let continuous = ahead - back;
    // the discrete input is first order in the step: extrapolate
    let (coarse, middle, fine) = (best_first_input(0.02, &start), best_first_input(0.01, &start), best_first_input(0.005, &start));
    let once = [2.0 * middle - coarse, 2.0 * fine - middle];
    let limit = once[1] + (once[1] - once[0]) / 3.0;
    assert!((continuous - limit).abs() < 2e-4 * limit.abs(), "{continuous} against {limit} ({coarse}, {middle}, {fine})");
    // the part that looks ahead matters here
    assert!(ahead.abs() > 0.05 * continuous.abs(), "{ahead}");
}

#[test]
fn a_longer_preview_changes_nothing_once_the_kernel_has_vanished() {
    let short = follow(&model(), &course(0.0), &design((4.0, 80))).unwrap();
    let long = follow(&model(), &course(0.0), &design((8.0, 160))).unwrap();
    assert!(short.preview.tail < 1e-4, "{:e}", short.preview.tail);
    let sum = |r: &Regulator| r.preview.weights.iter().enumerate().map(|(k, w)| w * bend(k as f64 * r.preview.interval)).sum::<f64>();
    assert!((sum(&short) - sum(&long)).abs() < 1e-6 * sum(&long).abs());
}

#[test]
fn margins_of_a_quadratic_regulator_are_those_that_theory_promises() {
    // one input, full state: phase margin of at least 60°, any gain above one half (Anderson and Moore, section 5.4)
    let m = regulator().margins;
    assert!(m.phase_margin() > 60.0_f64.to_radians(), "{:?}", m);
    assert!(m.distance > 1.0 - 1e-9);
    assert!(m.least_factor.is_none_or(|f| f < 0.5) && m.greatest_factor.is_none());
}

#[test]
fn a_held_state_is_not_fed_back_and_names_are_checked() {
    let held = Design { held: vec!["nothing".to_owned()], ..design((1.0, 4)) };
    let error = follow(&model(), &course(0.0), &held).unwrap_err().to_string();
    assert_eq!(error, "the linear model has no state `nothing`");
}

#[test]
fn a_dead_time_and_a_lag_are_part_of_the_design() {
    let actuator = Actuator { delay: Some(0.15), lag: Some((30.0, 0.7)) };
    let slow = follow(&model(), &course(0.0), &Design { actuator, ..design((4.0, 40)) }).unwrap();
    assert_eq!((slow.actuator_gains.len(), slow.closed.len()), (4, 8));
    // the closed loop has the poles of the whole: the dead time alone has its own at 6/T and beyond
    assert!(slow.closed.iter().all(|s| s.re < 0.0));
    // as both vanish the gains become those without
    let quick = Actuator { delay: Some(1e-4), lag: Some((3e4, 0.7)) };
    let near = follow(&model(), &course(0.0), &Design { actuator: quick, ..design((4.0, 40)) }).unwrap();
    let plain = follow(&model(), &course(0.0), &design((4.0, 40))).unwrap();
    for (a, b) in near.gains.iter().zip(&plain.gains).chain(near.path_gains.iter().zip(&plain.path_gains)) {
        assert!((a - b).abs() < 1e-2 * b.abs(), "{a} against {b}");
    }
}
