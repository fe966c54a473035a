//! Modes along a sweep of systems whose eigenvalues cross, veer, meet and part at known places.

#![allow(non_snake_case)]

use analyses::linearize::{Cyclic, State};
use analyses::modes::tracking::{Edge, Link, link, link_finely, names};
use analyses::{LinearModel, Modes};
use nalgebra::{Complex, DMatrix};
use problem::{ModeRule, Nature, Occurs, Signal, UnknownKind};

/// `q̈ + C q̇ + K q = 0` for two coordinates a and b.
fn model(C: [f64; 4], K: [f64; 4]) -> LinearModel {
    let mut A = DMatrix::zeros(4, 4);
    A.view_mut((0, 2), (2, 2)).copy_from(&DMatrix::identity(2, 2));
    A.view_mut((2, 0), (2, 2)).copy_from(&-DMatrix::from_row_slice(2, 2, &K));
    A.view_mut((2, 2), (2, 2)).copy_from(&-DMatrix::from_row_slice(2, 2, &C));
    let state = |(k, name): (usize, &str)| State {
        signal: Signal::new(name, "-", ""),
        kind: if k < 2 { UnknownKind::Position } else { UnknownKind::Velocity },
        cyclic: false,
        nominal: 1.0,
        unknown: k,
        partner: Some((k + 2) % 4),
    };
    let nothing = || DMatrix::zeros(0, 0);
    LinearModel {
        states: ["a", "b", "a_rate", "b_rate"].into_iter().enumerate().map(state).collect(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        E: DMatrix::identity(4, 4),
        A,
        B: nothing(),
        C: nothing(),
        D: nothing(),
        unknowns: DMatrix::identity(4, 4),
        unknowns_by_inputs: DMatrix::zeros(4, 0),
        unknown_signals: Vec::new(),
        cyclic: Cyclic { unknowns: Vec::new(), by_cyclic: nothing(), by_states: DMatrix::zeros(0, 4) },
        left_out: Vec::new(),
    }
}

fn modes(C: [f64; 4], K: [f64; 4]) -> Modes {
    Modes::of(&model(C, K)).unwrap_or_else(|error| panic!("{error}"))
}

/// Oscillators of 5 + t and 7 − t rad/s, coupled by a spring; without it they cross at t = 1.
fn two(t: f64, coupling: f64) -> Modes {
    let (a, b) = (5.0 + t, 7.0 - t);
    modes([0.02, 0.0, 0.0, 0.03], [a * a + coupling, -coupling, -coupling, b * b + coupling])
}

/// Where the slot of an eigenvalue at the first point ends.
fn follow(from: &Modes, to: &Modes, link: &Link, slot: usize) -> [Complex<f64>; 2] {
    [from.spectrum.values[slot], to.spectrum.values[link.to[slot]]]
}

#[test]
fn crossing_oscillators_keep_their_identity() {
    for steps in [1, 2, 5, 8] {
        let points: Vec<Modes> = (0..=steps).map(|k| two(2.0 * f64::from(k) / f64::from(steps), 0.0)).collect();
        let mut way = link(&points[0], &points[0]).expect("the same states");
        for pair in points.windows(2) {
            way = way.then(&link(&pair[0], &pair[1]).expect("the same states"));
        }
        let (first, last) = (&points[0], &points[points.len() - 1]);
        for slot in 0..4 {
            let [start, end] = follow(first, last, &way, slot);
            // what began at 5 rad/s ends at 7 rad/s, and the other way round
            assert!((start.im.abs() + end.im.abs() - 12.0).abs() < 1e-3, "{start} becomes {end} in {steps} steps");
            assert!(start.im * end.im > 0.0 && (start.re - end.re).abs() < 1e-12, "{start} becomes {end}");
            assert!(way.alike[slot] > 0.99);
        }
    }
}

/// One point of the sweep where the shapes are mixed is enough: points between are asked for until every step is clear.
#[test]
fn veering_oscillators_never_change_places() {
    let coupling = 0.6;
    for steps in [2, 8, 40] {
        let at = |k: i32| 2.0 * f64::from(k) / f64::from(steps);
        let points: Vec<Modes> = (0..=steps).map(|k| two(at(k), coupling)).collect();
        let mut way = link(&points[0], &points[0]).expect("the same states");
        let mut asked = 0;
        for (k, pair) in (0..steps).zip(points.windows(2)) {
            let mut between = |t: f64| {
                asked += 1;
                Some(two(at(k) + t * (at(k + 1) - at(k)), coupling))
            };
            way = way.then(&link_finely(&pair[0], &pair[1], &mut between).expect("the same states"));
        }
        assert!(asked > 0 || steps > 8, "coarse steps cannot tell veering from crossing");
        let (first, last) = (&points[0], &points[points.len() - 1]);
        let fastest = |modes: &Modes| modes.spectrum.values.iter().map(|s| s.im).fold(0.0, f64::max);
        let [start, end] = follow(first, last, &way, 0);
        assert_eq!((start.im, end.im), (fastest(first), fastest(last)), "{steps} steps");
        // the shape has gone over from b to a on the way
        let leads = |modes: &Modes| if modes.list[0].participation[0] > 0.5 { "a" } else { "b" };
        assert_eq!((leads(first), leads(last)), ("b", "a"));
    }
}

const RULES: &[ModeRule] = &[
    ModeRule {
        name: "swing",
        about: "",
        takes_part: &[("a", 1.0)],
        frequency: (0.1, 0.5),
        damping: (-1.0, 1.0),
        nature: Nature::Oscillation,
        occurs: Occurs::Once,
    },
    ModeRule {
        name: "shake",
        about: "",
        takes_part: &[("b", 1.0)],
        frequency: (1.0, 3.0),
        damping: (-1.0, 1.0),
        nature: Nature::Oscillation,
        occurs: Occurs::Once,
    },
];

/// `ä + 2 c ȧ + a = 0` beside an oscillation of 10 rad/s: at c = 1 the pair falls apart.
fn damped(c: f64) -> Modes {
    modes([2.0 * c, 0.0, 0.0, 0.1], [1.0, 0.0, 0.0, 100.0])
}

#[test]
fn a_pair_falls_apart_and_comes_together_where_its_discriminant_vanishes() {
    for (from, to) in [(0.5, 1.5), (1.5, 0.5)] {
        let sweep: Vec<f64> = (0..=10).map(|k| from + (to - from) * f64::from(k) / 10.0 + 0.003).collect();
        let points: Vec<Modes> = sweep.iter().map(|&c| damped(c)).collect();
        let edges: Vec<Edge> = (1..points.len())
            .map(|k| {
                let mut between = |t: f64| Some(damped(sweep[k - 1] + t * (sweep[k] - sweep[k - 1])));
                let link = link_finely(&points[k - 1], &points[k], &mut between).expect("the same states");
                Edge { from: k - 1, to: k, link }
            })
            .collect();
        let all: Vec<Option<&Modes>> = points.iter().map(Some).collect();
        let named = names(&all, &vec![false; points.len()], &edges, RULES);
        for ((c, point), names) in sweep.iter().zip(&points).zip(&named) {
            let called = |name: &str| names.iter().filter(|n| n.name == name).count();
            // one pair, or the two real ones that are left of it: s = −c ± √(c² − 1)
            assert_eq!((called("shake"), called("swing")), (1, if *c < 1.0 { 1 } else { 2 }), "c = {c}");
            let root = Complex::new(c * c - 1.0, 0.0).sqrt();
            for (mode, _) in point.list.iter().zip(names).filter(|(_, n)| n.name == "swing") {
                let expected = [-c + root, -c - root];
                assert!(expected.iter().any(|s| (s - mode.value).norm() < 1e-12), "{} at c = {c}", mode.value);
            }
        }
        // every eigenvalue has one path from end to end
        for edge in &edges {
            let mut to = edge.link.to.clone();
            to.sort_unstable();
            assert_eq!(to, [0, 1, 2, 3]);
        }
    }
}
