//! GMRES without any matrix: the heat equation on a line, whose modes decay by themselves.

mod motion;

use motion::*;
use problem::{EvalError, IntegrationEnding, IntegrationOptions, LinearSolver, Matrix, OdeMethod, OdeProblem};
use std::f64::consts::PI;
use std::panic::{AssertUnwindSafe, catch_unwind};
use sundials::{Cvode, RungeKutta};

/// Points of the line, more than a subspace has dimensions.
const POINTS: usize = 150;

/// ẏᵢ = (yᵢ₋₁ − 2 yᵢ + yᵢ₊₁) / h², zero at both ends.
struct Line {
    tolerance: Vec<f64>,
    fails: bool,
}

impl Line {
    fn new() -> Self {
        Self { tolerance: vec![1.0; POINTS], fails: false }
    }

    fn second_difference(y: &[f64], of: &mut [f64]) {
        let at = |i: usize, by: i32| usize::try_from(i as i32 + by).ok().and_then(|i| y.get(i)).copied().unwrap_or(0.0);
        let inverse = ((POINTS + 1) as f64).powi(2);
        of.iter_mut().enumerate().for_each(|(i, of)| *of = inverse * (at(i, -1) - 2.0 * at(i, 0) + at(i, 1)));
    }

    /// One mode of the line and its decay.
    fn mode(nth: f64, time: f64) -> Vec<f64> {
        let spacing = 1.0 / (POINTS + 1) as f64;
        let decay = (2.0 / spacing * (0.5 * nth * PI * spacing).sin()).powi(2);
        (1..=POINTS).map(|i| (nth * PI * i as f64 * spacing).sin() * (-decay * time).exp()).collect()
    }

    /// The first mode and one that decays a thousand times as fast.
    fn exact(time: f64) -> Vec<f64> {
        Self::mode(1.0, time).iter().zip(Self::mode(40.0, time)).map(|(slow, fast)| slow + 0.1 * fast).collect()
    }
}

impl OdeProblem for Line {
    fn size(&self) -> usize {
        POINTS
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &self.tolerance
    }
    fn rates(&mut self, _time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        Self::second_difference(y, yd);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, _y: &[f64], _jacobian: &mut Matrix) -> Result<(), EvalError> {
        panic!("no matrix is asked for");
    }
    fn product(&mut self, _time: f64, _y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        if self.fails {
            return Err(EvalError::Fatal { equation: 4 });
        }
        Self::second_difference(v, product);
        Ok(())
    }
}

fn methods() -> [Box<dyn OdeMethod>; 2] {
    [Box::new(Cvode::bdf()), Box::new(RungeKutta::implicit())]
}

fn options(relative: f64) -> IntegrationOptions {
    IntegrationOptions { linear_solver: LinearSolver::Gmres, ..tolerance(relative) }
}

#[test]
fn modes_decay_without_a_matrix() {
    let times = grid(0.0, 0.1, 4);
    for mut method in methods() {
        let record = record_ode(method.as_mut(), &mut Line::new(), &times, &Line::exact(0.0), &options(1e-8)).finished(&times);
        assert!(record.deviation(Line::exact) < 1e-6, "{} {:e}", method.name(), record.deviation(Line::exact));
        assert!(record.outcome.products > 0 && record.outcome.jacobians == 0, "{:?}", record.outcome);
        // the fastest mode would hold an explicit method to steps of 2.2e-5 s
        assert!(record.outcome.steps < 1000, "{:?}", record.outcome);
    }
}

#[test]
fn products_that_cannot_be_evaluated_are_named() {
    for mut method in methods() {
        let mut line = Line { fails: true, ..Line::new() };
        let record = record_ode(method.as_mut(), &mut line, &[0.0, 0.1], &Line::exact(0.0), &options(1e-8));
        assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Fatal { equation: 4 }), "{}", method.name());
    }
}

#[test]
fn a_method_changes_its_linear_solver() {
    let times = [0.0, 0.1];
    for mut method in methods() {
        let mut asked = |linear_solver| {
            let options = IntegrationOptions { linear_solver, ..tolerance(1e-8) };
            let run = || record_ode(method.as_mut(), &mut Line::new(), &times, &Line::exact(0.0), &options).finished(&times).y;
            catch_unwind(AssertUnwindSafe(run))
        };
        let before = asked(LinearSolver::Gmres).unwrap();
        let panic = asked(LinearSolver::Direct).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"no matrix is asked for"));
        assert_eq!(asked(LinearSolver::Gmres).unwrap(), before);
    }
}
