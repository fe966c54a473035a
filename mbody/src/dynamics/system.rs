//! The assembled system: tree, elements and the signals of all of them. Immutable; shared by all plants.
//!
//! `y = (q, v, s, λ)`; rows: `q̇ − N(q) v` (kinematic), `RNEA(q, v, v̇) − τ − Jᵀλ` (dynamic), one row per element state and multiplier.

use super::form::{Form, Formulation};
use crate::constraint::{Constraint, Level};
use crate::force::{Force, RangeDeclared};
use crate::model::Model;
use problem::{Equation, EquationKind, Input, Limit, Signal, Unknown, UnknownKind};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// An element in the system.
#[derive(Debug)]
pub struct Element {
    /// The law and its name.
    pub force: Force,
    /// Its states among the element states.
    pub states: Range<usize>,
    /// Its inputs among all inputs.
    pub inputs: Vec<usize>,
    /// Its outputs among all outputs.
    pub outputs: Range<usize>,
    /// The multipliers that it reads, among all multipliers.
    pub multipliers: Vec<usize>,
}

/// Why elements and a tree could not be joined.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SystemError {
    /// Two signals have one name.
    #[error("the signal `{signal}` is declared twice, the second time by `{owner}`")]
    DuplicateSignal {
        /// The signal.
        signal: String,
        /// Who declared it the second time.
        owner: String,
    },
    /// One input is declared with two units.
    #[error("the input `{signal}` is read as {first} and, by `{owner}`, as {second}")]
    InputUnits {
        /// The signal.
        signal: String,
        /// Unit first declared.
        first: String,
        /// Unit declared by `owner`.
        second: String,
        /// Who.
        owner: String,
    },
    /// An element reads the force of a constraint that holds nothing.
    #[error("`{owner}` reads `{signal}`, but no constraint that is held has this multiplier")]
    UnknownMultiplier {
        /// The signal.
        signal: String,
        /// Who reads it.
        owner: String,
    },
    /// A limit watches a signal that does not exist.
    #[error("the limit `{limit}` of `{owner}` watches `{signal}`, which does not exist")]
    UnknownLimitSignal {
        /// The limit.
        limit: String,
        /// The signal.
        signal: String,
        /// Who declared it.
        owner: String,
    },
}

/// A row of a constraint that is held, with its multiplier.
#[derive(Clone, Debug)]
pub(crate) struct Multiplier {
    /// Index of the constraint.
    pub constraint: usize,
    /// Its row.
    pub row: usize,
    /// Coordinates or velocities.
    pub level: Level,
    /// The multiplier as an unknown.
    pub unknown: Unknown,
    /// What is kept at zero: `closure: gap along x`.
    pub error: String,
    /// Unit of that.
    pub error_unit: &'static str,
    /// Typical magnitude of that.
    pub nominal: f64,
}

/// Constraints with the rows that are held, and the coordinates in which they are closed.
#[derive(Debug, Default)]
pub struct Closed {
    /// The constraints.
    pub constraints: Vec<Constraint>,
    /// Held rows: constraint and row; the others depend on them.
    pub held: Vec<(usize, usize)>,
    /// \[nq\] independent coordinates, where they differ from the references of the joints.
    pub q: Option<Vec<f64>>,
}

/// Tree, elements and signals.
#[derive(Debug)]
pub struct System {
    pub(crate) model: Model,
    pub(crate) elements: Vec<Element>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) multipliers: Vec<Multiplier>,
    /// [constraints] indices of the inputs of each.
    pub(crate) constraint_inputs: Vec<Vec<usize>>,
    /// Joints whose reactions are outputs: body and first output.
    pub(crate) reactions: Vec<(usize, usize)>,
    pub(crate) base_unknowns: Vec<Unknown>,
    pub(crate) base_equations: Vec<Equation>,
    pub(crate) form: Arc<Form>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) outputs: Vec<Signal>,
    pub(crate) limits: Vec<Limit>,
    pub(crate) state_count: usize,
}

/// Unit of the generalized force that belongs to a velocity.
fn effort_unit(velocity_unit: &str) -> (&'static str, &'static str) {
    if velocity_unit.starts_with("rad") { ("N m", "moment") } else { ("N", "force") }
}

impl System {
    /// Joins a tree and its elements.
    pub fn new(model: Model, forces: Vec<Force>) -> Result<Self, SystemError> {
        Self::constrained(model, Closed::default(), forces)
    }

    /// Joins a tree, constraints and elements.
    pub fn constrained(model: Model, closed: Closed, forces: Vec<Force>) -> Result<Self, SystemError> {
        let empty = Form {
            formulation: Formulation::Position,
            unknowns: Vec::new(),
            equations: Vec::new(),
            first_multiplier: 0,
            first_correction: 0,
            silent: Vec::new(),
        };
        let mut system = Self {
            elements: Vec::with_capacity(forces.len()),
            constraints: closed.constraints,
            multipliers: Vec::new(),
            constraint_inputs: Vec::new(),
            reactions: Vec::new(),
            base_unknowns: Vec::new(),
            base_equations: Vec::new(),
            form: Arc::new(empty),
            inputs: Vec::new(),
            outputs: Vec::new(),
            limits: Vec::new(),
            state_count: 0,
            model,
        };
        system.tree_signals(&forces);
        if let Some(q) = closed.q {
            system.base_unknowns.iter_mut().zip(q).for_each(|(unknown, q)| unknown.design = q);
        }
        let mut limits = Vec::new();
        for force in forces {
            limits.extend(force.declared().limits.iter().map(|l| (l.clone(), force.name().to_owned())));
            system.element(force)?;
        }
        system.multipliers(&closed.held);
        system.read_multipliers()?;
        system.constraint_inputs();
        system.form = Arc::new(Form::new(&system, Formulation::Position));
        system.check_names()?;
        for (l, owner) in limits {
            if system.find(&l.signal).is_none() {
                return Err(SystemError::UnknownLimitSignal { limit: l.name.into(), signal: l.signal, owner });
            }
            let (name, about) = (l.name.into(), l.about.into());
            system.limits.push(Limit { name, signal: l.signal, threshold: l.threshold, side: l.side, nominal: l.nominal, about });
        }
        Ok(system)
    }

    /// Unknowns and rows of the independent coordinates and velocities.
    fn tree_signals(&mut self, forces: &[Force]) {
        let rolls = |i: usize| self.constraints.iter().any(|c| c.spinning(&self.model).is_some_and(|b| b.get() == i));
        let spinning = |i: usize| forces.iter().any(|f| f.declared().spinning.iter().any(|b| b.get() == i)) || rolls(i);
        let weight = self.weight();
        let layout = &self.model.layout;
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        let (mut kinematic, mut dynamic) = (Vec::new(), Vec::new());
        for (i, body) in self.model.bodies.iter().enumerate().skip(1) {
            let owner = &body.joint_name;
            let spins = spinning(i);
            for (k, c) in body.q.clone().zip(body.joint.coordinates()) {
                if layout.independent_q.contains(&k) {
                    let unknown = Unknown {
                        signal: Signal::new(format!("{owner}.{}", c.name), c.unit, c.about),
                        kind: UnknownKind::Position,
                        cyclic: c.cyclic || spins,
                        differential: true,
                        nominal: c.nominal,
                        absolute_tolerance: 1e-7,
                        design: body.joint.reference()[k - body.q.start],
                        start: None,
                    };
                    kinematic.push(Equation {
                        name: format!("rate of {}", unknown.signal.name),
                        unit: format!("{}/s", c.unit).into(),
                        nominal: 1.0,
                        kind: EquationKind::Kinematic,
                    });
                    positions.push(unknown);
                }
            }
            for (k, c) in body.v.clone().zip(body.joint.velocities()) {
                if layout.independent_v.contains(&k) {
                    let name = if spins { "spin_rate" } else { c.name };
                    let (unit, word) = effort_unit(c.unit);
                    dynamic.push(Equation {
                        name: format!("{word} along {owner}.{name}"),
                        unit: unit.into(),
                        nominal: if spins { 0.05 * weight } else { weight },
                        kind: EquationKind::Dynamic,
                    });
                    velocities.push(Unknown {
                        signal: Signal::new(format!("{owner}.{name}"), c.unit, c.about),
                        kind: UnknownKind::Velocity,
                        cyclic: c.cyclic || spins,
                        differential: true,
                        nominal: if spins { 10.0 } else { c.nominal },
                        absolute_tolerance: 1e-6,
                        design: 0.0,
                        start: None,
                    });
                }
            }
        }
        self.base_unknowns = positions.into_iter().chain(velocities).collect();
        self.base_equations = kinematic.into_iter().chain(dynamic).collect();
    }

    /// States, inputs and outputs of one element.
    fn element(&mut self, force: Force) -> Result<(), SystemError> {
        let declared = force.declared();
        let first_state = self.state_count;
        for s in &declared.states {
            let owner = force.name();
            self.base_unknowns.push(Unknown {
                signal: Signal::new(format!("{owner}.{}", s.name), s.unit, s.about),
                kind: UnknownKind::State,
                cyclic: false,
                differential: s.differential,
                nominal: s.nominal,
                absolute_tolerance: s.absolute_tolerance,
                design: 0.0,
                start: None,
            });
            let (what, unit, nominal) = s.row;
            self.base_equations.push(Equation {
                name: format!("{what} of {owner}"),
                unit: unit.into(),
                nominal,
                kind: EquationKind::Element,
            });
        }
        self.state_count += declared.states.len();
        let mut inputs = Vec::new();
        for d in &declared.inputs {
            inputs.push(match self.inputs.iter().position(|i| i.signal.name == d.name) {
                Some(i) if self.inputs[i].signal.unit != d.unit => {
                    return Err(SystemError::InputUnits {
                        signal: d.name.clone(),
                        first: self.inputs[i].signal.unit.to_string(),
                        second: d.unit.into(),
                        owner: force.name().into(),
                    });
                }
                Some(i) => i,
                None => {
                    let signal = Signal::new(d.name.clone(), d.unit, d.about);
                    self.inputs.push(Input { signal, rate: None, nominal: d.nominal, default: d.default });
                    self.inputs.len() - 1
                }
            });
        }
        for d in &declared.inputs {
            let find = |name: &str| self.inputs.iter().position(|i| i.signal.name == name);
            if let (Some(of), Some(rate)) = (find(&d.name), d.rate.as_deref().and_then(find)) {
                self.inputs[of].rate = Some(rate);
            }
        }
        let first_output = self.outputs.len();
        self.outputs.extend(declared.outputs.iter().map(|o| Signal::new(o.name.clone(), o.unit, o.about)));
        let (states, outputs) = (first_state..self.state_count, first_output..self.outputs.len());
        self.elements.push(Element { force, states, inputs, outputs, multipliers: Vec::new() });
        Ok(())
    }

    /// Weight of the moving bodies, N; at least 1.
    fn weight(&self) -> f64 {
        (self.model.total_mass() * self.model.gravity.norm()).max(1.0)
    }

    /// Adds the reactions of all joints to the outputs: `<joint>.force_x` … `<joint>.moment_z`, what the parent exerts on the child through
    /// the joint, efforts along its free directions included, about the origin and in the axes of the child's frame.
    ///
    /// Joints that leave all six directions free exert nothing and are left out. A name that is taken already gets `reaction_` before the
    /// quantity. Called again it changes nothing.
    pub fn report_reactions(&mut self) {
        const QUANTITIES: [(&str, &str, &str); 6] = [
            ("moment_x", "N m", "moment of the parent on the child through the joint, about x of the child"),
            ("moment_y", "N m", "moment of the parent on the child through the joint, about y of the child"),
            ("moment_z", "N m", "moment of the parent on the child through the joint, about z of the child"),
            ("force_x", "N", "force of the parent on the child through the joint, along x of the child"),
            ("force_y", "N", "force of the parent on the child through the joint, along y of the child"),
            ("force_z", "N", "force of the parent on the child through the joint, along z of the child"),
        ];
        if !self.reactions.is_empty() {
            return;
        }
        for body in 1..self.model.bodies.len() {
            if self.model.bodies[body].v.len() == 6 {
                continue;
            }
            self.reactions.push((body, self.outputs.len()));
            for (quantity, unit, about) in QUANTITIES {
                let joint = &self.model.bodies[body].joint_name;
                let plain = format!("{joint}.{quantity}");
                let name = if self.find(&plain).is_some() { format!("{joint}.reaction_{quantity}") } else { plain };
                self.outputs.push(Signal::new(name, unit, about));
            }
        }
    }

    /// Lets start values be written into the unknowns.
    pub(crate) fn start(&mut self, write: impl FnOnce(&mut [Unknown])) {
        write(&mut self.base_unknowns);
        self.form = Arc::new(Form::new(self, Formulation::Position));
    }

    /// Multipliers of the rows that are held.
    fn multipliers(&mut self, held: &[(usize, usize)]) {
        let weight = self.weight();
        let of = |&(constraint, row): &(usize, usize)| {
            let c = &self.constraints[constraint];
            let r = &c.rows()[row];
            let unknown = Unknown {
                signal: Signal::new(format!("{}.{}", c.name(), r.multiplier), r.unit, r.about),
                kind: UnknownKind::Algebraic,
                cyclic: false,
                differential: false,
                nominal: weight,
                absolute_tolerance: 1e-6 * weight,
                design: 0.0,
                start: None,
            };
            let (error, error_unit, nominal) = (format!("{} of {}", r.error, c.name()), r.error_unit, r.nominal);
            Multiplier { constraint, row, level: r.level, unknown, error, error_unit, nominal }
        };
        self.multipliers = held.iter().map(of).collect();
    }

    /// Which multipliers the elements read.
    fn read_multipliers(&mut self) -> Result<(), SystemError> {
        for element in &mut self.elements {
            let find = |signal: &String| {
                let found = self.multipliers.iter().position(|m| m.unknown.signal.name == *signal);
                found.ok_or_else(|| SystemError::UnknownMultiplier { signal: signal.clone(), owner: element.force.name().into() })
            };
            element.multipliers = element.force.declared().multipliers.iter().map(find).collect::<Result<_, _>>()?;
        }
        Ok(())
    }

    /// Inputs of the constraints; each is the rate of the one before.
    fn constraint_inputs(&mut self) {
        for c in &self.constraints {
            let signals = c.inputs(&self.model);
            let (first, count) = (self.inputs.len(), signals.len());
            for (k, signal) in signals.into_iter().enumerate() {
                let rate = (k + 1 < count).then_some(first + k + 1);
                self.inputs.push(Input { signal, rate, nominal: 1.0, default: 0.0 });
            }
            self.constraint_inputs.push((first..first + count).collect());
        }
    }

    fn check_names(&self) -> Result<(), SystemError> {
        let mut seen: HashMap<&str, ()> = HashMap::new();
        let unknowns = self.form.unknowns.iter().map(|u| &u.signal);
        for signal in unknowns.chain(self.inputs.iter().map(|i| &i.signal)).chain(&self.outputs) {
            if seen.insert(&signal.name, ()).is_some() {
                let owner = signal.name.split('.').next().unwrap_or_default().to_owned();
                return Err(SystemError::DuplicateSignal { signal: signal.name.clone(), owner });
            }
        }
        Ok(())
    }

    fn find(&self, name: &str) -> Option<&Signal> {
        let unknowns = self.form.unknowns.iter().map(|u| &u.signal);
        unknowns.chain(self.inputs.iter().map(|i| &i.signal)).chain(&self.outputs).find(|s| s.name == name)
    }

    /// The tree.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The elements, in the order of the description.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Ranges of signals in which the elements can be trusted.
    pub fn ranges(&self) -> impl Iterator<Item = &RangeDeclared> {
        self.elements.iter().flat_map(|e| &e.force.declared().ranges)
    }

    /// Number of element states.
    pub fn state_count(&self) -> usize {
        self.state_count
    }

    /// Names of the outputs.
    pub fn outputs(&self) -> &[Signal] {
        &self.outputs
    }

    /// The inputs.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Height of every body's origin in the design pose, by the name of its joint, m.
    pub fn design_heights(&self) -> Vec<(&str, f64)> {
        self.heights(self.base_unknowns.iter().map(|u| u.design))
    }

    /// Height of every body's origin where the unknowns begin with these coordinates, by the name of its joint, m.
    pub fn heights(&self, coordinates: impl Iterator<Item = f64>) -> Vec<(&str, f64)> {
        let mut w = crate::stage::Workspace::<f64>::new(&self.model);
        w.to_coordinates(&self.model, coordinates.take(self.model.layout.nq()));
        let height = |i: usize| w.world.X_WB[i].p.z;
        self.model.bodies.iter().enumerate().skip(1).map(|(i, b)| (b.joint_name.as_str(), height(i))).collect()
    }

    /// The unknowns, multipliers included.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.form.unknowns
    }

    /// Number of velocities that are free: independent velocities less held rows.
    pub fn degrees_of_freedom(&self) -> usize {
        self.model.layout.nv() - self.multipliers.len()
    }

    /// Number of rows of constraints that are held.
    pub fn held_rows(&self) -> usize {
        self.multipliers.len()
    }

    /// The constraints.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }
}
