//! Which of several alternatives was meant, so that only its errors are told.

use super::message::{expectation, list, unknown_word, wrong_type};
use super::{Mistake, Schema, resolved};
use crate::description::document::About;
use crate::description::finding::{Finding, suggestion};
use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind as Kind;
use serde_json::Value;

/// What an alternative looks like.
enum Branch<'s> {
    /// An object with one key, the tag of a kind.
    Tagged(&'s str),
    /// One of some words.
    Words(Vec<&'s str>),
    /// `null`, for an entry that may be absent.
    Nothing,
    /// Anything else.
    Open,
}

fn branch(schema: &Value) -> Branch<'_> {
    let required = schema.get("required").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let properties = schema.get("properties").and_then(Value::as_object);
    if let (Some(word), None) = (schema.get("const").and_then(Value::as_str), properties) {
        return Branch::Words(vec![word]);
    }
    match (required, properties, schema.get("enum").and_then(Value::as_array)) {
        ([tag], Some(properties), _) if properties.len() == 1 => tag.as_str().map_or(Branch::Open, Branch::Tagged),
        (_, None, Some(words)) => Branch::Words(words.iter().filter_map(Value::as_str).collect()),
        _ if schema.get("type").and_then(Value::as_str) == Some("null") => Branch::Nothing,
        _ => Branch::Open,
    }
}

/// Whether a schema offers several kinds, one of which has this tag.
pub(super) fn is_tag(root: &Value, schema: &Value, key: &str) -> bool {
    let alternatives = ["oneOf", "anyOf"].iter().filter_map(|word| schema.get(word)?.as_array());
    alternatives.flatten().any(|s| matches!(branch(resolved(root, s)), Branch::Tagged(tag) if tag == key))
}

impl Schema {
    /// The mistakes of the branch that was meant.
    pub(super) fn branches(&self, error: &ValidationError, context: &[Vec<ValidationError<'static>>], root: &Value) -> Vec<Mistake> {
        let pointer = error.instance_path().as_str();
        let value = root.pointer(pointer).unwrap_or(&Value::Null);
        let alternatives = self.part(error.schema_path().as_str()).as_array().map(Vec::as_slice).unwrap_or_default();
        let schemas: Vec<&Value> = alternatives.iter().map(|s| resolved(&self.root, s)).collect();
        let branches: Vec<Branch> = schemas.iter().map(|s| branch(s)).collect();
        let tags: Vec<&str> = branches.iter().filter_map(|b| if let Branch::Tagged(tag) = b { Some(*tag) } else { None }).collect();
        let words: Vec<&str> =
            branches.iter().flat_map(|b| if let Branch::Words(words) = b { words.clone() } else { Vec::new() }).collect();
        let one = |about, finding| vec![Mistake::at(pointer, about, finding)];
        let all_words = || words.iter().chain(&tags).copied().collect::<Vec<_>>();
        let open = branches.iter().any(|b| matches!(b, Branch::Open));
        match value {
            Value::Object(entries) if !tags.is_empty() => {
                let chosen: Vec<&str> = tags.iter().copied().filter(|tag| entries.contains_key(*tag)).collect();
                match chosen[..] {
                    [tag] => {
                        let k = branches.iter().position(|b| matches!(b, Branch::Tagged(t) if *t == tag)).unwrap_or(0);
                        self.translate(context.get(k).into_iter().flatten(), root)
                    }
                    [] if open => self.likeliest(pointer, &schemas, context, root),
                    [] => unknown_kind(pointer, value, &tags),
                    _ => one(
                        About::Key,
                        Finding::error("two_kinds", format!("the entry has several kinds at once: {}", list(&chosen)))
                            .with_hint("keep one; in an overlay, remove the other with `null`"),
                    ),
                }
            }
            Value::String(text) if !open && (!tags.is_empty() || !words.is_empty()) => {
                let finding = match tags.iter().find(|tag| *tag == text) {
                    Some(tag) => Finding::error("missing_key", format!("kind `{tag}` has no parameters"))
                        .with_hint(format!("write `{tag}: {{ … }}` on a line of its own")),
                    None => unknown_word(text, &all_words()),
                };
                one(About::Value, finding)
            }
            _ if !open && (!tags.is_empty() || !words.is_empty()) => {
                one(About::Value, wrong_type(value, &format!("one of {}", list(&all_words()))))
            }
            _ => self.likeliest(pointer, &schemas, context, root),
        }
    }

    /// Without tags: the alternative of the right type with the fewest errors.
    fn likeliest(&self, pointer: &str, schemas: &[&Value], context: &[Vec<ValidationError<'static>>], root: &Value) -> Vec<Mistake> {
        let fits = |errors: &&Vec<ValidationError>| {
            !errors.iter().any(|e| matches!(e.kind(), Kind::Type { .. }) && e.instance_path().as_str() == pointer)
        };
        if let Some(errors) = context.iter().filter(fits).min_by_key(|errors| errors.len()) {
            return self.translate(errors, root);
        }
        let mut expected: Vec<String> = Vec::new();
        for schema in schemas.iter().filter(|s| !matches!(branch(s), Branch::Nothing)) {
            let words = expectation(schema);
            if !expected.contains(&words) {
                expected.push(words);
            }
        }
        let value = root.pointer(pointer).unwrap_or(&Value::Null);
        vec![Mistake::at(pointer, About::Value, wrong_type(value, &expected.join(" or ")))]
    }
}

/// No key of the entry is the tag of a kind.
fn unknown_kind(pointer: &str, value: &Value, tags: &[&str]) -> Vec<Mistake> {
    let keys: Vec<&String> = value.as_object().map(|o| o.keys().collect()).unwrap_or_default();
    match keys[..] {
        [key] => {
            let finding =
                Finding::error("unknown_kind", format!("unknown kind `{key}`")).with_hint_from(suggestion(key, tags.iter().copied()));
            let step = key.replace('~', "~0").replace('/', "~1");
            vec![Mistake::at(format!("{pointer}/{step}"), About::Key, finding)]
        }
        [] => vec![Mistake::at(
            pointer,
            About::Key,
            Finding::error("missing_kind", "the entry has no kind").with_hint_from(suggestion("", tags.iter().copied())),
        )],
        _ => {
            let hint =
                tags.first().map(|tag| format!("the parameters belong one level deeper, under their kind: `{tag}: {{ {}: … }}`", keys[0]));
            let message = format!("the entry has no kind, expected one of {}", list(tags));
            vec![Mistake::at(pointer, About::Key, Finding::error("missing_kind", message).with_hint_from(hint))]
        }
    }
}
