//! Checking of a document against a JSON Schema, with every mistake in mechanical words and at its line.
//!
//! The crate `jsonschema` judges and collects; this module chooses, translates and locates. Conventions of our schemas
//! (as `schemars` writes them for `deny_unknown_fields` structs and externally tagged enums):
//! - `"quantity": "<unit>"` beside `"type": ["number", "string"]`: a number in SI or a text with a unit of that dimension,
//!   and the bounds of the standard keywords hold for both ([`super::quantity`]);
//! - a kind is an object with one key, its tag: `oneOf` such objects. Of the errors of all branches, only those of the branch
//!   that carries the tag are told.

mod branch;
mod doubt;
mod keyword;
mod message;
mod walk;

use super::document::{About, Document};
use super::finding::{Finding, Findings};
use super::quantity::dimension::Number as PureNumber;
use super::quantity::{Dimension, Dimensioned, KEYWORD};
use jsonschema::error::ValidationErrorKind;
use jsonschema::{ValidationError, Validator};
use schemars::JsonSchema;
use serde_json::Value;

/// A compiled JSON Schema.
#[derive(Debug)]
pub struct Schema {
    root: Value,
    validator: Validator,
}

/// A number of a document, as its schema knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// JSON pointer.
    pub pointer: String,
    /// What it measures.
    pub dimension: &'static Dimension,
    /// What the schema says it is.
    pub about: String,
}

/// A mistake before its pointer is turned into a line.
struct Mistake {
    pointer: String,
    about: About,
    finding: Finding,
    /// Of an unknown key, the known one that is probably meant.
    meant: Option<String>,
}

impl Mistake {
    fn at(pointer: impl Into<String>, about: About, finding: Finding) -> Self {
        Self { pointer: pointer.into(), about, finding, meant: None }
    }
}

impl Schema {
    /// Compiles a schema. References within it are followed, none to elsewhere.
    ///
    /// # Errors
    /// It is no JSON Schema, or has a `quantity` of a unit that no dimension is shown in.
    pub fn new(root: &Value) -> Result<Self, Findings> {
        let validator = jsonschema::options().with_keyword(KEYWORD, keyword::compile).build(root);
        let validator = validator.map_err(|e| {
            let path = e.schema_path().to_string();
            Finding::error("bad_schema", format!("this is no schema: {e}")).at_path(path)
        })?;
        Ok(Self { root: root.clone(), validator })
    }

    /// The schema of a type.
    ///
    /// # Errors
    /// See [`Schema::new`].
    pub fn of<T: JsonSchema>() -> Result<Self, Findings> {
        Self::new(schemars::schema_for!(T).as_value())
    }

    /// The schema as JSON, for editors.
    pub fn as_json(&self) -> &Value {
        &self.root
    }

    /// Everything in a document that the schema does not allow, and doubts about units, in the order of the text.
    pub fn check(&self, document: &Document) -> Findings {
        let value = document.value();
        let errors: Vec<ValidationError> = self.validator.iter_errors(value).collect();
        let mistakes = self.translate(&errors, value).into_iter().chain(doubt::doubts(&self.root, value));
        mistakes.map(|m| document.located(m.finding, &m.pointer, m.about)).collect::<Findings>().sorted()
    }

    /// Every entry of a value that is a quantity or a number other than a count, in the order of the text.
    pub fn numbers(&self, value: &Value) -> Vec<Number> {
        let mut found: Vec<Number> = Vec::new();
        walk::walk(&self.root, value, &mut |met| {
            let plain = met.value.is_number() && allows(met.schema, "number");
            let dimension = message::dimension_of(met.schema).or(plain.then_some(PureNumber::DIMENSION));
            let Some(dimension) = dimension.filter(|_| met.value.is_number() || met.value.is_string()) else { return true };
            if !found.iter().any(|n| n.pointer == met.pointer) {
                found.push(Number { pointer: met.pointer.to_owned(), dimension, about: met.about.to_owned() });
            }
            false
        });
        found
    }

    /// Pointers to the entries of a value that choose one of several kinds by their only key: `{ spring_damper: … }`.
    pub fn choices(&self, value: &Value) -> Vec<String> {
        let mut found = Vec::new();
        walk::walk(&self.root, value, &mut |met| {
            let key = met.value.as_object().filter(|o| o.len() == 1).and_then(|o| o.keys().next());
            if key.is_some_and(|key| branch::is_tag(&self.root, met.schema, key)) && !found.iter().any(|p| p == met.pointer) {
                found.push(met.pointer.to_owned());
            }
            true
        });
        found
    }

    /// Texts that begin with `=` where a number belongs, and what it measures: `None` where any unit will do.
    pub fn formulas(&self, value: &Value) -> Vec<(String, Option<&'static Dimension>)> {
        let mut found: Vec<(String, Option<&'static Dimension>)> = Vec::new();
        walk::walk(&self.root, value, &mut |met| {
            if !met.value.as_str().is_some_and(|text| text.trim_start().starts_with('=')) {
                return true;
            }
            let plain = (allows(met.schema, "number") || allows(met.schema, "integer")).then(|| match allows(met.schema, "string") {
                true => None,
                false => Some(PureNumber::DIMENSION),
            });
            let Some(wanted) = message::dimension_of(met.schema).map(Some).or(plain) else { return true };
            if !found.iter().any(|(pointer, _)| pointer == met.pointer) {
                found.push((met.pointer.to_owned(), wanted));
            }
            false
        });
        found
    }

    /// The part of the schema at a pointer.
    fn part(&self, pointer: &str) -> &Value {
        self.root.pointer(pointer).unwrap_or(&Value::Null)
    }

    /// What errors mean. A key that is probably a misspelled required one is not missing as well.
    fn translate<'e>(&self, errors: impl IntoIterator<Item = &'e ValidationError<'e>>, value: &Value) -> Vec<Mistake> {
        let (mut mistakes, mut missing) = (Vec::new(), Vec::new());
        for error in errors {
            match error.kind() {
                ValidationErrorKind::Required { property } => missing.push((error, property.as_str().unwrap_or_default())),
                _ => mistakes.extend(self.mistakes(error, value)),
            }
        }
        for (error, key) in missing {
            let around = error.instance_path().as_str();
            let misspelled = mistakes.iter().any(|m: &Mistake| {
                m.meant.as_deref() == Some(key) && m.pointer.rsplit_once('/').is_some_and(|(parent, _)| parent == around)
            });
            if !misspelled {
                mistakes.push(self.missing_key(error, key));
            }
        }
        mistakes
    }
}

/// Whether a schema lets a value be of a type.
fn allows(schema: &Value, kind: &str) -> bool {
    match schema.get("type") {
        Some(Value::String(name)) => name == kind,
        Some(Value::Array(names)) => names.iter().any(|n| n == kind),
        _ => false,
    }
}

/// Follows references within a schema.
fn resolved<'s>(root: &'s Value, mut schema: &'s Value) -> &'s Value {
    const LONGEST_CHAIN: usize = 32;
    for _ in 0..LONGEST_CHAIN {
        let Some(reference) = schema.get("$ref").and_then(Value::as_str) else { break };
        let target = reference.strip_prefix('#').and_then(|pointer| root.pointer(pointer));
        let Some(target) = target else { break };
        schema = target;
    }
    schema
}

#[cfg(test)]
mod tests;
