//! Exact derivatives of inverse dynamics by a recursion of their own, several times cheaper than dual numbers.
//!
//! All vectors are written in axes of the world about one point. With the parent's twist V_P and acceleration A_P, each column h of a
//! subspace has the rates `ψ̇ = V_P × h`, `ψ̈ = A_P × h + V_P × ψ̇`. With the composite inertia Iᶜ, the composite wrench Fᶜ and
//! `2B m = (T m_w, −2 p × m_w)` of everything a joint carries, where `T = 2 w× (I_o − ½ tr I_o) − 2 h× v×` and p is the momentum,
//!
//! - for i on the way from j to the root: `∂τᵢ/∂qⱼ = hᵢ·(2B ψ̇ⱼ + Iᶜ ψ̈ⱼ + hⱼ ×* Fᶜ)`, `∂τᵢ/∂vⱼ = hᵢ·(2B hⱼ + Iᶜ (ψ̇ⱼ + V × hⱼ))`,
//!   without the term in Fᶜ where i and j belong to one joint;
//! - for i farther out: `∂τᵢ/∂qⱼ = hᵢ·(2B ψ̇ⱼ + Iᶜ ψ̈ⱼ)` with B and Iᶜ of i, and likewise for v.
//!
//! Source: S. Singh, R. P. Russell, P. M. Wensing, "Efficient analytical derivatives of rigid-body dynamics using spatial vector
//! algebra", IEEE Robotics and Automation Letters 7 (2022) 1776–1783. The short form of 2B follows from their
//! `2B = V ×* I − I V× + (I V) ×̄*` by writing out the blocks.
//! Valid where no subspace depends on the coordinates; elsewhere [`super::derivatives`] serves, and it is the oracle here.

use super::derivatives::Motion;
use super::kinematics;
use crate::model::Model;
use crate::spatial::{Inertia, Turn, Turned, Twist, Vec3, Wrench};
use crate::stage::Workspace;
use problem::Matrix;

/// One column of a motion subspace and its rates, in the world.
#[derive(Clone, Copy, Debug, Default)]
struct Column {
    h: Twist<f64>,
    /// ψ̇.
    rate: Twist<f64>,
    /// ψ̈.
    second_rate: Twist<f64>,
    /// `ψ̇ + V × h`.
    along_v: Twist<f64>,
}

/// A body, later with everything it carries, in the world.
#[derive(Clone, Copy, Debug, Default)]
struct Carried {
    V: Twist<f64>,
    A: Twist<f64>,
    inertia: Inertia<f64>,
    /// Columns of T.
    T: [Vec3<f64>; 3],
    /// Linear momentum p.
    momentum: Vec3<f64>,
    F: Wrench<f64>,
}

impl Carried {
    /// `2B m`.
    #[inline(always)]
    fn twice_B(&self, m: Twist<f64>) -> Wrench<f64> {
        let [a, b, c] = self.T;
        Wrench::new(a * m.w.x + b * m.w.y + c * m.w.z, self.momentum.cross(m.w) * -2.0)
    }

    /// The vector b with `m·2B k = b·k_w` for every k.
    #[inline(always)]
    fn twice_B_from_left(&self, m: Twist<f64>) -> Vec3<f64> {
        let [a, b, c] = self.T;
        Vec3::new(a.dot(m.w), b.dot(m.w), c.dot(m.w)) - m.v.cross(self.momentum) * 2.0
    }

    #[inline(always)]
    fn carry(&mut self, other: &Self) {
        self.inertia = self.inertia.plus(&other.inertia);
        for k in 0..3 {
            self.T[k] += other.T[k];
        }
        self.momentum += other.momentum;
        self.F += other.F;
    }
}

/// Work arrays for the derivatives of inverse dynamics of one model.
#[derive(Clone, Debug)]
pub struct RecursiveDerivatives {
    tree: Workspace<f64>,
    /// [tree nv].
    columns: Vec<Column>,
    /// [bodies].
    carried: Vec<Carried>,
}

impl RecursiveDerivatives {
    /// Work arrays; `None` where a subspace depends on the coordinates.
    pub fn new(model: &Model) -> Option<Self> {
        let constant = model.bodies.iter().all(|body| body.joint.subspace_is_constant());
        constant.then(|| Self {
            tree: Workspace::new(model),
            columns: vec![Column::default(); model.layout.tree_nv],
            carried: vec![Carried::default(); model.bodies.len()],
        })
    }

    /// Writes `∂τ/∂q` (along the velocity coordinates, `δq = N(q) δv`) and `∂τ/∂v`, [tree nv × tree nv] each.
    ///
    /// Cost: O(n d), allocates nothing.
    pub fn run(&mut self, model: &Model, at: Motion<'_>, dq: &mut Matrix, dv: &mut Matrix) {
        let w = &mut self.tree;
        w.position.q.copy_from_slice(at.q);
        w.velocity.v.copy_from_slice(at.v);
        w.acceleration.vd.copy_from_slice(at.vd);
        kinematics::position(model, &mut w.position);
        kinematics::world(model, &w.position, &mut w.world);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
        self.outward(model);
        dq.fill(0.0);
        dv.fill(0.0);
        self.inward(model, dq, dv);
    }

    /// Bodies and columns in the world, about the origin of the first body: far from the world's origin digits would be lost.
    fn outward(&mut self, model: &Model) {
        let Self { tree: w, columns, carried } = self;
        let origin = w.world.X_WB.get(1).map_or(Vec3::zero(), |X| X.p);
        carried[0] = Carried { A: w.acceleration.A_WB[0], ..Carried::default() };
        for (i, body) in model.bodies.iter().enumerate().skip(1) {
            let mut X = w.world.X_WB[i];
            X.p -= origin;
            let Carried { V: V_P, A: A_P, .. } = carried[body.parent.0];
            let (V, A) = (X.twist_to_parent(w.velocity.V_WB[i]), X.twist_to_parent(w.acceleration.A_WB[i]));
            let inertia = Turned::new(&X, Turn::Any).inertia_to_parent(&body.inertia);
            let momentum = inertia.times(V);
            let F = inertia.times(A) + V.cross_star(momentum);
            carried[i] = Carried { V, A, inertia, T: block(&inertia, V), momentum: momentum.f, F };
            for j in body.v.clone() {
                let h = X.twist_to_parent(w.position.H[j]);
                let rate = V_P.cross(h);
                let second_rate = A_P.cross(h) + V_P.cross(rate);
                columns[j] = Column { h, rate, second_rate, along_v: rate + V.cross(h) };
            }
        }
    }

    /// Entries of each joint with itself and with the joints that carry it; what is carried is summed on the way.
    fn inward(&mut self, model: &Model, dq: &mut Matrix, dv: &mut Matrix) {
        let Self { columns, carried, .. } = self;
        for (i, body) in model.bodies.iter().enumerate().skip(1).rev() {
            let all = carried[i];
            for j in body.v.clone() {
                let c = columns[j];
                let by_q = all.twice_B(c.rate) + all.inertia.times(c.second_rate);
                let by_v = all.twice_B(c.h) + all.inertia.times(c.along_v);
                for k in body.v.clone() {
                    dq[(k, j)] = columns[k].h.dot(by_q);
                    dv[(k, j)] = columns[k].h.dot(by_v);
                }
                let by_q = by_q + c.h.cross_star(all.F);
                let (b, M) = (all.twice_B_from_left(c.h), all.inertia.times(c.h));
                let mut at = body.parent.0;
                while at != 0 {
                    for k in model.bodies[at].v.clone() {
                        let o = &columns[k];
                        dq[(k, j)] = o.h.dot(by_q);
                        dv[(k, j)] = o.h.dot(by_v);
                        dq[(j, k)] = b.dot(o.rate.w) + o.second_rate.dot(M);
                        dv[(j, k)] = b.dot(o.h.w) + o.along_v.dot(M);
                    }
                    at = model.bodies[at].parent.0;
                }
            }
            carried[body.parent.0].carry(&all);
        }
    }
}

/// Columns of `T = 2 w× (I_o − ½ tr I_o) − 2 h× v×`.
#[inline(always)]
fn block(inertia: &Inertia<f64>, V: Twist<f64>) -> [Vec3<f64>; 3] {
    let [xx, yy, zz, xy, xz, yz] = inertia.I;
    let half = 0.5 * (xx + yy + zz);
    let J = [Vec3::new(xx - half, xy, xz), Vec3::new(xy, yy - half, yz), Vec3::new(xz, yz, zz - half)];
    let v = V.v;
    // columns of v×
    let across = [Vec3::new(0.0, v.z, -v.y), Vec3::new(-v.z, 0.0, v.x), Vec3::new(v.y, -v.x, 0.0)];
    std::array::from_fn(|k| (V.w.cross(J[k]) - inertia.h.cross(across[k])) * 2.0)
}
