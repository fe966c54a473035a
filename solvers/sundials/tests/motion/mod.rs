//! Initial value problems with published or exact solutions, and a recorder of samples.
#![allow(dead_code, unused_imports, reason = "each test binary uses a part")]

mod systems;

use problem::{
    DaeMethod, DaeProblem, EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, LinearSolver, Matrix, OdeMethod,
    OdeProblem,
};
pub use systems::*;

/// What came out of an integration.
pub struct Record {
    pub outcome: IntegrationOutcome,
    /// Time, y and ẏ of each sample.
    pub samples: Vec<(f64, Vec<f64>, Vec<f64>)>,
    /// y where it ended.
    pub y: Vec<f64>,
    /// ẏ where it ended; empty for explicit systems.
    pub yd: Vec<f64>,
}

impl Record {
    /// Holds that all sampling times were reached.
    pub fn finished(self, times: &[f64]) -> Self {
        assert_eq!(self.outcome.ending, IntegrationEnding::Finished, "{:?}", self.outcome);
        assert_eq!(self.samples.iter().map(|sample| sample.0).collect::<Vec<_>>(), times);
        assert_eq!(self.outcome.time, times[times.len() - 1]);
        self
    }

    /// Largest deviation of the samples from a known solution, over its leading entries.
    pub fn deviation(&self, exact: impl Fn(f64) -> Vec<f64>) -> f64 {
        let deviation = |(time, y, _): &(f64, Vec<f64>, Vec<f64>)| largest_difference(y, &exact(*time));
        self.samples.iter().map(deviation).fold(0.0, f64::max)
    }
}

/// Largest difference over the entries that both have.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Integrates an implicit system and records all samples.
pub fn record_dae(
    method: &mut dyn DaeMethod,
    problem: &mut dyn DaeProblem,
    times: &[f64],
    start: (&[f64], &[f64]),
    options: &IntegrationOptions,
) -> Record {
    let (mut y, mut yd, mut samples) = (start.0.to_vec(), start.1.to_vec(), Vec::new());
    let outcome = method.integrate(problem, times, (&mut y, &mut yd), options, &mut |time, y, yd| {
        samples.push((time, y.to_vec(), yd.to_vec()));
        Flow::Continue
    });
    Record { outcome, samples, y, yd }
}

/// Integrates an explicit system and records all samples.
pub fn record_ode(
    method: &mut dyn OdeMethod,
    problem: &mut dyn OdeProblem,
    times: &[f64],
    start: &[f64],
    options: &IntegrationOptions,
) -> Record {
    let (mut y, mut samples) = (start.to_vec(), Vec::new());
    let outcome = method.integrate(problem, times, &mut y, options, &mut |time, y, yd| {
        samples.push((time, y.to_vec(), yd.to_vec()));
        Flow::Continue
    });
    Record { outcome, samples, y, yd: Vec::new() }
}

/// Default options at a relative tolerance, with absolute tolerances scaled along (those of the systems are one).
pub fn tolerance(tolerance: f64) -> IntegrationOptions {
    IntegrationOptions { relative_tolerance: tolerance, absolute_tolerance_factor: tolerance, ..Default::default() }
}

/// Equally spaced times.
pub fn grid(from: f64, to: f64, intervals: usize) -> Vec<f64> {
    (0..=intervals).map(|i| from + (to - from) * i as f64 / intervals as f64).collect()
}

/// What may solve the linear equations of a step.
pub const LINEAR_SOLVERS: [LinearSolver; 2] = [LinearSolver::Direct, LinearSolver::Gmres];

/// A function of time and y.
pub type Law = fn(f64, f64) -> Result<f64, EvalError>;

/// One scalar equation ẏ = f(t, y), in both forms; `slope` is ∂f/∂y.
pub struct Scalar {
    pub rate: Law,
    pub slope: Law,
    pub event: Option<Law>,
    pub tolerance: f64,
}

impl Scalar {
    /// ẏ = −y.
    pub fn decay() -> Self {
        Self { rate: |_, y| Ok(-y), slope: |_, _| Ok(-1.0), event: None, tolerance: 1.0 }
    }
}

impl OdeProblem for Scalar {
    fn size(&self) -> usize {
        1
    }
    fn absolute_tolerance(&self) -> &[f64] {
        std::slice::from_ref(&self.tolerance)
    }
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        yd[0] = (self.rate)(time, y[0])?;
        Ok(())
    }
    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian[(0, 0)] = (self.slope)(time, y[0])?;
        Ok(())
    }
    fn event_count(&self) -> usize {
        usize::from(self.event.is_some())
    }
    fn events(&mut self, time: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values[0] = self.event.map_or(Ok(1.0), |event| event(time, y[0]))?;
        Ok(())
    }
}

impl DaeProblem for Scalar {
    fn size(&self) -> usize {
        1
    }
    fn differential(&self) -> &[bool] {
        &[true]
    }
    fn absolute_tolerance(&self) -> &[f64] {
        std::slice::from_ref(&self.tolerance)
    }
    fn residual(&mut self, time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        residual[0] = yd[0] - (self.rate)(time, y[0])?;
        Ok(())
    }
    fn jacobian(&mut self, time: f64, c: f64, y: &[f64], _yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian[(0, 0)] = c - (self.slope)(time, y[0])?;
        Ok(())
    }
    fn event_count(&self) -> usize {
        usize::from(self.event.is_some())
    }
    fn events(&mut self, time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values[0] = self.event.map_or(Ok(1.0), |event| event(time, y[0]))?;
        Ok(())
    }
}
