//! Moments about the point where the plane of the wheel meets the road.
//!
//! ```text
//! Mz = −t(αt,eq) Fy' + Mzr(αr,eq) + s Fx
//! t  = Dt cos[Ct θ(Bt αt; Et)] cos α        Mzr = Dr cos[atan(Br αr)] cos α       s = R0 (SSZ1 + SSZ2 Fy/Fz0 + (SSZ3 + SSZ4 d) γ)
//! 5.2, motorcycle   αeq = atan √(tan²α + (Kx κ/Ky)²)            6.x   αeq = √(α*² + (Kx κ/Ky)²)
//! 5.2   Fy' = Gyκ Fy0           6.x, motorcycle   Fy' = Gyκ Fy0 of the upright tire
//! Mx = R0 N [QSX1 − QSX2 γ + QSX3 Fy/Fz0],  and in 6.x the terms of QSX4 to QSX14
//! My = −R0 N [QSY1 + QSY2 Fx/Fz0 + QSY3 V/V0 + QSY4 (V/V0)⁴ + (QSY5 + QSY6 N/Fz0) γ²] (N/Fz0)^(QSY7 − 1) (p/p0)^QSY8
//! ```
//!
//! R0 free radius, m; Fz0 nominal load, N; V speed, m/s; V0 LONGVL; p, p0 pressure; others as for the forces. Dt has `1 + QDZ3 γ + QDZ4 γ²` in 5.2, and with
//! |γ| for motorcycle tires. For 6.x the book has |γ*|; the solver of its authors is reported to have the signed γ ([`TrailCamber`]).
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, 3rd ed., equations 4.E31 to 4.E49 and 4.E69 to 4.E78; 2nd ed., section 4.3.2; section 10.6.
//! Range: that of the property file.

use super::super::shape::{angle, cos_atan, length};
use super::dialect::Camber;
use super::planar::{Lateral, limited};
use super::{MagicFormula, Operating, TrailCamber};
use mbody::scalar::Real;
use mbody::scalar::smooth::ramp;
use std::f64::consts::FRAC_2_PI;

/// Share of the nominal load below which the power of the load in My is continued.
const LEAST_RATIO: f64 = 0.02;

/// What the moments need of the forces, per load.
pub(super) struct Forces<'a, S> {
    /// Total force forward.
    pub fx: S,
    /// Total side force.
    pub fy: S,
    /// Side force that the trail acts on.
    pub on_trail: S,
    /// Longitudinal slip stiffness.
    pub kx: S,
    /// Pure side force at the camber.
    pub lateral: &'a Lateral<S>,
    /// Cornering stiffness that turns longitudinal slip into slip angle.
    pub ky: S,
}

impl MagicFormula {
    /// Aligning moment per load, m.
    #[inline]
    pub(super) fn aligning<S: Real>(&self, at: &Operating<S>, f: &Forces<'_, S>) -> S {
        let (c, d) = (&self.c, at.d);
        let motorcycle = self.dialect.camber == Camber::Inside;
        let gs = if self.dialect.starred() { at.lateral_camber } else { at.camber * c.LGAZ };
        let signed = self.trail_camber == TrailCamber::Signed;
        // the solver of 6.x takes γ itself in slope and peak of the trail
        let g = if self.dialect.starred() && signed { at.camber } else { gs };
        let shift = (d * c.QHZ2 + c.QHZ1) * at.fade + (d * c.QHZ4 + c.QHZ3) * gs;
        let trail_slip = if motorcycle { at.alpha } else { at.alpha + shift };
        let residual_slip = at.alpha + if motorcycle { shift } else { f.lateral.residual_shift };
        let of_longitudinal = f.kx / f.ky * at.kappa;
        // cosines are even: the equivalent slips come without their sign
        let equivalent = |slip: S| match self.dialect.starred() {
            true => length(slip, of_longitudinal),
            false => length(slip.tan(), of_longitudinal).atan(),
        };
        let per_friction = c.LKY / c.LMUY;

        let bt = ((d * c.QBZ3 + c.QBZ2) * d + c.QBZ1) * (g * c.QBZ4 + g.abs() * c.QBZ5 + 1.0) * per_friction;
        let of_camber = if signed { g } else { g.abs() };
        let dt = (d * c.QDZ2 + c.QDZ1) * (of_camber * c.QDZ3 + g * g * c.QDZ4 + 1.0) * at.ratio;
        let scale = (1.0 - c.PPZ1 * self.pressure) * c.UNLOADED_RADIUS * c.LTR * if self.dialect.starred() { c.LFZO } else { 1.0 };
        let sense = (bt * trail_slip * c.QCZ1).atan() * FRAC_2_PI;
        let et = limited(((d * c.QEZ3 + c.QEZ2) * d + c.QEZ1) * ((gs * c.QEZ5 + c.QEZ4) * sense + 1.0));
        let trail = (angle(bt * equivalent(trail_slip), et) * c.QCZ1).cos() * dt * scale * at.cos_alpha;

        let of_slope = f.lateral.stiffness / f.lateral.friction * c.QBZ10;
        let br = if motorcycle { (of_slope + c.QBZ9) * per_friction } else { of_slope + c.QBZ9 * per_friction };
        let of_camber = ((d * c.QDZ9 + c.QDZ8) * (1.0 + c.PPZ2 * self.pressure) + (d * c.QDZ11 + c.QDZ10) * gs.abs()) * gs;
        let dr = ((d * c.QDZ7 + c.QDZ6) * at.fade * c.LRES + of_camber * c.LKZC) * (c.UNLOADED_RADIUS * c.LMUY);
        let residual = dr * cos_atan(br * equivalent(residual_slip)) * at.cos_alpha;

        let fy_ratio = f.fy * at.load / c.FNOMIN;
        let arm = (fy_ratio * c.SSZ2 + c.SSZ1 + (d * c.SSZ4 + c.SSZ3) * at.lateral_camber) * (c.UNLOADED_RADIUS * c.LS);
        residual - trail * f.on_trail + arm * f.fx
    }

    /// Overturning moment per load, m.
    #[inline]
    pub(super) fn overturning<S: Real>(&self, at: &Operating<S>, fy: S) -> S {
        let (c, g) = (&self.c, at.camber);
        let (n, fy_ratio) = (at.load / c.FNOMIN, fy * at.load / c.FNOMIN);
        let mut sum = fy_ratio * c.QSX3 - g * (c.QSX2 * (1.0 + c.PPMX1 * self.pressure)) + c.QSX1 * c.LVMX;
        if self.dialect.starred() {
            let load = n * c.QSX6;
            sum += ((load * load).atan() * c.QSX5).cos() * (g * c.QSX7 + (fy_ratio * c.QSX9).atan() * c.QSX8).sin() * c.QSX4;
            sum += (n * c.QSX11).atan() * g * c.QSX10;
            sum += fy * (g.abs() * c.QSX14 + c.QSX13) - g * g.abs() * c.QSX12;
        }
        sum * (c.UNLOADED_RADIUS * c.LMX)
    }

    /// Moment of rolling resistance per load, m, negative where it brakes a wheel that rolls forward.
    #[inline]
    pub(super) fn rolling<S: Real>(&self, at: &Operating<S>, fx: S) -> S {
        let c = &self.c;
        let n = at.load / c.FNOMIN;
        let v = at.speed / c.LONGVL;
        let g2 = at.camber * at.camber;
        let sum = fx * n * c.QSY2 + v * c.QSY3 + v.powi(4) * c.QSY4 + (n * c.QSY6 + c.QSY5) * g2 + c.QSY1;
        let mut scale = S::from_f64(-c.UNLOADED_RADIUS * c.LMY * self.rolling_pressure);
        if c.QSY7 != 1.0 {
            let positive = n + ramp(-(n - LEAST_RATIO), LEAST_RATIO);
            scale *= positive.powf(c.QSY7 - 1.0);
        }
        sum * scale
    }
}
