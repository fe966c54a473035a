//! `map`: a grid and its figure.

use super::{fastbike, folder, json, number};
use std::fs;

const GRID: [&str; 6] = ["map", "ref11", "--speed", "20..40:10", "--lean", "0deg..30deg:15deg"];

#[test]
fn points_are_those_of_trims() {
    let mut arguments = GRID.to_vec();
    arguments.extend(["--format", "json"]);
    let map = json(&arguments, 0);
    let points = map["points"].as_array().expect("points");
    assert_eq!(points.len(), 9);
    let corner = &points[8];
    let trim = json(&["trim", "ref11", "--speed", "40", "--lean", "30deg", "--format", "json"], 0);
    let (ours, alone) = (number(&corner["signals"]["steer.torque"]), number(&trim["points"][0]["signals"]["steer.torque"]));
    // both are converged to a residual of 1e-10, on different ways
    assert!((ours - alone).abs() < 1e-7 * alone.abs().max(1.0), "{ours} {alone}");
}

#[test]
fn figures_are_written_as_svg_and_png() {
    let folder = folder("map");
    for (name, magic) in [("torque.svg", &b"<svg"[..]), ("torque.png", &b"\x89PNG\r\n\x1a\n"[..])] {
        let path = folder.join(name);
        let path_text = path.display().to_string();
        let mut arguments = GRID.to_vec();
        arguments.extend(["--show", "steer.torque", "--plot", &path_text]);
        let answer = fastbike(&arguments);
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        let bytes = fs::read(&path).expect("the figure");
        assert!(bytes.starts_with(magic), "{name} begins with {:?}", &bytes[..16.min(bytes.len())]);
    }
}

#[test]
fn the_gear_counts_in_maps_too() {
    let answer = fastbike(&["map", "gsxr1000", "--speed", "20,30", "--lean", "0,0.2", "--gear", "9", "--show", "steer.torque"]);
    assert_eq!(answer.status, 2, "{}", answer.stdout);
    assert!(answer.stderr.contains("gear"), "{}", answer.stderr);
}

/// Between the last state within the limits and the next point of the grid, to a hundredth of the step, on both sides.
#[test]
fn limits_are_found_between_the_points() {
    let map = json(&["map", "gsxr1000", "--speed", "20,30", "--lateral-acceleration", "-16..16:4", "--format", "json"], 0);
    let limits = map["limits"].as_array().expect("limits");
    assert_eq!(limits.len(), 4);
    for limit in limits {
        let (speed, turn) = (number(&limit["given"]["speed"]), number(&limit["given"]["lateral_acceleration"]));
        assert_eq!(limit["ending"].as_str(), Some("reached"));
        let beyond = format!("{}", turn + 0.04_f64.copysign(turn));
        let trim = json(&["trim", "gsxr1000", "--speed", &speed.to_string(), "--lateral-acceleration", &beyond, "--format", "json"], 1);
        assert_eq!(trim["points"][0]["ending"].as_str(), Some("tire_saturated"), "{speed} m/s, {beyond} m/s²");
    }
    // left and right are mirror images
    let turn = |k: usize| number(&limits[k]["given"]["lateral_acceleration"]);
    assert!((turn(0) + turn(1)).abs() < 1e-9 && (turn(2) + turn(3)).abs() < 1e-9);
}
