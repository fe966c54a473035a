//! `trim`: formats, axes, sweeps, the run folder.

use super::{fastbike, folder, json, keys, number};
use serde_json::Value;
use std::fs;

const CORNER: [&str; 6] = ["trim", "ref11", "--speed", "30", "--lean", "0.6"];

fn corner(more: &[&str]) -> Vec<&'static str> {
    // arguments live as long as the test
    CORNER.into_iter().chain(more.iter().map(|s| &*Box::leak((*s).to_owned().into_boxed_str()))).collect()
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let report = json(&corner(&["--format", "json"]), 0);
    for key in ["fastbike", "command", "model", "units", "points", "warnings"] {
        assert!(report.get(key).is_some(), "`{key}` is missing");
    }
    assert_eq!((report["command"].as_str(), report["model"].as_str()), (Some("trim"), Some("ref11")));
    assert_eq!((report["units"]["chassis.roll"].as_str(), report["units"]["steer.torque"].as_str()), (Some("rad"), Some("N m")));
    let point = &report["points"][0];
    assert_eq!(keys(point), ["given", "ending", "iterations", "residual", "signals"]);
    assert_eq!((number(&point["given"]["speed"]), number(&point["given"]["lean"])), (30.0, 0.6));
    assert_eq!(point["ending"].as_str(), Some("reached"));
    assert!(number(&point["residual"]) < 1e-9 && point["iterations"].is_u64());
    assert_eq!(keys(&point["signals"]), keys(&report["units"]));
    assert!((number(&point["signals"]["chassis.roll"]) - 0.6).abs() < 1e-12);
    assert!((number(&point["signals"]["chassis.forward_speed"]) - 30.0).abs() < 1e-12);
    // a lean to the right is a turn to the right
    assert!(number(&point["signals"]["lateral_acceleration"]) < 0.0 && number(&point["signals"]["chassis.yaw_rate"]) < 0.0);
}

#[test]
fn the_three_formats_tell_the_same() {
    let report = json(&corner(&["--format", "json"]), 0);
    let signals = &report["points"][0]["signals"];
    let csv = fastbike(&corner(&["--format", "csv"])).stdout;
    let mut lines = csv.lines();
    let (names, values) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    assert!(names.starts_with("given.speed,given.lean,ending,iterations,residual,"), "{names}");
    let mut compared = 0;
    for (name, value) in names.split(',').zip(values.split(',')) {
        if let Some(expected) = signals.get(name) {
            assert_eq!(value.parse::<f64>().ok(), expected.as_f64(), "{name}");
            compared += 1;
        }
    }
    assert_eq!(compared, keys(signals).len());
    // the table: element, then quantity, number and unit; six digits, angles in degrees
    let table = fastbike(&corner(&[])).stdout;
    assert!(table.starts_with("trim ref11\nISO: x forward, y left, z up; lean > 0 to the right"), "{table}");
    let (mut element, mut compared) = ("", 0);
    for line in table.lines().skip(5) {
        let mut words = line.split_whitespace();
        match (line.starts_with(' '), words.next(), words.next().and_then(|w| w.parse::<f64>().ok())) {
            (false, Some(name), None) => element = name,
            (_, Some(quantity), Some(shown)) => {
                let Some(exact) = signals.get(format!("{element}.{quantity}")).and_then(Value::as_f64) else { continue };
                let shown = if words.next() == Some("deg") { shown.to_radians() } else { shown };
                assert!((shown - exact).abs() <= 1e-5 * exact.abs() + 1e-12, "{element}.{quantity}: {shown} {exact}");
                compared += 1;
            }
            _ => {}
        }
    }
    assert!(compared > 40, "only {compared} rows were compared\n{table}");
}

#[test]
fn sae_axes_turn_what_points_left_or_up() {
    let (iso, sae) = (json(&corner(&["--format", "json"]), 0), json(&corner(&["--format", "json", "--axes", "sae"]), 0));
    let value = |report: &Value, name: &str| number(&report["points"][0]["signals"][name]);
    let mut turned = Vec::new();
    for name in keys(&iso["units"]) {
        let (a, b) = (value(&iso, name), value(&sae, name));
        assert_eq!(a.abs(), b.abs(), "{name}");
        turned.extend((a != b).then_some(name));
    }
    for name in
        ["steer.angle", "steer.torque", "chassis.yaw_rate", "chassis.pitch", "rear_tire.lateral_force", "curvature", "lateral_acceleration"]
    {
        assert!(turned.contains(&name), "{name}");
    }
    for name in ["chassis.roll", "chassis.forward_speed", "fork.travel", "rear_tire.normal_force", "steer.torque_normalized"] {
        assert!(!turned.contains(&name), "{name}");
    }
    let table = fastbike(&corner(&["--axes", "sae"])).stdout;
    assert!(table.contains("SAE: x forward, y right, z down"), "{table}");
}

#[test]
fn signs_are_those_of_the_contract() {
    let right = json(&["trim", "ref11", "--speed", "30", "--lateral-acceleration", "-5", "--format", "json"], 0);
    let signals = &right["points"][0]["signals"];
    assert!((number(&signals["lateral_acceleration"]) + 5.0).abs() < 1e-8);
    assert!(number(&signals["chassis.roll"]) > 0.4);
    // the same turn by its curvature, radius and yaw rate
    let roll = number(&signals["chassis.roll"]);
    for (option, value) in [("--curvature", -5.0 / 900.0), ("--radius", -180.0), ("--yaw-rate", -5.0 / 30.0)] {
        let same = json(&["trim", "ref11", "--speed", "108km/h", option, &value.to_string(), "--format", "json"], 0);
        let other = number(&same["points"][0]["signals"]["chassis.roll"]);
        // different conditions, each converged to a scaled residual of 1e-10
        assert!((other - roll).abs() < 1e-8, "{option}: {other} {roll}");
    }
}

#[test]
fn a_sweep_goes_on_past_an_infeasible_point() {
    let report = json(&["trim", "gsxr1000", "--speed", "30,100,40", "--format", "json"], 0);
    let endings: Vec<_> = report["points"].as_array().into_iter().flatten().map(|p| p["ending"].as_str().unwrap_or_default()).collect();
    assert_eq!(endings, ["reached", "engine_limit", "reached"]);
    let limit = &report["points"][1]["limit"];
    assert_eq!(limit["signal"].as_str(), Some("engine.torque_margin"));
    assert!(number(&limit["value"]) < number(&limit["threshold"]));
    let table = fastbike(&["trim", "gsxr1000", "--speed", "30,100,40"]);
    assert_eq!(table.status, 0);
    assert!(table.stdout.contains("2 of 3 points reached"), "{}", table.stdout);
}

#[test]
fn a_sweep_without_a_single_feasible_point_ends_with_one() {
    let report = json(&["trim", "gsxr1000", "--speed", "100,110", "--format", "json"], 1);
    assert_eq!(report["points"].as_array().map(Vec::len), Some(2));
    assert!(report["points"][0]["ending"].as_str() == Some("engine_limit"));
}

#[test]
fn both_backends_find_the_same() {
    let (kinsol, newton) = (json(&corner(&["--format", "json"]), 0), json(&corner(&["--format", "json", "--backend", "newton"]), 0));
    for name in keys(&kinsol["units"]) {
        let value = |report: &Value| number(&report["points"][0]["signals"][name]);
        let (a, b) = (value(&kinsol), value(&newton));
        // residuals of 1e-10 of forces of some thousand newtons
        assert!((a - b).abs() <= 1e-7 * a.abs().max(1.0), "{name}: {a} {b}");
    }
}

#[test]
fn the_run_folder_holds_what_is_needed_to_repeat_the_run() {
    let folder = folder("run");
    let (out, figure) = (folder.join("kept"), folder.join("lean.svg"));
    let (out_text, figure_text) = (out.display().to_string(), figure.display().to_string());
    let set = "front_tire.radius=0.301m";
    let arguments = ["trim", "ref11", "--speed", "20..30:5", "--set", set, "--out", &out_text, "--plot", &figure_text];
    let answer = fastbike(&arguments);
    assert_eq!(answer.status, 0, "{}", answer.stderr);
    assert!(fs::read_to_string(&figure).is_ok_and(|text| text.starts_with("<svg")));
    let run: Value = serde_json::from_str(&fs::read_to_string(out.join("run.json")).expect("run.json")).expect("JSON");
    assert_eq!(run["arguments"], serde_json::json!(arguments));
    assert_eq!((run["model"].as_str(), run["set"][0].as_str()), (Some("ref11"), Some(set)));
    let inputs: Vec<_> = run["inputs"].as_array().into_iter().flatten().map(|i| i["file"].as_str().unwrap_or_default()).collect();
    assert_eq!(inputs, ["ref11.yaml", "ref11.urdf"]);
    assert_eq!(number(&run["statistics"]["points"]), 3.0);
    let results: Value = serde_json::from_str(&fs::read_to_string(out.join("results.json")).expect("results.json")).expect("JSON");
    assert_eq!(results["points"].as_array().map(Vec::len), Some(3));
    assert_eq!(fs::read_to_string(out.join("results.csv")).expect("results.csv").lines().count(), 4);
    assert!(fs::read(out.join("figure.png")).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG")));
}

#[test]
fn what_was_computed_is_told_where_the_folder_cannot_be_written() {
    let file = folder("unwritable").join("file");
    fs::write(&file, "in the way").expect("a file can be written");
    let out = file.join("below").display().to_string();
    let answer = fastbike(&corner(&["--out", &out]));
    assert_eq!(answer.status, 1);
    assert!(answer.stdout.contains("ending: reached") && answer.stderr.contains("could not be written"), "{}", answer.stderr);
}

#[test]
fn reactions_of_joints_are_signals_on_request() {
    let plain = json(&["trim", "gsxr1000", "--format", "json"], 0);
    assert!(plain["units"].get("front_wheel.force_z").is_none());
    let report = json(&["trim", "gsxr1000", "--reactions", "--format", "json"], 0);
    assert_eq!(
        (report["units"]["front_wheel.force_z"].as_str(), report["units"]["front_wheel.moment_y"].as_str()),
        (Some("N"), Some("N m"))
    );
    let signals = &report["points"][0]["signals"];
    let get = |name: &str| number(&signals[name]);
    // at rest the axle presses the wheel down with what the road carries less its own weight, 11.9 kg
    assert!((get("front_wheel.force_z") + get("front_tire.normal_force") - 11.9 * 9.81).abs() < 1e-6);
    assert!(get("front_wheel.force_y").abs() < 1e-6 && get("front_wheel.moment_x").abs() < 1e-6);
}
