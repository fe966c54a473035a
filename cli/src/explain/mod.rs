//! What words mean: kinds and their entries, signals, numbers of a model, endings, codes of findings.

mod codes;
mod endings;

pub use codes::CODES;
pub use endings::ENDINGS;

use mbody::assembly::Kinds;
use mbody::description::finding::nearest;
use serde_json::Value;
use std::fmt::Write;

/// A kind of the registry or of a table, as `info --kinds` tells it.
pub type Told<'a> = (&'a str, &'a str, &'a str);

/// Everything about words that needs no model.
#[derive(Debug)]
pub struct Dictionary<'k> {
    kinds: &'k Kinds,
    schema: Value,
    maneuver: Value,
}

impl<'k> Dictionary<'k> {
    /// With the kinds of a registry.
    pub fn of(kinds: &'k Kinds) -> Self {
        Self { kinds, schema: mbody::assembly::schema(kinds), maneuver: motorcycle::maneuver::schema() }
    }

    /// Kinds of elements.
    pub fn elements(&self) -> Vec<Told<'k>> {
        self.kinds.elements().iter().map(|k| (k.name, k.about, k.example)).collect()
    }

    /// Kinds of constraints.
    pub fn constraints(&self) -> Vec<Told<'k>> {
        self.kinds.constraints().iter().map(|k| (k.name, k.about, k.example)).collect()
    }

    /// Sections of paths of maneuvers.
    pub fn sections(&self) -> Vec<Told<'static>> {
        motorcycle::maneuver::section::KINDS.iter().map(|k| (k.name, k.about, k.example)).collect()
    }

    /// A kind with its parameters and an example; empty where there is none of this name.
    pub fn kind(&self, name: &str) -> String {
        let mut text = String::new();
        let choices = |section: &str| &self.schema["properties"][section]["additionalProperties"]["oneOf"];
        let tables = [
            (self.elements(), &self.schema, choices("elements")),
            (self.constraints(), &self.schema, choices("constraints")),
            (self.sections(), &self.maneuver, &self.maneuver["properties"]["path"]["items"]["oneOf"]),
        ];
        for (table, schema, choices) in tables {
            for kind in table.into_iter().filter(|k| k.0 == name) {
                one(&mut text, schema, choices, kind);
            }
        }
        text
    }

    /// What the schemas say about an entry: `elements`, `telescopic_fork.spring.stiffness`, `stiffness`; one paragraph for each place.
    pub fn entry(&self, path: &str) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for (root, place) in [(&self.schema, "descriptions"), (&self.maneuver, "maneuvers")] {
            let mut all = Vec::new();
            entries(root, root, "", 0, &mut all);
            for (at, entry) in all.iter().filter(|(at, _)| at == path || at.ends_with(&format!(".{path}"))) {
                let text = format!("{at} (in {place}){}\n    {}\n", unit(entry), sentence(entry));
                if !found.contains(&text) {
                    found.push(text);
                }
            }
        }
        found
    }

    /// Every word that can be explained without a model.
    pub fn words(&self) -> Vec<String> {
        let mut words: Vec<String> = CODES.iter().chain(ENDINGS).map(|(word, _)| (*word).to_owned()).collect();
        let kinds = [self.elements(), self.constraints()].concat();
        words.extend(kinds.iter().chain(&self.sections()).map(|k| k.0.to_owned()));
        for root in [&self.schema, &self.maneuver] {
            let mut all = Vec::new();
            entries(root, root, "", 0, &mut all);
            words.extend(all.into_iter().map(|(path, _)| path));
        }
        words
    }
}

/// The nearest of some words, by the whole word or by its last part.
pub fn near<'a>(word: &str, known: &'a [String]) -> Option<&'a str> {
    nearest(word, known.iter().map(String::as_str))
}

/// One kind among the choices of a schema.
fn one(text: &mut String, schema: &Value, choices: &Value, (name, about, example): Told<'_>) {
    let _ = writeln!(text, "{name} — {about}");
    let choice = choices.as_array().and_then(|c| c.iter().find(|c| c["properties"].get(name).is_some()));
    let parameters = choice.map(|c| resolved(schema, &c["properties"][name]));
    if let Some(properties) = parameters.and_then(|p| p["properties"].as_object()) {
        for (key, entry) in properties {
            let _ = writeln!(text, "    {key}{}: {}", unit(entry), sentence(entry));
        }
    }
    let _ = writeln!(text, "    example: {name}: {}\n", example.split_whitespace().collect::<Vec<_>>().join(" "));
}

fn unit(entry: &Value) -> String {
    entry.get("quantity").and_then(|q| q.as_str()).map(|u| format!(" [{u}]")).unwrap_or_default()
}

fn sentence(entry: &Value) -> String {
    entry.get("description").and_then(|d| d.as_str()).unwrap_or_default().replace('\n', " ")
}

/// Follows a reference within the schema.
fn resolved<'a>(schema: &'a Value, entry: &'a Value) -> &'a Value {
    let target = entry.get("$ref").and_then(|r| r.as_str()).and_then(|r| r.strip_prefix('#')).and_then(|p| schema.pointer(p));
    target.unwrap_or(entry)
}

/// Every property below a schema with its path; names that a user gives are left out.
fn entries<'a>(root: &'a Value, schema: &'a Value, path: &str, depth: usize, found: &mut Vec<(String, &'a Value)>) {
    // descriptions are about eight levels deep
    if depth > 24 {
        return;
    }
    let schema = resolved(root, schema);
    for word in ["oneOf", "anyOf", "allOf"] {
        for part in schema.get(word).and_then(Value::as_array).into_iter().flatten() {
            entries(root, part, path, depth + 1, found);
        }
    }
    for (key, entry) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        if !found.iter().any(|(known, _)| *known == path) {
            found.push((path.clone(), entry));
        }
        entries(root, entry, &path, depth + 1, found);
    }
    for word in ["additionalProperties", "items"] {
        if let Some(inner) = schema.get(word).filter(|v| v.is_object()) {
            entries(root, inner, path, depth + 1, found);
        }
    }
}
