//! Mechanisms of our own, a tree of the size of a humanoid and the benchmark motorcycle against an independent code, and identities.

use super::recorded::{Mechanism, State};
use mbody::algorithm::aba::aba;
use mbody::algorithm::crba::crba;
use mbody::algorithm::derivatives::{Motion, rnea_derivatives};
use mbody::algorithm::recursive_derivatives::RecursiveDerivatives;
use mbody::algorithm::rnea::rnea;
use mbody::algorithm::{energy, kinematics};
use mbody::model::Model;
use mbody::scalar::PerScalar;
use mbody::spatial::Vec3;
use mbody::stage::Workspace;
use nalgebra::{DMatrix, DVector};
use problem::Matrix;
use validation::agreement::{Agreement, Tolerance, absolute, relative};
use validation::evidence::Row;
use validation::numbers::Numbers;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    inverse_dynamics_agrees => (
        "inverse dynamics (RNEA) of ten mechanisms with every joint, of `tree38` and `moto11`",
        "Pinocchio 4.1.0; `tests/reference/mechanisms`, `moto11.json`",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    forward_dynamics_agrees => (
        "forward dynamics (ABA; with followers by the mass matrix) of the same mechanisms",
        "Pinocchio 4.1.0",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    mass_matrices_agree => (
        "mass matrix (CRBA) of the same mechanisms",
        "Pinocchio 4.1.0",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    energies_and_mass_centers_agree => (
        "kinetic and potential energy and mass center of the same mechanisms",
        "Pinocchio 4.1.0",
        "relative 1e-10: two codes in double precision"
    ),
    poses_and_velocities_of_links_agree => (
        "pose, velocity and angular velocity of every link frame, welded ones included",
        "Pinocchio 4.1.0",
        "1e-12 m, rad, m/s, rad/s and relative 1e-10: two codes in double precision"
    ),
    derivatives_of_inverse_dynamics_agree => (
        "∂τ/∂q and ∂τ/∂v by dual numbers, along the tangent of a free base too",
        "Pinocchio 4.1.0",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    recursive_derivatives_agree => (
        "∂τ/∂q and ∂τ/∂v by the recursion without dual numbers, where no subspace depends on the coordinates",
        "Pinocchio 4.1.0; dual numbers, on every mechanism and in random motion 10 km away from the origin",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    a_universal_joint_is_two_crossed_hinges => (
        "a universal joint is two revolute joints with a massless cross",
        "Pinocchio 4.1.0 on the two revolute joints",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    inverse_and_forward_dynamics_undo_each_other => (
        "RNEA(ABA(τ)) = τ on every mechanism, in random motion",
        "identity",
        "relative 1e-10 of the largest force: conditioning of light distal links"
    ),
    columns_of_the_mass_matrix_are_inverse_dynamics => (
        "column j of CRBA is RNEA(q, 0, e_j) − RNEA(q, 0, 0)",
        "identity",
        "relative 1e-12 of the largest entry: double precision under weights of some hundred N"
    ),
    a_free_flying_tree_keeps_energy_and_momentum => (
        "`tree38` flying and tumbling freely for 0.4 s keeps its energy and its angular momentum about the mass center; momentum grows with its weight",
        "conservation",
        "relative 1e-8, falling with the fourth power of the step: error of the Runge–Kutta rule"
    ),
];

const TWO_CODES: Tolerance = relative(1e-10).because("two codes in double precision");

/// Every recorded state of every mechanism.
fn states(mut hold: impl FnMut(&Mechanism, &State, &str)) {
    for mechanism in Mechanism::all() {
        for (k, state) in mechanism.states.iter().enumerate() {
            hold(&mechanism, state, &format!("{} state {k}", mechanism.name));
        }
    }
}

/// Fills all kinematic stages.
fn stages(model: &Model, q: &[f64], v: &[f64], vd: &[f64]) -> Workspace<f64> {
    let mut w = Workspace::new(model);
    model.layout().expand_q(q, &mut w.position.q);
    model.layout().expand_v(v, &mut w.velocity.v);
    model.layout().expand_v(vd, &mut w.acceleration.vd);
    kinematics::position(model, &mut w.position);
    kinematics::world(model, &w.position, &mut w.world);
    kinematics::velocity(model, &w.position, &mut w.velocity);
    kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
    w
}

/// Inverse dynamics on the independent coordinates.
fn inverse(model: &Model, q: &[f64], v: &[f64], vd: &[f64]) -> Vec<f64> {
    let mut w = stages(model, q, v, vd);
    rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
    let mut tau = vec![0.0; model.layout().nv()];
    model.layout().reduce(&mut w.tau, &mut tau);
    tau
}

/// Mass matrix on the independent coordinates, `Zᵀ M Z`.
fn mass_matrix(model: &Model, q: &[f64]) -> DMatrix<f64> {
    let (layout, n) = (model.layout(), model.layout().tree_nv);
    let zeros = vec![0.0; layout.nv()];
    let mut w = stages(model, q, &zeros, &zeros);
    let mut M = vec![0.0; n * n];
    crba(model, &w.position, &mut w.composite, &mut M);
    let M = DMatrix::from_row_slice(n, n, &M);
    let mut Z = DMatrix::zeros(n, layout.nv());
    for k in 0..layout.nv() {
        let mut unit = zeros.clone();
        unit[k] = 1.0;
        let mut tree = vec![0.0; n];
        layout.expand_v(&unit, &mut tree);
        Z.set_column(k, &DVector::from_vec(tree));
    }
    Z.transpose() * M * Z
}

/// Forward dynamics on the independent coordinates.
fn forward(model: &Model, q: &[f64], v: &[f64], tau: &[f64]) -> Vec<f64> {
    let zeros = vec![0.0; v.len()];
    if !model.layout().is_identity() {
        let bias = DVector::from_vec(inverse(model, q, v, &zeros));
        let solved = mass_matrix(model, q).cholesky().map(|M| M.solve(&(DVector::from_column_slice(tau) - bias)));
        return solved.expect("a positive mass matrix").iter().copied().collect();
    }
    let mut w = stages(model, q, v, &zeros);
    w.tau.copy_from_slice(tau);
    aba(model, &mut w);
    w.acceleration.vd
}

#[test]
fn inverse_dynamics_agrees() {
    let mut agreement = Agreement::on("mechanisms: RNEA against Pinocchio");
    states(|m, s, what| {
        if let Some(tau) = &s.tau {
            agreement.all_near(what, &m.in_order(&inverse(m.model(), &s.q, &s.v, &s.vd)), tau, &TWO_CODES);
        }
    });
    agreement.assert();
}

#[test]
fn forward_dynamics_agrees() {
    let mut agreement = Agreement::on("mechanisms: ABA against Pinocchio");
    states(|m, s, what| {
        agreement.all_near(what, &m.in_order(&forward(m.model(), &s.q, &s.v, &s.tau_in)), &s.vd_out, &TWO_CODES);
    });
    agreement.assert();
}

#[test]
fn mass_matrices_agree() {
    let mut agreement = Agreement::on("mechanisms: CRBA against Pinocchio");
    states(|m, s, what| {
        if let Some(expected) = &s.mass_matrix {
            agreement.all_near(what, &m.square_in_order(&mass_matrix(m.model(), &s.q)), expected, &TWO_CODES);
        }
    });
    agreement.assert();
}

#[test]
fn energies_and_mass_centers_agree() {
    let mut agreement = Agreement::on("mechanisms: energies and mass centers against Pinocchio");
    states(|m, s, what| {
        let w = stages(m.model(), &s.q, &s.v, &s.vd);
        agreement.near(&format!("{what}: kinetic"), energy::kinetic(m.model(), &w.velocity), s.kinetic, &TWO_CODES);
        agreement.near(&format!("{what}: potential"), energy::potential(m.model(), &w.world), s.potential, &TWO_CODES);
        let c = energy::mass_center(m.model(), &w.world);
        agreement.all_near(&format!("{what}: center"), &[c.x, c.y, c.z], &s.center, &TWO_CODES);
    });
    agreement.assert();
}

#[test]
fn poses_and_velocities_of_links_agree() {
    let mut agreement = Agreement::on("mechanisms: motion of links against Pinocchio");
    let tolerance = absolute(1e-12).or_relative(1e-10).because("two codes in double precision");
    states(|m, s, what| {
        let w = stages(m.model(), &s.q, &s.v, &s.vd);
        for link in &s.links {
            let Some(frame) = m.model().frame(&link.name) else {
                agreement.holds(&format!("{what}: link {} exists", link.name), false);
                continue;
            };
            let X = w.world.X_WB[frame.body.get()];
            let V = w.velocity.V_WB[frame.body.get()];
            let X_WF = X * frame.X_BF;
            let rows = |i: usize| X_WF.R.columns.map(|c| [c.x, c.y, c.z][i]);
            let flat = |v: Vec3<f64>| [v.x, v.y, v.z];
            let found = [flat(X_WF.p), rows(0), rows(1), rows(2), flat(X.R * V.at_point(frame.X_BF.p)), flat(X.R * V.w)].concat();
            agreement.all_near(&format!("{what}: {}", link.name), &found, &link.motion, &tolerance);
        }
    });
    agreement.assert();
}

#[test]
fn derivatives_of_inverse_dynamics_agree() {
    let mut agreement = Agreement::on("mechanisms: derivatives of RNEA against Pinocchio");
    states(|m, s, what| {
        let Some((by_q, by_v)) = &s.derivatives else { return };
        let model = m.model();
        assert!(model.layout().is_identity(), "recorded for trees without followers");
        let n = model.layout().tree_nv;
        let (mut dq, mut dv) = (Matrix::zeros(n, n), Matrix::zeros(n, n));
        let at = Motion { q: &s.q, v: &s.v, vd: &s.vd };
        rnea_derivatives(model, at, &mut PerScalar::new(model), &mut dq, &mut dv);
        for (name, found, expected) in [("by q", dq, by_q), ("by v", dv, by_v)] {
            let found = DMatrix::from_column_slice(n, n, found.as_slice());
            agreement.all_near(&format!("{what}: {name}"), &m.square_in_order(&found), expected, &TWO_CODES);
        }
    });
    agreement.assert();
}

#[test]
fn recursive_derivatives_agree() {
    let mut agreement = Agreement::on("mechanisms: derivatives of RNEA by recursion");
    let mut numbers = Numbers(23);
    let mut compared = 0;
    states(|m, s, what| {
        let model = m.model();
        let Some(mut recursion) = RecursiveDerivatives::new(model) else { return };
        // a motion is given in tree coordinates, the recorded states of followers are independent ones
        if !model.layout().is_identity() {
            return;
        }
        compared += 1;
        let n = model.layout().tree_nv;
        let zeros = || Matrix::zeros(n, n);
        let (mut dq, mut dv, mut dual_q, mut dual_v) = (zeros(), zeros(), zeros(), zeros());
        let square = |matrix: &Matrix| DMatrix::from_column_slice(n, n, matrix.as_slice());
        let at = Motion { q: &s.q, v: &s.v, vd: &s.vd };
        if let Some((by_q, by_v)) = s.derivatives.as_ref() {
            recursion.run(model, at, &mut dq, &mut dv);
            for (name, found, expected) in [("by q", &dq, by_q), ("by v", &dv, by_v)] {
                agreement.all_near(&format!("{what}: {name}"), &m.square_in_order(&square(found)), expected, &TWO_CODES);
            }
        }
        let mut q = s.q.clone();
        let free = model.bodies()[1].q.len() == 7;
        q[..if free { 3 } else { 0 }].iter_mut().for_each(|p| *p += 1e4);
        let v: Vec<f64> = s.v.iter().map(|_| 3.0 * numbers.signed()).collect();
        let at = Motion { q: &q, v: &v, vd: &s.vd };
        recursion.run(model, at, &mut dq, &mut dv);
        rnea_derivatives(model, at, &mut PerScalar::new(model), &mut dual_q, &mut dual_v);
        for (name, found, expected) in [("by q", &dq, &dual_q), ("by v", &dv, &dual_v)] {
            agreement.all_near(&format!("{what}: {name}, far away"), found.as_slice(), expected.as_slice(), &TWO_CODES);
        }
    });
    assert!(compared > 20, "{compared} states");
    agreement.assert();
}

#[test]
fn a_universal_joint_is_two_crossed_hinges() {
    let mut agreement = Agreement::on("universal joint against two revolute joints");
    let m = Mechanism::with_universal_joint();
    for (k, s) in m.states.iter().enumerate() {
        let what = format!("state {k}");
        let tau = s.tau.as_ref().expect("recorded");
        agreement.all_near(&what, &m.in_order(&inverse(m.model(), &s.q, &s.v, &s.vd)), tau, &TWO_CODES);
        agreement.all_near(&what, &m.in_order(&forward(m.model(), &s.q, &s.v, &s.tau_in)), &s.vd_out, &TWO_CODES);
        let expected = s.mass_matrix.as_ref().expect("recorded");
        agreement.all_near(&what, &m.square_in_order(&mass_matrix(m.model(), &s.q)), expected, &TWO_CODES);
    }
    agreement.assert();
}

#[test]
fn inverse_and_forward_dynamics_undo_each_other() {
    let mut agreement = Agreement::on("mechanisms: RNEA(ABA(τ)) = τ");
    let undone = relative(1e-10).because("conditioning of light distal links");
    let mut numbers = Numbers(17);
    states(|m, s, what| {
        let v: Vec<f64> = s.v.iter().map(|_| 3.0 * numbers.signed()).collect();
        let tau: Vec<f64> = s.v.iter().map(|_| 50.0 * numbers.signed()).collect();
        let vd = forward(m.model(), &s.q, &v, &tau);
        agreement.all_near(what, &inverse(m.model(), &s.q, &v, &vd), &tau, &undone);
    });
    agreement.assert();
}

#[test]
fn columns_of_the_mass_matrix_are_inverse_dynamics() {
    let mut agreement = Agreement::on("mechanisms: columns of CRBA by RNEA");
    let rounding = relative(1e-12).because("double precision under weights of some hundred N");
    states(|m, s, what| {
        let M = mass_matrix(m.model(), &s.q);
        let zeros = vec![0.0; s.v.len()];
        let weight = inverse(m.model(), &s.q, &zeros, &zeros);
        let mut columns = Vec::new();
        for k in 0..zeros.len() {
            let mut unit = zeros.clone();
            unit[k] = 1.0;
            columns.extend(inverse(m.model(), &s.q, &zeros, &unit).iter().zip(&weight).map(|(a, b)| a - b));
        }
        agreement.all_near(what, &columns, M.as_slice(), &rounding);
    });
    agreement.assert();
}

/// Rates of coordinates and velocities without joint forces.
fn free_motion(model: &Model, y: &[f64]) -> Vec<f64> {
    let (q, v) = y.split_at(model.layout().nq());
    let mut rates = vec![0.0; q.len()];
    for body in model.bodies().iter().skip(1) {
        body.joint.rates(&q[body.q.clone()], &v[body.v.clone()], &mut rates[body.q.clone()]);
    }
    rates.extend(forward(model, q, v, &vec![0.0; v.len()]));
    rates
}

/// One step of the classical Runge–Kutta rule.
fn runge_kutta(model: &Model, y: &[f64], h: f64) -> Vec<f64> {
    let moved = |k: &[f64], share: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + share * h * k).collect() };
    let k1 = free_motion(model, y);
    let k2 = free_motion(model, &moved(&k1, 0.5));
    let k3 = free_motion(model, &moved(&k2, 0.5));
    let k4 = free_motion(model, &moved(&k3, 1.0));
    (0..y.len()).map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])).collect()
}

/// Energy, momentum and angular momentum about the mass center.
fn invariants(model: &Model, y: &[f64]) -> (f64, Vec3<f64>, Vec3<f64>) {
    let (q, v) = y.split_at(model.layout().nq());
    let w = stages(model, q, v, &vec![0.0; v.len()]);
    let momentum = energy::momentum(model, &w.world, &w.velocity);
    let center = energy::mass_center(model, &w.world);
    let total = energy::kinetic(model, &w.velocity) + energy::potential(model, &w.world);
    (total, momentum.f, momentum.n - center.cross(momentum.f))
}

#[test]
fn a_free_flying_tree_keeps_energy_and_momentum() {
    let tree = Mechanism::named("tree38");
    let model = tree.model();
    let mut numbers = Numbers(3);
    let state = &tree.states[0];
    let v = (0..model.layout().nv()).map(|_| numbers.signed());
    let start: Vec<f64> = state.q.iter().copied().chain(v).collect();
    let (energy, momentum, spin) = invariants(model, &start);
    let duration = 0.4;
    let drift = |steps: u32| {
        let h = duration / f64::from(steps);
        let end = (0..steps).fold(start.clone(), |y, _| runge_kutta(model, &y, h));
        let (e, p, l) = invariants(model, &end);
        let fallen = momentum + model.gravity() * (model.total_mass() * duration);
        [(e - energy).abs() / energy.abs(), (p - fallen).norm() / fallen.norm(), (l - spin).norm() / spin.norm()]
    };
    let (coarse, fine) = (drift(100), drift(200));
    let mut agreement = Agreement::on("free flight of tree38");
    let rule = absolute(1e-8).because("error of the Runge–Kutta rule at steps of 2 ms");
    for (what, value) in ["energy", "momentum", "angular momentum"].into_iter().zip(fine) {
        agreement.near(&format!("drift of the {what}"), value, 0.0, &rule);
    }
    println!("free flight of tree38: drift of energy {:.1e} in 100 steps, {:.1e} in 200", coarse[0], fine[0]);
    let order = absolute(0.35).because("asymptotic only for vanishing steps");
    agreement.near("order of the drift of the energy", (coarse[0] / fine[0]).log2(), 4.0, &order);
    agreement.assert();
}
