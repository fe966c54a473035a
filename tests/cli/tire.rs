//! `tire`: curves of laws, property files and tires of models; and a motorcycle on a property file.

use super::{evidence, fastbike, folder, json, number};
use std::fs;

fn file(name: &str) -> String {
    evidence("reference/tire").join(name).display().to_string()
}

/// Stiffnesses are slopes of the curves beside them.
#[test]
fn the_table_goes_with_the_curves() {
    let report = json(
        &["tire", "sel04_120_70", "--load", "1100N", "--camber", "0", "--slip-angle", "1deg", "--slip", "0.001", "--format", "json"],
        0,
    );
    let load = &report["loads"][0];
    // printed by an independent program for these coefficients
    assert!((number(&load["cornering_stiffness"]) - 18358.6899).abs() < 0.5e-4, "{load}");
    assert!((number(&load["camber_stiffness"]) - 766.4470).abs() < 0.5e-4, "{load}");
    let curve = |along: &str| report["curves"].as_array().expect("curves").iter().find(|c| c["along"] == along).expect("a curve").clone();
    let (slip, force) = (&curve("longitudinal_slip")["longitudinal_slip"], &curve("longitudinal_slip")["longitudinal_force"]);
    let slope = number(&force[41]) / number(&slip[41]);
    assert!((slope / number(&load["slip_stiffness"]) - 1.0).abs() < 1e-4, "{slope} {load}");
}

#[test]
fn sae_axes_turn_the_side_force() {
    let [iso, sae] = ["iso", "sae"].map(|axes| json(&["tire", "ref11", "--tire", "rear_tire", "--axes", axes, "--format", "json"], 0));
    let value = |report: &serde_json::Value, key: &str| number(&report["curves"][1][key][70]);
    for (key, sign) in [("slip_angle", 1.0), ("lateral_force", -1.0), ("aligning_moment", -1.0), ("overturning_moment", 1.0)] {
        assert_eq!(value(&iso, key), sign * value(&sae, key), "{key}");
    }
    assert!(value(&iso, "lateral_force") > 0.0, "sliding right is pushed left");
}

#[test]
fn formats_and_figure() {
    let table = fastbike(&["tire", &file("mf61_example.tir"), "--load", "4kN"]);
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    for words in ["MF 6.1", "measured for load", "relaxation m"] {
        assert!(table.stdout.contains(words), "{}", table.stdout);
    }
    let csv = fastbike(&["tire", "sel04_160_70", "--load", "1kN,2kN", "--camber", "0", "--format", "csv"]).stdout;
    assert!(csv.starts_with("along,load,longitudinal_slip,") && csv.lines().count() > 600, "{}", csv.lines().count());
    let figure = folder("tire").join("tire.svg");
    let drawn = fastbike(&["tire", &file("mf52_example.tir"), "--plot", &figure.display().to_string()]);
    assert_eq!((drawn.status, drawn.stderr.as_str()), (0, ""));
    let svg = fs::read_to_string(figure).expect("a figure");
    assert!(svg.contains("y left, z up") && svg.contains("Mx (N m)") && svg.contains("camber 15°"), "words are missing");
}

#[test]
fn wrong_input_is_told() {
    for (arguments, words) in [
        (&["tire", "ref11", "--tire", "front_tir"][..], "did you mean `front_tire`"),
        (&["tire", "pendulum"], "no element of the kind `tire`"),
        (&["tire", "nothing.tir"], "was not found"),
        (&["tire", "ref11", "--load", "3m"], "a force"),
        (&["tire", "sel04_120_70", "--tire", "front_tire"], "a file holds one tire"),
        (&["tire", "ref11", "--slip", "0"], "greater than 0"),
    ] {
        let answer = fastbike(arguments);
        assert!(answer.status == 2 && answer.stdout.is_empty() && answer.stderr.contains(words), "{arguments:?}: {}", answer.stderr);
    }
}

/// Radius, springs, relaxation and rolling resistance come from the file; the lean is beyond what was measured, and that is told.
#[test]
fn a_property_file_replaces_a_tire() {
    let folder = folder("tire_file");
    let models = evidence("../models/vehicles/gsxr1000");
    for name in ["gsxr1000.yaml", "gsxr1000.urdf"] {
        fs::copy(models.join(name), folder.join(name)).expect("the model");
    }
    // a car tire in the size of a motorcycle tire: the example file at another nominal load
    let tir = fs::read_to_string(file("mf52_example.tir")).expect("the file");
    let tir = tir.replace("FNOMIN = 9416.6", "FNOMIN = 1400").replace("UNLOADED_RADIUS = 0.4", "UNLOADED_RADIUS = 0.29087290885");
    let tir = tir.replace("VERTICAL_STIFFNESS = 463000", "VERTICAL_STIFFNESS = 130000");
    fs::write(folder.join("front.tir"), tir).expect("written");
    let yaml = fs::read_to_string(folder.join("gsxr1000.yaml")).expect("the model");
    let (before, rest) = yaml.split_once("  front_tire:\n").expect("the front tire");
    let (_, after) = rest.split_once("  rear_tire:\n").expect("the rear tire");
    let shortest = "    tire: { wheel: front_wheel, law: { tir: front.tir }, road: front_road }\n";
    let model = folder.join("gsxr1000.yaml");
    fs::write(&model, format!("{before}  front_tire:\n{shortest}  rear_tire:\n{after}")).expect("written");
    let model = model.display().to_string();
    let straight = json(&["trim", &model, "--speed", "20", "--format", "json"], 0);
    let signal = |report: &serde_json::Value, name: &str| number(&report["points"][0]["signals"][name]);
    // what rolling resistance takes is its moment over the radius
    assert!(signal(&straight, "front_tire.rolling_moment") < 0.0 && signal(&straight, "front_tire.longitudinal_force") < 0.0);
    assert!(signal(&straight, "chassis.roll").abs() < 1e-9, "nothing tells left from right in the middle");
    assert_eq!(straight["warnings"].as_array().map(Vec::len), Some(0), "{}", straight["warnings"]);
    let turn = json(&["trim", &model, "--speed", "20", "--lateral-acceleration", "4", "--format", "json"], 0);
    let warnings = turn["warnings"].to_string();
    assert!(warnings.contains("`front_tire.camber` is outside the measurements of the tire"), "{warnings}");
}
