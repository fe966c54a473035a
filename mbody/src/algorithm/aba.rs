//! Forward dynamics: the accelerations that forces make, by the articulated-body algorithm.
//!
//! `U = Iᴬ H`, `D = Hᵀ U`, `u = τ − Hᵀ pᴬ`, `Iᵃ = Iᴬ − U D⁻¹ Uᵀ`, `pᵃ = pᴬ + Iᵃ c + U D⁻¹ u`, then outward
//! `v̇ = D⁻¹ (u − Uᵀ A')`, `A = A' + H v̇`.
//! Source: Featherstone (2008), table 7.1. Joints with several velocities factorize D (Cholesky, at most 6 × 6).

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::{ArticulatedInertia, Twist, Vec3, Wrench};
use crate::stage::Workspace;

/// Factorizes the leading n × n block in place: lower triangle L with `D = L Lᵀ`, its diagonal as reciprocals.
#[inline]
fn cholesky<S: SystemScalar>(D: &mut [[S; 6]; 6], n: usize) {
    for j in 0..n {
        let mut d = D[j][j];
        for k in 0..j {
            d -= D[j][k] * D[j][k];
        }
        let inverse = d.sqrt().recip();
        D[j][j] = inverse;
        for i in j + 1..n {
            let mut s = D[i][j];
            for k in 0..j {
                s -= D[i][k] * D[j][k];
            }
            D[i][j] = s * inverse;
        }
    }
}

/// Solves `L Lᵀ x = b` in place.
#[inline]
fn solve<S: SystemScalar>(L: &[[S; 6]; 6], b: &mut [S], n: usize) {
    for i in 0..n {
        for k in 0..i {
            b[i] -= L[i][k] * b[k];
        }
        b[i] *= L[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            b[i] -= L[k][i] * b[k];
        }
        b[i] *= L[i][i];
    }
}

/// Writes the tree accelerations into `w.acceleration.vd` (and body accelerations) for the motion in stages 1 and 2, the
/// joint forces `w.tau` and the applied wrenches `w.applied`. O(n), allocates nothing.
///
/// A body without any articulated inertia along its joint gives non-finite accelerations; assembly refuses such models.
pub fn aba<S: SystemScalar>(model: &Model, w: &mut Workspace<S>) {
    // inward: articulated inertias and bias wrenches
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let V = w.velocity.V_WB[i];
        w.articulated[i] = ArticulatedInertia::from_rigid(&body.inertia);
        w.articulated_bias[i] = V.cross_star(body.inertia.apply(V)) - w.applied[i];
    }
    for (i, body) in model.bodies.iter().enumerate().skip(1).rev() {
        let (n, first) = (body.v.len(), body.v.start);
        for j in body.v.clone() {
            w.U[j] = w.articulated[i].times(w.position.H[j]);
            w.u[j] = w.tau[j] - w.position.H[j].dot(w.articulated_bias[i]);
        }
        let D = &mut w.D[i];
        for a in 0..n {
            for b in 0..=a {
                D[a][b] = w.position.H[first + a].dot(w.U[first + b]);
            }
        }
        match n {
            1 => D[0][0] = D[0][0].recip(),
            _ => cholesky(D, n),
        }
        let p = body.parent.0;
        if p == 0 {
            continue;
        }
        let c = w.velocity.bias[i];
        let mut Ia = w.articulated[i];
        let mut pa = w.articulated_bias[i];
        if n == 1 {
            let inverse = D[0][0];
            Ia.subtract_outer(w.U[first], inverse);
            pa += Ia.times(c) + w.U[first].scaled(inverse * w.u[first]);
        } else {
            // columns of U L⁻ᵀ, one after the other
            let mut x = [S::zero(); 6];
            x[..n].copy_from_slice(&w.u[body.v.clone()]);
            solve(D, &mut x, n);
            let mut Y = [Wrench::zero(); 6];
            for a in 0..n {
                let mut y = w.U[first + a];
                for b in 0..a {
                    y -= Y[b].scaled(D[a][b]);
                }
                Y[a] = y.scaled(D[a][a]);
                Ia.subtract_outer(Y[a], S::one());
            }
            pa += Ia.times(c);
            for a in 0..n {
                pa += w.U[first + a].scaled(x[a]);
            }
        }
        let X = &w.position.X_PB[i];
        w.articulated[p].add(&Ia.in_parent(X));
        w.articulated_bias[p] += X.wrench_to_parent(pa);
    }
    // outward: accelerations
    w.acceleration.A_WB[0] = Twist::new(Vec3::zero(), Vec3::from_f64(-model.gravity));
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (n, first) = (body.v.len(), body.v.start);
        let mut A = w.position.X_PB[i].twist_to_child(w.acceleration.A_WB[body.parent.0]) + w.velocity.bias[i];
        let mut x = [S::zero(); 6];
        for a in 0..n {
            x[a] = w.u[first + a] - A.dot(w.U[first + a]);
        }
        if n == 1 {
            x[0] *= w.D[i][0][0];
        } else {
            solve(&w.D[i], &mut x, n);
        }
        w.acceleration.vd[body.v.clone()].copy_from_slice(&x[..n]);
        A += body.joint.motion(&w.position.H[body.v.clone()], &x[..n]);
        w.acceleration.A_WB[i] = A;
    }
}
