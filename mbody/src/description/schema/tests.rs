//! Every message of the schema check.

use super::*;
use crate::description::quantity::dimension::{Angle, Length, Number, Stiffness};
use crate::description::quantity::{Fraction, PositiveQuantity, Quantity};
use proptest::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A machine of elements.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Machine {
    name: String,
    #[serde(default)]
    elements: BTreeMap<String, Element>,
    #[serde(default)]
    lean: Option<Quantity<Angle>>,
    #[serde(default)]
    share: Option<Quantity<Number, Fraction>>,
    #[serde(default)]
    mode: Option<Mode>,
    #[serde(default)]
    table: Option<Table>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[allow(dead_code)]
enum Element {
    SpringDamper(SpringDamper),
    Stop { at: Quantity<Length> },
    Nothing,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct SpringDamper {
    /// Force per compression.
    stiffness: PositiveQuantity<Stiffness>,
    ends: [Quantity<Length>; 2],
    #[serde(default)]
    steps: Vec<u32>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Mode {
    Soft,
    /// With a description.
    Hard,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
#[allow(dead_code)]
enum Table {
    One(Quantity<Length>),
    Many(Vec<Quantity<Length>>),
}

fn check(text: &str) -> Vec<String> {
    let schema = Schema::of::<Machine>().unwrap_or_else(|f| panic!("{f}"));
    let document = Document::parse("f", text).unwrap_or_else(|f| panic!("{f}"));
    let findings = schema.check(&document);
    findings.iter().map(|f| format!("{} | {} | {} | {}", f.code, f.place(), f.message, f.hint.clone().unwrap_or_default())).collect()
}

const GOOD: &str = "name: m\nelements:\n  shock: {spring_damper: {stiffness: 58 kN/m, ends: [0, 30 cm], steps: [1]}}\n  stop: {stop: {at: 3 mm}}\n  \
                    none: nothing\nlean: 24 deg\nshare: 80 %\nmode: soft\ntable: [1 m, 2]\n";

#[test]
fn a_good_document_passes_and_reads() {
    assert_eq!(check(GOOD), Vec::<String>::new());
    let document = Document::parse("f", GOOD).unwrap_or_else(|f| panic!("{f}"));
    let machine = document.read::<Machine>("").unwrap_or_else(|f| panic!("{f}"));
    assert_eq!(machine.lean.map(Quantity::si), Some(24.0 * std::f64::consts::PI / 180.0));
}

#[test]
fn every_mistake_has_its_message() {
    let cases: &[(&str, &str, &str)] = &[
        ("name: m\n", "", "missing_key | f:1:1 | missing key `name` | `name` is a text"),
        ("lean:", "leen:", "unknown_key | f:6:1 (leen) | unknown key `leen` | did you mean `lean`?"),
        ("lean: 24 deg", "lean: 24 mm", "wrong_dimension | f:6:7 (lean) | `24 mm` is a length (m), expected an angle (rad) | "),
        ("lean: 24 deg", "lean: 24", "suspicious_unit | f:6:7 (lean) | 24 rad is 3.8 turns; did you mean `24 deg`? | "),
        ("lean: 24 deg", "lean: [1]", "wrong_type | f:6:1 (lean) | the entry is a list, expected an angle (rad) | "),
        ("lean: 24 deg", "lean: true", "wrong_type | f:6:7 (lean) | `true` is a truth value, expected an angle (rad) | "),
        ("name: m", "name: 3", "wrong_type | f:1:7 (name) | `3` is a number, expected a text | "),
        ("share: 80 %", "share: 180 %", "out_of_range | f:7:8 (share) | `180 %` is out of range: it must be at most 1 | "),
        ("share: 80 %", "share: -0.5", "out_of_range | f:7:8 (share) | `-0.5` is out of range: it must be at least 0 | "),
        (
            "mode: soft",
            "mode: sofd",
            "unknown_value | f:8:7 (mode) | unknown value `sofd`, expected one of `soft`, `hard` | did you mean `soft`?",
        ),
        ("mode: soft", "mode: 3", "wrong_type | f:8:7 (mode) | `3` is a number, expected one of `soft`, `hard` | "),
        ("table: [1 m, 2]", "table: [1 m, 2 s]", "wrong_dimension | f:9:14 (table.1) | `2 s` is a time (s), expected a length (m) | "),
        ("table: [1 m, 2]", "table: {a: 1}", "wrong_type | f:9:1 (table) | the entry is a mapping, expected a length (m) or a list | "),
        ("table: [1 m, 2]", "table: 1 kg", "wrong_dimension | f:9:8 (table) | `1 kg` is a mass (kg), expected a length (m) | "),
        (
            "58 kN/m",
            "-58 kN/m",
            "out_of_range | f:3:38 (elements.shock.spring_damper.stiffness) | `-58 kN/m` is out of range: it must be greater than 0 N/m | ",
        ),
        (
            "58 kN/m",
            "0",
            "out_of_range | f:3:38 (elements.shock.spring_damper.stiffness) | `0` is out of range: it must be greater than 0 N/m | ",
        ),
        (
            "58 kN/m",
            "58 kg",
            "wrong_dimension | f:3:38 (elements.shock.spring_damper.stiffness) | `58 kg` is a mass (kg), expected a stiffness (N/m) | ",
        ),
        (
            "58 kN/m",
            "58 KN/m",
            "unknown_unit | f:3:38 (elements.shock.spring_damper.stiffness) | unknown unit `KN` in `58 KN/m` | did you mean `kN`?",
        ),
        (
            "stiffness:",
            "stifness:",
            "unknown_key | f:3:27 (elements.shock.spring_damper.stifness) | unknown key `stifness` | did you mean `stiffness`?",
        ),
        (
            "stiffness: 58 kN/m, ",
            "",
            "missing_key | f:3:11 (elements.shock.spring_damper) | missing key `stiffness` | `stiffness` is a stiffness (N/m): Force per compression.",
        ),
        ("[0, 30 cm]", "[0, 30 cm, 1]", "wrong_count | f:3:47 (elements.shock.spring_damper.ends) | the list has 3 items, expected 2 | "),
        ("[1]}", "[1.5]}", "wrong_type | f:3:73 (elements.shock.spring_damper.steps.0) | `1.5` is a number, expected a whole number | "),
        (
            "spring_damper",
            "spring_dampr",
            "unknown_kind | f:3:11 (elements.shock.spring_dampr) | unknown kind `spring_dampr` | did you mean `spring_damper`?",
        ),
        (
            "{spring_damper: {stiffness: 58 kN/m, ends: [0, 30 cm], steps: [1]}}",
            "{stiffness: 58 kN/m, ends: [0, 1]}",
            "missing_kind | f:3:3 (elements.shock) | the entry has no kind, expected one of `spring_damper`, `stop` | the parameters belong one level deeper, under their kind: `spring_damper: { stiffness: … }`",
        ),
        ("{stop: {at: 3 mm}}", "{}", "missing_kind | f:4:3 (elements.stop) | the entry has no kind | known here: `spring_damper`, `stop`"),
        (
            "{stop: {at: 3 mm}}",
            "stop",
            "missing_key | f:4:9 (elements.stop) | kind `stop` has no parameters | write `stop: { … }` on a line of its own",
        ),
        (
            "{stop: {at: 3 mm}}",
            "3",
            "wrong_type | f:4:9 (elements.stop) | `3` is a number, expected one of `nothing`, `spring_damper`, `stop` | ",
        ),
        (
            "{stop: {at: 3 mm}}",
            "{stop: {at: 3 mm}, spring_damper: {}}",
            "two_kinds | f:4:3 (elements.stop) | the entry has several kinds at once: `spring_damper`, `stop` | keep one; in an overlay, remove the other with `null`",
        ),
        (
            "none: nothing",
            "none: nothin",
            "unknown_value | f:5:9 (elements.none) | unknown value `nothin`, expected one of `nothing`, `spring_damper`, `stop` | did you mean `nothing`?",
        ),
        (
            "none: nothing",
            "none:",
            "wrong_type | f:5:7 (elements.none) | the entry is empty, expected one of `nothing`, `spring_damper`, `stop` | ",
        ),
    ];
    let mut wrong = Vec::new();
    for (from, to, expected) in cases {
        assert!(GOOD.contains(from), "{from}");
        let found = check(&GOOD.replacen(from, to, 1));
        if found != [*expected] {
            wrong.push(format!("expected {expected}\nfound    {}", found.join("\n         ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_mistake_is_reported_in_the_order_of_the_text() {
    let text = "nam: m\nelements:\n  a: {spring_damper: {stiffness: -1, ends: [1], x: 2}}\n  b: {stopp: {}}\nlean: 3 s\n";
    let codes: Vec<String> = check(text).iter().map(|line| line.split(" | ").take(2).collect::<Vec<_>>().join(" ")).collect();
    let expected = [
        "unknown_key f:1:1 (nam)",
        "out_of_range f:3:34 (elements.a.spring_damper.stiffness)",
        "wrong_count f:3:38 (elements.a.spring_damper.ends)",
        "unknown_key f:3:49 (elements.a.spring_damper.x)",
        "unknown_kind f:4:7 (elements.b.stopp)",
        "wrong_dimension f:5:7 (lean)",
    ];
    assert_eq!(codes, expected);
}

#[test]
fn a_schema_with_an_unknown_unit_is_refused() {
    let code = |schema: Value| Schema::new(&schema).map(|_| ()).map_err(|f| f.iter().map(|f| f.code).collect::<Vec<_>>());
    assert_eq!(code(serde_json::json!({ "quantity": "furlong" })), Err(vec!["bad_schema"]));
    assert_eq!(code(serde_json::json!({ "type": 3 })), Err(vec!["bad_schema"]));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_text_makes_it_panic(start in 0..GOOD.len(), length in 0_usize..20, insert in "[\\[\\]{}:,a-z0-9 .-]{0,8}") {
        let end = (start + length).min(GOOD.len());
        let schema = Schema::of::<Machine>().unwrap_or_else(|f| panic!("{f}"));
        if let Ok(document) = Document::parse("f", &format!("{}{insert}{}", &GOOD[..start], &GOOD[end..])) {
            let findings = schema.check(&document);
            // what the schema lets pass can be read
            prop_assert!(findings.has_errors() || document.read::<Machine>("").is_ok());
        }
    }
}
