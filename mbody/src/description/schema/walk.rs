//! A value and its schema, walked together.

use super::resolved;
use serde_json::Value;

/// So many alternatives within alternatives at most, without going deeper into the value.
const DEEPEST: usize = 16;

/// What is met on the way.
pub(super) struct Met<'a> {
    /// One schema of the value, references followed.
    pub(super) schema: &'a Value,
    pub(super) value: &'a Value,
    /// JSON pointer of the value.
    pub(super) pointer: &'a str,
    /// What the schema of the key says; items of a list have the words of the list.
    pub(super) about: &'a str,
    /// What the schema of the key says about usual values, under [`super::doubt::PLAUSIBLE`].
    pub(super) plausible: Option<&'a Value>,
}

/// Shows every value with every schema that may apply to it; `look` answers whether to go on below.
pub(super) fn walk<'s>(root: &'s Value, value: &'s Value, look: &mut dyn FnMut(&Met<'_>) -> bool) {
    visit(root, root, value, ("", "", None), 0, look);
}

/// Where a value is, what the schema around it says about it, and about usual values.
type Around<'a> = (&'a str, &'a str, Option<&'a Value>);

fn visit(root: &Value, schema: &Value, value: &Value, at: Around<'_>, depth: usize, look: &mut dyn FnMut(&Met<'_>) -> bool) {
    let (pointer, inherited, usual) = at;
    let about = schema.get("description").and_then(Value::as_str).unwrap_or(inherited);
    let own = schema.get(super::doubt::PLAUSIBLE);
    let schema = resolved(root, schema);
    let plausible = own.or_else(|| schema.get(super::doubt::PLAUSIBLE)).or(usual);
    if !look(&Met { schema, value, pointer, about, plausible }) {
        return;
    }
    if depth < DEEPEST {
        for alternatives in ["oneOf", "anyOf", "allOf"] {
            for part in schema.get(alternatives).and_then(Value::as_array).into_iter().flatten() {
                visit(root, part, value, (pointer, about, plausible), depth + 1, look);
            }
        }
    }
    match value {
        Value::Object(entries) => {
            for (key, inner) in entries {
                let own = schema.get("properties").and_then(|p| p.get(key)).or_else(|| schema.get("additionalProperties"));
                if let Some(part) = own {
                    let step = key.replace('~', "~0").replace('/', "~1");
                    visit(root, part, inner, (&format!("{pointer}/{step}"), about, None), 0, look);
                }
            }
        }
        Value::Array(items) => {
            let prefix = schema.get("prefixItems").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
            for (k, item) in items.iter().enumerate() {
                if let Some(part) = prefix.get(k).or_else(|| schema.get("items")) {
                    visit(root, part, item, (&format!("{pointer}/{k}"), about, None), 0, look);
                }
            }
        }
        _ => {}
    }
}
