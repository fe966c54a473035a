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
            let in_parent = body.turned(&position.X_PB[i]).inertia_to_parent(&composite[i]);
            composite[p] = composite[p].plus(&in_parent);
        }
        let H = body.joint.columns(&position.H[body.v.clone()]);
        for (a, j) in body.v.clone().enumerate() {
            let mut F = H.carry(a, &composite[i]);
            for (b, k) in body.v.clone().enumerate() {
                M[k * nv + j] = H.dot(b, &F);
            }
            let (mut X, mut at) = (body.turned(&position.X_PB[i]), p);
            while at != 0 {
                F = X.wrench_to_parent(F);
                let carrier = &model.bodies[at];
                let H = carrier.joint.columns(&position.H[carrier.v.clone()]);
                for (b, k) in carrier.v.clone().enumerate() {
                    let entry = H.dot(b, &F);
                    (M[k * nv + j], M[j * nv + k]) = (entry, entry);
                }
                (X, at) = (carrier.turned(&position.X_PB[at]), carrier.parent.0);
            }
        }
    }
}
