//! Families of plants written by hand: parameters are the last inputs of the law, taken from the user's sight.

use super::Written;
use problem::{
    At, Dae, Differentiable, Equation, EvalError, Family, Input, Limit, Limits, Matrix, Member, NoMember, Outputs, Parameter, ParameterId,
    Seeds, Signal, Unknown,
};

/// A plant with numbers behind its inputs.
#[derive(Clone)]
struct Numbered {
    plant: Written,
    numbers: Vec<f64>,
}

impl Numbered {
    fn all(&self, u: &[f64]) -> Vec<f64> {
        u.iter().chain(&self.numbers).copied().collect()
    }
}

impl Dae for Numbered {
    fn unknowns(&self) -> &[Unknown] {
        Dae::unknowns(&self.plant)
    }
    fn equations(&self) -> &[Equation] {
        Dae::equations(&self.plant)
    }
    fn inputs(&self) -> &[Input] {
        let inputs = Dae::inputs(&self.plant);
        &inputs[..inputs.len() - self.numbers.len()]
    }
    fn residual(&mut self, at: At<'_>, residual: &mut [f64]) -> Result<(), EvalError> {
        let u = self.all(at.u);
        self.plant.residual(At { u: &u, ..at }, residual)
    }
}

impl Outputs for Numbered {
    fn outputs(&self) -> &[Signal] {
        Outputs::outputs(&self.plant)
    }
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        let u = self.all(at.u);
        self.plant.evaluate(At { u: &u, ..at }, residual, outputs)
    }
}

impl Limits for Numbered {
    fn limits(&self) -> &[Limit] {
        &[]
    }
}

impl Differentiable for Numbered {
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError> {
        let u = self.all(at.u);
        let inputs = self.inputs().len();
        let mut with_numbers = Seeds { u: Matrix::zeros(u.len(), seeds.columns()), ..seeds.clone() };
        for k in 0..seeds.columns() {
            with_numbers.u.column_mut(k)[..inputs].copy_from_slice(seeds.u.column(k));
        }
        self.plant.along(At { u: &u, ..at }, &with_numbers, values, residual, outputs)
    }
}

/// Plants that differ in the values of their last inputs.
pub struct Numbers {
    steady: Written,
    linear: Written,
    parameters: Vec<Parameter>,
}

impl Numbers {
    /// The last inputs of both forms become parameters with these values.
    pub fn of(steady: Written, linear: Written, values: &[f64]) -> Self {
        let first = Dae::inputs(&steady).len() - values.len();
        let parameter = |(input, &value): (&Input, &f64)| Parameter {
            name: input.signal.name.clone(),
            unit: "1".into(),
            value,
            nominal: if value == 0.0 { 1.0 } else { value.abs() },
            about: "".into(),
        };
        let parameters = Dae::inputs(&steady)[first..].iter().zip(values).map(parameter).collect();
        Self { steady, linear, parameters }
    }
}

impl Family for Numbers {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }
    fn with(&self, changes: &[(ParameterId, f64)]) -> Result<Member, NoMember> {
        let mut numbers: Vec<f64> = self.parameters.iter().map(|p| p.value).collect();
        changes.iter().for_each(|&(id, value)| numbers[id.0] = value);
        let of = |plant: &Written| Box::new(Numbered { plant: plant.clone(), numbers: numbers.clone() });
        Ok(Member { steady: of(&self.steady), linear: of(&self.linear) })
    }
}
