//! `setup`: formats, figures, poses, bad input.

use super::{fastbike, folder, json, keys, number};
use std::fs;

#[test]
fn table_says_what_does_not_apply() {
    let table = fastbike(&["setup", "whipple"]);
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    assert!(table.stdout.contains("front suspension left out: no joint lets the wheel move"), "{}", table.stdout);
    let full = fastbike(&["setup", "gsxr1000"]).stdout;
    for word in ["rake", "normal trail", "wheel rate", "squat ratio", "anti dive", "rider_upper", "kN/m"] {
        assert!(full.contains(word), "{word}: {full}");
    }
}

#[test]
fn json_and_csv_hold_the_curves() {
    let report = json(&["setup", "gsxr1000", "--format", "json"], 0);
    assert_eq!(keys(&report)[..4], ["fastbike", "command", "model", "given"]);
    let curve = &report["suspensions"]["rear"]["curve"];
    let travel = curve["travel"].as_array().map_or(0, Vec::len);
    assert!(travel > 30 && curve["springs"]["rear_shock"]["motion_ratio"].as_array().map_or(0, Vec::len) == travel, "{curve}");
    let csv = fastbike(&["setup", "gsxr1000", "--format", "csv"]).stdout;
    assert!(csv.starts_with("group,name,travel,unit,value\ngeometry,rake,,rad,0.41"), "{csv}");
}

/// In a steady acceleration the chain pulls with the thrust that the report says.
#[test]
fn the_pose_is_a_steady_state() {
    let report = json(&["setup", "gsxr1000", "--speed", "30", "--acceleration", "3", "--format", "json"], 0);
    let tension = number(&report["forces"]["chain.upper_tension"]) - number(&report["forces"]["chain.lower_tension"]);
    assert!((tension * 0.10622 - number(&report["forces"]["drive.torque"])).abs() < 1e-6);
    assert_eq!(number(&report["given"]["speed"]), 30.0);
    let still = json(&["setup", "gsxr1000", "--format", "json"], 0);
    let sag = |report: &serde_json::Value| number(&report["suspensions"]["front"]["sag"]);
    assert!(sag(&report) < sag(&still) - 5e-3, "{} {}", sag(&report), sag(&still));
}

/// In a turn the fork keeps its rake, and what belongs to straight running is left out.
#[test]
fn a_turn_has_no_squat() {
    let report = json(&["setup", "gsxr1000", "--speed", "30", "--lean", "40deg", "--format", "json"], 0);
    assert!((number(&report["geometry"]["rake"]) - 0.4189).abs() < 0.02, "{}", report["geometry"]);
    assert!(report["pull"]["squat_angle"].is_null() && report["left_out"].to_string().contains("straight running"));
}

#[test]
fn figures_are_drawn() {
    let folder = folder("setup");
    let [side, curves] = ["side.svg", "curves.svg"].map(|name| folder.join(name).display().to_string());
    assert_eq!(fastbike(&["setup", "gsxr1000", "--plot", &side, "--curves", &curves]).status, 0);
    let text = fs::read_to_string(&side).expect("the side view");
    assert!(text.contains("squat line") && text.contains("trail 96.5 mm"), "{text}");
    assert!(fs::read_to_string(&curves).expect("the curves").contains("motion ratio"));
    assert_eq!(fastbike(&["setup", "whipple", "--plot", &side]).status, 0);
}

#[test]
fn bad_input_is_refused() {
    for (arguments, expected) in [
        (&["setup", "gsxr1000", "--speed", "10..30:10"][..], "one steady state"),
        (&["setup", "gsxr1000", "--speed", "20", "--grade", "5%"], "level road"),
        (&["setup", "gsxr1000", "--curves", "travel.pdf"], "ends in `.svg` or `.png`"),
        (&["setup", "whipple", "--curves", "travel.svg"], "no axle of this vehicle is sprung"),
        (&["setup", "pendulum"], "needs a vehicle"),
        (&["setup", "gsxr1000", "--given", "chasis.roll=0"], "chassis.roll"),
    ] {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}: {}", answer.stderr);
        assert!(answer.stderr.contains(expected), "{arguments:?}: {}", answer.stderr);
    }
}
