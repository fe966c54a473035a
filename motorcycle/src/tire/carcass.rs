//! What a carcass is made of, and how the road holds it.
//!
//! ```text
//! bonded    N = f                                  the road pulls where f < 0: for straight comparisons of linear models
//! lifting   N = b(δ) (f + √(f² + 4 ε²))/2          b = 0 in the air, 1 from δ = w on;  ε = 1 N,  w = 0.5 mm
//! ```
//!
//! f force of springs and dampers along the normal of the road, N; δ depth of the undeformed tire below the road, m; b C2 step. At
//! 1000 N on the road the rounding adds ε²/f = 1 mN. Dampers never pull, because f enters the root with them.
//!
//! Source: ours.

use super::law::{AnyTireLaw, TireLaw};
use mbody::scalar::smooth::{sabs, splus, step};
use mbody::scalar::{Real, SystemScalar};

/// Depth over which the road takes hold, m.
const WIDTH: f64 = 0.5e-3;
/// Relaxation length that remains in the air, m: the rows of slips stay regular. Changes a length of 0.1 m by 5·10⁻⁷ of itself.
const SHORTEST: f64 = 1e-4;

/// A linear spring with a linear damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
}

impl Elastic {
    /// Force at a deflection and its rate, N.
    #[inline]
    pub(super) fn force<S: Real>(&self, x: S, rate: S) -> S {
        x * self.stiffness + rate * self.damping
    }

    /// Energy, J, and its rate, W.
    #[inline]
    pub(super) fn stored<S: Real>(&self, x: S, rate: S) -> [S; 2] {
        let f = x * self.stiffness;
        [x * f * 0.5, f * rate]
    }
}

/// Whether the tire can leave the road.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RoadContact {
    /// The tire lifts where the road would have to pull.
    #[default]
    Lifting,
    /// The road pulls where it has to.
    Bonded,
}

impl RoadContact {
    /// Share b of the road in holding the tire, from the depth of the undeformed tire.
    #[inline]
    pub(super) fn hold<S: Real>(self, penetration: S) -> S {
        match self {
            Self::Lifting => step(penetration, WIDTH),
            Self::Bonded => S::one(),
        }
    }

    /// The load N from the force f of springs and dampers along the normal.
    #[inline]
    pub(super) fn load<S: Real>(self, hold: S, force: S) -> S {
        match self {
            Self::Lifting => hold * splus(force, super::patch::LIFTED),
            Self::Bonded => force,
        }
    }

    /// The part of a compression that stores energy.
    #[inline]
    pub(super) fn compressed<S: Real>(self, deflection: S) -> S {
        if self == Self::Lifting && deflection.value() < 0.0 { S::zero() } else { deflection }
    }
}

/// Length over which slip or side force builds up.
#[derive(Clone, Debug, PartialEq)]
pub enum RelaxationLength {
    /// The same at every load and speed, m.
    Constant(f64),
    /// Polynomial of the load in N, m, constant coefficient first (Sharp 1994).
    LoadPolynomial(Vec<f64>),
    /// `σ = K(N, γ) (c0 + c1 V + c2 V²)` with the cornering stiffness K of the law, N (Sharp, Evangelou, Limebeer 2004).
    CorneringStiffness([f64; 3]),
    /// As the law says for lateral slip.
    LateralOfLaw,
    /// As the law says for longitudinal slip.
    LongitudinalOfLaw,
}

impl RelaxationLength {
    /// The length, m; forms that may vanish with the load are kept above [`SHORTEST`].
    #[inline]
    pub(super) fn at<S: SystemScalar>(&self, law: &AnyTireLaw, load: S, camber: S, speed: S) -> S {
        match self {
            Self::Constant(length) => S::from_f64(*length),
            Self::LoadPolynomial(coefficients) => {
                let length = coefficients.iter().rev().fold(S::zero(), |sum, c| sum * load + *c);
                sabs(length, SHORTEST)
            }
            Self::CorneringStiffness([c0, c1, c2]) => {
                let per_stiffness = (speed * *c2 + *c1) * speed + *c0;
                sabs(law.cornering_stiffness(load, camber) * per_stiffness, SHORTEST)
            }
            Self::LateralOfLaw => sabs(law.relaxation_lengths(load, camber)[0], SHORTEST),
            Self::LongitudinalOfLaw => sabs(law.relaxation_lengths(load, camber)[1], SHORTEST),
        }
    }
}
