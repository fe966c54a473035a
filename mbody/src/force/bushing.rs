//! Elastic bushing between two frames, three translations and three rotations.
//!
//! Frame F is fixed in the first body, M in the second; `p`, `R` is the pose of M in F. Potential
//! `U = ½ Σ kᵢ pᵢ² + Σ gᵢ (1 − Rᵢᵢ)` with `gᵢ = ½(κⱼ + κₖ − κᵢ)`, which for small angles is `½ Σ κᵢ θᵢ²`; the moment is its exact
//! gradient, `n = (A₂₃ − A₃₂, A₃₁ − A₁₃, A₁₂ − A₂₁)` with `A = R diag(g)`. Damping is linear in the relative twist.
//! Symbols: k N/m, κ N m/rad, c N s/m, γ N m s/rad. Valid for relative rotations below 90°.
//! Source: potential of the chordal metric on rotations, e.g. Bullo & Lewis, *Geometric Control of Mechanical Systems*, 2005.

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, OutputDeclared};
use crate::model::BodyIndex;
use crate::scalar::SystemScalar;
use crate::spatial::{Pose, Vec3};

/// A bushing with diagonal stiffness and damping in the axes of F.
#[derive(Clone, Debug)]
pub struct Bushing {
    /// First body and the pose of F in it.
    pub from: (BodyIndex, Pose<f64>),
    /// Second body and the pose of M in it.
    pub to: (BodyIndex, Pose<f64>),
    /// Translational stiffness along x, y, z of F, N/m.
    pub stiffness: Vec3<f64>,
    /// Translational damping, N s/m.
    pub damping: Vec3<f64>,
    /// Rotational stiffness about x, y, z of F, N m/rad.
    pub rotational_stiffness: Vec3<f64>,
    /// Rotational damping, N m s/rad.
    pub rotational_damping: Vec3<f64>,
}

/// Relative motion and the elastic and viscous answers, in axes of F.
struct Deflection<S> {
    X_WF: Pose<S>,
    p_WM: Vec3<S>,
    p: Vec3<S>,
    force: Vec3<S>,
    moment: Vec3<S>,
    stored: S,
    dissipated: S,
}

fn each<S: SystemScalar>(k: Vec3<f64>, v: Vec3<S>) -> Vec3<S> {
    Vec3::new(v.x * k.x, v.y * k.y, v.z * k.z)
}

impl Bushing {
    fn deflection<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Deflection<S> {
        let X_WF = *at.X_WB(self.from.0) * Pose::from_f64(&self.from.1);
        let X_WM = *at.X_WB(self.to.0) * Pose::from_f64(&self.to.1);
        let X_FM = X_WF.inverse() * X_WM;
        let (p, R) = (X_FM.p, X_FM.R.columns);
        // relative velocity at the origin of M, and relative angular velocity, in F
        let v = X_WF.R.inverse_times(at.v_WQ(self.to.0, X_WM.p) - at.v_WQ(self.from.0, X_WM.p));
        let w = X_WF.R.inverse_times(at.w_WB(self.to.0) - at.w_WB(self.from.0));
        let k = self.rotational_stiffness;
        let g = Vec3 { x: 0.5 * (k.y + k.z - k.x), y: 0.5 * (k.z + k.x - k.y), z: 0.5 * (k.x + k.y - k.z) };
        let elastic_moment = Vec3::new(R[2].y * g.z - R[1].z * g.y, R[0].z * g.x - R[2].x * g.z, R[1].x * g.y - R[0].y * g.x);
        let (viscous_force, viscous_moment) = (each(self.damping, v), each(self.rotational_damping, w));
        let rotational = (-R[0].x + 1.0) * g.x + (-R[1].y + 1.0) * g.y + (-R[2].z + 1.0) * g.z;
        Deflection {
            X_WF,
            p_WM: X_WM.p,
            p,
            force: -each(self.stiffness, p) - viscous_force,
            moment: elastic_moment - viscous_moment,
            stored: each(self.stiffness, p).dot(p) * 0.5 + rotational,
            dissipated: viscous_force.dot(v) + viscous_moment.dot(w),
        }
    }
}

impl ForceLaw for Bushing {
    fn declare(&self, element: &str) -> Declared {
        const NAMES: [(&str, &str, &str); 9] = [
            ("force_x", "N", "force on the second body along x of the first frame"),
            ("force_y", "N", "force on the second body along y of the first frame"),
            ("force_z", "N", "force on the second body along z of the first frame"),
            ("moment_x", "N m", "moment on the second body about x of the first frame"),
            ("moment_y", "N m", "moment on the second body about y of the first frame"),
            ("moment_z", "N m", "moment on the second body about z of the first frame"),
            ("deflection_x", "m", "deflection along x of the first frame"),
            ("deflection_y", "m", "deflection along y of the first frame"),
            ("deflection_z", "m", "deflection along z of the first frame"),
        ];
        let outputs = NAMES.map(|(q, unit, about)| OutputDeclared { name: format!("{element}.{q}"), unit, about });
        Declared { outputs: outputs.to_vec(), ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let d = self.deflection(at);
        let (f, n) = (d.X_WF.R * d.force, d.X_WF.R * d.moment);
        out.force_and_moment(self.to.0, d.p_WM, f, n);
        out.force_and_moment(self.from.0, d.p_WM, -f, -n);
        for k in 0..3 {
            out.output(k, d.force[k]);
            out.output(k + 3, d.moment[k]);
            out.output(k + 6, d.p[k]);
        }
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let d = self.deflection(at);
        Energy { stored: d.stored, supplied: S::zero(), dissipated: d.dissipated }
    }
}
