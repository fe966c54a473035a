//! One piece of a motion by a method of either form.

use super::acting::Acting;
use super::diagnosis::{fastest, not_finite, off_at, undetermined};
use super::ending::Cause;
use super::explicit::{ExplicitForm, Whole};
use super::implicit::Implicit;
use super::watch::Watch;
use super::{Method, SharedPlant};
use problem::{DaeMethod, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, OdeMethod, Sink};

/// Longest first step of an implicit method, s.
const FIRST_STEP: f64 = 1e-6;

/// A plant in the form that a method takes.
enum Form<'a, 'p, 'm> {
    Implicit(&'m mut dyn DaeMethod, Box<Implicit<'a, 'p>>),
    Explicit(&'m mut dyn OdeMethod, Box<(ExplicitForm<'a, 'p>, Whole<'a, 'p>)>, Vec<f64>),
}

/// A method and all that it works on.
pub(super) struct Integration<'a, 'p, 'm> {
    plant: &'a SharedPlant<'p>,
    form: Form<'a, 'p, 'm>,
    options: IntegrationOptions,
}

impl<'a, 'p, 'm> Integration<'a, 'p, 'm> {
    /// Absolute tolerances of algebraic unknowns have a factor of their own; `spacing` is the shortest distance of two samples.
    pub(super) fn new(
        (plant, acting, watch): (&'a SharedPlant<'p>, &'a Acting<'a>, &'a Watch),
        method: Method<'m>,
        (y, yd): (&[f64], &[f64]),
        (options, algebraic_factor): (IntegrationOptions, f64),
        spacing: f64,
    ) -> Self {
        match method {
            Method::Dae(method) => {
                // A method's own choice, half a tolerance over the largest rate, is some 1e-10 s for a mechanism that starts from rest. Over
                // such a step the rounding of a closed loop (1e-17 m) is a correction of 1e-7 m/s, which no iteration resolves, and shorter
                // steps are worse.
                let first_step = options.first_step.or(Some(spacing.min(FIRST_STEP)));
                let form = Form::Implicit(method, Box::new(Implicit::new(plant, acting, watch, &options, algebraic_factor)));
                Self { plant, form, options: IntegrationOptions { first_step, ..options } }
            }
            Method::Ode(method) => {
                let problem = ExplicitForm::new(plant, acting, watch, (y, yd), options.derivatives);
                let states = vec![0.0; problem.states().len()];
                let form = Form::Explicit(method, Box::new((problem, Whole::new(plant, acting, y, yd))), states);
                Self { plant, form, options }
            }
        }
    }

    /// Integrates from a consistent point through `times`; the cause matters only where it failed.
    pub(super) fn piece(&mut self, times: &[f64], (y, yd): (&mut [f64], &mut [f64]), sink: Sink<'_>) -> (IntegrationOutcome, Cause) {
        let (plant, options) = (self.plant, &self.options);
        match &mut self.form {
            Form::Implicit(method, problem) => implicitly((plant, options), (*method, problem), times, (y, yd), sink),
            Form::Explicit(method, forms, states) => {
                let (problem, whole) = &mut **forms;
                explicitly((plant, options), (*method, problem, whole), states, times, (y, yd), sink)
            }
        }
    }
}

fn implicitly(
    (plant, options): (&SharedPlant<'_>, &IntegrationOptions),
    (method, problem): (&mut dyn DaeMethod, &mut Implicit<'_, '_>),
    times: &[f64],
    (y, yd): (&mut [f64], &mut [f64]),
    sink: Sink<'_>,
) -> (IntegrationOutcome, Cause) {
    let before = problem.evaluations();
    let mut outcome = method.integrate(problem, times, (&mut *y, &mut *yd), options, sink);
    outcome.residuals += problem.evaluations() - before;
    let cause = match (outcome.ending, problem.failure()) {
        (IntegrationEnding::Evaluation(e), _) | (IntegrationEnding::Convergence | IntegrationEnding::ErrorTest, Some(e)) => {
            not_finite(e, plant)
        }
        (IntegrationEnding::Convergence, None) => Cause::Convergence { rows: problem.worst() },
        (IntegrationEnding::Singular, _) => {
            // the inverse of a typical step
            let elapsed = outcome.time - times[0];
            let c = if elapsed > 0.0 { outcome.steps.max(1) as f64 / elapsed } else { 1e3 };
            Cause::Singular { together: undetermined(plant, problem, (outcome.time, c), (y, yd)) }
        }
        (IntegrationEnding::Refused, _) => Cause::Refused { rows: off_at(problem, outcome.time, (y, yd)) },
        (ending, _) => too_fast(ending, plant, options, (y, yd)),
    };
    (outcome, cause)
}

fn explicitly(
    (plant, options): (&SharedPlant<'_>, &IntegrationOptions),
    (method, problem, whole): (&mut dyn OdeMethod, &mut ExplicitForm<'_, '_>, &mut Whole<'_, '_>),
    states: &mut [f64],
    times: &[f64],
    (y, yd): (&mut [f64], &mut [f64]),
    sink: Sink<'_>,
) -> (IntegrationOutcome, Cause) {
    for (state, &i) in states.iter_mut().zip(problem.states()) {
        *state = y[i];
    }
    // inputs may have jumped
    problem.forget();
    whole.forget();
    let mut lost = None;
    let mut completed = |time: f64, states: &[f64], _: &[f64]| match whole.complete(time, states) {
        Ok((y, yd)) => sink(time, y, yd),
        Err(e) => {
            lost = Some(e);
            Flow::Stop
        }
    };
    let before = problem.evaluations();
    let mut outcome = method.integrate(problem, times, states, options, &mut completed);
    outcome.residuals += problem.evaluations() - before;
    if let Some(e) = lost {
        outcome.ending = IntegrationEnding::Evaluation(e);
    }
    match whole.complete(outcome.time, states) {
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
        (ending, _) => too_fast(ending, plant, options, (y, yd)),
    };
    (outcome, cause)
}

/// Too many steps, or too small ones.
fn too_fast(ending: IntegrationEnding, plant: &SharedPlant<'_>, options: &IntegrationOptions, at: (&[f64], &[f64])) -> Cause {
    let moving = fastest(plant, options, at);
    match ending {
        IntegrationEnding::TooManySteps => Cause::TooManySteps { allowed: options.max_steps, moving },
        _ => Cause::ErrorTest { moving },
    }
}
