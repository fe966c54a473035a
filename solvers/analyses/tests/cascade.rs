//! A cascade holds what its gains say: poles, statics, the way ahead; what cannot be held is refused.

#![allow(non_snake_case)]

use analyses::LinearModel;
use analyses::linearize::{Cyclic, State};
use analyses::regulator::{Actuator, CascadeDesign, Course, Design, RegulatorError, cascade};
use nalgebra::DMatrix;
use problem::{Input, Signal, UnknownKind};

const SPEED: f64 = 20.0;
const GRAVITY: f64 = 9.81;

/// An inverted pendulum on a cart that turns as it leans: `φ̈ = (g φ + u)/h` and `r = −g φ/V` behind a lag, so that a lean to the right turns to the right.
fn model(sense: f64) -> LinearModel {
    let state = |name: &'static str, kind, k: usize| State {
        signal: Signal::new(name, "-", "a state"),
        kind,
        cyclic: false,
        nominal: 0.1,
        unknown: k,
        partner: None,
    };
    let input = Input { signal: Signal::new("u", "m/s^2", "push"), rate: None, nominal: 1.0, default: 0.0 };
    let states = vec![
        state("lean", UnknownKind::Position, 0),
        state("lean_rate", UnknownKind::Velocity, 1),
        state("lateral_speed", UnknownKind::Velocity, 2),
        state("yaw_rate", UnknownKind::Velocity, 3),
    ];
    let lag = 10.0;
    LinearModel {
        states,
        inputs: vec![input],
        outputs: Vec::new(),
        E: DMatrix::identity(4, 4),
        A: DMatrix::from_row_slice(
            4,
            4,
            &[0.0, 1.0, 0.0, 0.0, GRAVITY, 0.0, 0.0, 0.0, 0.0, 0.0, -lag, 0.0, -lag * GRAVITY / SPEED, 0.0, 0.0, -lag],
        ),
        B: DMatrix::from_row_slice(4, 1, &[0.0, sense, 0.0, 0.0]),
        C: DMatrix::zeros(0, 4),
        D: DMatrix::zeros(0, 1),
        unknowns: DMatrix::identity(4, 4),
        unknowns_by_inputs: DMatrix::zeros(4, 1),
        unknown_signals: Vec::new(),
        cyclic: Cyclic { unknowns: Vec::new(), by_cyclic: DMatrix::zeros(0, 0), by_states: DMatrix::zeros(0, 4) },
        left_out: Vec::new(),
    }
}

fn wanted(beside: &[&str], actuator: Actuator) -> CascadeDesign {
    let design = Design {
        input: "u".to_owned(),
        effort: 1.0,
        deviations: vec![("lean".to_owned(), 0.05)],
        path: (1.0, 1.0),
        held: Vec::new(),
        preview: (2.0, 20),
        actuator,
    };
    CascadeDesign { design, integral: 0.1, beside: beside.iter().map(|s| (*s).to_owned()).collect(), filter: (8.0, 0.8) }
}

const COURSE: Course = Course { lateral_speed: 2, yaw_rate: 3, speed: (SPEED, 0.0), curvature: 0.0 };

#[test]
fn lean_and_its_rate_are_all_that_this_pendulum_needs() {
    for actuator in [Actuator::default(), Actuator { delay: None, lag: Some((30.0, 0.7)) }] {
        let found = cascade(&model(1.0), &COURSE, &wanted(&["lean_rate"], actuator)).unwrap_or_else(|e| panic!("{e}"));
        assert!(found.regulator.closed.iter().all(|s| s.re < 0.0));
        // statics: the lean under which a = −g φ
        assert!((found.lead + 1.0 / GRAVITY).abs() < 1e-12, "{}", found.lead);
        let gains = &found.regulator.gains;
        assert!(gains[0] > GRAVITY && gains[1] > 0.0 && found.integral_gain > 0.0, "{gains:?} {}", found.integral_gain);
        let seen: f64 = found.regulator.preview.weights.iter().sum();
        assert!((seen - 1.0).abs() < 1e-9, "{seen}");
        let mean: f64 = (0..21).zip(&found.regulator.preview.weights).map(|(k, w)| 0.1 * f64::from(k) * w).sum();
        // at least the lag of the filter, 2 ζ/w
        assert!(mean > 0.2 && mean < 1.5, "{mean}");
    }
}

/// Without integral, lag and path the best feedback of all states is that of two: `K = (k, √(2k))` for the double integrator with gravity.
#[test]
fn what_is_nearest_to_a_feedback_of_two_states_is_that_feedback() {
    let mut design = wanted(&["lean_rate"], Actuator::default());
    // an integral that hardly counts
    design.integral = 1e6;
    let found = cascade(&model(1.0), &COURSE, &design).unwrap_or_else(|e| panic!("{e}"));
    // φ̈ = g φ + u: K₁ = g + √(g² + q), K₂ = √(2 K₁), q = 1/0.05²
    let first = GRAVITY + (GRAVITY * GRAVITY + 400.0).sqrt();
    let gains = &found.regulator.gains;
    assert!((gains[0] / first - 1.0).abs() < 1e-4 && (gains[1] / (2.0 * first).sqrt() - 1.0).abs() < 1e-4, "{gains:?} {first}");
}

#[test]
fn what_cannot_be_held_is_refused() {
    let refused = cascade(&model(0.0), &COURSE, &wanted(&["lean_rate"], Actuator::default()));
    assert!(refused.is_err());
    let unknown = cascade(&model(1.0), &COURSE, &wanted(&["leaning"], Actuator::default()));
    assert_eq!(unknown.err(), Some(RegulatorError::Unknown { what: "state", name: "leaning".to_owned() }));
    // half a second of dead time is too much for this pendulum
    let late = cascade(&model(1.0), &COURSE, &wanted(&["lean_rate"], Actuator { delay: Some(0.5), lag: None }));
    assert!(matches!(late.err(), Some(RegulatorError::Unstable { .. } | RegulatorError::Riccati(_))));
}
