//! `dynamics` against the numbers of an independent code, for mechanisms given as plain URDF.
//!
//! Source of the numbers: see `generator` in each file of `reference/mechanisms`.

use super::{evidence, fastbike, folder, json, keys, number};
use serde_json::{Value, json as object};
use std::fs;

/// Both codes compute in double precision; the worst mass matrices here have a condition of some thousands.
const RELATIVE: f64 = 1e-10;

/// Mechanism, and whether its root is free.
const MECHANISMS: [(&str, bool); 6] = [
    ("double_pendulum_3d", false),
    ("prismatic_revolute_chain", false),
    ("branched_tree", false),
    ("welded_tree", false),
    ("mimic_chain", false),
    ("free_floating_tree", true),
];

fn reference(name: &str) -> Value {
    let text = fs::read_to_string(evidence(&format!("reference/mechanisms/{name}.json"))).expect("a reference");
    serde_json::from_str(&text).expect("a reference is JSON")
}

fn urdf(name: &str) -> String {
    evidence(&format!("reference/mechanisms/{name}.urdf")).display().to_string()
}

/// Names of the joints without the base.
fn joints(reference: &Value) -> Vec<String> {
    let names = reference["v_names"].as_array().expect("names").iter().filter_map(Value::as_str);
    names.filter(|n| !n.starts_with("base.")).map(str::to_owned).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![number(other)],
    }
}

/// Compares in units of the largest number.
fn assert_same(ours: &Value, theirs: &Value, what: &str) {
    let (ours, theirs) = (numbers(ours), numbers(theirs));
    assert_eq!(ours.len(), theirs.len(), "{what}");
    let scale = theirs.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    let worst = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
    assert!(worst < RELATIVE, "{what} is off by {worst:.1e}:\n{ours:?}\n{theirs:?}");
}

fn states(reference: &Value) -> Vec<Value> {
    let states = reference["states"].as_array().expect("states").iter();
    states.map(|s| object!({ "q": s["q"], "v": s["v"], "a": s["a"], "tau": s["tau_in"] })).collect()
}

fn run(test: &str, name: &str, floating: bool, input: &Value) -> Value {
    let file = folder(&format!("dynamics_{test}_{name}")).join("state.json");
    fs::write(&file, input.to_string()).expect("a file can be written");
    let (urdf, file) = (urdf(name), file.display().to_string());
    let mut arguments = vec!["dynamics", &urdf, "--state", &file];
    arguments.extend(floating.then_some("--floating"));
    json(&arguments, 0)
}

#[test]
fn numbers_are_those_of_the_reference() {
    for (name, floating) in MECHANISMS {
        let reference = reference(name);
        let report = run("reference", name, floating, &object!({ "order": joints(&reference), "states": states(&reference) }));
        let results = report["states"].as_array().expect("states");
        let expected = reference["states"].as_array().expect("states");
        assert_eq!(results.len(), expected.len());
        for (ours, theirs) in results.iter().zip(expected) {
            let pairs = [
                ("inverse_dynamics", "tau_rnea"),
                ("forward_dynamics", "a_aba"),
                ("mass_matrix", "mass_matrix"),
                ("kinetic_energy", "kinetic_energy"),
                ("potential_energy", "potential_energy"),
                ("center_of_mass", "com"),
            ];
            for (key, other) in pairs {
                assert_same(&ours[key], &theirs[other], &format!("`{key}` of {name}"));
            }
            for (link, pose) in theirs["links"].as_object().expect("links") {
                for key in ["position", "rotation"] {
                    assert_same(&ours["poses"][link][key], &pose[key], &format!("`{key}` of `{link}` of {name}"));
                }
            }
        }
    }
}

#[test]
fn the_order_is_that_of_the_file() {
    let name = "prismatic_revolute_chain";
    let reference = reference(name);
    let forward = joints(&reference);
    let backward: Vec<&String> = forward.iter().rev().collect();
    let reversed = |v: &Value| Value::Array(v.as_array().into_iter().flatten().rev().cloned().collect());
    let turned =
        states(&reference).into_iter().map(|s| object!({ "q": reversed(&s["q"]), "v": reversed(&s["v"]), "a": reversed(&s["a"]) }));
    let report = run("order", name, false, &object!({ "order": backward, "states": turned.collect::<Vec<_>>() }));
    assert_eq!(report["order"], object!(backward));
    for (ours, theirs) in report["states"].as_array().into_iter().flatten().zip(reference["states"].as_array().into_iter().flatten()) {
        assert_same(&reversed(&ours["inverse_dynamics"]), &theirs["tau_rnea"], "inverse dynamics in reverse order");
        let columns = ours["mass_matrix"].as_array().into_iter().flatten().rev().map(reversed).collect();
        assert_same(&Value::Array(columns), &theirs["mass_matrix"], "mass matrix in reverse order");
    }
}

#[test]
fn keys_are_those_of_the_contract() {
    let reference = reference("double_pendulum_3d");
    let report = run("keys", "double_pendulum_3d", false, &object!({ "states": states(&reference)[..1] }));
    assert_eq!(keys(&report), ["fastbike", "command", "model", "order", "states", "warnings"]);
    assert_eq!(report["order"], object!(["shoulder", "elbow"]));
    let wanted = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "kinetic_energy", "potential_energy", "center_of_mass"];
    for key in wanted {
        assert!(report["states"][0].get(key).is_some(), "`{key}` is missing");
    }
}

/// At rest and without applied forces a tree falls freely; without gravity it stays.
#[test]
fn gravity_is_an_option() {
    let file = folder("dynamics_gravity").join("state.json");
    fs::write(&file, r#"{ "states": [ { "q": [0.1, 0.2] } ] }"#).expect("a file can be written");
    let (urdf, file) = (urdf("double_pendulum_3d"), file.display().to_string());
    let report = json(&["dynamics", &urdf, "--state", &file, "--gravity", "0"], 0);
    assert_eq!(numbers(&report["states"][0]["inverse_dynamics"]), [0.0, 0.0]);
    let moon = json(&["dynamics", &urdf, "--state", &file, "--gravity", "1.62 m/s^2"], 0);
    let earth = json(&["dynamics", &urdf, "--state", &file], 0);
    let ratio = number(&earth["states"][0]["inverse_dynamics"][0]) / number(&moon["states"][0]["inverse_dynamics"][0]);
    assert!((ratio - 9.81 / 1.62).abs() < 1e-12, "{ratio}");
    assert_eq!(fastbike(&["dynamics", &urdf, "--state", &file, "--gravity", "9.81 kg"]).status, 2);
}
