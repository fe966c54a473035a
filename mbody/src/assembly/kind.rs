//! A kind of element: what a description may say and how it becomes a law.

use super::{ConstraintKind, Site};
use crate::description::finding::Finding;
use crate::force::{Force, ForceLaw};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// The written form of one kind of element. Implement it on a `deny_unknown_fields` struct whose doc comments become the
/// documentation of the keys.
pub trait ElementDescription: DeserializeOwned + JsonSchema {
    /// Name in descriptions.
    const KIND: &'static str;
    /// One sentence.
    const ABOUT: &'static str;
    /// Parameters as a user would write them: YAML of the struct, in the tree [`Self::TREE`].
    const EXAMPLE: &'static str;
    /// URDF of the tree that the example speaks of.
    const TREE: &'static str = EXAMPLE_TREE;
    /// The law.
    type Law: ForceLaw;
    /// Turns names into bodies and numbers into a law. `None` where a finding was made, or where the element acts on a
    /// locked joint and is left out.
    fn assemble(self, site: &mut Site<'_>) -> Option<Self::Law>;
}

/// The URDF in whose terms the examples of this crate are written.
pub const EXAMPLE_TREE: &str = include_str!("example_tree.urdf");

/// A row of the table of kinds.
#[derive(Clone, Copy)]
pub struct ElementKind {
    /// Name in descriptions.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Parameters as a user would write them.
    pub example: &'static str,
    /// URDF of the tree that the example speaks of.
    pub tree: &'static str,
    /// JSON Schema of the parameters.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Reads the parameters and makes the element.
    pub build: fn(&mut Site<'_>, &Value) -> Option<Force>,
}

impl ElementKind {
    /// The row of a written form.
    pub const fn of<T: ElementDescription>() -> Self {
        Self { name: T::KIND, about: T::ABOUT, example: T::EXAMPLE, tree: T::TREE, schema: schema_of::<T>, build: build::<T> }
    }
}

impl std::fmt::Debug for ElementKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn schema_of<T: ElementDescription>(generator: &mut SchemaGenerator) -> Schema {
    generator.subschema_for::<T>()
}

fn build<T: ElementDescription>(site: &mut Site<'_>, value: &Value) -> Option<Force> {
    match serde_path_to_error::deserialize::<_, T>(value) {
        Ok(description) => {
            let name = site.element().to_owned();
            description.assemble(site).map(|law| Force::new(name, law))
        }
        Err(error) => {
            // the schema check comes first; this is reached where a rule is not expressible in the schema
            let path = error.path().to_string();
            let path = if path == "." { String::new() } else { path };
            site.find(&path, Finding::error("invalid_entry", error.into_inner().to_string()));
            None
        }
    }
}

/// The registry of kinds of elements and constraints.
#[derive(Clone, Debug)]
pub struct Kinds {
    elements: Vec<ElementKind>,
    constraints: Vec<ConstraintKind>,
}

impl Kinds {
    /// The kinds of this crate.
    pub fn standard() -> Self {
        Self { elements: super::STANDARD.to_vec(), constraints: super::STANDARD_CONSTRAINTS.to_vec() }
    }

    /// Adds the kinds of another crate; a kind of the same name replaces.
    #[must_use]
    pub fn with(mut self, more: &[ElementKind]) -> Self {
        for kind in more {
            self.elements.retain(|k| k.name != kind.name);
            self.elements.push(*kind);
        }
        self
    }

    /// All kinds of elements, in table order.
    pub fn elements(&self) -> &[ElementKind] {
        &self.elements
    }

    /// A kind of element by name.
    pub fn element(&self, name: &str) -> Option<&ElementKind> {
        self.elements.iter().find(|k| k.name == name)
    }

    /// Adds constraints of another crate; a kind of the same name replaces.
    #[must_use]
    pub fn with_constraints(mut self, more: &[ConstraintKind]) -> Self {
        for kind in more {
            self.constraints.retain(|k| k.name != kind.name);
            self.constraints.push(*kind);
        }
        self
    }

    /// All kinds of constraints, in table order.
    pub fn constraints(&self) -> &[ConstraintKind] {
        &self.constraints
    }

    /// A kind of constraint by name.
    pub fn constraint(&self, name: &str) -> Option<&ConstraintKind> {
        self.constraints.iter().find(|k| k.name == name)
    }
}
