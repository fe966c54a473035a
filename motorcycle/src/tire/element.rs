//! The tire as a force element: a wheel, a carcass, a friction law.
//!
//! The carcass is deformable in the directions of the rim ([`Deformable`]), or a vertical spring with a relaxation of slip
//! or force ([`Vertical`]), or rigid, held on the road by a constraint ([`Rigid`]). All hand over a patch: forces, slips, rows, energy.

use super::carcass::RoadContact;
use super::deformable::Deformable;
use super::effective_radius::EffectiveRadius;
use super::law::{AnyTireLaw, MomentPoint, TireLaw};
use super::patch::{Patch, limits, outputs, ranges};
use super::rigid::Rigid;
use super::rolling_resistance::RollingResistance;
use super::vertical::Vertical;
use super::wheel::{Rolling, Wheel};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, StateDeclared};
use mbody::model::{Model, Outline};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;

/// How the tire gives way between rim and road.
#[derive(Clone, Debug)]
pub enum Carcass {
    /// Springs radial and lateral of the rim; forces act where the deformed tire touches.
    Deformable(Deformable),
    /// A spring along the normal of the road, with a relaxation of slip or force.
    Vertical(Vertical),
    /// Rigid, with a relaxation of slip or force; a constraint holds the wheel on the road.
    Rigid(Rigid),
}

/// A tire on a wheel.
#[derive(Clone, Debug)]
pub struct Tire {
    /// The wheel.
    pub wheel: Wheel,
    /// Carcass.
    pub carcass: Carcass,
    /// Friction at the contact.
    pub law: AnyTireLaw,
    /// Whether it can leave the road.
    pub contact: RoadContact,
    /// Rolling resistance.
    pub rolling_resistance: RollingResistance,
    /// Effective rolling radius.
    pub effective_radius: EffectiveRadius,
    /// Speed V0 below which slips are rounded, m/s.
    pub low_speed: f64,
}

impl Tire {
    /// Reference speed `V* = √(V_x² + V0²)`, m/s.
    #[inline]
    pub(super) fn reference_speed<S: SystemScalar>(&self, forward: S) -> S {
        (forward * forward + self.low_speed * self.low_speed).sqrt()
    }

    fn states(&self) -> Vec<StateDeclared> {
        match &self.carcass {
            Carcass::Deformable(c) => c.states(),
            Carcass::Vertical(c) => c.relaxation.states(),
            Carcass::Rigid(c) => c.relaxation.states(),
        }
    }

    #[inline]
    fn patch<S: SystemScalar>(&self, rolling: &Rolling<S>, at: &Evaluated<'_, S>) -> Patch<S> {
        let mut patch = match &self.carcass {
            Carcass::Deformable(c) => c.patch(self, rolling, at),
            Carcass::Vertical(c) => c.patch(self, rolling, at),
            Carcass::Rigid(c) => c.patch(self, rolling, at),
        };
        self.carry(rolling, &mut patch);
        patch
    }

    /// Moments of the law at the point of contact P: about the point P_w where the plane of the wheel meets the road they are those about P and
    /// those of the forces, `Mz = Mz_w + y Fx`, `Mx = Mx_w − y N` with y the place of P to the left of P_w.
    #[inline]
    fn carry<S: SystemScalar>(&self, rolling: &Rolling<S>, patch: &mut Patch<S>) {
        let friction = &mut patch.friction;
        if let RollingResistance::Law = self.rolling_resistance {
            patch.rolling_moment = friction.rolling_moment * RollingResistance::fading(rolling.spin);
        }
        let point = self.law.moment_point();
        if point == MomentPoint::Contact {
            return;
        }
        let aside = patch.arm.dot(rolling.axis) / rolling.frame.cos_camber;
        friction.aligning_moment += aside * friction.longitudinal;
        if point == MomentPoint::WheelPlane {
            friction.overturning_moment -= aside * patch.load;
        }
    }
}

impl ForceLaw for Tire {
    fn declare(&self, element: &str) -> Declared {
        Declared {
            states: self.states(),
            inputs: self.wheel.inputs(),
            outputs: outputs(element),
            limits: limits(element, &self.wheel, self.law.saturates()),
            ranges: ranges(element, self.law.fit()),
            spinning: vec![self.wheel.body],
            tells_only: false,
            multipliers: match &self.carcass {
                Carcass::Rigid(c) => vec![c.load.clone()],
                _ => Vec::new(),
            },
        }
    }

    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let rolling = self.wheel.rolling(at);
        let patch = self.patch(&rolling, at);
        patch.apply(&self.wheel, &rolling, out);
        for (i, row) in patch.rows.into_iter().enumerate().take(self.carcass.state_count()) {
            out.row(i, row);
        }
    }

    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let rolling = self.wheel.rolling(at);
        self.patch(&rolling, at).energy(&rolling)
    }

    fn outlines(&self, model: &Model) -> Vec<Outline> {
        let axis = model.body(self.wheel.body).joint.rotation_axis();
        let round = |axis| Outline::Round { at: (self.wheel.body, Vec3::zero()), axis, profile: self.wheel.profile.clone() };
        axis.map(round).into_iter().collect()
    }
}

impl Carcass {
    fn state_count(&self) -> usize {
        match self {
            Self::Deformable(c) => c.state_count(),
            Self::Vertical(c) => c.relaxation.state_count(),
            Self::Rigid(c) => c.relaxation.state_count(),
        }
    }
}
