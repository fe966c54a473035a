//! Conditions on signals as event functions: those that end a simulation, and declared limits, which are told.
//!
//! The function of a condition is the room that is left, in units of the nominal value: it falls through zero where the condition is
//! met. A limit that is violated is respected again when that much room is back; without it rounding would tell a crossing again and again.

use super::acting::Observer;
use super::ending::TransientError;
use super::trajectory::Crossing;
use crate::{Variable, Variables};
use problem::{EvalError, Limit, Plant};
use std::cell::Cell;

/// Room that a violated limit needs to count as respected again.
const ROOM: f64 = 1e-3;
/// Crossings of one limit that are told; after them it is left alone.
const MOST: usize = 1000;

/// A condition under watch.
struct Condition {
    limit: Limit,
    variable: Variable,
    ends: bool,
    violated: Cell<bool>,
    told: Cell<usize>,
}

/// All conditions, shared by the forms of the problem and the simulation.
pub(super) struct Watch {
    conditions: Vec<Condition>,
    /// Whether unknowns and rates are all that is watched.
    plain: bool,
}

impl Watch {
    /// Those that end a simulation, then the limits of the plant that watch a signal which is there.
    pub(super) fn new(plant: &dyn Plant, ends: &[Limit], variables: &Variables) -> Result<Self, TransientError> {
        let condition = |limit: &Limit, variable, ends| Condition {
            limit: limit.clone(),
            variable,
            ends,
            violated: Cell::new(false),
            told: Cell::new(0),
        };
        let ending = ends.iter().map(|limit| match variables.find(&limit.signal) {
            Some(variable) => Ok(condition(limit, variable, true)),
            None => Err(TransientError::UnknownSignal { signal: limit.signal.clone() }),
        });
        let mut conditions = ending.collect::<Result<Vec<_>, _>>()?;
        let told = plant.limits().iter().filter(|l| l.nominal > 0.0 && !ends.iter().any(|e| e.name == l.name && e.signal == l.signal));
        conditions.extend(told.filter_map(|limit| Some(condition(limit, variables.find(&limit.signal)?, false))));
        let plain = conditions.iter().all(|c| matches!(c.variable, Variable::Unknown(_) | Variable::Rate(_)));
        Ok(Self { conditions, plain })
    }

    /// Number of event functions.
    pub(super) fn count(&self) -> usize {
        self.conditions.len()
    }

    /// Writes the event functions at a point.
    pub(super) fn values(
        &self,
        observer: &mut Observer<'_, '_>,
        time: f64,
        point: (&[f64], &[f64]),
        values: &mut [f64],
    ) -> Result<(), EvalError> {
        if !self.plain {
            observer.glance(time, point.0, point.1)?;
        }
        let sample = observer.sample(time, point);
        for (value, condition) in values.iter_mut().zip(&self.conditions) {
            let room = condition.limit.margin(sample.value(condition.variable));
            let back = if condition.violated.get() { ROOM } else { 0.0 };
            // a signal without a value here cannot cross anything
            *value = if room.is_finite() && condition.told.get() < MOST { room - back } else { 1.0 };
        }
        Ok(())
    }

    /// Takes the conditions as they are at the start; the limit that ends the simulation there, if one does.
    pub(super) fn begin(&self, values: &[f64]) -> Option<&Limit> {
        for (condition, &value) in self.conditions.iter().zip(values) {
            condition.violated.set(value < 0.0);
        }
        self.conditions.iter().find(|c| c.ends && c.violated.get()).map(|c| &c.limit)
    }

    /// Takes note of an event: what ends the simulation, or what is told.
    pub(super) fn crossed(&self, event: usize, time: f64) -> Result<Crossing, &Limit> {
        let condition = &self.conditions[event];
        if condition.ends {
            return Err(&condition.limit);
        }
        let violated = !condition.violated.get();
        condition.violated.set(violated);
        condition.told.set(condition.told.get() + 1);
        let limit = &condition.limit;
        Ok(Crossing { name: limit.name.to_string(), signal: limit.signal.clone(), threshold: limit.threshold, violated, time })
    }
}
