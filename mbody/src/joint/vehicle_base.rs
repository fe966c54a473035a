//! The base of a vehicle: planar motion with velocities in its own yawed frame, then heave, roll and pitch.
//!
//! `R = Rz(ψ) Rx(φ) Ry(θ)`, `p = (x, y, h)`, `v = (V_x, V_y, r, ḣ, φ̇, θ̇)`,
//! `ẋ = V_x cos ψ − V_y sin ψ`, `ẏ = V_x sin ψ + V_y cos ψ`, `ψ̇ = r`.
//! With `A = (Rx Ry)ᵀ` (yawed frame to body): `w = A (φ̇ x + r z) + θ̇ y`, `v = A (V_x, V_y, ḣ)`; the bias is
//! `−ω × A(…)` with `ω = A φ̇ x + θ̇ y`, the rate at which the body turns in the yawed frame.
//!
//! On a homogeneous plane nothing depends on x, y, ψ, so the symmetry shows as zero Jacobian columns and steady turns are
//! equilibria. Singular only at roll ±90°. Source: yaw–roll–pitch order of the single-track literature (3-1-2).

use super::{Coordinate, JointLaw};
use crate::scalar::Real;
use crate::spatial::{Pose, Rotation, Twist, Vec3, Wrench};

/// `planar ∘ heave ∘ roll ∘ pitch`.
#[derive(Clone, Copy, Debug)]
pub struct VehicleBase;

impl VehicleBase {
    /// Orientation of the body in the yawed frame: `Rx(φ) Ry(θ)`.
    #[inline(always)]
    fn tilt<S: Real>(roll: S, pitch: S) -> Rotation<S> {
        let (sr, cr) = roll.sin_cos();
        let (sp, cp) = pitch.sin_cos();
        Rotation::from_columns(Vec3::new(cp, sr * sp, -(cr * sp)), Vec3::new(S::zero(), cr, sr), Vec3::new(sp, -(sr * cp), cr * cp))
    }

    /// Columns of `H`: the axes of the yawed frame, written in the body, are the rows of the tilt.
    #[inline(always)]
    fn columns<S: Real>(tilt: &Rotation<S>, H: &mut [Twist<S>]) {
        let [x, y, z] = tilt.inverse().columns;
        let o = Vec3::zero();
        H[0] = Twist::new(o, x);
        H[1] = Twist::new(o, y);
        H[2] = Twist::new(z, o);
        H[3] = Twist::new(o, z);
        H[4] = Twist::new(x, o);
        H[5] = Twist::new(Vec3::new(S::zero(), S::one(), S::zero()), o);
    }
}

const fn c(name: &'static str, unit: &'static str, about: &'static str, nominal: f64, cyclic: bool) -> Coordinate {
    Coordinate { name, unit, about, nominal, cyclic }
}

impl JointLaw for VehicleBase {
    fn coordinates(&self) -> &'static [Coordinate] {
        const Q: [Coordinate; 6] = [
            c("x", "m", "position of the base point, forward in the world", 1.0, true),
            c("y", "m", "position of the base point, left in the world", 1.0, true),
            c("yaw", "rad", "heading, positive to the left", 1.0, true),
            c("heave", "m", "height of the base point above its design height", 0.01, false),
            c("roll", "rad", "lean, positive to the right", 0.01, false),
            c("pitch", "rad", "pitch, positive nose down", 0.01, false),
        ];
        &Q
    }
    fn velocities(&self) -> &'static [Coordinate] {
        const V: [Coordinate; 6] = [
            c("forward_speed", "m/s", "speed of the base point along the heading", 10.0, true),
            c("lateral_speed", "m/s", "speed of the base point to the left of the heading", 0.1, true),
            c("yaw_rate", "rad/s", "yaw rate, positive to the left", 0.1, true),
            c("heave_rate", "m/s", "vertical speed of the base point", 1.0, false),
            c("roll_rate", "rad/s", "roll rate, positive to the right", 1.0, false),
            c("pitch_rate", "rad/s", "pitch rate, positive nose down", 1.0, false),
        ];
        &V
    }
    #[inline(always)]
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S> {
        let R = Rotation::about_z(q[2]) * Self::tilt(q[4], q[5]);
        Pose::new(R, Vec3::new(q[0], q[1], q[3]))
    }
    #[inline(always)]
    fn rates<S: Real>(&self, q: &[S], v: &[S], rates: &mut [S]) {
        let (s, c) = q[2].sin_cos();
        rates[0] = v[0] * c - v[1] * s;
        rates[1] = v[0] * s + v[1] * c;
        rates[2..6].copy_from_slice(&v[2..6]);
    }
    #[inline(always)]
    fn subspace<S: Real>(&self, q: &[S], H: &mut [Twist<S>]) {
        Self::columns(&Self::tilt(q[4], q[5]), H);
    }
    #[inline(always)]
    fn update<S: Real>(&self, X_PF: &Pose<f64>, q: &[S], H: &mut [Twist<S>]) -> Pose<S> {
        let tilt = Self::tilt(q[4], q[5]);
        Self::columns(&tilt, H);
        X_PF.compose(&Pose::new(Rotation::about_z(q[2]) * tilt, Vec3::new(q[0], q[1], q[3])))
    }
    #[inline(always)]
    fn motion<S: Real>(&self, H: &[Twist<S>], v: &[S]) -> Twist<S> {
        let (x, y, z) = (H[0].v, H[1].v, H[2].w);
        let w = x.scaled(v[4]) + z.scaled(v[2]);
        Twist::new(Vec3::new(w.x, w.y + v[5], w.z), x.scaled(v[0]) + y.scaled(v[1]) + z.scaled(v[3]))
    }
    #[inline(always)]
    fn bias<S: Real>(&self, q: &[S], v: &[S]) -> Twist<S> {
        let mut H = [Twist::zero(); 6];
        self.subspace(q, &mut H);
        self.motion_and_bias(q, &H, v).1
    }
    #[inline(always)]
    fn motion_and_bias<S: Real>(&self, _q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>) {
        let V = self.motion(H, v);
        // in the yawed frame the body turns with φ̇ x + θ̇ y; θ̇ y itself is fixed in the body
        let rolling = H[0].v.scaled(v[4]);
        let omega = Vec3::new(rolling.x, rolling.y + v[5], rolling.z);
        let carried = Vec3::new(V.w.x, V.w.y - v[5], V.w.z);
        (V, Twist::new(-omega.cross(carried), -omega.cross(V.v)))
    }
    #[inline(always)]
    fn effort<S: Real>(&self, H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        let (x, y, z) = (H[0].v, H[1].v, H[2].w);
        (tau[0], tau[1], tau[2]) = (x.dot(F.f), y.dot(F.f), z.dot(F.n));
        (tau[3], tau[4], tau[5]) = (z.dot(F.f), x.dot(F.n), F.n.y);
    }
    #[inline(always)]
    fn wrench<S: Real>(&self, H: &[Twist<S>], tau: &[S]) -> Option<Wrench<S>> {
        let (x, y, z) = (H[0].v, H[1].v, H[2].w);
        // n = τ_φ x + a y + τ_r z with the component τ_θ along y of the body, on which x stands
        let a = (tau[5] - tau[2] * z.y) / y.y;
        let n = x.scaled(tau[4]) + y.scaled(a) + z.scaled(tau[2]);
        Some(Wrench::new(n, x.scaled(tau[0]) + y.scaled(tau[1]) + z.scaled(tau[3])))
    }
    #[inline(always)]
    fn velocity<S: Real>(&self, H: &[Twist<S>], V: Twist<S>, v: &mut [S]) {
        let (x, y, z) = (H[0].v, H[1].v, H[2].w);
        let pitch_rate = y.dot(V.w) / y.y;
        v.copy_from_slice(&[x.dot(V.v), y.dot(V.v), z.dot(V.w) - pitch_rate * z.y, z.dot(V.v), x.dot(V.w), pitch_rate]);
    }
}
