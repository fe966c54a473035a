//! A motion piece by piece, from one break or event to the next.

use super::SharedPlant;
use super::acting::Acting;
use super::diagnosis::not_finite;
use super::ending::{Cause, TransientEnding};
use super::integrate::Integration;
use super::recorder::Recorder;
use super::trajectory::Crossing;
use super::watch::Watch;
use problem::{Flow, IntegrationEnding, IntegrationOutcome, Limit, ProjectionError};

/// Sampling times and breaks, and how far they have been passed.
pub(super) struct Pieces<'a> {
    pub(super) samples: &'a [f64],
    /// Within the samples, in order.
    pub(super) breaks: Vec<f64>,
    /// The first sample not yet taken.
    pub(super) next: usize,
    /// Times of the piece at work.
    pub(super) times: Vec<f64>,
}

/// The ending where a condition is met.
pub(super) fn met(limit: &Limit) -> TransientEnding {
    TransientEnding::Met { name: limit.name.to_string(), signal: limit.signal.clone(), threshold: limit.threshold }
}

/// Work of two pieces one after the other.
fn sum(before: &IntegrationOutcome, piece: &IntegrationOutcome) -> IntegrationOutcome {
    IntegrationOutcome {
        ending: piece.ending,
        time: piece.time,
        steps: before.steps + piece.steps,
        rejected: before.rejected + piece.rejected,
        convergence_failures: before.convergence_failures + piece.convergence_failures,
        residuals: before.residuals + piece.residuals,
        jacobians: before.jacobians + piece.jacobians,
        products: before.products + piece.products,
        iterations: before.iterations + piece.iterations,
    }
}

impl Pieces<'_> {
    /// Integrates from a consistent point to the last sample, or to what ends it before.
    pub(super) fn integrate(
        &mut self,
        (plant, acting, watch): (&SharedPlant<'_>, &Acting<'_>, &Watch),
        mut work: Integration<'_, '_, '_>,
        (y, yd): (&mut [f64], &mut [f64]),
        recorder: &mut Recorder<'_, '_>,
        crossings: &mut Vec<Crossing>,
    ) -> (TransientEnding, IntegrationOutcome) {
        let (samples, last) = (self.samples, self.samples[self.samples.len() - 1]);
        let (mut from, mut begin) = (samples[0], samples[0]);
        let mut total = IntegrationOutcome::nothing_done(IntegrationEnding::Finished, from);
        loop {
            let until = self.breaks.iter().copied().find(|&b| b > from);
            let end = until.unwrap_or(last);
            acting.enter(begin, until.unwrap_or(f64::INFINITY));
            self.times.clear();
            self.times.extend(std::iter::once(from).chain(samples[self.next..].iter().copied().filter(|&t| from < t && t < end)));
            self.times.extend((from < end).then_some(end));
            let next = &mut self.next;
            let mut sink = |time: f64, y: &[f64], yd: &[f64]| {
                // a sample on a break is that after it
                if samples.get(*next) != Some(&time) || until == Some(time) {
                    return Flow::Continue;
                }
                *next += 1;
                recorder.sample(time, y, yd)
            };
            let (outcome, cause) = work.piece(&self.times, (&mut *y, &mut *yd), &mut sink);
            total = sum(&total, &outcome);
            from = outcome.time;
            match outcome.ending {
                IntegrationEnding::Finished if until.is_none() => return (TransientEnding::Reached, total),
                IntegrationEnding::Finished => (from, begin) = (end, end),
                IntegrationEnding::Event { event, .. } => match watch.crossed(event, from) {
                    Ok(crossing) => crossings.push(crossing),
                    Err(limit) => return (met(limit), total),
                },
                IntegrationEnding::Stopped => {
                    let ending = match recorder.failure() {
                        None => TransientEnding::Stopped,
                        Some(e) => TransientEnding::Failed { cause: not_finite(e, plant) },
                    };
                    return (ending, total);
                }
                _ => return (TransientEnding::Failed { cause }, total),
            }
            let next_break = self.breaks.iter().copied().find(|&b| b > from);
            acting.enter(begin, next_break.unwrap_or(f64::INFINITY));
            if let Err(cause) = restart(plant, acting, from, (&mut *y, &mut *yd)) {
                yd.fill(f64::NAN);
                return (TransientEnding::Failed { cause }, total);
            }
        }
    }
}

/// Multipliers and rates after a jump, at the coordinates and velocities before it.
fn restart(plant: &SharedPlant<'_>, acting: &Acting<'_>, time: f64, (y, yd): (&mut [f64], &mut [f64])) -> Result<(), Cause> {
    let mut u = vec![0.0; plant.borrow().inputs().len()];
    acting.at(time, &mut u);
    let projected = plant.borrow_mut().project(time, y, &u, &[]);
    projected.map_err(|error| match error {
        ProjectionError::Open { rows } | ProjectionError::Velocity { rows } => Cause::Open { rows },
        ProjectionError::Evaluation(e) => not_finite(e, plant),
    })?;
    let solved = plant.borrow_mut().solve_rates(time, y, &u, yd);
    solved.map_err(|e| not_finite(e, plant))
}
