//! `frf`: keys, sweeps of frequencies, roads, axes, figures, refusals.

use super::{fastbike, folder, json, number};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;

const STEERING: [&str; 8] = ["frf", "ref11", "--speed", "30", "--frequency", "0.1..30:log50", "--format", "json"];

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().map(number).collect()
}

/// The response of a point from an input to an output.
fn the<'a>(point: &'a Value, input: &str, output: &str) -> &'a Value {
    let list = point["responses"].as_array().expect("responses");
    list.iter().find(|r| r["input"] == input && r["output"] == output).unwrap_or_else(|| panic!("no `{output}` to `{input}` in {point}"))
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let report = json(&STEERING, 0);
    assert_eq!((report["command"].as_str(), report["model"].as_str()), (Some("frf"), Some("ref11")));
    let point = &report["points"][0];
    let frequencies = numbers(&point["frequency_hz"]);
    assert_eq!((frequencies.len(), frequencies[0], frequencies[49]), (50, 0.1, 30.0));
    for output in ["chassis.roll", "steer.angle"] {
        let response = the(point, "steer.torque", output);
        assert_eq!(response["unit"].as_str(), Some("rad/(N m)"));
        let parts = ["re", "im", "magnitude", "phase"].map(|key| numbers(&response[key]));
        for k in 0..50 {
            let [re, im, magnitude, phase] = parts.each_ref().map(|p| p[k]);
            assert!((re.hypot(im) - magnitude).abs() <= 1e-12 * magnitude && (im.atan2(re) - phase).abs() < 1e-12);
        }
    }
}

/// The matrices of `linearize` give the same numbers: D alone far above all modes, and rates from jω.
#[test]
fn rates_are_those_of_their_signals() {
    let outputs =
        ["--output", "chassis.roll", "--output", "rate(chassis.roll)", "--output", "chassis.roll_rate", "--output", "chassis.yaw"];
    let report = json(&[&STEERING[..], &outputs, &["--output", "chassis.yaw_rate"]].concat(), 0);
    let point = &report["points"][0];
    let part = |output: &str, key: &str| numbers(&the(point, "steer.torque", output)[key]);
    let frequencies = numbers(&point["frequency_hz"]);
    for (k, frequency) in frequencies.iter().enumerate() {
        let omega = TAU * frequency;
        for (signal, rate) in
            [("chassis.roll", "rate(chassis.roll)"), ("chassis.roll", "chassis.roll_rate"), ("chassis.yaw", "chassis.yaw_rate")]
        {
            // jω (re + j im)
            let (re, im) = (part(signal, "re")[k], part(signal, "im")[k]);
            let size = omega * re.hypot(im);
            assert!((part(rate, "re")[k] + omega * im).abs() < 1e-9 * size, "{rate} at {frequency} Hz");
            assert!((part(rate, "im")[k] - omega * re).abs() < 1e-9 * size, "{rate} at {frequency} Hz");
        }
    }
}

#[test]
fn a_road_reaches_the_rear_wheel_later() {
    let both = ["frf", "gsxr1000", "--speed", "20", "--frequency", "1,5,12", "--output", "saddle.acceleration_z", "--format", "json"];
    let report = json(&[&both[..], &["--road", "both"]].concat(), 0);
    let front = json(&[&both[..], &["--road", "front"]].concat(), 0);
    let rear = json(&[&both[..], &["--road", "rear"]].concat(), 0);
    let delay = number(&report["points"][0]["signals"]["wheelbase"]) / 20.0;
    let part = |report: &Value, input: &str, key: &str| numbers(&the(&report["points"][0], input, "saddle.acceleration_z")[key]);
    for (k, frequency) in [1.0, 5.0, 12.0].into_iter().enumerate() {
        let (sin, cos) = (-TAU * frequency * delay).sin_cos();
        let [fr, fi] = ["re", "im"].map(|key| part(&front, "front_road.height", key)[k]);
        let [rr, ri] = ["re", "im"].map(|key| part(&rear, "rear_road.height", key)[k]);
        let [re, im] = ["re", "im"].map(|key| part(&report, "road", key)[k]);
        assert!((fr + rr * cos - ri * sin - re).abs() < 1e-9 * re.hypot(im) && (fi + rr * sin + ri * cos - im).abs() < 1e-9 * re.hypot(im));
    }
}

#[test]
fn sae_axes_turn_responses() {
    let outputs = ["--output", "chassis.roll", "--output", "rate(steer.rate)"];
    let iso = json(&[&STEERING[..], &outputs].concat(), 0);
    let sae = json(&[&STEERING[..], &outputs, &["--axes", "sae"]].concat(), 0);
    let part = |report: &Value, output: &str| numbers(&the(&report["points"][0], "steer.torque", output)["re"])[20];
    // torque and steering rate change their signs, the roll does not
    assert_eq!(part(&iso, "chassis.roll"), -part(&sae, "chassis.roll"));
    assert_eq!(part(&iso, "rate(steer.rate)"), part(&sae, "rate(steer.rate)"));
}

#[test]
fn constrained_models_and_sweeps_have_responses_too() {
    let report = json(&["frf", "whipple", "--speed", "4..6:1", "--frequency", "0.5", "--format", "json"], 0);
    let points = report["points"].as_array().expect("points");
    assert_eq!(points.len(), 3);
    assert!(points.iter().all(|p| number(&the(p, "steer.torque", "chassis.roll")["magnitude"][0]) > 0.0));
    let table = fastbike(&["frf", "whipple", "--speed", "4..6:1", "--frequency", "0.5"]).stdout;
    assert!(table.contains("3 of 3 points reached") && table.contains("chassis.roll / steer.torque"), "{table}");
    let csv = fastbike(&["frf", "whipple", "--speed", "4..6:1", "--frequency", "0.5,1", "--format", "csv"]).stdout;
    assert!(csv.starts_with("given.speed,ending,input,output,frequency_hz,re,im,magnitude,phase\n"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + 3 * 2 * 2);
}

#[test]
fn points_that_are_not_reached_are_told_and_the_rest_goes_on() {
    let sweep = ["frf", "ref11", "--speed", "30", "--lean", "0.2,1.4", "--frequency", "1,2", "--format", "json"];
    let report = json(&sweep, 0);
    assert!(report["points"][0]["responses"].is_array() && report["points"][1]["refused"].is_string());
    assert_ne!(report["points"][1]["ending"].as_str(), Some("reached"));
}

#[test]
fn figures_are_written() {
    let path = folder("frf").join("frf.svg");
    let text = path.display().to_string();
    let answer = fastbike(&["frf", "gsxr1000", "--speed", "20,40", "--road", "both", "--plot", &text]);
    assert_eq!(answer.status, 0, "{}", answer.stderr);
    let figure = fs::read_to_string(&path).expect("the figure");
    for word in ["Response of gsxr1000 to road", "frequency (Hz)", "phase (deg)", "speed 20 m/s", "rad/s²"] {
        assert!(figure.contains(word), "`{word}` is missing");
    }
    let single = fastbike(&["frf", "ref11", "--speed", "30", "--frequency", "1", "--plot", &text]);
    assert_eq!(single.status, 2, "{}", single.stderr);
}

#[test]
fn variants_stand_beside_the_base() {
    // without its damper the steering swings further near the wobble
    let variant = "steering_damper.coefficient=0";
    let report = json(&["frf", "gsxr1000", "--speed", "30", "--frequency", "7", "--versus", variant, "--format", "json"], 0);
    let magnitude = |point: &Value| number(&point["responses"][1]["magnitude"][0]);
    let (base, other) = (magnitude(&report["points"][0]), magnitude(&report["versus"][0]["points"][0]));
    assert!(other > 1.5 * base, "{base} {other}");
    for command in [
        &["frf", "gsxr1000", "--speed", "30", "--frequency", "2,7", "--versus", variant][..],
        &["slalom", "gsxr1000", "--speed", "10,20", "--versus", variant],
        &["comfort", "gsxr1000", "--speed", "10,20", "--versus", variant],
    ] {
        let answer = fastbike(command);
        assert!(
            answer.status == 0 && answer.stdout.contains(variant) && answer.stdout.contains("difference"),
            "{command:?}: {}",
            answer.stdout
        );
    }
}
