//! Motion over time: consistent start, integration by any method, samples of named signals.
//!
//! 1. The start is brought onto the constraints: coordinates, then velocities, none of the held ones; then multipliers and rates follow.
//! 2. The plant becomes `0 = F(t, y, ẏ)` for a [`DaeMethod`] (rows in units of their nominal values, exact Jacobian ∂F/∂y + c ∂F/∂ẏ) or
//!    `ẏ = f(t, y)` of its differential unknowns for an [`OdeMethod`] (projected after each step).
//! 3. Every sample is recorded by name as soon as it is computed. A simulation that cannot go on is no error: it has an ending with the
//!    time reached and the cause in signal and equation names, and everything before it is kept.
//!
//! All values are SI; times are in s. The service allocates nothing between the first and the last sample.
//!
//! An event function on signals (`DaeProblem::events`, `OdeProblem::events`) would stand in both forms of the plant; its ending is there.

mod diagnosis;
mod ending;
mod explicit;
mod implicit;
mod inputs;
mod recorder;
mod trajectory;

pub use ending::{Cause, Moving, TransientEnding, TransientError};
pub use inputs::{Constant, Inputs};
pub use trajectory::{Drift, LimitMet, NearSingular, Trajectory, Worst};

use crate::{Variable, Variables};
use diagnosis::{fastest, not_finite, off_at, undetermined};
use explicit::{ExplicitForm, Whole};
use implicit::Implicit;
use problem::{DaeMethod, Flow, Integrable, IntegrationEnding, IntegrationOptions, IntegrationOutcome, OdeMethod, Plant};
use recorder::Recorder;
use std::cell::RefCell;

/// Problem and recorder evaluate the same plant, by turns.
type SharedPlant<'p> = RefCell<&'p mut dyn Integrable>;

/// Longest first step of an implicit method, s.
const FIRST_STEP: f64 = 1e-6;

/// A method of either form.
pub enum Method<'a> {
    /// Takes the implicit form.
    Dae(&'a mut dyn DaeMethod),
    /// Takes the explicit form.
    Ode(&'a mut dyn OdeMethod),
}

impl Method<'_> {
    /// Name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Dae(method) => method.name(),
            Self::Ode(method) => method.name(),
        }
    }
}

/// Where a simulation starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// All unknowns, before they are brought onto the constraints.
    pub y: Vec<f64>,
    /// Which of them must keep their values.
    pub held: Vec<bool>,
}

impl Start {
    /// As the plant states it: stated values, which are held, and the design pose at rest.
    pub fn stated(plant: &dyn Plant) -> Self {
        let unknowns = plant.unknowns().iter();
        Self { y: unknowns.clone().map(|u| u.start.unwrap_or(u.design)).collect(), held: unknowns.map(|u| u.start.is_some()).collect() }
    }

    /// Gives unknowns values that they keep. Where one of them is a coordinate, no other coordinate is held any longer; likewise
    /// velocities and states: what is given last counts, and the constraints find the rest.
    pub fn hold(&mut self, plant: &dyn Plant, given: &[(usize, f64)]) {
        let kind = |i: usize| plant.unknowns()[i].kind;
        for i in 0..self.held.len() {
            self.held[i] &= !given.iter().any(|&(g, _)| kind(g) == kind(i));
        }
        for &(i, value) in given {
            (self.y[i], self.held[i]) = (value, true);
        }
    }
}

/// A simulation to be run.
#[derive(Clone, Debug)]
pub struct Transient {
    /// Where it starts.
    pub start: Start,
    /// Sampling times, s, the start included; each later than the one before.
    pub times: Vec<f64>,
    /// Tolerances and steps.
    pub options: IntegrationOptions,
    /// What is recorded.
    pub record: Vec<Variable>,
}

/// A simulation that was run.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The recorded signals.
    pub trajectory: Trajectory,
    /// How it ended.
    pub ending: TransientEnding,
    /// Time reached and what the method did on the way.
    pub statistics: IntegrationOutcome,
    /// How well the constraints held.
    pub drift: Drift,
    /// Declared limits that were violated on the way, in the order of their declaration.
    pub limits: Vec<LimitMet>,
    /// The sample nearest to a singular position, where the constraints lost most of their independence.
    pub near_singular: Option<NearSingular>,
    /// All unknowns at the time reached.
    pub y: Vec<f64>,
    /// Their rates; not finite where the point reached has none.
    pub yd: Vec<f64>,
}

/// `count` sampling times from 0 to `duration` (s), evenly spaced, both ends included.
pub fn evenly(duration: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|k| duration * (k as f64 / last)).collect()
}

/// Every unknown, input and output of a plant.
pub fn everything(plant: &dyn Plant) -> Vec<Variable> {
    let unknowns = (0..plant.unknowns().len()).map(Variable::Unknown);
    let inputs = (0..plant.inputs().len()).map(Variable::Input);
    unknowns.chain(inputs).chain((0..plant.outputs().len()).map(Variable::Output)).collect()
}

impl Transient {
    /// A simulation from the stated start, everything recorded.
    pub fn new(plant: &dyn Plant, times: Vec<f64>) -> Self {
        Self { start: Start::stated(plant), times, options: IntegrationOptions::default(), record: everything(plant) }
    }

    /// Runs it.
    ///
    /// # Errors
    /// The simulation could not start: no sequence of times, or a start that cannot satisfy the constraints. What happens later is an
    /// ending.
    pub fn run(&self, plant: &mut dyn Integrable, inputs: &dyn Inputs, method: Method<'_>) -> Result<Simulation, TransientError> {
        let (mut y, mut yd) = self.consistent_start(plant, inputs)?;
        let variables = Variables::of(&*plant);
        let plant = RefCell::new(plant);
        // one more: the time reached, where it lies between two samples
        let mut recorder = Recorder::new(&plant, inputs, &variables, &self.record, self.times.len() + 1);
        let (statistics, cause) = match method {
            Method::Dae(method) => self.implicitly(&plant, inputs, method, (&mut y, &mut yd), &mut recorder),
            Method::Ode(method) => self.explicitly(&plant, inputs, method, (&mut y, &mut yd), &mut recorder),
        };
        // what was reached beyond the last sample is kept too
        let beyond = recorder.last_time().is_none_or(|last| last < statistics.time);
        if beyond && recorder.failure().is_none() && yd.iter().all(|rate| rate.is_finite()) {
            recorder.sample(statistics.time, &y, &yd);
        }
        let ending = match (statistics.ending, recorder.failure()) {
            (IntegrationEnding::Finished, _) => TransientEnding::Reached,
            (IntegrationEnding::Event { event, rising }, _) => TransientEnding::Event { event, rising },
            (IntegrationEnding::Stopped, None) => TransientEnding::Stopped,
            (IntegrationEnding::Stopped, Some(e)) => TransientEnding::Failed { cause: not_finite(e, &plant) },
            (_, _) => TransientEnding::Failed { cause },
        };
        let (trajectory, drift, limits, near_singular) = recorder.finish();
        Ok(Simulation { trajectory, ending, statistics, drift, limits, near_singular, y, yd })
    }

    /// Coordinates and velocities on the constraints, then multipliers and rates.
    fn consistent_start(&self, plant: &mut dyn Integrable, inputs: &dyn Inputs) -> Result<(Vec<f64>, Vec<f64>), TransientError> {
        let rising = self.times.windows(2).all(|w| w[0] < w[1]) && self.times.iter().all(|t| t.is_finite());
        let (Some(&first), true, true) = (self.times.first(), self.times.len() > 1, rising) else {
            return Err(TransientError::Times);
        };
        let (mut y, mut yd, mut u) = (self.start.y.clone(), vec![0.0; self.start.y.len()], vec![0.0; plant.inputs().len()]);
        inputs.at(first, &mut u);
        plant.project(first, &mut y, &u, &self.start.held).map_err(|e| TransientError::projection(e, plant.equations()))?;
        plant
            .solve_rates(first, &mut y, &u, &mut yd)
            .map_err(|e| TransientError::NotFinite { equation: ending::equation(e, plant.equations()) })?;
        Ok((y, yd))
    }

    /// Integrates the implicit form; the cause matters only where the integration failed.
    fn implicitly(
        &self,
        plant: &SharedPlant<'_>,
        inputs: &dyn Inputs,
        method: &mut dyn DaeMethod,
        (y, yd): (&mut [f64], &mut [f64]),
        recorder: &mut Recorder<'_, '_>,
    ) -> (IntegrationOutcome, Cause) {
        let mut problem = Implicit::new(plant, inputs);
        let options = IntegrationOptions { first_step: self.options.first_step.or(Some(self.first_step())), ..self.options };
        let mut sink = |time: f64, y: &[f64], yd: &[f64]| recorder.sample(time, y, yd);
        let outcome = method.integrate(&mut problem, &self.times, (&mut *y, &mut *yd), &options, &mut sink);
        let cause = match (outcome.ending, problem.failure()) {
            (IntegrationEnding::Evaluation(e), _) | (IntegrationEnding::Convergence | IntegrationEnding::ErrorTest, Some(e)) => {
                not_finite(e, plant)
            }
            (IntegrationEnding::Convergence, None) => Cause::Convergence { rows: problem.worst() },
            (IntegrationEnding::Singular, _) => {
                // the inverse of a typical step
                let elapsed = outcome.time - self.times[0];
                let c = if elapsed > 0.0 { outcome.steps.max(1) as f64 / elapsed } else { 1e3 };
                Cause::Singular { together: undetermined(plant, &mut problem, (outcome.time, c), (y, yd)) }
            }
            (IntegrationEnding::Refused, _) => Cause::Refused { rows: off_at(&mut problem, outcome.time, (y, yd)) },
            (ending, _) => self.too_fast(ending, plant, (y, yd)),
        };
        (outcome, cause)
    }

    /// First step of an implicit method where nobody says otherwise, s.
    ///
    /// A method's own choice, half a tolerance over the largest rate, is some 1e-10 s for a mechanism that starts from rest. Over such a step the
    /// rounding of a closed loop (1e-17 m) is a correction of 1e-7 m/s, which no iteration resolves, and shorter steps are worse.
    fn first_step(&self) -> f64 {
        self.times.windows(2).map(|w| w[1] - w[0]).fold(FIRST_STEP, f64::min)
    }

    /// Integrates the explicit form; the cause matters only where the integration failed.
    fn explicitly(
        &self,
        plant: &SharedPlant<'_>,
        inputs: &dyn Inputs,
        method: &mut dyn OdeMethod,
        (y, yd): (&mut [f64], &mut [f64]),
        recorder: &mut Recorder<'_, '_>,
    ) -> (IntegrationOutcome, Cause) {
        let mut problem = ExplicitForm::new(plant, inputs, y, yd);
        let mut whole = Whole::new(plant, inputs, y, yd);
        let mut states: Vec<f64> = problem.states().iter().map(|&i| y[i]).collect();
        let mut lost = None;
        let mut sink = |time: f64, states: &[f64], _: &[f64]| match whole.complete(time, states) {
            Ok((y, yd)) => recorder.sample(time, y, yd),
            Err(e) => {
                lost = Some(e);
                Flow::Stop
            }
        };
        let mut outcome = method.integrate(&mut problem, &self.times, &mut states, &self.options, &mut sink);
        if let Some(e) = lost {
            outcome.ending = IntegrationEnding::Evaluation(e);
        }
        match whole.complete(outcome.time, &states) {
            Ok((all, rates)) => {
                y.copy_from_slice(all);
                yd.copy_from_slice(rates);
            }
            Err(_) => yd.fill(f64::NAN),
        }
        let cause = match (outcome.ending, problem.failure()) {
            (IntegrationEnding::Evaluation(_) | IntegrationEnding::ErrorTest, _) if !problem.off().is_empty() => {
                Cause::Open { rows: problem.off().to_vec() }
            }
            (IntegrationEnding::Evaluation(e), _) | (IntegrationEnding::ErrorTest, Some(e)) => not_finite(e, plant),
            (ending, _) => self.too_fast(ending, plant, (y, yd)),
        };
        (outcome, cause)
    }

    /// Too many steps, or too small ones.
    fn too_fast(&self, ending: IntegrationEnding, plant: &SharedPlant<'_>, at: (&[f64], &[f64])) -> Cause {
        let moving = fastest(plant, &self.options, at);
        match ending {
            IntegrationEnding::TooManySteps => Cause::TooManySteps { allowed: self.options.max_steps, moving },
            _ => Cause::ErrorTest { moving },
        }
    }
}
