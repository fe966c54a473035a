//! Vehicles that differ in numbers only: the description is read once, every member is assembled from it.

use crate::library::Source;
use mbody::assembly::{Blueprint, Entry, Kinds};
use mbody::dynamics::{Formulation, TreePlant};
use problem::{Family, Member, NoMember, Parameter, ParameterId};
use std::sync::Arc;

/// All models that a description describes with other numbers in it.
#[derive(Debug)]
pub struct Vehicles<'a> {
    blueprint: &'a Blueprint,
    source: &'a Source,
    kinds: &'a Kinds,
    reactions: bool,
    parameters: Vec<Parameter>,
}

impl<'a> Vehicles<'a> {
    /// The family of a description; `reactions`: whether the reactions of all joints are among the outputs.
    pub fn of(blueprint: &'a Blueprint, source: &'a Source, kinds: &'a Kinds, reactions: bool) -> Self {
        let parameters = blueprint.entries().iter().map(parameter).collect();
        Self { blueprint, source, kinds, reactions, parameters }
    }

    /// Whether the value of a parameter follows from no other one.
    pub fn is_free(&self, id: ParameterId) -> bool {
        !self.blueprint.entries()[id.0].derived
    }

    /// The parameter with this path.
    pub fn find(&self, path: &str) -> Option<ParameterId> {
        self.parameters.iter().position(|p| p.name == path).map(ParameterId)
    }
}

fn parameter(entry: &Entry) -> Parameter {
    Parameter {
        name: entry.path.clone(),
        unit: entry.dimension.unit.into(),
        value: entry.value,
        nominal: if entry.value == 0.0 { typical(entry.dimension.unit) } else { entry.value.abs() },
        about: entry.about.clone().into(),
    }
}

/// Magnitude of an entry that is zero, on a vehicle.
fn typical(unit: &str) -> f64 {
    match unit {
        "m" | "rad" => 0.1,
        _ => 1.0,
    }
}

impl Family for Vehicles<'_> {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn with(&self, changes: &[(ParameterId, f64)]) -> Result<Member, NoMember> {
        let changes: Vec<(usize, f64)> = changes.iter().map(|&(id, value)| (id.0, value)).collect();
        let mut assembled = self.blueprint.with(&changes, self.source, self.kinds).map_err(|findings| NoMember {
            because: findings.iter().next().map_or_else(|| "there is no such model".to_owned(), |f| f.message.clone()),
        })?;
        // nobody else has seen the system yet
        if let Some(system) = Arc::get_mut(&mut assembled.system).filter(|_| self.reactions) {
            system.report_reactions();
        }
        Ok(Member {
            steady: Box::new(TreePlant::new(assembled.system.clone())),
            linear: Box::new(TreePlant::in_formulation(assembled.system, Formulation::Ggl)),
        })
    }
}
