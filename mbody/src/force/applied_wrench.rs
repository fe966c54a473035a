//! A force and a moment on a body, given as inputs.

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared};
use crate::model::BodyIndex;
use crate::scalar::SystemScalar;
use crate::spatial::Vec3;

/// In which axes the inputs of an [`AppliedWrench`] are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrenchAxes {
    /// Axes of the world.
    World,
    /// Axes of the body.
    Body,
}

/// Inputs `force_x … moment_z` at a point of a body.
#[derive(Clone, Debug)]
pub struct AppliedWrench {
    /// The body.
    pub body: BodyIndex,
    /// The point, in the body frame, m.
    pub point: Vec3<f64>,
    /// Axes of the inputs.
    pub axes: WrenchAxes,
}

impl AppliedWrench {
    /// Point, force and moment in the world.
    fn wrench<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> (Vec3<S>, Vec3<S>, Vec3<S>) {
        let f = Vec3::new(at.input(0), at.input(1), at.input(2));
        let n = Vec3::new(at.input(3), at.input(4), at.input(5));
        let p = at.p_WQ(self.body, self.point);
        match self.axes {
            WrenchAxes::World => (p, f, n),
            WrenchAxes::Body => {
                let R = &at.X_WB(self.body).R;
                (p, R * f, R * n)
            }
        }
    }
}

impl ForceLaw for AppliedWrench {
    fn declare(&self, element: &str) -> Declared {
        const INPUTS: [(&str, &str); 6] =
            [("force_x", "N"), ("force_y", "N"), ("force_z", "N"), ("moment_x", "N m"), ("moment_y", "N m"), ("moment_z", "N m")];
        let about = "applied from outside";
        let inputs =
            INPUTS.map(|(q, unit)| InputDeclared { name: format!("{element}.{q}"), unit, about, nominal: 100.0, rate: None, default: 0.0 });
        Declared { inputs: inputs.to_vec(), ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let (p, f, n) = self.wrench(at);
        out.force_and_moment(self.body, p, f, n);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let (p, f, n) = self.wrench(at);
        Energy { supplied: f.dot(at.v_WQ(self.body, p)) + n.dot(at.w_WB(self.body)), ..Default::default() }
    }
}
