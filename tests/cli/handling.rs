//! `handling`: indices of steady turns and of rides, formats, figure, bad input.

use super::{fastbike, folder, json, number};
use std::fs;

const TURNS: [&str; 5] = ["handling", "ref11", "--speed", "15,30", "--no-rides"];

fn with<'a>(first: &[&'a str], rest: &[&'a str]) -> Vec<&'a str> {
    [first, rest].concat()
}

/// The indices are quotients of what `trim` finds in the same turn.
#[test]
fn indices_of_turns_are_those_of_the_trim() {
    let report = json(&with(&TURNS, &["--format", "json"]), 0);
    for (k, speed) in ["15", "30"].into_iter().enumerate() {
        let trim = json(&["trim", "ref11", "--speed", speed, "--lateral-acceleration", "4", "--format", "json"], 0);
        let signal = |name: &str| number(&trim["points"][0]["signals"][name]);
        let index = |name: &str| number(&report["points"][k]["indices"][name]);
        let torque = signal("steer.torque");
        for (name, expected) in [
            ("acceleration_index", torque / 4.0),
            ("roll_index", torque / signal("chassis.roll")),
            ("yaw_index", torque / signal("chassis.yaw_rate")),
        ] {
            assert!((index(name) - expected).abs() < 1e-9 * expected.abs(), "{name}: {} {expected}", index(name));
        }
        // slip angles small against the steering angle change the radius by their difference: tan(Δ + λ_r − λ_f) ≈ p/R
        let (slip, curvature) = (signal("rear_tire.slip_angle") - signal("front_tire.slip_angle"), signal("kinematic_curvature"));
        let expected = (1.0 + slip / (curvature * signal("wheelbase"))).abs();
        assert!((index("steering_ratio") / expected - 1.0).abs() < 0.05, "{} {expected}", index("steering_ratio"));
    }
}

#[test]
fn a_turn_to_the_other_side_has_the_same_indices() {
    let [left, right] = ["4", "-4"].map(|a| json(&with(&TURNS, &["--format", "json", "--lateral-acceleration", a]), 0));
    for name in ["acceleration_index", "roll_index", "yaw_index", "steering_ratio"] {
        let [l, r] = [&left, &right].map(|report| number(&report["points"][1]["indices"][name]));
        assert!((l - r).abs() < 1e-7 * l.abs(), "{name}: {l} {r}");
    }
}

#[test]
fn rides_add_their_indices() {
    let report = json(&["handling", "ref11", "--speed", "20", "--format", "json"], 0);
    let indices = &report["points"][0]["indices"];
    // tens of newton meters at a roll rate below 1 rad/s
    for name in ["koch_index", "lane_change_roll_index"] {
        assert!((0.2..10.0).contains(&number(&indices[name])), "{indices}");
    }
    assert!(report["warnings"].as_array().is_some_and(Vec::is_empty), "{}", report["warnings"]);
}

#[test]
fn formats_and_figure() {
    let table = fastbike(&TURNS);
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    assert!(table.stdout.contains("steering ratio") && table.stdout.contains("N m/deg"), "{}", table.stdout);
    let csv = fastbike(&with(&TURNS, &["--format", "csv"])).stdout;
    assert!(csv.starts_with("given.speed,given.lateral_acceleration,ending,acceleration_index,"), "{csv}");
    let path = folder("handling").join("handling.svg");
    let text = path.display().to_string();
    assert_eq!(fastbike(&with(&TURNS, &["--plot", &text])).status, 0);
    assert!(fs::read_to_string(&path).expect("the figure").contains("Handling indices of ref11"));
    let alone = fastbike(&["handling", "ref11", "--speed", "20", "--no-rides", "--plot", &text]);
    assert!(alone.status == 2 && alone.stderr.contains("sweep the speed"), "{}", alone.stderr);
}

#[test]
fn bad_input_is_refused() {
    for (arguments, expected) in [
        (&["handling", "ref11", "--speed", "0"][..], "greater than 0"),
        (&["handling", "ref11", "--lateral-acceleration", "0"], "not be 0"),
        (&["handling", "ref11", "--width", "-1m"], "greater than 0"),
        (&["handling", "ref11", "--width", "1m,2m"], "one value"),
    ] {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}: {}", answer.stderr);
        assert!(answer.stderr.contains(expected), "{arguments:?}: {}", answer.stderr);
    }
}
