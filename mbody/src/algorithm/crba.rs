//! Joint-space mass matrix by the composite-rigid-body algorithm.
//!
//! `Iᶜ_P += Iᶜ`, `F = Iᶜ H`, `M_jj = Hⱼᵀ F`, then toward the root `F ← ᴮXᴾᵀ F`, `M_ij = H_iᵀ F`.
//! Source: Featherstone (2008), table 6.2.

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::Inertia;
use crate::stage::Position;

/// Writes the mass matrix of the tree velocities, row-major [tree nv × tree nv], symmetric. O(n d), allocates nothing.
pub fn crba<S: SystemScalar>(model: &Model, position: &Position<S>, composite: &mut [Inertia<S>], M: &mut [S]) {
    let nv = model.layout.tree_nv;
    M.fill(S::zero());
    for (Ic, body) in composite.iter_mut().zip(&model.bodies) {
        *Ic = Inertia::from_f64(&body.inertia);
    }
    for (i, body) in model.bodies.iter().enumerate().skip(1).rev() {
        let p = body.parent.0;
        if p != 0 {
            let in_parent = composite[i].in_parent(&position.X_PB[i]);
            composite[p] = composite[p].plus(&in_parent);
        }
        for j in body.v.clone() {
            let mut F = composite[i].times(position.H[j]);
            for k in body.v.clone() {
                M[k * nv + j] = position.H[k].dot(F);
            }
            let mut at = i;
            while model.bodies[at].parent.0 != 0 {
                F = position.X_PB[at].wrench_to_parent(F);
                at = model.bodies[at].parent.0;
                for k in model.bodies[at].v.clone() {
                    let entry = position.H[k].dot(F);
                    M[k * nv + j] = entry;
                    M[j * nv + k] = entry;
                }
            }
        }
    }
}
