//! Walks from a steady state to another one in steps that halve where the method fails.

use super::diagnosis::{fold, violated, worst};
use super::roles::TrimError;
use super::system::TrimProblem;
use problem::{AlgebraicMethod, AlgebraicOptions, AlgebraicOutcome, AlgebraicProblem, Effort, Ending};

/// One steady state, or the last one before the path ended.
#[derive(Clone, Debug)]
pub struct TrimPoint {
    /// What was asked for.
    pub goals: Vec<(String, f64)>,
    /// Reached, or why not.
    pub ending: Ending,
    /// Whether the equations hold at the goals; a declared limit may be violated there all the same. Where false, the values
    /// are those of the last steady state before the path ended.
    pub solved: bool,
    /// What the method did, all steps together.
    pub effort: Effort,
    /// Largest scaled residual.
    pub residual: f64,
    /// Solution of the algebraic system (of the last steady state where the goal was not reached).
    pub x: Vec<f64>,
    /// Unknowns of the plant.
    pub y: Vec<f64>,
    /// Their rates.
    pub yd: Vec<f64>,
    /// Inputs.
    pub u: Vec<f64>,
    /// Outputs.
    pub outputs: Vec<f64>,
}

/// How to walk.
#[derive(Clone, Debug)]
pub struct Walk {
    /// Largest change of each goal in one step; goals beyond the list have no limit.
    pub largest_steps: Vec<f64>,
    /// Smallest fraction of the way that is tried.
    pub smallest_fraction: f64,
    /// Room to a declared limit, in units of its nominal value, below which it explains the end of a path.
    pub room: f64,
    /// Largest distance between a step's prediction and its solution, in units of the scale of each unknown. A solution
    /// farther away belongs to another branch, and the step is halved.
    pub largest_correction: f64,
    /// Tolerances of the method.
    pub options: AlgebraicOptions,
}

impl Default for Walk {
    fn default() -> Self {
        let options = AlgebraicOptions { residual_tolerance: 1e-10, max_iterations: 40, ..Default::default() };
        Self { largest_steps: Vec::new(), smallest_fraction: 1.0 / 256.0, room: 0.03, largest_correction: 10.0, options }
    }
}

impl Walk {
    /// Solves for one set of goals, starting at x (changed in place, also on failure).
    pub fn solve(&self, problem: &mut TrimProblem<'_>, method: &mut dyn AlgebraicMethod, goals: &[f64], x: &mut [f64]) -> AlgebraicOutcome {
        problem.set_goals(goals);
        method.solve(problem, x, &self.options)
    }

    /// Walks from a steady state (its goals and x) to other goals.
    ///
    /// Steps follow a secant predictor; a step that fails is halved. The result carries the last steady state reached.
    ///
    /// # Errors
    /// Equations that no unknown can satisfy.
    pub fn reach(
        &self,
        problem: &mut TrimProblem<'_>,
        method: &mut dyn AlgebraicMethod,
        from: (&[f64], &[f64]),
        to: &[f64],
    ) -> Result<TrimPoint, TrimError> {
        let (start, mut x) = (from.0.to_vec(), from.1.to_vec());
        let at = |s: f64| -> Vec<f64> { start.iter().zip(to).map(|(a, b)| a + s * (b - a)).collect() };
        let steps = start.iter().zip(to).zip(&self.largest_steps).map(|((a, b), h)| ((b - a) / h).abs().ceil());
        let mut step = 1.0 / steps.fold(1.0, f64::max).max(1.0);
        let (mut s, mut effort, mut residual) = (0.0, Effort::default(), f64::NAN);
        let mut before: Option<(f64, Vec<f64>)> = None;
        while s < 1.0 {
            let next = if s + step > 1.0 - 1e-12 { 1.0 } else { s + step };
            let mut trial: Vec<f64> = match &before {
                Some((sb, xb)) => x.iter().zip(xb).map(|(x, b)| x + (x - b) * ((next - s) / (s - sb))).collect(),
                None => x.clone(),
            };
            // without a second point the prediction is the last point, and the correction is the step itself
            let allowance = self.largest_correction * if before.is_some() { 1.0 } else { 3.0 };
            let predicted = trial.clone();
            let outcome = self.solve(problem, method, &at(next), &mut trial);
            effort += outcome.effort;
            if outcome.converged() && distance(&predicted, &trial, problem.unknown_scale()) <= allowance {
                before = Some((s, std::mem::replace(&mut x, trial)));
                (s, residual) = (next, outcome.residual);
                step *= 1.5;
            } else {
                step *= 0.5;
                // a predictor from far back may be the reason: once more from the last point
                before = before.filter(|_| step > 0.05);
                if step < self.smallest_fraction {
                    return Ok(self.ended(problem, &at(s), to, &x, effort));
                }
            }
        }
        // values of this very point, not of the last trial
        problem.set_goals(to);
        let mut f = vec![0.0; problem.size()];
        let evaluated = problem.residual(&x, &mut f);
        debug_assert!(evaluated.is_ok());
        problem.check_implied()?;
        let ending = violated(problem).unwrap_or(Ending::Reached);
        Ok(self.point(problem, (ending, true), effort, residual, x))
    }

    /// The end of a path that did not reach its goals.
    fn ended(&self, problem: &mut TrimProblem<'_>, reached: &[f64], to: &[f64], x: &[f64], effort: Effort) -> TrimPoint {
        problem.set_goals(reached);
        let n = problem.size();
        let (mut f, mut J) = (vec![0.0; n], problem::Matrix::zeros(n, n));
        let known = problem.jacobian(x, &mut f, &mut J);
        let reached_named = problem.goals();
        let ending = match known {
            Ok(()) => worst(problem, self.room).unwrap_or_else(|| fold(problem, &reached_named)),
            Err(_) => Ending::NotConverged { because: "the equations cannot be evaluated at the start of the path".to_owned() },
        };
        let residual = f.iter().zip(problem.equation_scale()).map(|(f, s)| (f / s).abs()).fold(0.0, f64::max);
        let mut point = self.point(problem, (ending, false), effort, residual, x.to_vec());
        for ((_, value), goal) in point.goals.iter_mut().zip(to) {
            *value = *goal;
        }
        point
    }

    fn point(&self, problem: &TrimProblem<'_>, (ending, solved): (Ending, bool), effort: Effort, residual: f64, x: Vec<f64>) -> TrimPoint {
        let (y, yd, u, outputs) = problem.point();
        TrimPoint {
            goals: problem.goals(),
            ending,
            solved,
            effort,
            residual,
            x,
            y: y.to_vec(),
            yd: yd.to_vec(),
            u: u.to_vec(),
            outputs: outputs.to_vec(),
        }
    }
}

/// Largest difference in units of the scales.
fn distance(a: &[f64], b: &[f64], scale: &[f64]) -> f64 {
    a.iter().zip(b).zip(scale).map(|((a, b), s)| ((a - b) / s).abs()).fold(0.0, f64::max)
}
