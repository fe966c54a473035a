//! Setups: values of the adjustables of an engineering model, and nothing else.

use super::{Composer, advice, listed};
use crate::description::document::Document;
use crate::description::finding::Finding;
use serde_json::Value;

/// Keys of a setup.
const KEYS: [&str; 4] = ["setup", "name", "about", "adjust"];

impl Composer<'_> {
    /// The model of a setup with its adjustables at the values of the setup.
    pub(super) fn setup(&mut self, document: Document) -> Option<Document> {
        let mut found = Vec::new();
        for key in document.value().as_object().into_iter().flat_map(|o| o.keys()).filter(|k| !KEYS.contains(&k.as_str())) {
            let hint = format!("a setup has {}; everything else belongs to the model, or to a description that includes it", listed(&KEYS));
            found.push(document.finding(key, "unknown_key", format!("`{key}` does not belong in a setup")).with_hint(hint));
        }
        let Some(name) = document.value()["setup"].as_str() else {
            self.findings.push(document.finding("setup", "wrong_type", "this is not the name of a model"));
            return None;
        };
        let full = self.library.resolve(name, document.file());
        if self.library.text(&full).is_none() {
            let finding = document.finding("setup", "missing_file", format!("model `{name}` was not found"));
            self.findings.push(finding.with_hint("give the name of a bundled model, or a file beside this one"));
            return None;
        }
        let model = self.text(&full)?;
        if model.value().get("setup").is_some() {
            let finding = document.finding("setup", "wrong_file", format!("`{name}` is a setup itself"));
            self.findings.push(finding.with_hint("a setup stands on an engineering model"));
            return None;
        }
        let mut model = self.compose(model)?;
        let adjust = document.value().get("adjust");
        if adjust.is_some_and(|a| !a.is_object()) {
            found.push(document.finding("adjust", "wrong_type", "expected adjustables with their values, like `rear_preload: 4 mm`"));
        }
        let mut moves = vec![("/name".to_owned(), "/name".to_owned()), ("/about".to_owned(), "/about".to_owned())];
        for (key, value) in adjust.and_then(Value::as_object).into_iter().flatten() {
            let path = format!("adjust.{key}");
            match model.value().get("adjustables").and_then(|a| a.get(key)) {
                None => found.push(unknown(&document, &path, key, &model)),
                Some(_) if !(value.is_number() || value.is_string()) => {
                    found.push(document.finding(&path, "wrong_type", format!("`{key}` is not a number with an optional unit")));
                }
                Some(_) => {
                    let key = key.replace('~', "~0").replace('/', "~1");
                    moves.push((format!("/adjust/{key}"), format!("/adjustables/{key}/value")));
                }
            }
        }
        let wrong = !found.is_empty();
        self.findings.extend(found);
        let values = document.picked(&moves);
        model.merge(values, &[]);
        (!wrong).then_some(model)
    }
}

fn unknown(document: &Document, path: &str, key: &str, model: &Document) -> Finding {
    let adjustables = model.value().get("adjustables").and_then(Value::as_object);
    let known: Vec<String> = adjustables.into_iter().flat_map(|a| a.keys().cloned()).collect();
    let shown = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let ranges = adjustables.into_iter().flatten().map(|(name, entry)| match entry["range"].as_array().map(Vec::as_slice) {
        Some([low, high]) => format!("`{name}` ({} to {})", shown(low), shown(high)),
        _ => format!("`{name}`"),
    });
    let all = match known.is_empty() {
        true => "the model declares none; an engineering model lists them under `adjustables:`".to_owned(),
        false => format!("adjustable are {}", ranges.collect::<Vec<_>>().join(", ")),
    };
    let finding = document.finding(path, "unknown_adjustable", format!("`{key}` is not adjustable"));
    finding.with_hint(advice(key, &known, &all))
}
