//! One evaluation of the residual, for one scalar.
//!
//! `F = [ q̇ − N(q)(v + Jᵀμ) ;  Zᵀ(RNEA(q, v, v̇) − τ) − Jᵀλ ;  element rows ;  constraint rows ]`. Neither a mass matrix nor J is formed:
//! multipliers act as wrenches on the bodies.

use super::System;
use super::form::{Form, Formulation};
use crate::algorithm::{aba::aba, energy, kinematics, rnea::rnea};
use crate::constraint::{Level, Moment, RowValue, apply_wrench};
use crate::force::{Effort, Energy, Evaluated, Force};
use crate::model::Model;
use crate::scalar::{Family, Make, SystemScalar};
use crate::spatial::{Pose, Wrench};
use crate::stage::Workspace;
use std::cell::Cell;

/// Arguments and results of one evaluation. Allocated once per plant and scalar.
#[derive(Clone, Debug)]
pub struct Evaluation<S> {
    /// Time, s.
    pub time: f64,
    /// \[unknowns\] `(q, v, s)`.
    pub y: Vec<S>,
    /// \[unknowns\] rates.
    pub yd: Vec<S>,
    /// \[inputs\].
    pub u: Vec<S>,
    /// \[equations\] residual.
    pub residual: Vec<S>,
    /// \[outputs\].
    pub outputs: Vec<S>,
    /// Work arrays of the tree.
    pub tree: Workspace<S>,
    /// Whether the bodies were ever placed.
    placed: bool,
    /// Whether bodies and elements are those of `(time, y, u)`.
    pub(super) current: bool,
    /// Whether the elements that only tell took part.
    told: bool,
    /// \[elements\] whether it has read an acceleration or the rate of a state.
    reads_rates: Vec<bool>,
    joint_efforts: Vec<S>,
    /// [rows of all constraints] error, rate, acceleration.
    pub(super) rows: Vec<RowValue<S>>,
    /// [rows of all constraints] wrench of a unit multiplier on the second frame.
    pub(super) directions: Vec<Wrench<S>>,
    /// \[constraints\] pose of the second frame in the first.
    pub(super) poses: Vec<Pose<S>>,
    /// \[bodies\] wrenches of the stabilizing multipliers.
    pull: Vec<Wrench<S>>,
    /// [tree nv] `v + Jᵀ μ`.
    corrected: Vec<S>,
}

/// Which elements take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// All.
    All,
    /// Those that exert something or have rows.
    Forces,
}

/// What is known at the point where outputs are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// Nothing.
    Nothing,
    /// Where the bodies are and how fast they move.
    Bodies,
    /// What the elements do, as far as they do not read rates.
    Elements,
}

/// Family of [`Evaluation`]s.
pub struct Evaluations;

impl Family for Evaluations {
    type Of<S: SystemScalar> = Evaluation<S>;
}

/// Makes work arrays for a system in one form.
pub(super) struct Maker<'a>(pub &'a System, pub &'a Form);

impl Make<Evaluations> for Maker<'_> {
    fn make<S: SystemScalar>(&self) -> Evaluation<S> {
        let Self(system, form) = self;
        let zeros = |n| vec![S::zero(); n];
        let rows = system.constraints.iter().map(|c| c.rows().len()).sum();
        let stabilized = form.formulation == Formulation::Ggl && !system.constraints.is_empty();
        let nv = system.model.layout.tree_nv;
        Evaluation {
            time: 0.0,
            y: zeros(form.unknowns.len()),
            yd: zeros(form.unknowns.len()),
            u: zeros(system.inputs.len()),
            residual: zeros(form.equations.len()),
            outputs: zeros(system.outputs.len()),
            tree: Workspace::new(&system.model),
            placed: false,
            current: false,
            told: false,
            reads_rates: vec![false; system.elements.len()],
            joint_efforts: zeros(nv),
            rows: vec![RowValue::default(); rows],
            directions: vec![Wrench::zero(); rows],
            poses: vec![Pose::identity(); system.constraints.len()],
            pull: vec![Wrench::zero(); if stabilized { system.model.bodies.len() } else { 0 }],
            corrected: zeros(if stabilized { nv } else { 0 }),
        }
    }
}

/// Energy account of the whole system at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Account<S> {
    /// Kinetic energy, J.
    pub kinetic: S,
    /// Potential energy of gravity, J.
    pub gravity: S,
    /// Sum over the elements.
    pub elements: Energy<S>,
}

/// Hands out `N(q) v`, joint by joint, kept for independent coordinates.
#[inline]
fn for_each_rate<S: SystemScalar>(model: &Model, q: &[S], v: &[S], mut put: impl FnMut(usize, S)) {
    let mut row = 0;
    for body in model.bodies.iter().skip(1) {
        let mut rates = [S::zero(); 7];
        body.joint.rates(&q[body.q.clone()], &v[body.v.clone()], &mut rates[..body.q.len()]);
        for (k, rate) in body.q.clone().zip(rates) {
            if model.layout.independent_q.get(row) == Some(&k) {
                put(row, rate);
                row += 1;
            }
        }
    }
}

impl<S: SystemScalar> Evaluation<S> {
    /// Fills the kinematic stages from y and ẏ.
    fn stages(&mut self, system: &System) {
        self.motion(system);
        self.accelerations(system);
    }

    /// Fills the stages of coordinates and velocities from y.
    fn motion(&mut self, system: &System) {
        let (model, w) = (&system.model, &mut self.tree);
        let (nq, nv) = (model.layout.nq(), model.layout.nv());
        let (q, rest) = self.y.split_at(nq);
        model.layout.expand_q(q, &mut w.position.q);
        model.layout.expand_v(&rest[..nv], &mut w.velocity.v);
        kinematics::position(model, &mut w.position);
        kinematics::world(model, &w.position, &mut w.world);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        self.placed = true;
    }

    /// Fills the stage of accelerations from ẏ.
    fn accelerations(&mut self, system: &System) {
        let (model, w) = (&system.model, &mut self.tree);
        let (nq, nv) = (model.layout.nq(), model.layout.nv());
        model.layout.expand_v(&self.yd[nq..nq + nv], &mut w.acceleration.vd);
        kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
    }

    /// Writes `(q̇, v̇)` of a tree without constraints, couplings and states at `(time, y, u)`, by the articulated-body algorithm.
    ///
    /// Elements see the accelerations of some earlier point, on which their forces must not depend. Allocates nothing.
    pub(super) fn forward(&mut self, system: &System, form: &Form, rates: &mut [S]) {
        self.motion(system);
        self.elements(system, form, Part::Forces);
        let (model, w) = (&system.model, &mut self.tree);
        std::mem::swap(&mut w.tau, &mut self.joint_efforts);
        aba(model, w);
        let nq = model.layout.nq();
        for_each_rate(model, &w.position.q, &w.velocity.v, |row, rate| rates[row] = rate);
        rates[nq..].copy_from_slice(&w.acceleration.vd);
    }

    /// Evaluates the outputs at `(time, y, yd, u)`, given what is known there. The residual is left in any state. Allocates nothing.
    pub(super) fn observe(&mut self, system: &System, form: &Form, known: Known) {
        if !system.reactions.is_empty() {
            return self.run(system, form);
        }
        if known == Known::Nothing || !self.placed {
            self.motion(system);
        }
        self.accelerations(system);
        match known {
            Known::Nothing | Known::Bodies => self.elements(system, form, Part::All),
            Known::Elements => {
                for k in 0..system.elements.len() {
                    let silent = form.silent.get(k) == Some(&true);
                    let unknown = self.reads_rates[k] || !self.told && system.elements[k].force.declared().tells_only;
                    if unknown && !silent {
                        self.reads_rates[k] = self.element(system, k);
                    }
                }
                (self.current, self.told) = (true, true);
            }
        }
    }

    /// Evaluates residual and outputs at `(time, y, yd, u)`. Allocates nothing.
    pub fn run(&mut self, system: &System, form: &Form) {
        self.run_part(system, form, Part::All);
    }

    /// Evaluates the residual at `(time, y, yd, u)`, and outputs as far as [`Part`] says. Allocates nothing.
    pub(super) fn run_part(&mut self, system: &System, form: &Form, part: Part) {
        self.stages(system);
        self.elements(system, form, part);
        self.constraints(system, form);
        let (model, w) = (&system.model, &mut self.tree);
        let (nq, nv) = (model.layout.nq(), model.layout.nv());
        rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
        for (tau, effort) in w.tau.iter_mut().zip(&self.joint_efforts) {
            *tau -= *effort;
        }
        for &(body, first) in &system.reactions {
            let Wrench { n, f } = w.transmitted[body];
            self.outputs[first..first + 6].copy_from_slice(&[n.x, n.y, n.z, f.x, f.y, f.z]);
        }
        let (kinematic, rest) = self.residual.split_at_mut(nq);
        model.layout.reduce(&mut w.tau, &mut rest[..nv]);
        let v = if self.corrected.is_empty() { &w.velocity.v } else { &self.corrected };
        for_each_rate(model, &w.position.q, v, |row, rate| kinematic[row] = self.yd[row] - rate);
    }

    /// Evaluates all constraints: wrenches of the multipliers, rows, corrected velocities.
    fn constraints(&mut self, system: &System, form: &Form) {
        if system.constraints.is_empty() {
            return;
        }
        let (model, w) = (&system.model, &mut self.tree);
        self.pull.fill(Wrench::zero());
        let (mut first_row, mut k, mut correction) = (0, 0, form.first_correction);
        for (c, constraint) in system.constraints.iter().enumerate() {
            let rows = first_row..first_row + constraint.rows().len();
            first_row = rows.end;
            let mut moment = Moment::at(self.time);
            moment.inputs.iter_mut().zip(&system.constraint_inputs[c]).for_each(|(x, &i)| *x = self.u[i]);
            let X_FM = constraint.observe(model, w, &moment, &mut self.rows[rows.clone()], &mut self.directions[rows.clone()]);
            self.poses[c] = X_FM;
            let (mut F, mut G) = (Wrench::zero(), Wrench::zero());
            while let Some(m) = system.multipliers.get(k).filter(|m| m.constraint == c) {
                let direction = self.directions[rows.start + m.row];
                let at = form.first_multiplier + k;
                F += direction.scaled(self.y[at]);
                self.residual[at] = form.formulation.row(m.level, &self.rows[rows.start + m.row]);
                if form.formulation == Formulation::Ggl && m.level == Level::Position {
                    G += direction.scaled(self.y[correction]);
                    self.residual[correction] = self.rows[rows.start + m.row].error;
                    correction += 1;
                }
                k += 1;
            }
            apply_wrench(constraint, &X_FM, F, &mut w.applied);
            if form.formulation == Formulation::Ggl {
                apply_wrench(constraint, &X_FM, G, &mut self.pull);
            }
        }
        if form.formulation == Formulation::Ggl {
            self.correct(system);
        }
    }

    /// `v + Jᵀ μ` in tree velocities, from the wrenches of μ on the bodies.
    fn correct(&mut self, system: &System) {
        let (model, w) = (&system.model, &self.tree);
        for (i, body) in model.bodies.iter().enumerate().skip(1).rev() {
            let F = self.pull[i];
            body.joint.effort(&w.position.H[body.v.clone()], F, &mut self.corrected[body.v.clone()]);
            if body.parent.get() != 0 {
                self.pull[body.parent.get()] += body.turned(&w.position.X_PB[i]).wrench_to_parent(F);
            }
        }
        model.layout.spread(&mut self.corrected);
        for (x, v) in self.corrected.iter_mut().zip(&w.velocity.v) {
            *x += *v;
        }
    }

    /// Applies all elements: wrenches, joint efforts, rows, outputs.
    fn elements(&mut self, system: &System, form: &Form, part: Part) {
        self.tree.applied.fill(Default::default());
        self.joint_efforts.fill(S::zero());
        for (k, element) in system.elements.iter().enumerate() {
            let idle = part == Part::Forces && element.force.declared().tells_only;
            if !idle && form.silent.get(k) != Some(&true) {
                self.reads_rates[k] = self.element(system, k);
            }
        }
        (self.current, self.told) = (true, part == Part::All);
    }

    /// Applies one element. True where it has read an acceleration or the rate of a state.
    #[inline]
    fn element(&mut self, system: &System, k: usize) -> bool {
        self.show(system, k, |force, at, out| force.apply(at, out)).1
    }

    /// Shows one element the system, and tells whether it has read an acceleration or the rate of a state. The stages must be filled.
    #[inline(always)]
    fn show<T>(&mut self, system: &System, k: usize, body: impl FnOnce(&Force, &Evaluated<'_, S>, &mut Effort<'_, S>) -> T) -> (T, bool) {
        let (model, w, element) = (&system.model, &mut self.tree, &system.elements[k]);
        let first = model.layout.nq() + model.layout.nv();
        let states = first + element.states.start..first + element.states.end;
        let reads_rates = Cell::new(false);
        let at = Evaluated {
            model,
            time: self.time,
            position: &w.position,
            world: &w.world,
            velocity: &w.velocity,
            acceleration: &w.acceleration,
            states: &self.y[states.clone()],
            state_rates: &self.yd[states.clone()],
            inputs: &self.u,
            input_map: &element.inputs,
            multipliers: &self.y[system.base_unknowns.len()..],
            multiplier_map: &element.multipliers,
            reads_rates: &reads_rates,
        };
        let mut out = Effort {
            model,
            world: &w.world,
            applied: &mut w.applied,
            tau: &mut self.joint_efforts,
            rows: &mut self.residual[states],
            outputs: &mut self.outputs[element.outputs.clone()],
        };
        (body(&element.force, &at, &mut out), reads_rates.get())
    }

    /// Energy account at `(time, y, yd, u)`; fills the kinematic stages itself.
    pub fn account(&mut self, system: &System) -> Account<S> {
        self.stages(system);
        let mut sum = Energy::default();
        for k in 0..system.elements.len() {
            let (e, _) = self.show(system, k, |force, at, _| force.energy(at));
            sum.stored += e.stored;
            sum.supplied += e.supplied;
            sum.dissipated += e.dissipated;
        }
        let (model, w) = (&system.model, &self.tree);
        Account { kinetic: energy::kinetic(model, &w.velocity), gravity: energy::potential(model, &w.world), elements: sum }
    }

    /// Power that the elements deliver to the tree at the last evaluated point, W.
    pub fn delivered_power(&self, system: &System) -> S {
        let w = &self.tree;
        let mut power = S::zero();
        for i in 1..system.model.bodies.len() {
            power += w.velocity.V_WB[i].dot(w.applied[i]);
        }
        for (effort, v) in self.joint_efforts.iter().zip(&w.velocity.v) {
            power += *effort * *v;
        }
        power
    }
}
