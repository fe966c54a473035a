//! One error of the validator in mechanical words.

use super::{Mistake, Schema, keyword, resolved};
use crate::description::document::About;
use crate::description::finding::{Finding, nearest, suggestion};
use crate::description::quantity::{Bounds, Dimension, Dimensioned, KEYWORD, QuantityError, dimension::Number};
use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind as Kind;
use serde_json::Value;

impl Schema {
    /// What one error means; several mistakes where it is about several keys or a whole branch.
    pub(super) fn mistakes(&self, error: &ValidationError, root: &Value) -> Vec<Mistake> {
        let pointer = error.instance_path().as_str();
        let value = root.pointer(pointer).unwrap_or(&Value::Null);
        let schema = self.around(error);
        let one = |finding| vec![Mistake::at(pointer, About::Value, finding)];
        match error.kind() {
            Kind::AdditionalProperties { unexpected } | Kind::UnevaluatedProperties { unexpected } => {
                unexpected.iter().map(|key| unknown_key(pointer, key, value, schema)).collect()
            }
            Kind::OneOfNotValid { context } | Kind::OneOfMultipleValid { context } | Kind::AnyOf { context } => {
                self.branches(error, context, root)
            }
            Kind::Type { .. } => one(wrong_type(value, &expectation(schema))),
            Kind::Enum { options } => one(wrong_word(value, options.as_array().map(Vec::as_slice).unwrap_or_default())),
            Kind::Constant { expected_value } => one(wrong_word(value, std::slice::from_ref(expected_value))),
            Kind::Minimum { .. } | Kind::Maximum { .. } | Kind::ExclusiveMinimum { .. } | Kind::ExclusiveMaximum { .. } => {
                out_of_range(value, schema).map(one).unwrap_or_default()
            }
            Kind::MinItems { limit } | Kind::MaxItems { limit } => one(wrong_count(value, schema, *limit)),
            Kind::MinProperties { limit } => one(Finding::error(
                "wrong_count",
                format!("there are {} entries, expected at least {limit}", value.as_object().map_or(0, |o| o.len())),
            )),
            Kind::MinLength { .. } => one(Finding::error("wrong_value", "the text is too short")),
            Kind::Custom { keyword, .. } if keyword == KEYWORD => wrong_quantity(value, schema).map(one).unwrap_or_default(),
            Kind::Pattern { pattern } => one(Finding::error("wrong_value", format!("{} does not have the form `{pattern}`", shown(value)))),
            Kind::Required { property } => vec![self.missing_key(error, property.as_str().unwrap_or_default())],
            _ => one(Finding::error("wrong_value", error.masked().to_string())),
        }
    }

    /// The schema in which the failed keyword stands.
    pub(super) fn around(&self, error: &ValidationError) -> &Value {
        let pointer = error.schema_path().as_str();
        self.part(pointer.rsplit_once('/').map_or("", |(around, _)| around))
    }

    pub(super) fn missing_key(&self, error: &ValidationError, key: &str) -> Mistake {
        let property = self.around(error).get("properties").and_then(|p| p.get(key)).unwrap_or(&Value::Null);
        let about = property.get("description").and_then(Value::as_str).and_then(|text| text.lines().next());
        let expected = expectation(resolved(&self.root, property));
        let hint = match about {
            Some(about) => format!("`{key}` is {expected}: {about}"),
            None => format!("`{key}` is {expected}"),
        };
        let finding = Finding::error("missing_key", format!("missing key `{key}`")).with_hint(hint);
        Mistake::at(error.instance_path().as_str(), About::Key, finding)
    }
}

fn unknown_key(pointer: &str, key: &str, value: &Value, schema: &Value) -> Mistake {
    let known = schema.get("properties").and_then(Value::as_object);
    // what is there already is not what is meant
    let free = || known.into_iter().flatten().map(|(name, _)| name.as_str()).filter(|name| value.get(name).is_none());
    let meant = nearest(key, free()).map(str::to_string);
    let all = known.into_iter().flatten().map(|(name, _)| name.as_str());
    let there = nearest(key, all).filter(|_| meant.is_none()).map(|name| format!("did you mean `{name}`, which is here already?"));
    let hint = there.or_else(|| suggestion(key, free()));
    let finding = Finding::error("unknown_key", format!("unknown key `{key}`")).with_hint_from(hint);
    let key = key.replace('~', "~0").replace('/', "~1");
    Mistake { meant, ..Mistake::at(format!("{pointer}/{key}"), About::Key, finding) }
}

pub(super) fn wrong_type(value: &Value, expected: &str) -> Finding {
    Finding::error("wrong_type", format!("{} is {}, expected {expected}", shown(value), sort_of(value)))
}

fn wrong_word(value: &Value, options: &[Value]) -> Finding {
    let words: Vec<&str> = options.iter().filter_map(Value::as_str).collect();
    match value.as_str() {
        Some(text) => unknown_word(text, &words),
        None => wrong_type(value, &format!("one of {}", list(&words))),
    }
}

pub(super) fn unknown_word(text: &str, words: &[&str]) -> Finding {
    let hint = suggestion(text, words.iter().copied());
    Finding::error("unknown_value", format!("unknown value `{}`, expected one of {}", short(text), list(words))).with_hint_from(
        // the list stands in the message already
        hint.filter(|h| h.starts_with("did you mean")),
    )
}

fn out_of_range(value: &Value, schema: &Value) -> Option<Finding> {
    let bounds = Bounds::of_schema(schema.as_object()?);
    let bound = bounds.violated_by(value.as_f64()?, dimension_of(schema).unwrap_or(Number::DIMENSION))?;
    Some(of_quantity(&QuantityError::OutOfRange { text: value.to_string(), bound }))
}

fn wrong_quantity(value: &Value, schema: &Value) -> Option<Finding> {
    let bounds = Bounds::of_schema(schema.as_object()?);
    keyword::judge_text(value, dimension_of(schema)?, &bounds).as_ref().map(of_quantity)
}

fn of_quantity(error: &QuantityError) -> Finding {
    Finding::error(error.code(), error.to_string()).with_hint_from(error.hint())
}

fn wrong_count(value: &Value, schema: &Value, limit: u64) -> Finding {
    let found = value.as_array().map_or(0, Vec::len);
    let (least, most) = (schema.get("minItems").and_then(Value::as_u64), schema.get("maxItems").and_then(Value::as_u64));
    let expected = match (least, most) {
        (Some(least), Some(most)) if least == most => format!("{least}"),
        (Some(least), Some(most)) => format!("{least} to {most}"),
        (Some(least), None) => format!("at least {least}"),
        _ => format!("at most {limit}"),
    };
    Finding::error("wrong_count", format!("the list has {found} items, expected {expected}"))
}

/// The dimension that a schema asks for.
pub(super) fn dimension_of(schema: &Value) -> Option<&'static Dimension> {
    schema.get(KEYWORD).and_then(Value::as_str).and_then(Dimension::of_unit)
}

/// What a schema asks for, with article.
pub(super) fn expectation(schema: &Value) -> String {
    if let Some(dimension) = dimension_of(schema) {
        return dimension.to_string();
    }
    let words = |names: &[&str]| names.iter().map(|n| sort_named(n)).collect::<Vec<_>>().join(" or ");
    match schema.get("type") {
        Some(Value::String(name)) => words(&[name]),
        Some(Value::Array(names)) => words(&names.iter().filter_map(Value::as_str).filter(|n| *n != "null").collect::<Vec<_>>()),
        _ if schema.get("oneOf").is_some() || schema.get("enum").is_some() => "one of several kinds".to_string(),
        _ => "something else".to_string(),
    }
}

fn sort_named(type_name: &str) -> &str {
    match type_name {
        "object" => "a mapping",
        "array" => "a list",
        "string" => "a text",
        "number" => "a number",
        "integer" => "a whole number",
        "boolean" => "`true` or `false`",
        "null" => "nothing",
        other => other,
    }
}

fn sort_of(value: &Value) -> &'static str {
    match value {
        Value::Object(_) => "a mapping",
        Value::Array(_) => "a list",
        Value::String(_) => "a text",
        Value::Number(_) => "a number",
        Value::Bool(_) => "a truth value",
        Value::Null => "empty",
    }
}

/// A value in a message.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => format!("`{}`", short(text)),
        Value::Number(_) | Value::Bool(_) => format!("`{value}`"),
        Value::Null | Value::Array(_) | Value::Object(_) => "the entry".to_string(),
    }
}

fn short(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut short: String = text.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

pub(super) fn list(words: &[&str]) -> String {
    crate::description::nearest::names(words)
}
