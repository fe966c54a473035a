//! The assembled system: tree, elements and the signals of all of them. Immutable; shared by all plants.
//!
//! `y = (q, v, s)`; rows: `q̇ − N(q) v` (kinematic), `RNEA(q, v, v̇) − τ` (dynamic), one row per element state.

use crate::force::Force;
use crate::model::Model;
use problem::{Equation, EquationKind, Input, Limit, Signal, Unknown, UnknownKind};
use std::collections::HashMap;
use std::ops::Range;
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

/// Tree, elements and signals.
#[derive(Debug)]
pub struct System {
    pub(crate) model: Model,
    pub(crate) elements: Vec<Element>,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) equations: Vec<Equation>,
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
        let mut system = Self {
            elements: Vec::with_capacity(forces.len()),
            unknowns: Vec::new(),
            equations: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            limits: Vec::new(),
            state_count: 0,
            model,
        };
        system.tree_signals(&forces);
        let mut limits = Vec::new();
        for force in forces {
            limits.extend(force.declared().limits.iter().map(|l| (l.clone(), force.name().to_owned())));
            system.element(force)?;
        }
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
        let spinning = |i: usize| forces.iter().any(|f| f.declared().spinning.iter().any(|b| b.get() == i));
        let weight = (self.model.total_mass() * self.model.gravity.norm()).max(1.0);
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
                    });
                }
            }
        }
        self.unknowns = positions.into_iter().chain(velocities).collect();
        self.equations = kinematic.into_iter().chain(dynamic).collect();
    }

    /// States, inputs and outputs of one element.
    fn element(&mut self, force: Force) -> Result<(), SystemError> {
        let declared = force.declared();
        let first_state = self.state_count;
        for s in &declared.states {
            let owner = force.name();
            self.unknowns.push(Unknown {
                signal: Signal::new(format!("{owner}.{}", s.name), s.unit, s.about),
                kind: UnknownKind::State,
                cyclic: false,
                differential: s.differential,
                nominal: s.nominal,
                absolute_tolerance: s.absolute_tolerance,
                design: 0.0,
            });
            let (what, unit, nominal) = s.row;
            self.equations.push(Equation { name: format!("{what} of {owner}"), unit: unit.into(), nominal, kind: EquationKind::Element });
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
                    self.inputs.push(Input { signal, rate: None, nominal: d.nominal, default: 0.0 });
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
        self.elements.push(Element { force, states, inputs, outputs });
        Ok(())
    }

    fn check_names(&self) -> Result<(), SystemError> {
        let mut seen: HashMap<&str, ()> = HashMap::new();
        let unknowns = self.unknowns.iter().map(|u| &u.signal);
        for signal in unknowns.chain(self.inputs.iter().map(|i| &i.signal)).chain(&self.outputs) {
            if seen.insert(&signal.name, ()).is_some() {
                let owner = signal.name.split('.').next().unwrap_or_default().to_owned();
                return Err(SystemError::DuplicateSignal { signal: signal.name.clone(), owner });
            }
        }
        Ok(())
    }

    fn find(&self, name: &str) -> Option<&Signal> {
        let unknowns = self.unknowns.iter().map(|u| &u.signal);
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
        let mut w = crate::stage::Workspace::<f64>::new(&self.model);
        w.to_design(&self.model);
        let height = |i: usize| w.world.X_WB[i].p.z;
        self.model.bodies.iter().enumerate().skip(1).map(|(i, b)| (b.joint_name.as_str(), height(i))).collect()
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }
}
