//! Forward dynamics: the accelerations that forces make, by the articulated-body algorithm.
//!
//! `U = Iᴬ H`, `D = Hᵀ U`, `u = τ − Hᵀ pᴬ`, `Iᵃ = Iᴬ − U D⁻¹ Uᵀ`, `pᵃ = pᴬ + Iᵃ c + U D⁻¹ u`, then outward
//! `v̇ = D⁻¹ (u − Uᵀ A')`, `A = A' + H v̇`. A joint that leaves all six motions carries nothing but its effort, `Iᵃ = 0`, `pᵃ = H⁻ᵀ τ`, and
//! `A = (Iᴬ)⁻¹ (H⁻ᵀ τ − pᴬ)`, `v̇ = H⁻¹ (A − A')`.
//! Source: Featherstone (2008), table 7.1; floating bases: section 9.4. Joints with several velocities factorize D (at most 6 × 6).

use crate::model::Model;
use crate::scalar::SystemScalar;
use crate::spatial::{ArticulatedInertia, Twist, Vec3, Wrench};
use crate::stage::Workspace;

/// Factorizes the leading n × n block in place: lower triangle L with ones on the diagonal, in place of which 1/d stands, `D = L d Lᵀ`.
#[inline(always)]
fn factorize<S: SystemScalar>(D: &mut [[S; 6]; 6], n: usize) {
    for k in 0..n {
        let inverse = D[k][k].recip();
        for j in k + 1..n {
            let l = D[j][k] * inverse;
            for i in j..n {
                let share = D[i][k] * l;
                D[i][j] -= share;
            }
        }
        for j in k + 1..n {
            D[j][k] *= inverse;
        }
        D[k][k] = inverse;
    }
}

/// Solves `L d Lᵀ x = b` in place.
#[inline(always)]
fn solve<S: SystemScalar>(L: &[[S; 6]; 6], b: &mut [S; 6], n: usize) {
    for i in 1..n {
        for k in 0..i {
            b[i] -= L[i][k] * b[k];
        }
    }
    for i in (0..n).rev() {
        b[i] *= L[i][i];
        for k in i + 1..n {
            b[i] -= L[k][i] * b[k];
        }
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
        let (n, first, p) = (body.v.len(), body.v.start, body.parent.0);
        let X = body.turned(&w.position.X_PB[i]);
        if let Some(F) = body.joint.wrench(&w.position.H[body.v.clone()], &w.tau[body.v.clone()]) {
            w.articulated_bias[i] -= F;
            if p != 0 {
                w.articulated_bias[p] += X.wrench_to_parent(F);
            }
            continue;
        }
        let H = body.joint.columns(&w.position.H[body.v.clone()]);
        for (a, j) in body.v.clone().enumerate() {
            w.U[j] = H.carry_articulated(a, &w.articulated[i]);
            w.u[j] = w.tau[j] - H.dot(a, &w.articulated_bias[i]);
        }
        let D = &mut w.D[i];
        for a in 0..n {
            for b in 0..=a {
                D[a][b] = H.dot(a, &w.U[first + b]);
            }
        }
        match n {
            1 => D[0][0] = D[0][0].recip(),
            _ => factorize(D, n),
        }
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
                Y[a] = w.U[first + a];
                for b in 0..a {
                    let share = Y[b].scaled(D[a][b]);
                    Y[a] -= share;
                }
                Ia.subtract_outer(Y[a], D[a][a]);
            }
            pa += Ia.times(c);
            for a in 0..n {
                pa += w.U[first + a].scaled(x[a]);
            }
        }
        w.articulated[p].add(&X.articulated_to_parent(&Ia));
        w.articulated_bias[p] += X.wrench_to_parent(pa);
    }
    // outward: accelerations
    w.acceleration.A_WB[0] = Twist::new(Vec3::zero(), Vec3::from_f64(-model.gravity));
    for (i, body) in model.bodies.iter().enumerate().skip(1) {
        let (n, first) = (body.v.len(), body.v.start);
        let (H, vd) = (&w.position.H[body.v.clone()], &mut w.acceleration.vd[body.v.clone()]);
        let carried = body.turned(&w.position.X_PB[i]).twist_to_child(w.acceleration.A_WB[body.parent.0]) + w.velocity.bias[i];
        if body.joint.leaves_all() {
            let A = w.articulated[i].motion_under(-w.articulated_bias[i]);
            body.joint.velocity(H, A - carried, vd);
            w.acceleration.A_WB[i] = A;
            continue;
        }
        if n == 1 {
            vd[0] = (w.u[first] - carried.dot(w.U[first])) * w.D[i][0][0];
        } else {
            let mut x = [S::zero(); 6];
            for a in 0..n {
                x[a] = w.u[first + a] - carried.dot(w.U[first + a]);
            }
            solve(&w.D[i], &mut x, n);
            vd.copy_from_slice(&x[..n]);
        }
        w.acceleration.A_WB[i] = body.joint.moved(carried, H, vd);
    }
}
