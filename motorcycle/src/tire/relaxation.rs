//! How side forces build up: one of several ways in which slip or force follow what the wheel does.
//!
//! ```text
//! none                  a = −V_sy/V*
//! elastic               0 = kl λ + cl λ̇ − Fy,      a = −(V_sy + λ̇)/V*
//! slip                  σ ȧ + V* a + V_sy = 0       (and σκ κ̇ + V* κ + V_sx = 0 where σκ is given)
//! force                 (σ/V*) Ḟ + F = Fy(κ, a, γ, N)
//! force without camber  (σ/V*) Ḟ + F = Fy(κ, a, γ, N) − Fy(κ, 0, γ, N),      side force F + Fy(κ, 0, γ, N)
//! ```
//!
//! V_sx, V_sy sliding of the carrier at the contact, m/s; V* reference speed, m/s; λ displacement of the patch to the left in the plane of
//! the road, m; σ relaxation length, m. All moments follow the slip, not the lagged force. The equations of slip hold through
//! standstill, where they make a spring of stiffness C_α/σ.
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, chapter 7 (slip); R. S. Sharp, J. Mech. Eng. Sci. 13 (1971) 316–329 (force);
//! the elastic form after R. Lot, Meccanica 39 (2004) 207–220, with the spring in the plane of the road.
//! Range: a polynomial of load holds near the loads that it was fitted at. A lagged force outlives the load by σ/V*.

use super::carcass::{Elastic, RelaxationLength};
use super::deformable::CARCASS_LATERAL;
use super::element::Tire;
use super::law::Slip;
use super::patch::Patch;
use super::similarity;
use mbody::force::{Evaluated, StateDeclared};
use mbody::scalar::SystemScalar;

/// How side forces build up.
#[derive(Clone, Debug)]
pub enum Relaxation {
    /// At once.
    None,
    /// By a spring along the road.
    Elastic(Elastic),
    /// By a lag of the slip.
    Slip {
        /// Length for the lateral slip.
        lateral: RelaxationLength,
        /// Length for the longitudinal slip; none: at once.
        longitudinal: Option<RelaxationLength>,
    },
    /// By a lag of the side force.
    Force(RelaxationLength),
    /// By a lag of the side force except what camber alone produces.
    ForceWithoutCamber(RelaxationLength),
}

const SLIP: StateDeclared = StateDeclared {
    name: "lagged_lateral_slip",
    unit: "-",
    about: "lateral slip after relaxation, positive when the tire slides to the right",
    nominal: 0.01,
    absolute_tolerance: 1e-8,
    differential: true,
    row: ("lateral sliding", "m/s", 1.0),
};

const LONGITUDINAL_SLIP: StateDeclared = StateDeclared {
    name: "lagged_longitudinal_slip",
    about: "longitudinal slip after relaxation, driving positive",
    row: ("longitudinal sliding", "m/s", 1.0),
    ..SLIP
};

const FORCE: StateDeclared = StateDeclared {
    name: "lagged_lateral_force",
    unit: "N",
    about: "side force after relaxation, to the left",
    nominal: 1000.0,
    absolute_tolerance: 1e-3,
    differential: true,
    row: ("build-up of the lateral force", "N", 1000.0),
};

/// Sliding of the rigid tire and what the rows need beside it.
pub(super) struct Sliding<S> {
    pub x: S,
    pub y: S,
    pub reference: S,
    pub load: S,
    pub camber: S,
    /// Friction of the road; none where it is 1.
    pub road: Option<S>,
}

impl<S: SystemScalar> Sliding<S> {
    fn slip(&self, lateral: S, longitudinal: S) -> Slip<S> {
        Slip { load: self.load, lateral, longitudinal, camber: self.camber, speed: self.reference }
    }
}

impl Relaxation {
    pub(super) fn states(&self) -> Vec<StateDeclared> {
        match self {
            Self::None => vec![],
            Self::Elastic(_) => vec![CARCASS_LATERAL],
            Self::Slip { longitudinal: None, .. } => vec![SLIP],
            Self::Slip { longitudinal: Some(_), .. } => vec![SLIP, LONGITUDINAL_SLIP],
            Self::Force(_) | Self::ForceWithoutCamber(_) => vec![FORCE],
        }
    }

    pub(super) fn state_count(&self) -> usize {
        match self {
            Self::None => 0,
            Self::Slip { longitudinal: Some(_), .. } => 2,
            _ => 1,
        }
    }

    /// Friction, slips and rows.
    #[inline]
    pub(super) fn relax<S: SystemScalar>(&self, tire: &Tire, sliding: &Sliding<S>, at: &Evaluated<'_, S>, patch: &mut Patch<S>) {
        let Sliding { x, y, reference, load, camber, road } = *sliding;
        let length = |sigma: &RelaxationLength| sigma.at(&tire.law, load, camber, reference);
        let per_reference = reference.recip();
        let (mut a, mut kappa) = (-y * per_reference, -x * per_reference);
        match self {
            Self::Elastic(_) => a -= at.state_rate(0) * per_reference,
            Self::Slip { lateral, longitudinal } => {
                a = at.state(0);
                patch.rows[0] = length(lateral) * at.state_rate(0) + reference * a + y;
                if let Some(sigma) = longitudinal {
                    kappa = at.state(1);
                    patch.rows[1] = length(sigma) * at.state_rate(1) + reference * kappa + x;
                }
            }
            Self::None | Self::Force(_) | Self::ForceWithoutCamber(_) => {}
        }
        let mut friction = similarity::friction(&tire.law, &sliding.slip(a, kappa), road);
        let steady = friction.lateral;
        match self {
            Self::Elastic(spring) => {
                let (lateral, rate) = (at.state(0), at.state_rate(0));
                patch.rows[0] = spring.force(lateral, rate) - steady;
                let [stored, stored_rate] = spring.stored(lateral, rate);
                (patch.stored, patch.stored_rate) = (patch.stored + stored, patch.stored_rate + stored_rate);
            }
            Self::Force(sigma) => {
                friction.lateral = at.state(0);
                patch.rows[0] = length(sigma) * per_reference * at.state_rate(0) + friction.lateral - steady;
            }
            Self::ForceWithoutCamber(sigma) => {
                let of_camber = similarity::friction(&tire.law, &sliding.slip(S::zero(), kappa), road).lateral;
                friction.lateral = at.state(0) + of_camber;
                patch.rows[0] = length(sigma) * per_reference * at.state_rate(0) + friction.lateral - steady;
            }
            Self::None | Self::Slip { .. } => {}
        }
        (patch.friction, patch.slip_angle, patch.longitudinal_slip) = (friction, a.atan(), kappa);
    }
}
