//! `run` with recorded rides: a path from a file, a record repeated; roads and inputs of maneuvers.

use super::{fastbike, folder, json, number};
use serde_json::Value;
use std::fs;

fn column(report: &Value, name: &str) -> Vec<f64> {
    report["signals"][name].as_array().unwrap_or_else(|| panic!("`{name}` is missing")).iter().map(number).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

#[test]
fn a_record_is_repeated_and_its_path_is_ridden_again() {
    let folder = folder("replay");
    let recorded = fastbike(&["run", "ref11", "lane_change", "--format", "csv"]);
    assert_eq!((recorded.status, recorded.stderr.as_str()), (0, ""));
    fs::write(folder.join("ride.csv"), &recorded.stdout).expect("a file");
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        fs::write(&file, format!("maneuver: 1\nname: again\nspeed: 25 m/s\npath: [{{ through_points: {{ file: ride.csv }} }}]\n{text}"))
            .expect("a file");
        file.display().to_string()
    };
    let (path, replay) = (write("path.yaml", ""), write("replay.yaml", "replay: { file: ride.csv, gain: 0.2 }\n"));
    let first = json(&["run", "ref11", "lane_change", "--format", "json"], 0);
    let path = json(&["run", "ref11", &path, "--format", "json"], 0);
    assert_eq!(path["ending"].as_str(), Some("end_of_path"), "{}", path["because"]);
    assert!(largest(&column(&path, "rider.path_error")) < 0.2);
    let (ends, ended) = (column(&path, "chassis.y"), column(&first, "chassis.y"));
    assert!((ends[ends.len() - 1] - ended[ended.len() - 1]).abs() < 0.02, "{:?} {:?}", ends.last(), ended.last());
    let again = json(&["run", "ref11", &replay, "--format", "json"], 0);
    assert_eq!(again["ending"].as_str(), Some("reached"), "{}", again["because"]);
    // where it was a moment before the end, which is no whole sample
    for (name, allowed) in [("chassis.y", 0.01), ("chassis.roll", 2e-3), ("steer.torque", 0.2)] {
        let (now, then) = (column(&again, name), column(&first, name));
        let apart = (0..now.len().min(then.len()) - 2).map(|k| (now[k] - then[k]).abs()).fold(0.0, f64::max);
        assert!(apart < allowed, "{name}: {apart}");
    }
}

#[test]
fn roads_and_inputs_act_and_what_is_wrong_is_said() {
    let gust = json(&["run", "gsxr1000", "side_gust", "--format", "json"], 0);
    let wind = column(&gust, "wind.lateral");
    assert!((largest(&wind) - 10.0).abs() < 1e-2 && wind[0] == 0.0);
    assert!(largest(&column(&gust, "chassis.roll")) > 1e-3 && largest(&column(&gust, "rider.path_error")) < 0.5);
    let bump = json(&["run", "gsxr1000", "bump", "--change", "road.cosine_bump.height=5mm", "--format", "json"], 0);
    let height = column(&bump, "rear_road.height");
    assert!((largest(&height) - 5e-3).abs() < 5e-4, "{}", largest(&height));
    for (arguments, status, words) in [
        (&["run", "whipple", "bump", "--change", "speed=5"][..], 2, "`front_road.height`"),
        (&["run", "ref11", "side_gust", "--change", "inputs.0.input=wind.latral"], 2, "`wind.lateral`"),
        (&["run", "ref11", "side_gust", "--change", "inputs.0.pulse.peak=3 N"], 2, "expected a speed"),
        (&["run", "ref11", "side_gust", "--change", "inputs.0.input=steer.torque"], 2, "rider or road command it"),
    ] {
        let answer = fastbike(arguments);
        assert_eq!(answer.status, status, "{arguments:?}: {}", answer.stderr);
        assert!(answer.stderr.contains(words), "{arguments:?}: {}", answer.stderr);
    }
}
