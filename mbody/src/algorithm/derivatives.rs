//! Exact derivatives of inverse dynamics, by dual numbers through the recursion.
//!
//! `∂τ/∂q` is taken along the velocity coordinates (`δq = N(q) δv`), so it is square for quaternion joints too.

use super::{kinematics, rnea::rnea};
use crate::model::Model;
use crate::scalar::{PerScalar, SystemScalar};
use crate::stage::Workspaces;
use problem::Matrix;

/// One motion of the tree.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// [tree nq] coordinates.
    pub q: &'a [f64],
    /// [tree nv] velocities.
    pub v: &'a [f64],
    /// [tree nv] accelerations.
    pub vd: &'a [f64],
}

/// Writes `∂τ/∂q` and `∂τ/∂v`, [tree nv × tree nv] each. `∂τ/∂v̇` is the mass matrix, see [`super::crba`].
///
/// Cost: one recursion on dual numbers per 24 directions; allocates nothing.
pub fn rnea_derivatives(model: &Model, at: Motion<'_>, spaces: &mut PerScalar<Workspaces>, dq: &mut Matrix, dv: &mut Matrix) {
    use crate::scalar::Lanes;
    let total = 2 * model.layout.tree_nv;
    let mut first = 0;
    while first < total {
        first += match total - first {
            1..=8 => sweep::<Lanes<2>>(model, at, spaces, first, dq, dv),
            9..=16 => sweep::<Lanes<4>>(model, at, spaces, first, dq, dv),
            _ => sweep::<Lanes<6>>(model, at, spaces, first, dq, dv),
        };
    }
}

/// One sweep over as many directions as S carries, starting at direction `first`; returns how many.
fn sweep<S: SystemScalar>(
    model: &Model,
    at: Motion<'_>,
    spaces: &mut PerScalar<Workspaces>,
    first: usize,
    dq: &mut Matrix,
    dv: &mut Matrix,
) -> usize {
    let nv = model.layout.tree_nv;
    let count = S::DIRECTIONS.min(2 * nv - first);
    let w = S::pick_mut(spaces);
    for (x, &value) in w.position.q.iter_mut().zip(at.q) {
        *x = S::from_f64(value);
    }
    for (x, &value) in w.velocity.v.iter_mut().zip(at.v) {
        *x = S::from_f64(value);
    }
    for (x, &value) in w.acceleration.vd.iter_mut().zip(at.vd) {
        *x = S::from_f64(value);
    }
    for direction in 0..count {
        let k = first + direction;
        if k < nv {
            seed_coordinate(model, at.q, k, direction, &mut w.position.q);
        } else {
            w.velocity.v[k - nv].set_derivative(direction, 1.0);
        }
    }
    kinematics::position(model, &mut w.position);
    kinematics::velocity(model, &w.position, &mut w.velocity);
    kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
    w.applied.fill(Default::default());
    rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
    for direction in 0..count {
        let k = first + direction;
        let column = if k < nv { dq.column_mut(k) } else { dv.column_mut(k - nv) };
        for (entry, tau) in column.iter_mut().zip(&w.tau) {
            *entry = tau.derivative(direction);
        }
    }
    count
}

/// Seeds `δq = N(q) e_k`.
fn seed_coordinate<S: SystemScalar>(model: &Model, q: &[f64], k: usize, direction: usize, seeded: &mut [S]) {
    let Some(body) = model.bodies.iter().skip(1).find(|b| b.v.contains(&k)) else { return };
    let mut v = [0.0; 6];
    let mut rates = [0.0; 7];
    v[k - body.v.start] = 1.0;
    body.joint.rates(&q[body.q.clone()], &v[..body.v.len()], &mut rates[..body.q.len()]);
    for (i, &rate) in body.q.clone().zip(&rates) {
        seeded[i].set_derivative(direction, rate);
    }
}
