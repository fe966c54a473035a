//! `rider`: gains, margins, poles; formats, figures, bad input.

use super::{fastbike, folder, json, keys, number};
use std::fs;

const DESIGN: [&str; 4] = ["rider", "ref11", "--speed", "15,25"];

fn with<'a>(first: &[&'a str], rest: &[&'a str]) -> Vec<&'a str> {
    [first, rest].concat()
}

#[test]
fn every_point_has_gains_margins_and_poles_that_decay() {
    let report = json(&with(&DESIGN, &["--format", "json"]), 0);
    assert_eq!(report["command"].as_str(), Some("rider"));
    let points = report["points"].as_array().expect("points");
    assert_eq!(points.len(), 2);
    for point in points {
        let rider = &point["rider"];
        assert_eq!(keys(rider), ["gains", "preview", "closed", "margins"]);
        assert!(rider["closed"].as_array().expect("poles").iter().all(|s| number(&s["re"]) < 0.0), "{rider}");
        // an offset to the left is steered against: the torque of the law is minus the gain times the offset
        let gains = &rider["gains"];
        assert_eq!(keys(gains), keys(&report["gain_units"]));
        assert!(number(&gains["path.offset"]).abs() > 1.0 && number(&gains["chassis.roll"]).abs() > 1.0, "{gains}");
        // a regulator of full state keeps 60°, half the gain and any larger one (B. D. O. Anderson, J. B. Moore, 1990, 5.4)
        let margins = &rider["margins"];
        assert!(number(&margins["phase_margin"]).to_degrees() >= 60.0 - 1e-6, "{margins}");
        assert!(number(&margins["distance"]) >= 1.0 - 1e-6, "{margins}");
        assert!(number(&rider["preview"]["tail"]) < 0.01);
    }
}

/// Reaction time and muscles are known to the design: states of their own with gains of their own, and the loop stays stable.
#[test]
fn human_limits_are_part_of_the_design() {
    let limits = ["--delay", "0.1s", "--muscles", "30rad/s"];
    let [plain, human] = [&[][..], &limits[..]].map(|more| json(&with(&DESIGN, &with(&["--format", "json"], more)), 0));
    let poles = |report: &serde_json::Value| report["points"][0]["rider"]["closed"].as_array().map_or(0, Vec::len);
    assert_eq!(poles(&human), poles(&plain) + 4);
    let gains = &human["points"][0]["rider"]["gains"];
    for name in ["rider.delay", "rider.delay_rate", "rider.muscle_torque", "rider.muscle_torque_rate"] {
        assert!(number(&gains[name]).is_finite(), "{name}: {gains}");
    }
    assert!(human["points"][0]["rider"]["closed"].as_array().expect("poles").iter().all(|s| number(&s["re"]) < 0.0));
}

#[test]
fn the_rider_in_two_loops_is_designed_too() {
    let report = json(&with(&DESIGN, &["--lateral", "pid", "--format", "json"]), 0);
    for point in report["points"].as_array().expect("points") {
        let rider = &point["rider"];
        assert!(rider["closed"].as_array().expect("poles").iter().all(|s| number(&s["re"]) < 0.0), "{rider}");
        // positive in the counter-steering sense: theory manual 10.3
        assert!(number(&rider["gains"]["chassis.roll"]) > 0.0 && number(&rider["gains"]["chassis.roll_rate"]) > 0.0, "{rider}");
    }
    assert!(fastbike(&with(&DESIGN, &["--lateral", "pid"])).stdout.contains("two loops"));
    assert_eq!(fastbike(&with(&DESIGN, &["--lateral", "lqg"])).status, 2);
}

#[test]
fn table_and_csv_hold_the_same_numbers() {
    let table = fastbike(&DESIGN);
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    for word in ["phase margin", "crossover", "slowest pole", "least damping", "looks ahead"] {
        assert!(table.stdout.contains(word), "{word}: {}", table.stdout);
    }
    let csv = fastbike(&with(&DESIGN, &["--format", "csv"])).stdout;
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    assert!(header.contains(&"gain.path.offset") && header.contains(&"preview.0"), "{header:?}");
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|c| c.parse().unwrap_or(f64::NAN)).collect()).collect();
    let report = json(&with(&DESIGN, &["--format", "json"]), 0);
    let column = header.iter().position(|h| *h == "gain.path.offset").expect("a column");
    assert_eq!(rows.len(), 2);
    for (k, row) in rows.iter().enumerate() {
        assert_eq!(row[column], number(&report["points"][k]["rider"]["gains"]["path.offset"]));
    }
}

#[test]
fn figures_of_loop_poles_and_gains() {
    let folder = folder("rider");
    for (picture, word) in [("loop", "Open loop"), ("poles", "Closed loop"), ("gains", "Gains")] {
        let path = folder.join(format!("{picture}.svg"));
        let answer = fastbike(&with(&DESIGN, &["--figure", picture, "--plot", &path.display().to_string()]));
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        assert!(fs::read_to_string(&path).expect("the figure").contains(word), "{picture}");
    }
    let path = folder.join("gains.svg").display().to_string();
    let alone = fastbike(&["rider", "ref11", "--speed", "20", "--figure", "gains", "--plot", &path]);
    assert!(alone.status == 2 && alone.stderr.contains("sweep the speed"), "{}", alone.stderr);
}

#[test]
fn bad_input_is_refused_with_its_option() {
    for (arguments, expected) in [
        (&["rider", "ref11", "--offset", "0"][..], "greater than 0"),
        (&["rider", "ref11", "--torque", "20 kg"], "--torque"),
        (&["rider", "ref11", "--delay", "-0.1s"], "greater than 0"),
        (&["rider", "ref11", "--offset", "0.1,0.2"], "one value"),
        (&["rider", "ref11", "--speed", "fast"], "--speed"),
        (&["rider", "pendulum"], "nobody can ride it"),
        (&["rider", "ref12"], "`ref11`"),
    ] {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}: {}", answer.stderr);
        assert!(answer.stderr.contains(expected), "{arguments:?}: {}", answer.stderr);
    }
}
