//! The same problem by several methods: motions by every integrator and tolerance, sweeps of steady states by every solver.

use crate::backend::{self, IntegrationBackend, Steps};
use crate::output::comparison::{Comparison, NONE, Row};
use crate::output::{History, Progress};
use crate::{Failure, maneuver, motion, plan, steady};
use mbody::dynamics::System;
use motorcycle::maneuver::Maneuver;
use problem::{Derivatives, Effort, LinearSolver};
use rayon::ThreadPoolBuilder;
use std::sync::Arc;
use std::time::Instant;

/// The reference: a method of high order at a tolerance near rounding, then what else may do.
const REFERENCES: [(&str, f64); 3] = [("erk", 1e-11), ("ida", 1e-10), ("cvode", 1e-10)];

/// A backend in a form of the problem.
#[derive(Clone)]
pub struct Contender {
    /// The backend.
    pub backend: &'static IntegrationBackend,
    /// Formulation of the constraints, for the implicit form.
    pub formulation: Option<String>,
    /// Where matrices come from.
    pub derivatives: Derivatives,
    /// What solves linear equations.
    pub linear_solver: LinearSolver,
}

/// How closely, and how often.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Relative tolerances.
    pub tolerances: Vec<f64>,
    /// Lengths of steps, s, for methods whose steps are all alike.
    pub steps: Vec<f64>,
    /// How often each is timed.
    pub repeats: usize,
}

/// What decides about the error of one run.
#[derive(Clone, Copy, Debug)]
enum Care {
    Tolerance(f64),
    Step(f64),
}

impl Care {
    /// Relative tolerance and step; not a number where the other decides.
    fn told(self) -> (f64, f64) {
        match self {
            Self::Tolerance(tolerance) => (tolerance, f64::NAN),
            Self::Step(step) => (f64::NAN, step),
        }
    }
}

/// A motion to be computed many times.
#[derive(Debug)]
pub struct Motion<'a> {
    /// What is common to all.
    pub request: motion::Request,
    /// The system.
    pub system: &'a Arc<System>,
    /// Name of the model.
    pub model: &'a str,
    /// A maneuver and its name.
    pub maneuver: Option<(&'a str, Maneuver)>,
}

impl Motion<'_> {
    fn run(&self, contender: &Contender, care: Care) -> Result<History, Failure> {
        let mut request = motion::Request {
            backend: contender.backend.name.to_owned(),
            formulation: contender.formulation.clone(),
            derivatives: contender.derivatives,
            linear_solver: contender.linear_solver,
            ..self.request.clone()
        };
        match care {
            Care::Tolerance(tolerance) => request.relative_tolerance = tolerance,
            Care::Step(step) => request.fixed_step = step,
        }
        let ride = self.maneuver.clone().map(|(name, m)| maneuver::ride(name, m, self.system)).transpose()?;
        motion::run(&request, self.system, self.model, ride)
    }

    /// All contenders at all tolerances or steps, and how far they are from a reference.
    ///
    /// # Errors
    /// The motion cannot start.
    pub fn compare(&self, contenders: &[Contender], settings: &Settings) -> Result<Comparison, Failure> {
        let cares = |contender: &Contender| -> Vec<Care> {
            match contender.backend.steps {
                Steps::Variable => settings.tolerances.iter().copied().map(Care::Tolerance).collect(),
                Steps::Fixed => settings.steps.iter().copied().map(Care::Step).collect(),
            }
        };
        let progress = Progress::new("compare", contenders.iter().map(|c| cares(c).len()).sum::<usize>() + 1);
        let mut warnings = Vec::new();
        let mut reference: Option<(History, String)> = None;
        for (backend, tolerance) in REFERENCES {
            let Some(row) = backend::integration(backend) else { continue };
            let contender =
                Contender { backend: row, formulation: None, derivatives: Derivatives::Exact, linear_solver: LinearSolver::Direct };
            let found = self.run(&contender, Care::Tolerance(tolerance))?;
            let reached = found.outcome.because.is_none();
            let better = reference.as_ref().is_none_or(|(kept, _)| found.recording.len() > kept.recording.len());
            if reached || better {
                reference = Some((found, format!("{backend} at {tolerance:e}")));
            }
            if reached {
                break;
            }
        }
        progress.advance();
        let Some((reference, name)) = reference else { return Err(Failure::Argument("no method is known".to_owned())) };
        if let Some(because) = &reference.outcome.because {
            warnings.push(format!("the reference itself ends early: {because}"));
        }
        let mut rows = Vec::new();
        for contender in contenders {
            for care in cares(contender) {
                rows.push(self.row(contender, care, settings.repeats, &reference)?);
                progress.advance();
            }
        }
        let end = self.request.times.last().copied().unwrap_or_default();
        let what = self.maneuver.as_ref().map_or_else(|| format!("motion of {end} s"), |(_, m)| m.name.clone());
        Ok(Comparison { model: self.model.to_owned(), problem: what, reference: name, in_time: true, rows, warnings })
    }

    fn row(&self, contender: &Contender, care: Care, repeats: usize, reference: &History) -> Result<Row, Failure> {
        let mut walls = Vec::with_capacity(repeats);
        let mut last = self.run(contender, care)?;
        walls.push(last.outcome.wall);
        for _ in 1..repeats {
            last = self.run(contender, care)?;
            walls.push(last.outcome.wall);
        }
        let (least, most) = walls.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
        let s = &last.outcome.statistics;
        let implicit = !contender.backend.linear_solvers.is_empty();
        Ok(Row {
            backend: contender.backend.name.to_owned(),
            form: last.outcome.formulation.to_owned(),
            jacobian: if implicit { contender.derivatives.name() } else { NONE },
            linear_solver: if implicit { contender.linear_solver.name() } else { NONE },
            relative_tolerance: care.told().0,
            step: care.told().1,
            ending: last.outcome.ending.clone(),
            because: last.outcome.because.clone(),
            wall: least,
            spread: most / least - 1.0,
            real_time_factor: s.time / least,
            steps: s.steps,
            rejected: s.rejected,
            residuals: s.residuals,
            jacobians: s.jacobians,
            products: s.products,
            solves: s.iterations,
            error: self.difference(&last, reference)?,
            energy_drift: energy_drift(&last)?,
            constraint_drift: last.outcome.drift.position.as_ref().map_or(f64::NAN, |w| w.off.by),
        })
    }

    /// Largest difference of coordinates and velocities at common samples, in units of `nominal + |value|`.
    fn difference(&self, found: &History, reference: &History) -> Result<f64, Failure> {
        let times = found.recording.time().iter().zip(reference.recording.time());
        let common = times.take_while(|(a, b)| (*a - *b).abs() <= 1e-9 * b.abs()).count();
        if common < 2 {
            return Ok(f64::NAN);
        }
        let mut worst = 0.0_f64;
        for unknown in self.system.unknowns() {
            let column = |h: &History| h.column(&unknown.signal.name);
            if let (Some(a), Some(b)) = (column(found)?, column(reference)?) {
                let off = a.iter().zip(&b).take(common).map(|(x, y)| (x - y).abs() / (unknown.nominal + y.abs()));
                worst = off.fold(worst, f64::max);
            }
        }
        Ok(worst)
    }
}

/// Largest change of the energy, as a share of its largest size, where no power goes in or out.
fn energy_drift(history: &History) -> Result<f64, Failure> {
    let (Some(energy), Some(supplied), Some(dissipated)) =
        (history.column(motion::ENERGY)?, history.column(motion::SUPPLIED)?, history.column(motion::DISSIPATED)?)
    else {
        return Ok(f64::NAN);
    };
    let size = energy.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    let idle = supplied.iter().chain(dissipated.iter()).all(|p| p.abs() <= 1e-9 * size.max(1e-9));
    Ok(match idle && size > 0.0 {
        true => energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max) / size,
        false => f64::NAN,
    })
}

/// A sweep of steady states by every solver, on one core.
///
/// # Errors
/// The request as a whole is impossible.
pub fn sweeps(
    request: &plan::Request,
    system: &Arc<System>,
    model: &str,
    backends: &[String],
    repeats: usize,
) -> Result<Comparison, Failure> {
    // solvers are timed, not cores
    let alone = ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| Failure::Unreached(format!("no thread can be made: {e}")))?;
    let mut rows = Vec::new();
    let mut reference: Option<steady::Steady> = None;
    for name in backends {
        let mut walls = Vec::new();
        let mut found = None;
        for _ in 0..repeats {
            let began = Instant::now();
            found = Some(alone.install(|| steady::run(request, system, name, "compare"))?);
            walls.push(began.elapsed().as_secs_f64());
        }
        let Some(found) = found else { continue };
        let (least, most) = walls.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
        let missed = found.points.iter().filter(|p| p.values.is_empty()).count();
        let error = reference.as_ref().map_or(f64::NAN, |reference| {
            let pairs = found.points.iter().zip(&reference.points).filter(|(a, b)| !a.values.is_empty() && !b.values.is_empty());
            let off = pairs.flat_map(|(a, b)| {
                system.unknowns().iter().enumerate().map(|(k, u)| (a.values[k] - b.values[k]).abs() / (u.nominal + b.values[k].abs()))
            });
            off.fold(0.0, f64::max)
        });
        let mut effort = Effort::default();
        found.points.iter().for_each(|p| effort += p.effort);
        rows.push(Row {
            backend: name.clone(),
            form: "algebraic".to_owned(),
            jacobian: NONE,
            linear_solver: NONE,
            relative_tolerance: f64::NAN,
            step: f64::NAN,
            ending: if missed < found.points.len() { "reached" } else { "not_converged" }.to_owned(),
            because: (missed == found.points.len()).then(|| "no point was reached".to_owned()),
            wall: least,
            spread: most / least - 1.0,
            real_time_factor: f64::NAN,
            steps: found.points.len(),
            rejected: missed,
            residuals: effort.residuals,
            jacobians: effort.jacobians,
            products: effort.products,
            solves: effort.iterations,
            error,
            energy_drift: f64::NAN,
            constraint_drift: f64::NAN,
        });
        reference.get_or_insert(found);
    }
    let problem = format!("{} steady states", rows.first().map_or(0, |r| r.steps));
    let first = backends.first().map_or_else(|| backend::ALGEBRAIC[0].name.to_owned(), Clone::clone);
    Ok(Comparison { model: model.to_owned(), problem, reference: first, in_time: false, rows, warnings: Vec::new() })
}
