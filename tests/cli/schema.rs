//! The committed schema is the one the tool prints, and every bundled description keeps it.
//!
//! After a change of a description: `cargo run -- schema > models/schema/fastbike.schema.json`; of a maneuver: `cargo run -- schema --maneuver >
//! models/schema/maneuver.schema.json`; of a tire law: `cargo run -- schema --tire > models/schema/tire.schema.json`.

use super::{evidence, fastbike};
use mbody::description::document::Document;
use mbody::description::schema::Schema;
use std::fs;

fn committed() -> String {
    fs::read_to_string(evidence("../models/schema/fastbike.schema.json")).expect("the committed schema")
}

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
fn the_committed_schema_of_tire_laws_is_up_to_date() {
    let printed = fastbike(&["schema", "--tire"]);
    assert_eq!((printed.status, printed.stderr.as_str()), (0, ""));
    let committed = fs::read_to_string(evidence("../models/schema/tire.schema.json")).expect("the committed schema");
    assert!(printed.stdout == committed, "out of date; update it: cargo run -- schema --tire > models/schema/tire.schema.json");
}

#[test]
fn every_bundled_tire_names_and_keeps_the_schema() {
    let schema = Schema::new(&motorcycle::tire::law_description::schema()).expect("the schema is a schema");
    let mut seen = 0;
    for file in
        fs::read_dir(evidence("../models/tires")).expect("tires").flatten().filter(|f| f.path().extension().is_some_and(|e| e == "yaml"))
    {
        let (name, text) = (file.file_name().to_string_lossy().into_owned(), fs::read_to_string(file.path()).expect("text"));
        let first = text.lines().next().unwrap_or_default();
        assert_eq!(first, "# yaml-language-server: $schema=../schema/tire.schema.json", "first line of {name}");
        let document = Document::parse(&name, &text).unwrap_or_else(|e| panic!("{e}"));
        let findings = schema.check(&document);
        assert!(findings.is_empty(), "{findings}");
        seen += 1;
    }
    assert!(seen >= 3, "{seen} tires");
}

#[test]
fn the_committed_schema_is_up_to_date() {
    let printed = fastbike(&["schema"]);
    assert_eq!((printed.status, printed.stderr.as_str()), (0, ""));
    assert!(printed.stdout == committed(), "out of date; update it: cargo run -- schema > models/schema/fastbike.schema.json");
}

#[test]
fn every_bundled_description_names_and_keeps_the_schema() {
    let json = serde_json::from_str(&committed()).expect("the schema is JSON");
    let schema = Schema::new(&json).expect("the schema is a schema");
    let mut seen = 0;
    for folder in fs::read_dir(evidence("../models/vehicles")).expect("vehicles").flatten() {
        for file in fs::read_dir(folder.path()).expect("a vehicle").flatten().filter(|f| f.path().extension().is_some_and(|e| e == "yaml"))
        {
            let (name, text) = (file.file_name().to_string_lossy().into_owned(), fs::read_to_string(file.path()).expect("text"));
            let first = text.lines().next().unwrap_or_default();
            assert_eq!(first, "# yaml-language-server: $schema=../../schema/fastbike.schema.json", "first line of {name}");
            let document = Document::parse(&name, &text).unwrap_or_else(|e| panic!("{e}"));
            let findings = schema.check(&document);
            assert!(findings.is_empty(), "{findings}");
            seen += 1;
        }
    }
    assert!(seen >= 3, "{seen} descriptions");
}
