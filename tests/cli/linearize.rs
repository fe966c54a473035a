//! `linearize`: keys, exported files, refusals.

use super::{fastbike, folder, json, keys, number};
use serde_json::Value;
use std::fs;

const LEANING: [&str; 6] = ["linearize", "ref11", "--speed", "30", "--lean", "0.6"];

fn shape(matrix: &Value) -> (usize, usize) {
    let rows = matrix.as_array().map(Vec::as_slice).unwrap_or_default();
    (rows.len(), rows.first().and_then(Value::as_array).map_or(0, Vec::len))
}

fn count(list: &Value) -> usize {
    list.as_array().map_or(0, Vec::len)
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let report = json(&[&LEANING[..], &["--format", "json"]].concat(), 0);
    let (states, inputs, outputs) = (count(&report["states"]), count(&report["inputs"]), count(&report["outputs"]));
    assert_eq!(states, 19);
    assert_eq!(keys(&report["states"][0]), ["name", "unit"]);
    let by = [("E", states, states), ("A", states, states), ("B", states, inputs), ("C", outputs, states), ("D", outputs, inputs)];
    for (letter, rows, columns) in by {
        assert_eq!(shape(&report[letter]), (rows, columns), "{letter}");
        assert_eq!(report[letter], report["points"][0][letter], "{letter}");
    }
    // a road height comes with its rate
    let height = report["inputs"].as_array().into_iter().flatten().find(|i| i["name"] == "front_road.height").expect("road height");
    assert_eq!(height["rate"].as_str(), Some("front_road.height_rate"));
}

#[test]
fn points_of_a_sweep_have_a_model_each() {
    let report = json(&["linearize", "whipple", "--speed", "4..6:1", "--format", "json"], 0);
    assert_eq!(count(&report["points"]), 3);
    for point in report["points"].as_array().into_iter().flatten() {
        assert_eq!(shape(&point["A"]), (5, 5));
    }
    assert!(report.get("A").is_none());
}

#[test]
fn sae_axes_turn_rows_and_columns() {
    let iso = json(&[&LEANING[..], &["--format", "json"]].concat(), 0);
    let sae = json(&[&LEANING[..], &["--format", "json", "--axes", "sae"]].concat(), 0);
    let at = |list: &str, name: &str| iso[list].as_array().and_then(|l| l.iter().position(|s| s["name"] == name)).expect("a name");
    let entry = |report: &Value, row: usize, column: usize| number(&report["B"][row][column]);
    let (roll_rate, steer_rate, torque) = (at("states", "chassis.roll_rate"), at("states", "steer.rate"), at("inputs", "steer.torque"));
    // both the rate and the torque of the steering change sign; the roll rate does not
    assert_eq!(entry(&iso, steer_rate, torque), entry(&sae, steer_rate, torque));
    assert_eq!(entry(&iso, roll_rate, torque), -entry(&sae, roll_rate, torque));
}

/// NumPy's and MATLAB's own readers were tried by hand; here the containers are read as their formats say.
#[test]
fn files_hold_the_matrices() {
    let folder = folder("linearize");
    let report = json(&[&LEANING[..], &["--format", "json"]].concat(), 0);
    let first_row: Vec<u8> = report["A"][0].as_array().into_iter().flatten().flat_map(|v| number(v).to_le_bytes()).collect();
    let first_column: Vec<u8> = report["A"].as_array().into_iter().flatten().flat_map(|row| number(&row[0]).to_le_bytes()).collect();
    let contains = |bytes: &[u8], part: &[u8]| bytes.windows(part.len()).any(|w| w == part);
    for (name, magic, part) in [("ref11.npz", &b"PK\x03\x04"[..], &first_row), ("ref11.mat", b"MATLAB 5.0", &first_column)] {
        let path = folder.join(name);
        let answer = fastbike(&[&LEANING[..], &["--export", &path.display().to_string()]].concat());
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        let bytes = fs::read(&path).expect("the file");
        assert!(bytes.starts_with(magic) && contains(&bytes, part), "{name}");
    }
    let path = folder.join("ref11.json");
    fastbike(&[&LEANING[..], &["--export", &path.display().to_string()]].concat());
    let kept: Value = serde_json::from_str(&fs::read_to_string(&path).expect("the file")).expect("JSON");
    assert_eq!(kept["A"], report["A"]);
}

#[test]
fn a_point_that_is_no_steady_state_is_refused() {
    let report = json(&[&LEANING[..], &["--residual-tolerance", "1e-30", "--format", "json"]].concat(), 1);
    let because = report["points"][0]["refused"].as_str().unwrap_or_default();
    assert!(because.contains("no steady state"), "{because}");
    assert!(report.get("A").is_none());
}

#[test]
fn wrong_files_are_told_before_anything_is_computed() {
    for arguments in [&["--export", "model.xml"][..], &["--export", "model.mat", "--lean", "0..0.4:0.2"], &["--plot", "model.svg"]] {
        let answer = fastbike(&[&["linearize", "ref11", "--speed", "30"][..], arguments].concat());
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}");
    }
}
