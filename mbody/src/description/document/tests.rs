//! What documents know and say.

use super::*;
use proptest::prelude::*;
use serde_json::json;

const PLANT: &str = "name: plant\nelements:\n  shock:\n    spring_damper:\n      stiffness: 58 kN/m\n      points: [[0, 0, 1], [0, 0, 2]]\n  \
                     stay: {bushing: {stiffness: 1e6}}\ngiven: {shock.length: 0.3}\n";

fn plant() -> Document {
    match Document::parse("plant.yaml", PLANT) {
        Ok(document) => document,
        Err(findings) => panic!("{findings}"),
    }
}

fn said(text: &str) -> String {
    match Document::parse("f", text) {
        Ok(_) => "fine".to_string(),
        Err(findings) => {
            let lines =
                findings.iter().map(|f| format!("{} | {} | {} | {}", f.code, f.place(), f.message, f.hint.clone().unwrap_or_default()));
            lines.collect::<Vec<_>>().join("\n")
        }
    }
}

#[test]
fn every_entry_knows_its_place() {
    let document = plant();
    let place = |path: &str| document.finding(path, "x", "y").place();
    assert_eq!(place("elements.shock.spring_damper.stiffness"), "plant.yaml:5:18 (elements.shock.spring_damper.stiffness)");
    assert_eq!(place("elements.shock.spring_damper"), "plant.yaml:4:5 (elements.shock.spring_damper)");
    assert_eq!(place("elements.shock.spring_damper.points.1.2"), "plant.yaml:6:34 (elements.shock.spring_damper.points.1.2)");
    assert_eq!(place("given.shock.length"), "plant.yaml:8:23 (given.shock.length)");
    assert_eq!(document.finding("elements.stay", "x", "y").excerpt.as_deref(), Some("stay: {bushing: {stiffness: 1e6}}"));
    // what is not there is placed at what is around it
    assert_eq!(place("elements.shock.spring_damper.damping"), "plant.yaml:4:5 (elements.shock.spring_damper.damping)");
    assert_eq!(place("nowhere.at.all"), "plant.yaml:1:1 (nowhere.at.all)");
}

#[test]
fn section_and_tag_may_be_left_out() {
    let document = plant();
    assert_eq!(document.get("shock.stiffness"), Some(&json!("58 kN/m")));
    assert_eq!(document.get("elements.stay.stiffness"), Some(&json!(1e6)));
    assert_eq!(document.get("shock.points.1.2"), Some(&json!(2)));
    assert_eq!(document.get("shock.length"), Some(&json!(0.3)));
    let paths = document.paths();
    assert!(paths.contains(&"shock.stiffness".to_string()) && paths.contains(&"name".to_string()), "{paths:?}");
    assert!(paths.iter().all(|p| document.get(p).is_some()), "{paths:?}");
}

#[test]
fn reads_parts_into_types() {
    let document = plant();
    assert_eq!(document.read::<Vec<[f64; 3]>>("shock.points"), Ok(vec![[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]));
    let wrong = document.read::<HashMap<String, f64>>("elements.shock.spring_damper").map_err(|f| f.to_string());
    let text = "error[invalid_entry]: invalid type: string \"58 kN/m\", expected f64\n  --> plant.yaml:5:18 \
                (elements.shock.spring_damper.stiffness)\n    5 | stiffness: 58 kN/m\n      |            ^";
    assert_eq!(wrong, Err(text.to_string()));
}

#[test]
fn mistakes_of_writing_have_messages() {
    let cases = [
        ("a: 1\nb:\n\tc: 2\n", "bad_yaml | f:3:2 | a tab is used for indentation | indent with blanks"),
        (
            "a: 1\n  b: 2\n",
            "bad_yaml | f:2:4 | a `:` stands where no entry can begin | check the indentation of this line and of the one before; \
             a text with `: ` in it needs quotes",
        ),
        ("a: [1, 2\nb: 3\n", "bad_yaml | f:2:2 | a `:` stands where no entry can begin | is a `]` or `}` missing before it?"),
        (
            "a:\n  - 1\n - 2\n",
            "bad_yaml | f:3:2 | this line is not indented like the ones it belongs to | entries that belong together begin in the same column",
        ),
        (
            "- a\nb: 1\n",
            "bad_yaml | f:2:1 | a list goes on without `-` | items begin with `- ` at one indentation; names do not mix with them",
        ),
        ("a: 'x\n", "bad_yaml | f:1:4 | a quotation mark is not closed | texts in quotes end on `\"` or `'`"),
        ("a: @x\n", "bad_yaml | f:1:4 | a text cannot begin with this character | put it in quotes"),
        (
            "a: *x\n",
            "bad_yaml | f:1:4 | there is no anchor of this name before this line | an anchor `&name` comes before its alias `*name`",
        ),
        ("a: 1\nb: 2\nstiffness\n", "bad_yaml | f:4:1 | an entry has no `:` | write `name: value`"),
        ("a: 1\n---\nb: 2\n", "bad_yaml | f:2:1 | a second document begins here, expected one | "),
        ("a: !x 1\n", "bad_yaml | f:1:4 (a) | tags with `!` are not used here | put a text that begins with `!` in quotes"),
        ("a: 1\nb: 2\na: 3\n", "duplicate_key | f:3:1 (a) | `a` stands here twice | the first one is on line 1"),
        ("a: .nan\n", "bad_number | f:1:4 (a) | `.nan` is not a finite number | "),
        ("a: {1: 2}\n", "bad_key | f:1:5 (a) | `1` stands where a name belongs | put it in quotes to use it as a name"),
        ("? [1, {b: 2}]\n: 3\n", "bad_key | f:1:3 | a list or mapping stands where a name belongs | "),
    ];
    for (text, expected) in cases {
        assert_eq!(said(text), expected, "{text}");
    }
    assert!(said(&"[".repeat(100_000)).starts_with("bad_yaml"));
    assert!(said(&"{a: ".repeat(100_000)).starts_with("bad_yaml"));
}

#[test]
fn several_mistakes_are_reported_at_once() {
    assert_eq!(said("a: 1\na: 2\nb: .inf\nc: !x 1\n").lines().count(), 3);
}

#[test]
fn anchors_keep_the_place_of_the_original() {
    let text = "base: &base\n  k: 1\n  c: 2\nx: *base\ny:\n  <<: *base\n  c: 3\n";
    let Ok(document) = Document::parse("f", text) else { panic!("{}", said(text)) };
    assert_eq!(document.value()["y"], json!({"c": 3, "k": 1}));
    let place = |path: &str| document.finding(path, "x", "y").place();
    assert_eq!((place("x.k"), place("y.k"), place("y.c")), ("f:2:6 (x.k)".into(), "f:2:6 (y.k)".into(), "f:7:6 (y.c)".into()));
}

#[test]
fn aliases_of_aliases_do_not_fill_the_memory() {
    let mut text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n".to_string();
    for k in 1..12 {
        let before = format!("*a{}, ", k - 1).repeat(9);
        text.push_str(&format!("a{k}: &a{k} [{before}]\n"));
    }
    assert!(said(&text).starts_with("bad_yaml"));
}

#[test]
fn entries_can_be_set() {
    let mut document = plant();
    let set =
        [("shock.stiffness", "60 kN/m"), ("shock.damping", "1.5e3"), ("elements.shock.points.0", "[1, 2, 3]"), ("stay.stiffness", "")];
    for (path, text) in set {
        assert_eq!(document.set(path, text), Ok(()), "{path}");
    }
    let expected = json!({"shock": {"spring_damper": {"stiffness": "60 kN/m", "points": [[1, 2, 3], [0, 0, 2]], "damping": 1500.0}},
                          "stay": {"bushing": {}}});
    assert_eq!(document.value()["elements"], expected);
    let found = document.finding("elements.shock.spring_damper.stiffness", "x", "too soft");
    assert_eq!(found.place(), "shock.stiffness=60 kN/m (elements.shock.spring_damper.stiffness)");
}

#[test]
fn setting_what_is_not_there_names_the_nearest_path() {
    let mut document = plant();
    let said = document.set("shok.stiffness", "1").map_err(|f| f.to_string());
    let text = "error[unknown_path]: there is no entry `shok.stiffness` in `plant.yaml`\n  --> shok.stiffness\n   hint: did you mean `shock.stiffness`?";
    assert_eq!(said, Err(text.to_string()));
    assert!(document.set("title", "1").is_err());
    assert!(document.set("name.x", "1").is_err());
}

#[test]
fn overlays_join_replace_and_remove() {
    let mut document = plant();
    let text = "elements:\n  shock: {spring_damper: {stiffness: 70 kN/m, points: null}}\n  new: {bushing: {}}\n";
    match Document::parse("over.yaml", text) {
        Ok(overlay) => document.merge(overlay, &[]),
        Err(findings) => panic!("{findings}"),
    }
    let expected =
        json!({"shock": {"spring_damper": {"stiffness": "70 kN/m"}}, "stay": {"bushing": {"stiffness": 1e6}}, "new": {"bushing": {}}});
    assert_eq!(document.value()["elements"], expected);
    let place = |path: &str| document.finding(path, "x", "y").place();
    assert_eq!(place("elements.shock.spring_damper.stiffness"), "over.yaml:2:38 (elements.shock.spring_damper.stiffness)");
    assert_eq!(place("elements.stay.bushing.stiffness"), "plant.yaml:7:31 (elements.stay.bushing.stiffness)");
    assert_eq!(place("elements.new"), "over.yaml:3:3 (elements.new)");
    assert_eq!(place("elements.shock"), "plant.yaml:3:3 (elements.shock)");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_text_makes_it_panic(start in 0..PLANT.len(), length in 0_usize..20, insert in "[\\[\\]{}:,&*!?<|>'\"a-z0-9 .\n\t~/-]{0,12}") {
        let end = (start + length).min(PLANT.len());
        let text = format!("{}{insert}{}", &PLANT[..start], &PLANT[end..]);
        match Document::parse("f", &text) {
            Ok(mut document) => {
                let _ = document.set(&insert, "1");
                let _ = document.finding(&insert, "x", "y");
                let _ = document.paths();
            }
            Err(findings) => prop_assert!(findings.has_errors()),
        }
    }
}
