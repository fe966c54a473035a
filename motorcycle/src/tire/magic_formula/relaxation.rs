//! Relaxation lengths.
//!
//! ```text
//! 5.2          σκ = n (PTX1 + PTX2 d) exp(−PTX3 d) R0 LFZO LSGKP            σα = PTY1 sin[2 atan(n/PTY2)] (1 − PKY3 |γ|) R0 LFZO LSGAL
//! motorcycle   σκ likewise                                                 σα = PTY1 sin[PTY2 atan(n/PTY3)] R0 LFZO LSGAL
//! 6.x          σκ = |Kx/CFx|                                               σα = |Ky/CFy|
//! CFx = LONGITUDINAL_STIFFNESS (1 + PCFX1 d + PCFX2 d²)(1 + PCFX3 p),   CFy likewise
//! ```
//!
//! n load over nominal load. A file without these data gives 0: forces build up at once. The sign of PTX3 differs between texts; it is minus here, because
//! then σκ of published files grows with the load as their slip stiffness Kx does, whose length over a stiffness it is.
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, section 4.3.3 and chapter 9; manuals of PAC2002 as public programs reproduce them.
//! Range: that of the property file.

use super::super::shape::saturation;
use super::dialect::Camber;
use super::{MagicFormula, Operating};
use mbody::scalar::Real;

impl MagicFormula {
    /// Lateral and longitudinal relaxation length, m.
    #[inline]
    pub(super) fn lengths<S: Real>(&self, at: &Operating<S>) -> [S; 2] {
        let (c, d, p) = (&self.c, at.d, self.pressure);
        if self.dialect.camber == Camber::Stiffness {
            let over = |k: S, stiffness: f64, [c1, c2, c3]: [f64; 3]| match stiffness > 0.0 {
                true => (k * at.load / (((d * c2 + c1) * d + 1.0) * (stiffness * (1.0 + c3 * p)))).abs(),
                false => S::zero(),
            };
            let lateral = over(self.stiffness_per_load(at), c.LATERAL_STIFFNESS, [c.PCFY1, c.PCFY2, c.PCFY3]);
            return [lateral, over(self.longitudinal(at).stiffness, c.LONGITUDINAL_STIFFNESS, [c.PCFX1, c.PCFX2, c.PCFX3])];
        }
        let length = c.UNLOADED_RADIUS * c.LFZO;
        let longitudinal = at.ratio * (d * c.PTX2 + c.PTX1) * (-(d * c.PTX3)).exp() * (length * c.LSGKP);
        let (shape, q, camber) = match self.dialect.camber {
            Camber::Inside => (c.PTY2, c.PTY3, 0.0),
            _ => (2.0, c.PTY2, c.PKY3),
        };
        if c.PTY1 == 0.0 || q == 0.0 {
            return [S::zero(), longitudinal];
        }
        let u = at.ratio / q;
        let lateral = saturation(shape, u) * u * (at.lateral_camber.abs() * -camber + 1.0) * (c.PTY1 * length * c.LSGAL);
        [lateral, longitudinal]
    }
}
