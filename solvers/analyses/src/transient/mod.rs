//! Motion over time: consistent start, integration by any method, samples of named signals.
//!
//! 1. The start is brought onto the constraints: coordinates, then velocities, none of the held ones; then multipliers and rates follow.
//! 2. The plant becomes `0 = F(t, y, ẏ)` for a [`DaeMethod`] (rows in units of their nominal values, exact Jacobian ∂F/∂y + c ∂F/∂ẏ) or
//!    `ẏ = f(t, y)` of its differential unknowns for an [`OdeMethod`] (projected after each step).
//! 3. Every sample is recorded by name as soon as it is computed. A simulation that cannot go on is no error: it has an ending with the
//!    time reached and the cause in signal and equation names, and everything before it is kept.
//!
//! 4. Where an input jumps and where a condition on a signal is met the integration stops exactly there and starts anew: with rates and
//!    multipliers after the jump, and without a memory of what was before.
//!
//! All values are SI; times are in s. The service allocates nothing between the first and the last sample, events left aside.

mod acting;
mod diagnosis;
mod differences;
mod ending;
mod explicit;
mod implicit;
mod inputs;
mod integrate;
mod pieces;
mod recorder;
mod track;
mod trajectory;
mod watch;

pub use acting::Sample;
pub use ending::{Cause, Moving, TransientEnding, TransientError};
pub use inputs::{Constant, Inputs};
pub use track::{Drifting, Driven, Pulse, Ramp, Step, Table, Track};
pub use trajectory::{Crossing, Drift, LimitMet, NearSingular, Trajectory, Worst};

use crate::{Variable, Variables};
use acting::{Acting, Observer};
use integrate::Integration;
use pieces::{Pieces, met};
use problem::{DaeMethod, Flow, Integrable, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Limit, OdeMethod, Plant};
use recorder::Recorder;
use std::cell::RefCell;
use watch::Watch;

/// Problem and recorder evaluate the same plant, by turns.
type SharedPlant<'p> = RefCell<&'p mut dyn Integrable>;

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
    /// What multiplies absolute tolerances of algebraic unknowns; `None`: the same factor as that of all others.
    ///
    /// Tightened ones make the last digits of multipliers count; of those that stabilize, rounding of coordinates over a short step leaves few.
    pub algebraic_factor: Option<f64>,
    /// What is recorded.
    pub record: Vec<Variable>,
    /// Conditions that end it where they are violated. Limits that the plant declares are told and do not end it, unless they stand here.
    pub ends: Vec<Limit>,
    /// Times at which the plant itself jumps or has a corner, s: those of its controllers.
    pub breaks: Vec<f64>,
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
    /// Declared limits that were violated at some sample, in the order of their declaration.
    pub limits: Vec<LimitMet>,
    /// Crossings of declared limits, in the order of time.
    pub crossings: Vec<Crossing>,
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
        Self {
            start: Start::stated(plant),
            times,
            options: IntegrationOptions::default(),
            algebraic_factor: None,
            record: everything(plant),
            ends: Vec::new(),
            breaks: Vec::new(),
        }
    }

    /// Runs it.
    ///
    /// # Errors
    /// The simulation could not start: no sequence of times, or a start that cannot satisfy the constraints. What happens later is an
    /// ending.
    pub fn run(&self, plant: &mut dyn Integrable, inputs: &dyn Inputs, method: Method<'_>) -> Result<Simulation, TransientError> {
        self.run_watched(plant, inputs, method, &mut |_| Flow::Continue)
    }

    /// Runs it and shows `watcher` every sample as it is taken, the point reached beyond the last one included; it may ask for the end.
    ///
    /// Whoever keeps samples that way need not have them recorded: `record` may be empty.
    ///
    /// # Errors
    /// As [`Transient::run`].
    pub fn run_watched(
        &self,
        plant: &mut dyn Integrable,
        inputs: &dyn Inputs,
        method: Method<'_>,
        watcher: &mut dyn FnMut(&Sample<'_>) -> Flow,
    ) -> Result<Simulation, TransientError> {
        let (mut y, mut yd) = self.consistent_start(plant, inputs)?;
        let variables = Variables::of(&*plant);
        let watch = Watch::new(&*plant, &self.ends, &variables)?;
        let (plant, acting) = (RefCell::new(plant), Acting::new(inputs));
        // one more: the time reached, where it lies between two samples
        let mut recorder = Recorder::new(&plant, &acting, &variables, (&self.record, self.times.len() + 1), watcher);
        let spacing = self.times.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let options = (self.options, self.algebraic_factor.unwrap_or(self.options.absolute_tolerance_factor));
        let work = Integration::new((&plant, &acting, &watch), method, (&y, &yd), options, spacing);
        let mut pieces = Pieces { samples: &self.times, breaks: self.breaks(inputs), next: 0, times: Vec::with_capacity(self.times.len()) };
        let mut crossings = Vec::new();
        let (ending, statistics) = match self.met_at_start(&plant, &acting, &watch, (&y, &yd)) {
            Some(ending) => (ending, IntegrationOutcome::nothing_done(IntegrationEnding::Finished, self.times[0])),
            None => pieces.integrate((&plant, &acting, &watch), work, (&mut y, &mut yd), &mut recorder, &mut crossings),
        };
        // what was reached beyond the last sample is kept too
        let beyond = recorder.last_time().is_none_or(|last| last < statistics.time);
        if beyond && recorder.failure().is_none() && yd.iter().all(|rate| rate.is_finite()) {
            recorder.sample(statistics.time, &y, &yd);
        }
        let (trajectory, drift, limits, near_singular) = recorder.finish();
        Ok(Simulation { trajectory, ending, statistics, drift, limits, crossings, near_singular, y, yd })
    }

    /// Takes the conditions as they are at the start, where one of them may end the simulation already.
    fn met_at_start(&self, plant: &SharedPlant<'_>, acting: &Acting<'_>, watch: &Watch, at: (&[f64], &[f64])) -> Option<TransientEnding> {
        let mut values = vec![0.0; watch.count()];
        // where this fails, so will the first sample, with its row
        watch.values(&mut Observer::new(plant, acting), self.times[0], at, &mut values).ok()?;
        watch.begin(&values).map(met)
    }

    /// Breaks of inputs and plant within the time asked for, each once, in order.
    fn breaks(&self, inputs: &dyn Inputs) -> Vec<f64> {
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        let mut breaks = inputs.breaks();
        breaks.extend(&self.breaks);
        breaks.retain(|&t| first < t && t < last);
        breaks.sort_by(f64::total_cmp);
        // no step fits between times that rounding separates
        breaks.dedup_by(|b, a| *b - *a <= 1e-12 * b.abs());
        breaks
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
}
