//! Quantities that can be read but probably do not mean what they say.

use super::message::dimension_of;
use super::{Mistake, resolved};
use crate::description::document::About;
use crate::description::finding::Finding;
use crate::description::quantity::suspicion;
use serde_json::Value;

/// So many alternatives within alternatives at most, without going deeper into the value.
const DEEPEST: usize = 16;

/// Every doubt about a value, each once.
pub(super) fn doubts(root: &Value, value: &Value) -> Vec<Mistake> {
    let mut found: Vec<Mistake> = Vec::new();
    visit(root, root, value, "", 0, &mut found);
    found
}

fn visit(root: &Value, schema: &Value, value: &Value, pointer: &str, depth: usize, found: &mut Vec<Mistake>) {
    let schema = resolved(root, schema);
    if let Some(doubt) = dimension_of(schema).and_then(|dimension| suspicion(value, dimension)) {
        if !found.iter().any(|m| m.pointer == pointer) {
            found.push(Mistake::at(pointer, About::Value, Finding::warning("suspicious_unit", doubt)));
        }
        return;
    }
    if depth < DEEPEST {
        for alternatives in ["oneOf", "anyOf", "allOf"] {
            for part in schema.get(alternatives).and_then(Value::as_array).into_iter().flatten() {
                visit(root, part, value, pointer, depth + 1, found);
            }
        }
    }
    match value {
        Value::Object(entries) => {
            for (key, inner) in entries {
                let own = schema.get("properties").and_then(|p| p.get(key)).or_else(|| schema.get("additionalProperties"));
                if let Some(part) = own {
                    let step = key.replace('~', "~0").replace('/', "~1");
                    visit(root, part, inner, &format!("{pointer}/{step}"), 0, found);
                }
            }
        }
        Value::Array(items) => {
            let prefix = schema.get("prefixItems").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
            for (k, item) in items.iter().enumerate() {
                if let Some(part) = prefix.get(k).or_else(|| schema.get("items")) {
                    visit(root, part, item, &format!("{pointer}/{k}"), 0, found);
                }
            }
        }
        _ => {}
    }
}
