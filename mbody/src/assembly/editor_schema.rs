//! The JSON Schemas for editors: what may be typed, where the schema of the reader says what a whole description means.
//!
//! Both come from [`schema`]: formulas may stand where a number does, descriptions name their unit, `include` is known. In a part nothing
//! is required and everything may be removed by `null`, because the rest stands elsewhere.

use super::Kinds;
use super::description::schema;
use crate::description::quantity::KEYWORD;
use serde_json::{Map, Value, json};

/// The schema of whole descriptions.
pub fn editor_schema(kinds: &Kinds) -> Value {
    let mut root = schema(kinds);
    told(&mut root);
    root["properties"]["include"] = include();
    root
}

/// The schema of parts, of descriptions that change what they include, and of setups.
pub fn part_schema(kinds: &Kinds) -> Value {
    let mut root = schema(kinds);
    told(&mut root);
    loosen(&mut root);
    root["title"] = json!("FastBike part or setup");
    root["description"] = json!("A part that others include, a description over what it includes, or a setup of a model.");
    let entries = [
        ("include", include()),
        ("part", json!({ "type": "string", "description": "A sentence: what this part is. It is for readers and changes nothing." })),
        (
            "setup",
            json!({ "type": "string", "description": "Model whose adjustables have the values under `adjust`; a bundled name or a file." }),
        ),
        (
            "adjust",
            json!({
                "type": "object",
                "description": "Values of adjustables of the model, by name; `fastbike info MODEL` lists them with their ranges.",
                "additionalProperties": { "type": ["number", "string"], "description": "A number with its unit, within the range." }
            }),
        ),
    ];
    for (name, entry) in entries {
        root["properties"][name] = entry;
    }
    root
}

fn include() -> Value {
    json!({
        "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }],
        "description": "Files that come first: other descriptions or parts, bundled ones by their bare name. Entries here win: mappings are joined, \
            all else is replaced, `null` removes; another kind replaces the whole entry."
    })
}

/// Units into the descriptions, formulas beside numbers.
fn told(schema: &mut Value) {
    if let Value::Object(entries) = schema {
        formulas(entries);
        // what is said of a kind is said where its tag is typed
        let about = entries.get("description").cloned().filter(|_| is_tagged(entries));
        if let (Some(about), Some(Value::Object(properties))) = (about, entries.get_mut("properties")) {
            for tag in properties.values_mut().filter_map(Value::as_object_mut) {
                tag.entry("description").or_insert(about.clone());
            }
        }
        if let Some(unit) = entries.get(KEYWORD).and_then(Value::as_str).map(str::to_owned) {
            let about = entries.get("description").and_then(Value::as_str).unwrap_or_default();
            let unit = if unit == "1" { "a plain number".to_owned() } else { format!("in {unit} where no unit is written") };
            let about = if about.is_empty() { format!("A number, {unit}.") } else { format!("{about} ({unit})") };
            entries.insert("description".to_owned(), about.into());
        }
        entries.values_mut().for_each(told);
    } else if let Value::Array(items) = schema {
        items.iter_mut().for_each(told);
    }
}

/// A number may be a formula, a text that begins with `=`.
fn formulas(schema: &mut Map<String, Value>) {
    let mut types: Vec<Value> = match schema.get("type") {
        Some(Value::Array(types)) => types.clone(),
        Some(one @ Value::String(_)) => vec![one.clone()],
        _ => return,
    };
    let number = types.iter().any(|t| t == "number" || t == "integer");
    if number && !types.iter().any(|t| t == "string") {
        types.push("string".into());
        schema.insert("type".to_owned(), types.into());
        schema.insert("pattern".to_owned(), "^\\s*=".into());
    }
}

/// Whether a schema is that of a kind: its only entry is its tag.
fn is_tagged(schema: &Map<String, Value>) -> bool {
    let count = |key: &str| schema.get(key).map_or(0, |v| v.as_array().map_or_else(|| v.as_object().map_or(0, Map::len), Vec::len));
    count("required") == 1 && count("properties") == 1
}

/// Nothing is required; entries of mappings may be `null`.
fn loosen(schema: &mut Value) {
    match schema {
        Value::Object(entries) => {
            // the tag of a kind stays: it tells the kinds apart
            let tagged = is_tagged(entries);
            if !tagged {
                entries.shift_remove("required");
            }
            for key in ["properties", "additionalProperties"].into_iter().filter(|_| !tagged) {
                let of = match (key, entries.get_mut(key)) {
                    ("properties", Some(Value::Object(properties))) => properties.values_mut().collect(),
                    (_, Some(one)) if one.is_object() => vec![one],
                    _ => Vec::new(),
                };
                of.into_iter().for_each(removable);
            }
            entries.values_mut().for_each(loosen);
        }
        Value::Array(items) => items.iter_mut().for_each(loosen),
        _ => {}
    }
}

fn removable(schema: &mut Value) {
    let Value::Object(entries) = schema else { return };
    match entries.get_mut("type") {
        Some(Value::Array(types)) if !types.iter().any(|t| t == "null") => types.push("null".into()),
        Some(one @ Value::String(_)) => *one = json!([one.clone(), "null"]),
        Some(_) => {}
        None => {
            let about = entries.get("description").cloned();
            let word = ["oneOf", "anyOf"].into_iter().find(|w| entries.contains_key(*w));
            match word.and_then(|w| entries.get_mut(w)).and_then(Value::as_array_mut) {
                Some(branches) => branches.push(json!({ "type": "null" })),
                None => {
                    let inner = Value::Object(std::mem::take(entries));
                    *schema = json!({ "anyOf": [inner, { "type": "null" }] });
                    if let Some(about) = about {
                        schema["description"] = about;
                    }
                }
            }
        }
    }
}
