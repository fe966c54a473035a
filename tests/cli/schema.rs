//! The committed schema is the one the tool prints, and every bundled description keeps it.
//!
//! After a change of a description: `cargo run -- schema > models/schema/fastbike.schema.json`; the same with `--part` for `part.schema.json`, with
//! `--maneuver` for `maneuver.schema.json`, with `--tire` for `tire.schema.json`.

use super::{evidence, fastbike};
use mbody::description::document::Document;
use mbody::description::schema::Schema;
use serde_json::Value;
use std::fs;

#[test]
fn the_committed_schema_of_maneuvers_is_up_to_date() {
    let printed = fastbike(&["schema", "--maneuver"]);
    assert_eq!((printed.status, printed.stderr.as_str()), (0, ""));
    let committed = fs::read_to_string(evidence("../models/schema/maneuver.schema.json")).expect("the committed schema");
    assert!(printed.stdout == committed, "out of date; update it: cargo run -- schema --maneuver > models/schema/maneuver.schema.json");
}

#[test]
fn every_bundled_maneuver_names_and_keeps_the_schema() {
    let schema = Schema::new(&motorcycle::maneuver::schema()).expect("the schema is a schema");
    let mut seen = 0;
    for file in fs::read_dir(evidence("../models/maneuvers")).expect("maneuvers").flatten() {
        let (name, text) = (file.file_name().to_string_lossy().into_owned(), fs::read_to_string(file.path()).expect("text"));
        let first = text.lines().next().unwrap_or_default();
        assert_eq!(first, "# yaml-language-server: $schema=../schema/maneuver.schema.json", "first line of {name}");
        let document = Document::parse(&name, &text).unwrap_or_else(|e| panic!("{e}"));
        let findings = schema.check(&document);
        assert!(findings.is_empty(), "{findings}");
        seen += 1;
    }
    assert!(seen >= 12, "{seen} maneuvers");
}

#[test]
fn the_committed_schemas_are_up_to_date() {
    for (arguments, file) in [(&["schema"][..], "fastbike"), (&["schema", "--part"], "part"), (&["schema", "--tire"], "tire")] {
        let printed = fastbike(arguments);
        assert_eq!((printed.status, printed.stderr.as_str()), (0, ""));
        let committed = fs::read_to_string(evidence(&format!("../models/schema/{file}.schema.json"))).expect("the committed schema");
        assert!(
            printed.stdout == committed,
            "out of date; update it: cargo run -- {} > models/schema/{file}.schema.json",
            arguments.join(" ")
        );
    }
}

/// Every YAML file below `models/`, with its path from there.
fn bundled_texts() -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![evidence("../models")];
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(folder).expect("models").flatten().map(|e| e.path()) {
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "yaml") {
                let text = fs::read_to_string(&path).expect("text");
                found.push((path.strip_prefix(evidence("../models")).expect("below models").display().to_string(), text));
            }
        }
    }
    found.sort();
    found
}

/// The schema that the first line names, from the folder of the file.
fn named_schema(name: &str, text: &str) -> Value {
    let first = text.lines().next().unwrap_or_default();
    let path = first.strip_prefix("# yaml-language-server: $schema=").unwrap_or_else(|| panic!("first line of {name}: {first}"));
    let folder = evidence("../models").join(name).parent().expect("a folder").to_owned();
    let schema = fs::read_to_string(folder.join(path)).unwrap_or_else(|e| panic!("{name} names {path}: {e}"));
    serde_json::from_str(&schema).expect("a schema is JSON")
}

/// As an editor does: a validator that knows nothing of units.
#[test]
fn every_bundled_file_keeps_the_schema_that_it_names() {
    let mut seen = 0;
    for (name, text) in bundled_texts().into_iter() {
        let schema = named_schema(&name, &text);
        let value: Value = serde_yaml::from_str(&text).expect("YAML");
        let plain = jsonschema::validator_for(&schema).expect("a schema");
        let errors: Vec<String> = plain.iter_errors(&value).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{name}: {errors:#?}");
        // with units
        let document = Document::parse(&name, &text).unwrap_or_else(|e| panic!("{e}"));
        let findings = Schema::new(&schema).expect("a schema").check(&document);
        assert!(findings.is_empty(), "{findings}");
        seen += 1;
    }
    assert!(seen >= 30, "{seen} files");
}

/// Whoever types sees what an entry is, and its unit.
#[test]
fn every_property_has_a_description_and_every_quantity_its_unit() {
    for file in ["fastbike", "part", "maneuver", "tire"] {
        let text = fs::read_to_string(evidence(&format!("../models/schema/{file}.schema.json"))).expect("the committed schema");
        let root: Value = serde_json::from_str(&text).expect("JSON");
        let mut silent = Vec::new();
        look(&root, &root, String::new(), file != "maneuver", &mut silent);
        assert!(silent.is_empty(), "{file}: {} properties say nothing: {silent:#?}", silent.len());
    }
}

fn look(root: &Value, schema: &Value, path: String, units: bool, silent: &mut Vec<String>) {
    for (key, entry) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        let referred = entry.get("$ref").and_then(Value::as_str).and_then(|r| root.pointer(r.trim_start_matches('#')));
        let of = |v: &Value| v.get("description").and_then(Value::as_str).map(str::to_owned);
        // of a variant with one key the mapping itself tells what it is
        let variant = || schema.get("required").and_then(Value::as_array).is_some_and(|r| r.len() == 1).then(|| of(schema)).flatten();
        let about = of(entry).or_else(|| referred.and_then(of)).or_else(variant).unwrap_or_default();
        let unit = entry.get("quantity").and_then(Value::as_str);
        if about.is_empty() || unit.is_some_and(|u| units && u != "1" && !about.contains(u)) {
            silent.push(format!("{path}/{key}"));
        }
    }
    match schema {
        Value::Object(entries) => entries.iter().for_each(|(key, v)| look(root, v, format!("{path}/{key}"), units, silent)),
        Value::Array(items) => items.iter().enumerate().for_each(|(k, v)| look(root, v, format!("{path}/{k}"), units, silent)),
        _ => {}
    }
}
