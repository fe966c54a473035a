//! Forces in the plane of the road, per load.
//!
//! ```text
//! longitudinal   Fx0 = N μx sin[Cx θ(Bx κx; Ex)] + SVx      κx = κ + SHx,   Bx = Kx/(Cx N μx)
//! car            Fy0 = N μy sin[Cy θ(By αy; Ey)] + SVy      αy = α + SHy,   By = Ky/(Cy N μy)
//!   5.2          SHy = (PHY1 + PHY2 d) LHY + PHY3 γ
//!   6.x          SHy = (PHY1 + PHY2 d) LHY + (Kyγ γ* − SVyγ)/Ky
//! motorcycle     Fy0 = N μy sin[Cy θ(By αy; Ey) + Cγ θ(Bγ γ; Eγ)]      Bγ = Kγ/(Cγ N μy),  SHx = −(QSY1 N + SVx)/Kx
//! combined       Fx = Gxα Fx0,   Fy = Gyκ Fy0 + SVyκ,       G(s) = cos[C θ(B (s + SH); E)]/cos[C θ(B SH; E)]
//! ```
//!
//! N load, N; κ longitudinal slip; α slip angle, rad (6.x: α* = tan α); γ camber, rad (6.x: γ* = sin γ); d relative deviation of the load from the
//! nominal one; μ friction, K stiffness, SH and SV shifts; B, C, E slope, shape and curvature factors, E never above 1. The jump of E at zero slip
//! multiplies a cubic term: the curve is twice differentiable there. |γ| in Ky has the derivative 0 at 0.
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, 3rd ed., equations 4.E9 to 4.E67 (6.x), 2nd ed., section 4.3.2 (5.2), section 10.6 (motorcycle). That
//! κ = 0 is free rolling for motorcycle tires (SHx) is reported of the solver for motorcycles; nobody here has read its manual.
//! Range: that of the property file.

use super::super::magic_formula_motorcycle::CamberPeak;
use super::super::shape::{angle, cos_atan, saturation};
use super::dialect::Camber;
use super::{MagicFormula, Operating};
use mbody::scalar::Real;

/// Pure force forward, per load.
pub(super) struct Longitudinal<S> {
    pub force: S,
    pub friction: S,
    pub stiffness: S,
}

/// Pure side force, per load.
pub(super) struct Lateral<S> {
    pub force: S,
    pub friction: S,
    pub stiffness: S,
    /// Shift of the slip angle where the residual moment vanishes, SHy + SVy/Ky.
    pub residual_shift: S,
}

/// Friction and cornering stiffness per load.
struct Side<S> {
    friction: S,
    stiffness: S,
}

/// A curvature factor, at most 1.
#[inline]
pub(super) fn limited<S: Real>(e: S) -> S {
    if e.value() > 1.0 { S::one() } else { e }
}

impl MagicFormula {
    #[inline]
    pub(super) fn longitudinal<S: Real>(&self, at: &Operating<S>) -> Longitudinal<S> {
        let (c, d, p) = (&self.c, at.d, self.pressure);
        let g = at.camber * c.LGAX;
        let friction = (d * c.PDX2 + c.PDX1) * (g * g * -c.PDX3 + 1.0) * ((1.0 + (c.PPX4 * p + c.PPX3) * p) * c.LMUX);
        let stiffness = (d * c.PKX2 + c.PKX1) * (d * c.PKX3).exp() * ((1.0 + (c.PPX2 * p + c.PPX1) * p) * c.LKX);
        let sv = (d * c.PVX2 + c.PVX1) * at.fade * (c.LVX * c.LMUX);
        let sh = match self.dialect.camber {
            Camber::Inside => -(sv + c.QSY1 * c.LMY) / stiffness,
            _ => (d * c.PHX2 + c.PHX1) * at.fade * c.LHX,
        };
        let kappa = at.kappa + sh;
        let e = limited(((d * c.PEX3 + c.PEX2) * d + c.PEX1) * ((1.0 - c.PEX4 * kappa.sign()) * c.LEX));
        let shape = c.PCX1 * c.LCX;
        let force = (angle(stiffness / (friction * shape) * kappa, e) * shape).sin() * friction + sv;
        Longitudinal { force, friction, stiffness }
    }

    /// Friction and stiffness at a camber.
    #[inline]
    fn side<S: Real>(&self, at: &Operating<S>, g: S) -> Side<S> {
        let (c, d, p) = (&self.c, at.d, self.pressure);
        let g2 = g * g;
        if self.dialect.camber == Camber::Inside {
            let growth = g2 * c.PDY3 + 1.0;
            let peak = (d * c.PDY2).exp() * (c.PDY1 * c.LMUY);
            let friction = match self.camber_peak {
                CamberPeak::Divide => peak / growth,
                CamberPeak::Multiply => peak * growth,
            };
            let q = g2 * c.PKY4 + c.PKY3;
            return Side { friction, stiffness: saturation(c.PKY2, at.ratio / q) * (c.PKY1 * c.LKY) / (q * (g2 * c.PKY5 + 1.0)) };
        }
        let friction = (d * c.PDY2 + c.PDY1) * (g2 * -c.PDY3 + 1.0) * ((1.0 + (c.PPY4 * p + c.PPY3) * p) * c.LMUY);
        // Ky = PKY1 Fz0' sin(PKY4 atan(n/q)), divided by the load
        let q = (g2 * c.PKY5 + c.PKY2) * (1.0 + c.PPY2 * p);
        let stiffness = saturation(c.PKY4, at.ratio / q) / q * (g.abs() * -c.PKY3 + 1.0) * (c.PKY1 * (1.0 + c.PPY1 * p) * c.LKY);
        Side { friction, stiffness }
    }

    /// Cornering stiffness per load at a camber of the file.
    #[inline]
    pub(super) fn stiffness_per_load<S: Real>(&self, at: &Operating<S>) -> S {
        self.side(at, at.lateral_camber).stiffness
    }

    /// Pure side force at a camber `g`, that of the state or none.
    #[inline]
    pub(super) fn lateral<S: Real>(&self, at: &Operating<S>, g: S) -> Lateral<S> {
        let (c, d) = (&self.c, at.d);
        let Side { friction, stiffness } = self.side(at, g);
        let shape = c.PCY1 * c.LCY;
        let slope = stiffness / (friction * shape);
        if self.dialect.camber == Camber::Inside {
            let alpha = at.alpha + at.fade * (c.PHY1 * c.LHY);
            let e = limited((g * g * c.PEY2 + c.PEY1 + (g * c.PEY4 + c.PEY3) * alpha.sign()) * c.LEY);
            let of_camber = c.PCY2 * c.LCC;
            let camber_slope = (d * c.PKY7 + c.PKY6) * c.LKC / (friction * of_camber);
            let camber = angle(camber_slope * g, limited(S::from_f64(c.PEY5 * c.LEC)));
            let force = (angle(slope * alpha, e) * shape + camber * of_camber).sin() * friction;
            return Lateral { force, friction, stiffness, residual_shift: S::zero() };
        }
        let sv_camber = (d * c.PVY4 + c.PVY3) * g * (c.LKYC * c.LMUY);
        let sv = (d * c.PVY2 + c.PVY1) * at.fade * (c.LVY * c.LMUY) + sv_camber;
        let of_camber = match self.dialect.camber {
            Camber::Stiffness => ((d * c.PKY7 + c.PKY6) * g * ((1.0 + c.PPY5 * self.pressure) * c.LKYC) - sv_camber) / stiffness,
            _ => g * (c.PHY3 * c.LKYC),
        };
        let sh = (d * c.PHY2 + c.PHY1) * at.fade * c.LHY + of_camber;
        let alpha = at.alpha + sh;
        let e = limited((d * c.PEY2 + c.PEY1) * (g * g * c.PEY5 + 1.0 - (g * c.PEY4 + c.PEY3) * alpha.sign()) * c.LEY);
        let force = (angle(slope * alpha, e) * shape).sin() * friction + sv;
        Lateral { force, friction, stiffness, residual_shift: sh + sv / stiffness }
    }

    /// How slip angle weakens the force forward.
    #[inline]
    pub(super) fn longitudinal_weight<S: Real>(&self, at: &Operating<S>) -> S {
        let (c, g) = (&self.c, at.lateral_camber);
        let b = (g * g * c.RBX3 + c.RBX1) * cos_atan(at.kappa * c.RBX2) * c.LXAL;
        weight(c.RCX1, b, limited(at.d * c.REX2 + c.REX1), at.alpha, S::from_f64(c.RHX1))
    }

    /// How longitudinal slip weakens the side force at a camber `g`.
    #[inline]
    pub(super) fn lateral_weight<S: Real>(&self, at: &Operating<S>, g: S) -> S {
        let c = &self.c;
        let b = (g * g * c.RBY4 + c.RBY1) * cos_atan((at.alpha - c.RBY3) * c.RBY2) * c.LYKA;
        weight(c.RCY1, b, limited(at.d * c.REY2 + c.REY1), at.kappa, at.d * c.RHY2 + c.RHY1)
    }

    /// Side force per load that longitudinal slip makes, SVyκ.
    #[inline]
    pub(super) fn plysteer_of_slip<S: Real>(&self, at: &Operating<S>, friction: S) -> S {
        let c = &self.c;
        let peak = friction * (at.d * c.RVY2 + c.RVY1 + at.lateral_camber * c.RVY3) * cos_atan(at.alpha * c.RVY4);
        peak * ((at.kappa * c.RVY6).atan() * c.RVY5).sin() * c.LVYKA
    }
}

/// The weighting function of combined slip, 1 at no slip.
#[inline]
fn weight<S: Real>(shape: f64, b: S, e: S, slip: S, shift: S) -> S {
    let of = |s: S| (angle(b * s, e) * shape).cos();
    of(slip + shift) / of(shift)
}
