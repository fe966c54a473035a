//! Plants written by hand: a residual over dual numbers, and names for its unknowns and rows.

// every test uses another part of it
#![allow(dead_code)]

mod dual;
pub mod family;

pub use dual::Dual;
use problem::{
    At, Dae, Differentiable, Equation, EquationKind, EvalError, Input, Limit, Limits, Matrix, Outputs, Seeds, Signal, Unknown, UnknownKind,
};

/// The residual and the outputs of a plant from y, ẏ and u.
pub type Law = fn(&[Dual], &[Dual], &[Dual]) -> (Vec<Dual>, Vec<Dual>);

/// A plant given by a plain function.
#[derive(Clone)]
pub struct Written {
    law: Law,
    unknowns: Vec<Unknown>,
    equations: Vec<Equation>,
    inputs: Vec<Input>,
    outputs: Vec<Signal>,
}

fn signal(name: &str) -> Signal {
    Signal::new(name, "-", "")
}

impl Written {
    /// A plant without names.
    pub fn new(law: Law) -> Self {
        Self { law, unknowns: Vec::new(), equations: Vec::new(), inputs: Vec::new(), outputs: Vec::new() }
    }

    fn unknowns(mut self, names: &str, kind: UnknownKind, cyclic: bool, differential: bool) -> Self {
        self.unknowns.extend(names.split_whitespace().map(|name| Unknown {
            signal: signal(name),
            kind,
            cyclic,
            differential,
            nominal: 1.0,
            absolute_tolerance: 1e-8,
            design: 0.0,
            start: None,
        }));
        self
    }

    fn rows(mut self, names: &str, kind: EquationKind) -> Self {
        let row = |name: &str| Equation { name: name.to_owned(), unit: "-".into(), nominal: 1.0, kind };
        self.equations.extend(names.split_whitespace().map(row));
        self
    }

    /// Coordinates and their rates.
    pub fn coordinates(self, names: &str, rates: &str) -> Self {
        let named = |prefix: &str, names: &str| names.split_whitespace().map(|n| format!("{prefix}{n} ")).collect::<String>();
        let (kinematic, dynamic) = (named("rate_of_", names), named("force_along_", rates));
        let plant = self.unknowns(names, UnknownKind::Position, false, true).unknowns(rates, UnknownKind::Velocity, false, true);
        plant.rows(&kinematic, EquationKind::Kinematic).rows(&dynamic, EquationKind::Dynamic)
    }

    /// Declares unknowns cyclic.
    pub fn cyclic(mut self, names: &str) -> Self {
        self.unknowns.iter_mut().filter(|u| names.split_whitespace().any(|n| n == u.signal.name)).for_each(|u| u.cyclic = true);
        self
    }

    /// Element states with or without rates, and their rows.
    pub fn states(self, names: &str, differential: bool) -> Self {
        let rows: String = names.split_whitespace().map(|n| format!("row_of_{n} ")).collect();
        self.unknowns(names, UnknownKind::State, false, differential).rows(&rows, EquationKind::Element)
    }

    /// Multipliers and constraints: those on velocities first, as their forces λ are; then those on coordinates with μ.
    pub fn constraints(self, multipliers: &str, on_velocities: &str, on_coordinates: &str) -> Self {
        let plant = self.unknowns(multipliers, UnknownKind::Algebraic, false, false);
        plant.rows(on_velocities, EquationKind::VelocityConstraint).rows(on_coordinates, EquationKind::Constraint)
    }

    /// Inputs; `rate` of the first one may be the second.
    pub fn inputs(mut self, names: &str) -> Self {
        let input = |name: &str| Input { signal: signal(name), rate: None, nominal: 1.0, default: 0.0 };
        self.inputs.extend(names.split_whitespace().map(input));
        self
    }

    /// Outputs.
    pub fn outputs(mut self, names: &str) -> Self {
        self.outputs.extend(names.split_whitespace().map(signal));
        self
    }

    fn run(&self, at: At<'_>, seed: impl Fn(Part, usize) -> f64) -> (Vec<Dual>, Vec<Dual>) {
        let load = |part: Part, values: &[f64]| -> Vec<Dual> {
            values.iter().enumerate().map(|(i, &value)| Dual { value, slope: seed(part, i) }).collect()
        };
        (self.law)(&load(Part::Y, at.y), &load(Part::Yd, at.yd), &load(Part::U, at.u))
    }
}

#[derive(Clone, Copy)]
enum Part {
    Y,
    Yd,
    U,
}

impl Dae for Written {
    fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }
    fn equations(&self) -> &[Equation] {
        &self.equations
    }
    fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    fn residual(&mut self, at: At<'_>, residual: &mut [f64]) -> Result<(), EvalError> {
        let (f, _) = self.run(at, |_, _| 0.0);
        residual.iter_mut().zip(&f).for_each(|(r, f)| *r = f.value);
        Ok(())
    }
}

impl Outputs for Written {
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        self.residual(at, residual)?;
        let (_, z) = self.run(at, |_, _| 0.0);
        outputs.iter_mut().zip(&z).for_each(|(o, z)| *o = z.value);
        Ok(())
    }
}

impl Limits for Written {
    fn limits(&self) -> &[Limit] {
        &[]
    }
}

impl Differentiable for Written {
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError> {
        self.evaluate(at, values.0, values.1)?;
        for k in 0..seeds.columns() {
            let (f, z) = self.run(at, |part, i| match part {
                Part::Y => seeds.y[(i, k)],
                Part::Yd => seeds.yd[(i, k)],
                Part::U => seeds.u[(i, k)],
            });
            assert_eq!((f.len(), z.len()), (self.equations.len(), self.outputs.len()), "rows and names");
            residual.column_mut(k).iter_mut().zip(&f).for_each(|(r, f)| *r = f.slope);
            outputs.column_mut(k).iter_mut().zip(&z).for_each(|(o, z)| *o = z.slope);
        }
        Ok(())
    }
}
