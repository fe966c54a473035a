//! The tree algorithms on the two trees that the peers were timed on, at the states of the reference files.

use crate::clock::Clock;
use mbody::algorithm::derivatives::{Motion, rnea_derivatives};
use mbody::algorithm::recursive_derivatives::RecursiveDerivatives;
use mbody::algorithm::{aba::aba, crba::crba, kinematics, rnea::rnea};
use mbody::assembly::{BaseDescription, assemble_urdf};
use mbody::dynamics::System;
use mbody::scalar::PerScalar;
use mbody::stage::{Workspace, Workspaces};
use problem::Matrix;
use std::hint::black_box;
use std::sync::Arc;

/// One state: coordinates, velocities, accelerations, generalized forces, in the order of the tree.
#[derive(Clone, Debug)]
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    vd: Vec<f64>,
    tau: Vec<f64>,
}

/// A tree and the states at which it is evaluated.
struct Case {
    name: &'static str,
    system: Arc<System>,
    states: Vec<State>,
}

fn tree(urdf: &str) -> Arc<System> {
    let (assembled, findings) = assemble_urdf("tree.urdf", urdf, BaseDescription::Free, 9.81, &[]);
    assembled.unwrap_or_else(|| panic!("{findings:?}")).system
}

/// Sorts columns of a reference file, each named after its joint, into the order of the tree; the base comes first in both.
fn order(system: &System, names: &[String], base: usize, pick: impl Fn(&mbody::model::Body) -> usize) -> Vec<usize> {
    let bodies = &system.model().bodies()[1..];
    let mut columns = vec![0; names.len()];
    (0..base).for_each(|k| columns[k] = k);
    for body in &bodies[1..] {
        columns[pick(body)] = names.iter().position(|n| *n == body.joint_name).unwrap_or_else(|| panic!("no column {}", body.joint_name));
    }
    columns
}

fn permuted(values: &[f64], columns: &[usize]) -> Vec<f64> {
    columns.iter().map(|&c| values[c]).collect()
}

fn moto11() -> Case {
    let system = tree(include_str!("../../reference/moto11/moto11_free.urdf"));
    let text = include_str!("../../reference/moto11/moto11.csv");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let group = |prefix: &str| -> (usize, Vec<String>) {
        let first = header.iter().position(|h| h.starts_with(prefix)).expect("a group of columns");
        (first, header.iter().filter_map(|h| h.strip_prefix(prefix)).map(str::to_owned).collect())
    };
    let groups = ["q.", "v.", "a.", "tau."].map(group);
    let q_columns = order(&system, &groups[0].1, 7, |b| b.q.start);
    let v_columns = order(&system, &groups[1].1, 6, |b| b.v.start);
    let states = lines
        .map(|line| {
            let row: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
            let part = |k: usize, columns: &[usize]| permuted(&row[groups[k].0..], columns);
            State { q: part(0, &q_columns), v: part(1, &v_columns), vd: part(2, &v_columns), tau: part(3, &v_columns) }
        })
        .collect();
    Case { name: "moto11", system, states }
}

fn tree38() -> Case {
    let system = tree(include_str!("../../../models/mechanisms/tree38/tree38.urdf"));
    let data: serde_json::Value = serde_json::from_str(include_str!("../../reference/mechanisms/tree38.json")).expect("json");
    let names = |key: &str| -> Vec<String> { serde_json::from_value(data[key].clone()).expect("names") };
    let q_columns = order(&system, &names("q_names"), 7, |b| b.q.start);
    let v_columns = order(&system, &names("v_names"), 6, |b| b.v.start);
    let states = data["states"].as_array().expect("states").iter().map(|s| {
        let part = |key: &str, columns: &[usize]| {
            let values: Vec<f64> = serde_json::from_value(s[key].clone()).expect("numbers");
            permuted(&values, columns)
        };
        State { q: part("q", &q_columns), v: part("v", &v_columns), vd: part("a", &v_columns), tau: part("tau_rnea", &v_columns) }
    });
    Case { name: "tree38", states: states.collect(), system: system.clone() }
}

/// Inverse dynamics of one state, into `w.tau`.
fn inverse(system: &System, w: &mut Workspace<f64>, s: &State) {
    let model = system.model();
    w.position.q.copy_from_slice(&s.q);
    w.velocity.v.copy_from_slice(&s.v);
    w.acceleration.vd.copy_from_slice(&s.vd);
    kinematics::position(model, &mut w.position);
    kinematics::velocity(model, &w.position, &mut w.velocity);
    kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
    rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
}

/// Forward dynamics of one state, into `w.acceleration.vd`.
fn forward(system: &System, w: &mut Workspace<f64>, s: &State) {
    let model = system.model();
    w.position.q.copy_from_slice(&s.q);
    w.velocity.v.copy_from_slice(&s.v);
    w.tau.copy_from_slice(&s.tau);
    kinematics::position(model, &mut w.position);
    kinematics::velocity(model, &w.position, &mut w.velocity);
    aba(model, w);
}

/// What is timed gives the numbers of the reference, or the table is worth nothing.
fn check(case: &Case, w: &mut Workspace<f64>) {
    let largest = |values: &[f64]| values.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
    for s in &case.states {
        inverse(&case.system, w, s);
        assert!(off(&w.tau, &s.tau) < 1e-10 * largest(&s.tau), "inverse dynamics of {}", case.name);
        forward(&case.system, w, s);
        // conditioning of the mass matrix costs digits on the way back
        assert!(off(&w.acceleration.vd, &s.vd) < 1e-8 * largest(&s.vd), "forward dynamics of {}", case.name);
    }
}

/// Times the algorithms on both trees.
pub fn run(clock: &mut Clock) {
    for case in [moto11(), tree38()] {
        let (system, states) = (case.system.as_ref(), &case.states);
        let model = system.model();
        let nv = model.layout().tree_nv;
        let mut w = Workspace::<f64>::new(model);
        check(&case, &mut w);
        let at = |round: usize| &states[round % states.len()];
        clock.case(&format!("rnea {}", case.name), 1, |round| {
            inverse(system, &mut w, at(round));
            black_box(&w.tau);
        });
        clock.case(&format!("aba {}", case.name), 1, |round| {
            forward(system, &mut w, at(round));
            black_box(&w.acceleration.vd);
        });
        let mut M = vec![0.0; nv * nv];
        clock.case(&format!("crba {}", case.name), 1, |round| {
            w.position.q.copy_from_slice(&at(round).q);
            kinematics::position(model, &mut w.position);
            crba(model, &w.position, &mut w.composite, &mut M);
            black_box(&M);
        });
        let mut recursion = RecursiveDerivatives::new(model).expect("constant subspaces");
        let mut spaces = PerScalar::<Workspaces>::new(model);
        let (mut dq, mut dv) = (Matrix::zeros(nv, nv), Matrix::zeros(nv, nv));
        clock.case(&format!("drnea {}", case.name), 1, |round| {
            let s = at(round);
            recursion.run(model, Motion { q: &s.q, v: &s.v, vd: &s.vd }, &mut dq, &mut dv);
            black_box((&dq, &dv));
        });
        clock.case(&format!("drnea {}, dual numbers", case.name), 1, |round| {
            let s = at(round);
            rnea_derivatives(model, Motion { q: &s.q, v: &s.v, vd: &s.vd }, &mut spaces, &mut dq, &mut dv);
            black_box((&dq, &dv));
        });
    }
}
