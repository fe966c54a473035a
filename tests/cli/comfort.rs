//! `comfort`: classes of roads, points, formats, figure.

use super::{fastbike, folder, json, number};
use std::fs;

const RIDE: [&str; 4] = ["comfort", "gsxr1000", "--speed", "10,30"];

#[test]
fn classes_double_the_acceleration() {
    let report = json(&[&RIDE[..], &["--road-class", "A..C", "--format", "json"]].concat(), 0);
    for point in report["points"].as_array().expect("points") {
        let classes = point["comfort"].as_array().expect("classes");
        assert_eq!(classes.iter().map(|c| c["road_class"].as_str()).collect::<Vec<_>>(), [Some("A"), Some("B"), Some("C")]);
        for pair in classes.windows(2) {
            assert!((number(&pair[1]["total"]) / number(&pair[0]["total"]) - 2.0).abs() < 1e-12);
        }
        let first = &classes[0];
        let squares: f64 = first["directions"].as_array().into_iter().flatten().map(|d| number(&d["weighted"]).powi(2)).sum();
        assert!((squares.sqrt() - number(&first["total"])).abs() < 1e-9 * number(&first["total"]));
        assert!((number(&point["index"]) * number(&first["level"]).sqrt() - number(&first["total"])).abs() < 1e-12);
        // straight running: nothing moves sideways
        assert!(number(&first["directions"][1]["weighted"]) < 1e-9);
        assert!((0.0..0.2).contains(&number(&first["share_above_20_hz"])));
    }
}

#[test]
fn any_point_with_an_acceleration_can_be_judged() {
    let saddle = json(&[&RIDE[..], &["--format", "json"]].concat(), 0);
    let handlebar = json(&[&RIDE[..], &["--point", "handlebar", "--format", "json"]].concat(), 0);
    assert_ne!(saddle["points"][1]["index"], handlebar["points"][1]["index"]);
    assert_eq!(handlebar["points"][0]["comfort"][0]["directions"][0]["output"].as_str(), Some("handlebar.acceleration_x"));
}

#[test]
fn tables_and_figures_tell_the_weightings() {
    let path = folder("comfort").join("comfort.svg");
    let answer = fastbike(&[&RIDE[..], &["--plot", &path.display().to_string()]].concat());
    assert_eq!(answer.status, 0, "{}", answer.stderr);
    for word in ["Wk", "Wd", "road A", "above 20 Hz", "2 of 2 points reached"] {
        assert!(answer.stdout.contains(word), "`{word}` is missing in\n{}", answer.stdout);
    }
    assert!(fs::read_to_string(&path).expect("the figure").contains("road class A"));
    let csv = fastbike(&[&RIDE[..], &["--road-class", "A,E", "--format", "csv"]].concat()).stdout;
    assert_eq!(csv.lines().count(), 1 + 2 * 2);
}
