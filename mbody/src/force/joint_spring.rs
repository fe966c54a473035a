//! Spring, damper, stops and friction on one joint coordinate: `τ = −F(q, q̇)`.
//!
//! The law F is that of [`super::characteristic`].

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, LimitDeclared, OutputDeclared, SpringDamperLaw};
use crate::model::BodyIndex;
use crate::scalar::SystemScalar;
use problem::Side;

/// A one-dimensional law on the coordinate of a joint.
#[derive(Clone, Debug)]
pub struct JointSpring {
    /// The body carried by the joint.
    pub joint: BodyIndex,
    /// The law; positive force opposes a positive coordinate.
    pub law: SpringDamperLaw,
    /// Unit of the effort: N on a prismatic joint, N m else.
    pub effort: JointEffortUnit,
    /// Name of the limit that the stops declare, and the full name of the coordinate's signal.
    pub stop: Option<(&'static str, String)>,
}

/// Unit of a generalized force on a joint with one coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointEffortUnit {
    /// N, along a prismatic joint.
    Force,
    /// N m, about an axis.
    Torque,
}

impl JointEffortUnit {
    /// Quantity name and unit.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Force => ("force", "N"),
            Self::Torque => ("torque", "N m"),
        }
    }
}

/// The two limits of the stops of a law: where the build-up of a stop is complete.
pub fn stop_limits(law: &SpringDamperLaw, name: &'static str, signal: &str) -> Vec<LimitDeclared> {
    let Some(s) = law.stops else { return Vec::new() };
    let nominal = (s.upper - s.lower).abs().max(1e-6);
    let limit = |threshold, side, about| LimitDeclared { name, signal: signal.into(), threshold, side, nominal, about };
    vec![
        limit(s.upper + s.width, Side::Above, "the travel has used up the bump stop"),
        limit(s.lower - s.width, Side::Below, "the travel has used up the rebound stop"),
    ]
}

impl ForceLaw for JointSpring {
    fn declare(&self, element: &str) -> Declared {
        let (word, unit) = self.effort.words();
        let about = "spring, damper, stops and friction together, positive when it opposes a positive coordinate";
        let limits = self.stop.as_ref().map(|(name, signal)| stop_limits(&self.law, name, signal)).unwrap_or_default();
        Declared { outputs: vec![OutputDeclared { name: format!("{element}.{word}"), unit, about }], limits, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let F = self.law.force(at.coordinate(self.joint), at.speed(self.joint));
        out.joint(self.joint, -F);
        out.output(0, F);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let v = at.speed(self.joint);
        Energy { stored: self.law.stored(at.coordinate(self.joint)), supplied: S::zero(), dissipated: self.law.viscous(v) * v }
    }
}
