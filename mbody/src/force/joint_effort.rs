//! A force or torque on one joint coordinate, given as an input.

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared, joint_spring::JointEffortUnit};
use crate::model::BodyIndex;
use crate::scalar::SystemScalar;

/// An input that acts on the coordinate of a joint; the reaction on the parent is implied.
#[derive(Clone, Debug)]
pub struct JointEffort {
    /// The body carried by the joint.
    pub joint: BodyIndex,
    /// N on a prismatic joint, N m else.
    pub unit: JointEffortUnit,
    /// Value where nobody says otherwise, N or N m.
    pub default: f64,
}

impl ForceLaw for JointEffort {
    fn declare(&self, element: &str) -> Declared {
        let (word, unit) = self.unit.words();
        let input = InputDeclared {
            name: format!("{element}.{word}"),
            unit,
            about: "applied to the joint, positive in the sense of its coordinate",
            nominal: 100.0,
            rate: None,
            default: self.default,
        };
        Declared { inputs: vec![input], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        out.joint(self.joint, at.input(0));
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        Energy { supplied: at.input(0) * at.speed(self.joint), ..Default::default() }
    }
}
