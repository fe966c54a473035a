//! Effective rolling radius: speed over spin of a free wheel.
//!
//! ```text
//! fraction   re = a − η δ
//! fit        re = a − δ0 [D atan(B n) + F n]        δ0 = Fz0/Cz,  n = N/Fz0
//! ```
//!
//! a distance of the touching point of the cross-section from the axle, m; δ compression, m; N load, Fz0 nominal load, N; Cz vertical stiffness, N/m; B, D, F
//! coefficients BREFF, DREFF, FREFF.
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, section 4.3.2, with the radius of the cross-section in place of the free radius; the growth with speed is left out.
//! Range: loads from 0 to a few nominal loads.

use mbody::scalar::Real;

/// How the effective radius depends on the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EffectiveRadius {
    /// Smaller than the free radius by a share η of the compression, 0 to 1.
    Fraction(f64),
    /// A fit over the load.
    Fit {
        /// Nominal load, N.
        nominal_load: f64,
        /// Compression at nominal load Fz0/Cz, m.
        deflection: f64,
        /// Slope B at low load.
        slope: f64,
        /// Peak D.
        peak: f64,
        /// Slope F at high load.
        linear: f64,
    },
}

impl EffectiveRadius {
    /// The radius, m: `free` where nothing is compressed, m; compression, m; load, N.
    #[inline]
    pub(super) fn at<S: Real>(&self, free: S, compression: S, load: S) -> S {
        match *self {
            Self::Fraction(share) => free - compression * share,
            Self::Fit { nominal_load, deflection, slope, peak, linear } => {
                let n = load / nominal_load;
                free - ((n * slope).atan() * peak + n * linear) * deflection
            }
        }
    }
}
