//! `slalom`: frequencies, formats, figure.

use super::{fastbike, folder, json, number};
use std::fs;

const CONES: [&str; 6] = ["slalom", "ref11", "--spacing", "14", "--speed", "7,8,30"];

#[test]
fn every_speed_has_its_frequency() {
    let report = json(&[&CONES[..], &["--format", "json"]].concat(), 0);
    assert_eq!(report["command"].as_str(), Some("slalom"));
    // theory manual B.3, deg per N m
    for (k, (speed, printed)) in [(7.0, 3.3004), (8.0, 3.1683), (30.0, 0.1640)].into_iter().enumerate() {
        let point = &report["points"][k];
        let response = &point["responses"][0];
        assert_eq!((response["input"].as_str(), response["output"].as_str()), (Some("steer.torque"), Some("chassis.roll")));
        assert!((number(&point["frequency_hz"][0]) - speed / 28.0).abs() < 1e-12);
        assert!((number(&response["magnitude"][0]).to_degrees() - printed).abs() < 0.5e-4);
    }
}

#[test]
fn unstable_speeds_are_told() {
    let answer = fastbike(&CONES);
    assert_eq!((answer.status, answer.stderr.as_str()), (0, ""));
    assert!(answer.stdout.contains("3.30038") && answer.stdout.contains("deg/(N m)"), "{}", answer.stdout);
    let slow = fastbike(&["slalom", "ref11", "--speed", "4,8"]);
    assert!(slow.status == 0 && slow.stderr.contains("1 of 2 steady states is unstable"), "{}", slow.stderr);
}

#[test]
fn the_figure_needs_a_sweep() {
    let path = folder("slalom").join("slalom.svg");
    let text = path.display().to_string();
    let answer = fastbike(&[&CONES[..], &["--plot", &text]].concat());
    assert_eq!(answer.status, 0, "{}", answer.stderr);
    assert!(fs::read_to_string(&path).expect("the figure").contains("cones every 14 m"));
    let alone = fastbike(&["slalom", "ref11", "--speed", "8", "--plot", &text]);
    assert_eq!(alone.status, 2, "{}", alone.stderr);
}
