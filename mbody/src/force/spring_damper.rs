//! Spring and damper between two points.
//!
//! With `d = p_B − p_A`, `l = |d|`, `u = d/l`: compression `x = l₀ − l`, force `F(x, −l̇)` pushes the points apart, `+F u` on
//! B and `−F u` on A. Symbols: l₀ free length, m; F of [`super::characteristic`]. Not defined where the points coincide.

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, LimitDeclared, OutputDeclared, SpringDamperLaw, joint_spring::stop_limits};
use crate::model::{BodyIndex, Model, Outline};
use crate::scalar::SystemScalar;
use crate::spatial::Vec3;

/// A one-dimensional law along the line between two points.
#[derive(Clone, Debug)]
pub struct SpringDamper {
    /// First body and the point in its frame.
    pub from: (BodyIndex, Vec3<f64>),
    /// Second body and the point in its frame.
    pub to: (BodyIndex, Vec3<f64>),
    /// Length at which the compression is zero, m.
    pub free_length: f64,
    /// The law; positive force pushes the points apart.
    pub law: SpringDamperLaw,
    /// Name of the limit that the stops declare.
    pub stop: &'static str,
}

/// Line of action at one instant.
struct Line<S> {
    a: Vec3<S>,
    b: Vec3<S>,
    u: Vec3<S>,
    length: S,
    length_rate: S,
}

impl SpringDamper {
    fn line<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Line<S> {
        let a = at.p_WQ(self.from.0, self.from.1);
        let b = at.p_WQ(self.to.0, self.to.1);
        let d = b - a;
        let length = d.norm();
        let u = d.scaled(length.recip());
        let length_rate = u.dot(at.v_WQ(self.to.0, b) - at.v_WQ(self.from.0, a));
        Line { a, b, u, length, length_rate }
    }
}

impl ForceLaw for SpringDamper {
    fn declare(&self, element: &str) -> Declared {
        let output = |quantity, unit, about| OutputDeclared { name: format!("{element}.{quantity}"), unit, about };
        let outputs = vec![
            output("force", "N", "force along the line of the points, positive in compression"),
            output("length", "m", "distance of the points"),
            output("compression", "m", "free length minus length"),
        ];
        let limits: Vec<LimitDeclared> = stop_limits(&self.law, self.stop, &format!("{element}.compression"));
        Declared { outputs, limits, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let line = self.line(at);
        let x = -line.length + self.free_length;
        let F = self.law.force(x, -line.length_rate);
        let f = line.u.scaled(F);
        out.force(self.to.0, line.b, f);
        out.force(self.from.0, line.a, -f);
        out.output(0, F);
        out.output(1, line.length);
        out.output(2, x);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let line = self.line(at);
        let v = -line.length_rate;
        Energy { stored: self.law.stored(-line.length + self.free_length), supplied: S::zero(), dissipated: self.law.viscous(v) * v }
    }
    fn outlines(&self, _model: &Model) -> Vec<Outline> {
        vec![Outline::Spring { from: self.from, to: self.to }]
    }
}
