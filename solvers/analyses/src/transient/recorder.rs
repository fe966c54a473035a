//! Takes samples: recorded signals, drift of the constraints, limits that were met.

use super::SharedPlant;
use super::acting::{Acting, Observer, Sample};
use super::diagnosis::off;
use super::trajectory::{Drift, LimitMet, NearSingular, Trajectory, Worst};
use crate::{Variable, Variables};
use problem::{EquationKind, EvalError, Flow};

/// Share of their independence at the start below which constraints are near a singular position.
const NEAR: f64 = 0.1;

/// Largest violation of one family of rows so far.
struct Family {
    rows: Vec<usize>,
    /// Row, residual in SI units, time.
    worst: Option<(usize, f64, f64)>,
}

/// A declared limit under watch.
struct Watched {
    limit: usize,
    variable: Variable,
    /// Value and time of the first violation.
    met: Option<(f64, f64)>,
}

/// The receiver of all samples.
pub(super) struct Recorder<'a, 'p> {
    plant: &'a SharedPlant<'p>,
    observer: Observer<'a, 'p>,
    record: Vec<Variable>,
    trajectory: Trajectory,
    /// Constraints on coordinates, constraints on velocities.
    families: [Family; 2],
    nominal: Vec<f64>,
    limits: Vec<Watched>,
    /// Independence of the constraints at the first sample, and the least so far with its time.
    independence: Option<(f64, f64, f64)>,
    failure: Option<EvalError>,
    watcher: &'a mut dyn FnMut(&Sample<'_>) -> Flow,
}

impl<'a, 'p> Recorder<'a, 'p> {
    pub(super) fn new(
        plant: &'a SharedPlant<'p>,
        acting: &'a Acting<'a>,
        variables: &Variables,
        (record, samples): (&[Variable], usize),
        watcher: &'a mut dyn FnMut(&Sample<'_>) -> Flow,
    ) -> Self {
        let p = plant.borrow();
        let rows = |kind: EquationKind| p.equations().iter().enumerate().filter(move |(_, e)| e.kind == kind).map(|(i, _)| i).collect();
        let family = |kind| Family { rows: rows(kind), worst: None };
        let watched = p.limits().iter().enumerate();
        let watched = watched.filter_map(|(limit, l)| variables.find(&l.signal).map(|variable| Watched { limit, variable, met: None }));
        Self {
            plant,
            observer: Observer::new(plant, acting),
            record: record.to_vec(),
            trajectory: Trajectory::with_room(variables, record, samples),
            families: [family(EquationKind::Constraint), family(EquationKind::VelocityConstraint)],
            nominal: p.equations().iter().map(|e| e.nominal).collect(),
            limits: watched.collect(),
            independence: None,
            failure: None,
            watcher,
        }
    }

    /// Takes one sample and shows it to the watcher. One that cannot be evaluated is not part of the record, and nothing further is asked for.
    pub(super) fn sample(&mut self, time: f64, y: &[f64], yd: &[f64]) -> Flow {
        if let Err(e) = self.observer.look(time, y, yd) {
            self.failure = Some(e);
            return Flow::Stop;
        }
        let observer = &self.observer;
        let sample = observer.sample(time, (y, yd));
        let value = |v: Variable| sample.value(v);
        self.trajectory.time.push(time);
        for (column, &v) in self.trajectory.columns.iter_mut().zip(&self.record) {
            column.push(value(v));
        }
        if self.families.iter().any(|family| !family.rows.is_empty()) {
            let now = self.plant.borrow_mut().independence(time, y, &observer.u);
            let (first, least, when) = self.independence.unwrap_or((now, now, time));
            self.independence = Some(if now < least { (first, now, time) } else { (first, least, when) });
        }
        let plant = self.plant.borrow();
        for watched in self.limits.iter_mut().filter(|w| w.met.is_none()) {
            let value = value(watched.variable);
            if plant.limits()[watched.limit].margin(value) < 0.0 {
                watched.met = Some((value, time));
            }
        }
        for family in &mut self.families {
            for &row in &family.rows {
                let share = |row: usize, residual: f64| (residual / self.nominal[row]).abs();
                if family.worst.is_none_or(|(r, worst, _)| share(row, observer.residual[row]) > share(r, worst)) {
                    family.worst = Some((row, observer.residual[row], time));
                }
            }
        }
        drop(plant);
        (self.watcher)(&sample)
    }

    /// Time of the last sample, s.
    pub(super) fn last_time(&self) -> Option<f64> {
        self.trajectory.time.last().copied()
    }

    /// The row that made a sample fail.
    pub(super) fn failure(&self) -> Option<EvalError> {
        self.failure
    }

    /// Everything recorded, in names.
    pub(super) fn finish(self) -> (Trajectory, Drift, Vec<LimitMet>, Option<NearSingular>) {
        let plant = self.plant.borrow();
        let worst = |family: &Family| family.worst.map(|(row, by, time)| Worst { off: off(&plant.equations()[row], by), time });
        let [position, velocity] = &self.families;
        let drift = Drift { position: worst(position), velocity: worst(velocity) };
        let met = self.limits.iter().filter_map(|watched| {
            let (limit, (value, time)) = (&plant.limits()[watched.limit], watched.met?);
            Some(LimitMet { name: limit.name.to_string(), signal: limit.signal.clone(), value, threshold: limit.threshold, time })
        });
        let near = self.independence.filter(|(first, least, _)| *least < NEAR * first);
        let near = near.map(|(first, least, time)| NearSingular { independence: least / first, time });
        (self.trajectory, drift, met.collect(), near)
    }
}
