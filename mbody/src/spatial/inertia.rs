//! Rigid-body, composite and articulated inertias.
//!
//! A rigid body is (m, h = m c, I about the origin); `I = I_c − m [c]×[c]×` (Featherstone, section 2.13).

use super::turn::Turning;
use super::{Pose, Rotation, Twist, Vec3, Wrench};
use crate::scalar::Real;
use nalgebra::Matrix3;

/// Mass, center of mass and rotational inertia about the center of mass, as people write them down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Center of mass in the body frame, m.
    pub center: Vec3<f64>,
    /// Tensor entries xx, yy, zz, xy, xz, yz about the center of mass in body axes, kg m² (`xz = −∫ x z dm`).
    pub inertia: [f64; 6],
}

impl MassProperties {
    /// No mass.
    pub const NONE: Self = Self { mass: 0.0, center: Vec3 { x: 0.0, y: 0.0, z: 0.0 }, inertia: [0.0; 6] };

    /// Principal moments in ascending order, kg m².
    pub fn principal_moments(&self) -> [f64; 3] {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let eigen = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigenvalues();
        let mut moments = [eigen[0], eigen[1], eigen[2]];
        moments.sort_by(f64::total_cmp);
        moments
    }

    /// The same body described in frame A, given the pose of its frame B in A.
    pub fn in_parent(&self, X_AB: &Pose<f64>) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let m = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let c = X_AB.R.columns;
        let r = Matrix3::new(c[0].x, c[1].x, c[2].x, c[0].y, c[1].y, c[2].y, c[0].z, c[1].z, c[2].z);
        let t = r * m * r.transpose();
        Self {
            mass: self.mass,
            center: X_AB.point(self.center),
            inertia: [t[(0, 0)], t[(1, 1)], t[(2, 2)], t[(0, 1)], t[(0, 2)], t[(1, 2)]],
        }
    }

    /// Two bodies welded together, both described in the same frame.
    pub fn welded_with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Self::NONE;
        }
        let center = (self.center * self.mass + other.center * other.mass) * (1.0 / mass);
        let mut inertia = [0.0; 6];
        for part in [self, other] {
            let d = part.center - center;
            let shift = [d.y * d.y + d.z * d.z, d.x * d.x + d.z * d.z, d.x * d.x + d.y * d.y, -d.x * d.y, -d.x * d.z, -d.y * d.z];
            for k in 0..6 {
                inertia[k] += part.inertia[k] + part.mass * shift[k];
            }
        }
        Self { mass, center, inertia }
    }

    /// The spatial inertia about the origin of the frame.
    pub fn spatial(&self) -> Inertia<f64> {
        let (m, c) = (self.mass, self.center);
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        Inertia {
            m,
            h: c * m,
            I: [
                xx + m * (c.y * c.y + c.z * c.z),
                yy + m * (c.x * c.x + c.z * c.z),
                zz + m * (c.x * c.x + c.y * c.y),
                xy - m * c.x * c.y,
                xz - m * c.x * c.z,
                yz - m * c.y * c.z,
            ],
        }
    }
}

/// Spatial inertia of a rigid body about the origin of its frame: mass, first moment and tensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia<S> {
    /// Mass, kg.
    pub m: S,
    /// First moment m·c, kg m.
    pub h: Vec3<S>,
    /// Tensor entries xx, yy, zz, xy, xz, yz about the origin, kg m².
    pub I: [S; 6],
}

#[inline(always)]
pub(super) fn symmetric_times<S: Real>(I: &[S; 6], w: Vec3<S>) -> Vec3<S> {
    Vec3::new(w.x * I[0] + w.y * I[3] + w.z * I[4], w.x * I[3] + w.y * I[1] + w.z * I[5], w.x * I[4] + w.y * I[5] + w.z * I[2])
}

impl Inertia<f64> {
    /// Constant inertia times a motion vector of any scalar: momentum, or inertial wrench.
    #[inline(always)]
    pub fn apply<S: Real>(&self, V: Twist<S>) -> Wrench<S> {
        let I = &self.I;
        let Iw = Vec3::new(
            V.w.x * I[0] + V.w.y * I[3] + V.w.z * I[4],
            V.w.x * I[3] + V.w.y * I[1] + V.w.z * I[5],
            V.w.x * I[4] + V.w.y * I[5] + V.w.z * I[2],
        );
        // h × v = −(v × h), w × h
        Wrench::new(Iw - V.v.cross_const(self.h), V.v * self.m + V.w.cross_const(self.h))
    }
}

impl<S: Real> Inertia<S> {
    /// Lifts a constant inertia.
    #[inline]
    pub fn from_f64(c: &Inertia<f64>) -> Self {
        Self { m: S::from_f64(c.m), h: Vec3::from_f64(c.h), I: std::array::from_fn(|k| S::from_f64(c.I[k])) }
    }

    /// Inertia times motion: `(I w + h × v, m v − h × w)`.
    #[inline(always)]
    pub fn times(&self, V: Twist<S>) -> Wrench<S> {
        Wrench::new(symmetric_times(&self.I, V.w) + self.h.cross(V.v), V.v.scaled(self.m) - self.h.cross(V.w))
    }

    /// Sum of two bodies in the same frame.
    #[inline(always)]
    pub fn plus(&self, b: &Self) -> Self {
        Self { m: self.m + b.m, h: self.h + b.h, I: std::array::from_fn(|k| self.I[k] + b.I[k]) }
    }

    /// The same body in turned axes.
    #[inline(always)]
    pub(super) fn turned<T: Turning>(&self, R: &Rotation<S>) -> Self {
        Self { m: self.m, h: T::turned(R, self.h), I: T::symmetric(R, &self.I) }
    }

    /// The same body about a point at −p.
    #[inline(always)]
    pub(super) fn shifted(&self, p: Vec3<S>) -> Self {
        // I − [p]×[h]× − [h]×[p]× − m [p]×[p]×
        let (m, h, I, pm) = (self.m, self.h, &self.I, p.scaled(self.m));
        let d = (p.dot(h)) * 2.0 + p.dot(pm);
        let outer = |i: usize, j: usize| p[i] * h[j] + h[i] * p[j] + p[i] * pm[j];
        Self {
            m,
            h: h + pm,
            I: [
                I[0] + d - outer(0, 0),
                I[1] + d - outer(1, 1),
                I[2] + d - outer(2, 2),
                I[3] - outer(0, 1),
                I[4] - outer(0, 2),
                I[5] - outer(1, 2),
            ],
        }
    }
}

/// Inverse of a symmetric tensor (xx, yy, zz, xy, xz, yz), by cofactors.
#[inline(always)]
fn symmetric_inverse<S: Real>(I: &[S; 6]) -> [S; 6] {
    let [xx, yy, zz, xy, xz, yz] = *I;
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let per = (xx * a + xy * b + xz * c).recip();
    [a, xx * zz - xz * xz, xx * yy - xy * xy, b, c, xy * xz - xx * yz].map(|cofactor| cofactor * per)
}

/// Articulated-body inertia: a general symmetric 6 × 6 in blocks `[[J, H], [Hᵀ, M]]` acting on (w; v).
#[derive(Clone, Copy, Debug)]
pub struct ArticulatedInertia<S> {
    /// Angular block, symmetric: xx, yy, zz, xy, xz, yz.
    pub J: [S; 6],
    /// Coupling block, by columns.
    pub H: [Vec3<S>; 3],
    /// Linear block, symmetric: xx, yy, zz, xy, xz, yz.
    pub M: [S; 6],
}

impl<S: Real> Default for ArticulatedInertia<S> {
    fn default() -> Self {
        Self { J: [S::zero(); 6], H: [Vec3::zero(); 3], M: [S::zero(); 6] }
    }
}

impl<S: Real> ArticulatedInertia<S> {
    /// From a rigid body.
    #[inline(always)]
    pub fn from_rigid(r: &Inertia<f64>) -> Self {
        let (o, c) = (S::zero(), S::from_f64);
        let h = r.h;
        Self {
            J: std::array::from_fn(|k| c(r.I[k])),
            // [h]× by columns
            H: [Vec3::new(o, c(h.z), c(-h.y)), Vec3::new(c(-h.z), o, c(h.x)), Vec3::new(c(h.y), c(-h.x), o)],
            M: [c(r.m), c(r.m), c(r.m), o, o, o],
        }
    }

    /// Inertia times motion.
    #[inline(always)]
    pub fn times(&self, V: Twist<S>) -> Wrench<S> {
        let [a, b, c] = self.H;
        Wrench::new(
            symmetric_times(&self.J, V.w) + a.scaled(V.v.x) + b.scaled(V.v.y) + c.scaled(V.v.z),
            Vec3::new(a.dot(V.w), b.dot(V.w), c.dot(V.w)) + symmetric_times(&self.M, V.v),
        )
    }

    /// The motion that makes a wrench, `I⁻¹ F`, of an inertia that resists every motion: the linear block is eliminated first.
    ///
    /// `K = H M⁻¹`, `(J − K Hᵀ) w = n − K f`, `v = M⁻¹ (f − Hᵀ w)`.
    #[inline(always)]
    pub fn motion_under(&self, F: Wrench<S>) -> Twist<S> {
        let (H, M) = (&self.H, symmetric_inverse(&self.M));
        let of = |x: Vec3<S>| H[0].scaled(x.x) + H[1].scaled(x.y) + H[2].scaled(x.z);
        let K = [of(Vec3::new(M[0], M[3], M[4])), of(Vec3::new(M[3], M[1], M[5])), of(Vec3::new(M[4], M[5], M[2]))];
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let rest: [S; 6] = std::array::from_fn(|k| {
            let (a, b) = pairs[k];
            self.J[k] - (K[0][a] * H[0][b] + K[1][a] * H[1][b] + K[2][a] * H[2][b])
        });
        let moment = F.n - (K[0].scaled(F.f.x) + K[1].scaled(F.f.y) + K[2].scaled(F.f.z));
        let w = symmetric_times(&symmetric_inverse(&rest), moment);
        let force = F.f - Vec3::new(H[0].dot(w), H[1].dot(w), H[2].dot(w));
        Twist::new(w, symmetric_times(&M, force))
    }

    /// Subtracts `U d⁻¹ Uᵀ` for one column: `scale` is 1/d.
    #[inline(always)]
    pub fn subtract_outer(&mut self, U: Wrench<S>, scale: S) {
        let (n, f) = (U.n, U.f);
        let (ns, fs) = (n.scaled(scale), f.scaled(scale));
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        for (k, (i, j)) in pairs.into_iter().enumerate() {
            self.J[k] -= ns[i] * n[j];
            self.M[k] -= fs[i] * f[j];
        }
        for j in 0..3 {
            self.H[j] -= ns.scaled(f[j]);
        }
    }

    /// Adds another articulated inertia in the same frame.
    #[inline(always)]
    pub fn add(&mut self, b: &Self) {
        for k in 0..6 {
            self.J[k] += b.J[k];
            self.M[k] += b.M[k];
        }
        for k in 0..3 {
            self.H[k] += b.H[k];
        }
    }

    /// The same inertia in turned axes.
    #[inline(always)]
    pub(super) fn turned<T: Turning>(&self, R: &Rotation<S>) -> Self {
        Self { J: T::symmetric(R, &self.J), H: T::tensor(R, &self.H), M: T::symmetric(R, &self.M) }
    }

    /// The same inertia about a point at −p.
    #[inline(always)]
    pub(super) fn shifted(&self, p: Vec3<S>) -> Self {
        let Self { J, H, M } = self;
        let Mcol = [Vec3::new(M[0], M[3], M[4]), Vec3::new(M[3], M[1], M[5]), Vec3::new(M[4], M[5], M[2])];
        // H_A = H + [p]× M ;  J_A = J + [p]× Hᵀ + ([p]× Hᵀ)ᵀ + [p]× M [p]×ᵀ = J + [p]× Hᵀ − H_A [p]×
        let HA: [Vec3<S>; 3] = std::array::from_fn(|j| H[j] + p.cross(Mcol[j]));
        // columns of Hᵀ are the rows of H
        let rows: [Vec3<S>; 3] = std::array::from_fn(|i| Vec3::new(H[0][i], H[1][i], H[2][i]));
        let A: [Vec3<S>; 3] = std::array::from_fn(|j| p.cross(rows[j]));
        // columns of [p]×: (0, pz, −py), (−pz, 0, px), (py, −px, 0)
        let B = [HA[1].scaled(p.z) - HA[2].scaled(p.y), HA[2].scaled(p.x) - HA[0].scaled(p.z), HA[0].scaled(p.y) - HA[1].scaled(p.x)];
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        Self { J: std::array::from_fn(|k| J[k] + A[pairs[k].1][pairs[k].0] - B[pairs[k].1][pairs[k].0]), H: HA, M: *M }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The motion under a wrench takes this wrench.
    #[test]
    fn motions_under_wrenches_take_these_wrenches() {
        let v = |a: f64| Vec3::new(a, a * a - 1.0, 2.0 - a);
        let I =
            ArticulatedInertia { J: [90.0, 80.0, 70.0, 4.0, 5.0, 6.0], H: [v(0.7), v(0.8), v(-0.9)], M: [9.0, 8.0, 7.0, 0.6, 0.5, 0.4] };
        let F = Wrench::new(v(2.2), v(0.9));
        let found = I.times(I.motion_under(F));
        assert!((found.n - F.n).norm() < 1e-13 && (found.f - F.f).norm() < 1e-13, "{found:?}");
    }
}
