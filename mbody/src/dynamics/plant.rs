//! The assembled system in the vocabulary of `problem`: the only file of the engine that implements it.

use super::closure::{Closure, Work};
use super::evaluation::{Evaluation, Evaluations, Known, Maker, Part};
use super::explicit::ExplicitSolver;
use super::{Account, Element, Form, Formulation, System};
use crate::scalar::{Lanes, PerScalar, SystemScalar};
use problem::contract::finite;
use problem::{
    At, Dae, Differentiable, Equation, EvalError, Explicit, Input, Limit, Limits, Matrix, Outputs, Projection, ProjectionError, Seeds,
    Signal, Unknown,
};
use std::sync::Arc;

/// An assembled system with work arrays of its own. One per task; the system behind it is shared.
pub struct TreePlant {
    system: Arc<System>,
    form: Arc<Form>,
    evaluations: PerScalar<Evaluations>,
    /// Made when it is first asked for.
    explicit: Option<Box<ExplicitSolver>>,
    /// Work arrays of the projection, made when they are first needed.
    closure: Option<Work>,
}

impl TreePlant {
    /// A plant over a shared system, with constraints on coordinates as they are: the form of steady states.
    pub fn new(system: Arc<System>) -> Self {
        let form = system.form.clone();
        Self::with(system, form)
    }

    /// A plant over a shared system in a formulation of its constraints.
    pub fn in_formulation(system: Arc<System>, formulation: Formulation) -> Self {
        let form = Arc::new(Form::new(&system, formulation));
        Self::with(system, form)
    }

    /// A plant over a shared system in which some elements are silent: they add no force, and their rows and outputs stay 0.
    ///
    /// For experiments on a part of a system, as a mechanism without what acts on its end. Held by the tests of the services that make them.
    pub fn without(system: Arc<System>, silent: impl Fn(&Element) -> bool) -> Self {
        let mut form = system.form.as_ref().clone();
        form.silent = system.elements.iter().map(silent).collect();
        Self::with(system, Arc::new(form))
    }

    fn with(system: Arc<System>, form: Arc<Form>) -> Self {
        let evaluations = PerScalar::new(&Maker(&system, &form));
        Self { system, form, evaluations, explicit: None, closure: None }
    }

    /// Unknowns and equations of the formulation.
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// The assembled system.
    pub fn system(&self) -> &Arc<System> {
        &self.system
    }

    /// Another plant over the same system, for another task.
    pub fn another(&self) -> Self {
        Self::with(self.system.clone(), self.form.clone())
    }

    /// Evaluates at a point and hands out everything that was computed.
    pub fn evaluate_at(&mut self, at: At<'_>) -> &Evaluation<f64> {
        let e = f64::pick_mut(&mut self.evaluations);
        load(e, at);
        e.run(&self.system, &self.form);
        e
    }

    /// Evaluates at a point without those who only tell.
    pub(super) fn residual_at(&mut self, at: At<'_>) -> &Evaluation<f64> {
        let e = f64::pick_mut(&mut self.evaluations);
        load(e, at);
        e.run_part(&self.system, &self.form, Part::Forces);
        e
    }

    /// Writes the rates of coordinates and velocities of a tree without constraints and states.
    pub(super) fn forward_at(&mut self, at: At<'_>, rates: &mut [f64]) {
        let e = f64::pick_mut(&mut self.evaluations);
        e.current = false;
        e.time = at.time;
        e.y.copy_from_slice(at.y);
        e.u.copy_from_slice(at.u);
        e.forward(&self.system, &self.form, rates);
    }

    /// What the last evaluation left at a point.
    pub(super) fn known_at(&self, at: At<'_>) -> Known {
        let e = f64::pick(&self.evaluations);
        match e.y == at.y {
            true if e.current && e.time == at.time && e.u == at.u => Known::Elements,
            true => Known::Bodies,
            false => Known::Nothing,
        }
    }

    /// Writes the outputs at a point, given what is known there.
    pub(super) fn observe_at(&mut self, at: At<'_>, known: Known, outputs: &mut [f64]) {
        let e = f64::pick_mut(&mut self.evaluations);
        load(e, at);
        e.observe(&self.system, &self.form, known);
        outputs.copy_from_slice(&e.outputs);
    }

    /// The evaluation of plain numbers, as the last point left it.
    pub(super) fn evaluation_mut(&mut self) -> &mut Evaluation<f64> {
        f64::pick_mut(&mut self.evaluations)
    }

    /// Energy account at a point, J and W.
    pub fn account_at(&mut self, at: At<'_>) -> Account<f64> {
        let e = f64::pick_mut(&mut self.evaluations);
        load(e, at);
        e.account(&self.system)
    }

    /// Rate of the total energy (kinetic, gravity, stored) along ẏ, and the power delivered to the tree, W.
    pub fn energy_rate_at(&mut self, at: At<'_>) -> (f64, Account<f64>) {
        let e = Lanes::<2>::pick_mut(&mut self.evaluations);
        load(e, at);
        for (y, &rate) in e.y.iter_mut().zip(at.yd) {
            y.set_derivative(0, rate);
        }
        let a = e.account(&self.system);
        let rate = (a.kinetic + a.gravity + a.elements.stored).derivative(0);
        (rate, self.account_at(at))
    }
}

/// Loads a point without derivatives.
#[inline]
fn load<S: SystemScalar>(e: &mut Evaluation<S>, at: At<'_>) {
    e.current = false;
    e.time = at.time;
    for (x, &value) in e.y.iter_mut().zip(at.y) {
        *x = S::from_f64(value);
    }
    for (x, &value) in e.yd.iter_mut().zip(at.yd) {
        *x = S::from_f64(value);
    }
    for (x, &value) in e.u.iter_mut().zip(at.u) {
        *x = S::from_f64(value);
    }
}

impl Dae for TreePlant {
    fn unknowns(&self) -> &[Unknown] {
        &self.form.unknowns
    }
    fn equations(&self) -> &[Equation] {
        &self.form.equations
    }
    fn inputs(&self) -> &[Input] {
        &self.system.inputs
    }
    fn residual(&mut self, at: At<'_>, residual: &mut [f64]) -> Result<(), EvalError> {
        residual.copy_from_slice(&self.residual_at(at).residual);
        finite(residual)
    }
}

impl Outputs for TreePlant {
    fn outputs(&self) -> &[Signal] {
        &self.system.outputs
    }
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        let e = self.evaluate_at(at);
        residual.copy_from_slice(&e.residual);
        outputs.copy_from_slice(&e.outputs);
        finite(residual)
    }
    fn observe(&mut self, at: At<'_>, _residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        // where rates were just solved for, most is known; what is silent here is not silent there
        let explicit = self.explicit.as_mut().filter(|_| self.form.silent.is_empty());
        if !explicit.is_some_and(|explicit| explicit.observe_again(at, outputs)) {
            self.observe_at(at, self.known_at(at), outputs);
        }
        Ok(())
    }
}

impl Limits for TreePlant {
    fn limits(&self) -> &[Limit] {
        &self.system.limits
    }
}

/// One sweep over as many directions as S carries; returns how many.
fn sweep<S: SystemScalar>(
    plant: &mut TreePlant,
    at: At<'_>,
    seeds: &Seeds,
    first: usize,
    values: (&mut [f64], &mut [f64]),
    d: (&mut Matrix, &mut Matrix),
) -> usize {
    let count = S::DIRECTIONS.min(seeds.columns() - first);
    let e = S::pick_mut(&mut plant.evaluations);
    load(e, at);
    for k in 0..count {
        let column = first + k;
        let parts = [(&mut e.y, &seeds.y), (&mut e.yd, &seeds.yd), (&mut e.u, &seeds.u)];
        for (values, directions) in parts {
            for (x, &direction) in values.iter_mut().zip(directions.column(column)) {
                if direction != 0.0 {
                    x.set_derivative(k, direction);
                }
            }
        }
    }
    e.run(&plant.system, &plant.form);
    let pairs = [(&e.residual, values.0, d.0), (&e.outputs, values.1, d.1)];
    for (duals, value, derivative) in pairs {
        for (value, x) in value.iter_mut().zip(duals) {
            *value = x.value();
        }
        for k in 0..count {
            for (entry, x) in derivative.column_mut(first + k).iter_mut().zip(duals) {
                *entry = x.derivative(k);
            }
        }
    }
    count
}

impl Differentiable for TreePlant {
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError> {
        let mut first = 0;
        while first < seeds.columns() {
            let (v, d) = ((&mut *values.0, &mut *values.1), (&mut *residual, &mut *outputs));
            first += match seeds.columns() - first {
                0..=8 => sweep::<Lanes<2>>(self, at, seeds, first, v, d),
                9..=16 => sweep::<Lanes<4>>(self, at, seeds, first, v, d),
                _ => sweep::<Lanes<6>>(self, at, seeds, first, v, d),
            };
        }
        finite(values.0)?;
        finite(residual.as_slice()).map_err(|e| match e {
            EvalError::Recoverable { equation } => EvalError::Recoverable { equation: equation % residual.rows() },
            fatal @ EvalError::Fatal { .. } => fatal,
        })
    }
}

/// Velocities whose coordinates are held.
fn held_in_position(system: &System, held: &[bool]) -> Vec<bool> {
    let layout = &system.model.layout;
    let stated: Vec<usize> = (0..layout.nq()).filter(|&i| held.get(i).copied().unwrap_or(false)).collect();
    layout.held_velocities(&system.model, &stated)
}

impl Projection for TreePlant {
    fn project(&mut self, time: f64, y: &mut [f64], u: &[f64], held: &[bool]) -> Result<(), ProjectionError> {
        if self.system.constraints.is_empty() {
            return Ok(());
        }
        let system = self.system.clone();
        let work = self.closure.take().unwrap_or_else(|| Work::new(&system.model, &system.constraints));
        let mut closure = Closure::with(&system.model, &system.constraints, work);
        closure.at_moment(time, u, &system.constraint_inputs);
        let (q, rest) = y.split_at_mut(system.model.layout.nq());
        let v = &mut rest[..system.model.layout.nv()];
        let of_velocities = held.get(q.len()..q.len() + v.len()).unwrap_or_default();
        let projected = closure
            .close(q, &held_in_position(&system, held))
            .map_err(|rows| ProjectionError::Open { rows })
            .and_then(|()| closure.project_velocity(q, v, of_velocities).map_err(|rows| ProjectionError::Velocity { rows }));
        self.closure = Some(closure.into_work());
        projected
    }

    fn independence(&mut self, time: f64, y: &[f64], u: &[f64]) -> f64 {
        if self.system.multipliers.is_empty() {
            return 1.0;
        }
        let system = self.system.clone();
        let work = self.closure.take().unwrap_or_else(|| Work::new(&system.model, &system.constraints));
        let mut closure = Closure::with(&system.model, &system.constraints, work);
        closure.at_moment(time, u, &system.constraint_inputs);
        let (nq, nv) = (system.model.layout.nq(), system.model.layout.nv());
        closure.evaluate(&y[..nq], &y[nq..nq + nv]);
        let rows: Vec<(usize, usize)> = system.multipliers.iter().map(|m| (m.constraint, m.row)).collect();
        let independence = closure.independence(&rows);
        self.closure = Some(closure.into_work());
        independence
    }
}

impl Explicit for TreePlant {
    fn solve_rates(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let system = &self.system;
        self.explicit.get_or_insert_with(|| Box::new(ExplicitSolver::new(system))).solve(time, y, u, yd)
    }

    fn rates_along(&mut self, at: At<'_>, seeds: &Seeds, solved: &mut Matrix) -> Result<(), EvalError> {
        let system = &self.system;
        self.explicit.get_or_insert_with(|| Box::new(ExplicitSolver::new(system))).solve_along(at, seeds, solved)
    }
}
