//! `modes`: keys, names, changes of stability, figures.

use super::{fastbike, folder, json, keys, number};
use serde_json::Value;
use std::fs;

const STRAIGHT: [&str; 4] = ["modes", "ref11", "--speed", "30"];

fn modes(point: &Value) -> &[Value] {
    point["modes"].as_array().map(Vec::as_slice).unwrap_or_default()
}

/// The only mode of a point with this name that oscillates or does not.
fn the<'a>(point: &'a Value, name: &str, oscillates: bool) -> &'a Value {
    let mut found = modes(point).iter().filter(|m| m["name"] == name && (number(&m["im"]) > 0.0) == oscillates);
    match (found.next(), found.next()) {
        (Some(mode), None) => mode,
        (first, _) => panic!("{} modes are called `{name}` at {}", if first.is_some() { "several" } else { "no" }, point["given"]),
    }
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let report = json(&[&STRAIGHT[..], &["--format", "json"]].concat(), 0);
    assert_eq!((report["command"].as_str(), report["model"].as_str()), (Some("modes"), Some("ref11")));
    let point = &report["points"][0];
    assert_eq!((point["ending"].as_str(), number(&point["given"]["speed"])), (Some("reached"), 30.0));
    // 19 states: six pairs and seven real eigenvalues
    assert_eq!(modes(point).len(), 13);
    for mode in modes(point) {
        for key in ["name", "re", "im", "frequency_hz", "damping_ratio", "confidence", "participation"] {
            assert!(mode.get(key).is_some(), "`{key}` is missing");
        }
        let (re, im) = (number(&mode["re"]), number(&mode["im"]));
        let size = re.hypot(im);
        assert!((number(&mode["frequency_hz"]) - size / std::f64::consts::TAU).abs() < 1e-12 * size);
        assert!((number(&mode["damping_ratio"]) + re / size).abs() < 1e-12);
        let shares: f64 = keys(&mode["participation"]).iter().map(|k| number(&mode["participation"][k])).sum();
        assert!((shares - 1.0).abs() < 1e-12, "shares of {} add up to {shares}", mode["name"]);
    }
    // theory manual B.3
    let wobble = the(point, "wobble", true);
    assert!((number(&wobble["re"]) + 4.160852).abs() < 1e-6 && (number(&wobble["im"]) - 49.932087).abs() < 1e-6, "{wobble}");
}

#[test]
fn every_mode_of_the_bundled_motorcycles_is_recognized() {
    for model in ["ref11", "gsxr1000", "moto11"] {
        let report = json(&["modes", model, "--speed", "30", "--format", "json"], 0);
        let point = &report["points"][0];
        for name in ["weave", "wobble", "pitch", "bounce"] {
            the(point, name, true);
        }
        for name in ["capsize", "speed", "rear wobble"] {
            the(point, name, false);
        }
        for mode in modes(point) {
            assert!(number(&mode["confidence"]) > 0.3, "{model}: {mode}");
        }
    }
}

/// A name is carried along: in a turn, and under brakes or power, from straight running.
#[test]
fn names_are_kept_along_sweeps() {
    for more in [&[][..], &["--lateral-acceleration", "-5"], &["--acceleration", "-5"], &["--acceleration", "3"]] {
        let arguments = [&["modes", "gsxr1000", "--speed", "5..80:5", "--format", "json"][..], more].concat();
        let report = json(&arguments, 0);
        let points = report["points"].as_array().expect("points");
        assert_eq!(points.len(), 16);
        let frozen = report["warnings"].as_array().expect("warnings").iter().any(|w| w.as_str().is_some_and(|w| w.contains("frozen time")));
        assert_eq!(frozen, more.first() == Some(&"--acceleration"));
        for point in points {
            for (name, low, high) in [("weave", 0.3, 5.0), ("wobble", 4.6, 10.5), ("pitch", 5.9, 7.0), ("bounce", 2.4, 4.5)] {
                let frequency = number(&the(point, name, true)["frequency_hz"]);
                // no swap: the frequencies of other modes are elsewhere, or cross it in the damping
                assert!((low..high).contains(&frequency), "{more:?}: {name} at {}: {frequency} Hz", point["given"]);
            }
            the(point, "capsize", false);
        }
        for name in ["wobble", "weave", "pitch"] {
            let values: Vec<(f64, f64)> = points.iter().map(|p| the(p, name, true)).map(|m| (number(&m["re"]), number(&m["im"]))).collect();
            for pair in values.windows(2) {
                let step = (pair[0].0 - pair[1].0).hypot(pair[0].1 - pair[1].1);
                assert!(step < 10.0, "{more:?}: {name} jumps by {step} 1/s");
            }
        }
    }
}

#[test]
fn changes_of_stability_are_found_between_the_points() {
    let report = json(&["modes", "whipple", "--speed", "1..10:1", "--format", "json"], 0);
    let critical = report["critical"].as_array().expect("changes of stability");
    let told: Vec<_> = critical.iter().map(|c| (c["name"].as_str(), c["becomes"].as_str())).collect();
    assert_eq!(told, [(Some("weave"), Some("stable")), (Some("capsize"), Some("unstable"))]);
    // Meijaard, Papadopoulos, Ruina, Schwab (2007), weave and capsize speed
    for (found, printed) in critical.iter().zip([4.292_382_536_341, 6.024_262_015_388]) {
        let speed = number(&found["given"]["speed"]);
        assert!((speed - printed).abs() < 1e-8, "{speed} instead of {printed}");
    }
}

#[test]
fn the_three_formats_tell_the_same() {
    let report = json(&[&STRAIGHT[..], &["--format", "json"]].concat(), 0);
    let csv = fastbike(&[&STRAIGHT[..], &["--format", "csv"]].concat()).stdout;
    let table = fastbike(&STRAIGHT).stdout;
    let names: Vec<&str> = csv.lines().next().unwrap_or_default().split(',').collect();
    assert_eq!(names[..5], ["given.speed", "ending", "name", "re", "im"]);
    assert_eq!(csv.lines().count(), 14);
    for (line, mode) in csv.lines().skip(1).zip(modes(&report["points"][0])) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!((Some(cells[2]), cells[3].parse().ok()), (mode["name"].as_str(), mode["re"].as_f64()));
        assert!(table.lines().any(|l| l.starts_with(cells[2])), "{}", cells[2]);
    }
}

#[test]
fn shapes_are_told_on_request() {
    let report = json(&[&STRAIGHT[..], &["--shapes", "--format", "json"]].concat(), 0);
    let weave = &the(&report["points"][0], "weave", true)["shape"];
    assert_eq!(report["shape_units"]["chassis.roll"].as_str(), Some("rad"));
    let size = |name: &str| number(&weave[name]["re"]).hypot(number(&weave[name]["im"]));
    // the heading is the integral of the yaw rate, and straight running has no motion in its plane of symmetry in a weave
    let mode = the(&report["points"][0], "weave", true);
    let s = number(&mode["re"]).hypot(number(&mode["im"]));
    assert!((size("chassis.yaw") * s / size("chassis.yaw_rate") - 1.0).abs() < 1e-9);
    assert!(size("chassis.roll") > 1e-3 && size("fork.travel") < 1e-9);
    let without = json(&[&STRAIGHT[..], &["--format", "json"]].concat(), 0);
    assert!(modes(&without["points"][0])[0].get("shape").is_none());
    assert!(fastbike(&[&STRAIGHT[..], &["--shapes"]].concat()).stdout.contains("shape of weave"));
}

#[test]
fn figures_are_written_as_svg_and_png() {
    let folder = folder("modes");
    for (picture, name, magic) in [("locus", "locus.svg", &b"<svg"[..]), ("frequencies", "frequencies.png", &b"\x89PNG\r\n\x1a\n"[..])] {
        let path = folder.join(name);
        let answer = fastbike(&["modes", "ref11", "--speed", "10..60:10", "--figure", picture, "--plot", &path.display().to_string()]);
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        assert!(fs::read(&path).expect("the figure").starts_with(magic), "{name}");
    }
    let locus = fs::read_to_string(folder.join("locus.svg")).expect("the figure");
    for word in ["weave", "wobble", "capsize", "unstable", "damping ratio", "speed 10 m/s"] {
        assert!(locus.contains(word), "`{word}` is missing");
    }
    for (name, more, words) in [
        ("shapes.svg", &["--speed", "30", "--shapes"][..], &["wobble, 7.95 Hz", "steer angle", "chassis roll", "leads"][..]),
        ("sensitivity.svg", &["--speed", "30", "--sensitivity", "weave"], &["weave, 2.89 Hz", "real part", "per 1 %"]),
        ("versus.svg", &["--speed", "10..60:10", "--versus", "steering_damper.coefficient=3"], &["coefficient=3", "ref11", "wobble"]),
    ] {
        let path = folder.join(name);
        let answer = fastbike(&[&["modes", "ref11"][..], more, &["--plot", &path.display().to_string()]].concat());
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        let figure = fs::read_to_string(&path).expect("the figure");
        for word in words {
            assert!(figure.contains(word), "`{word}` is missing in {name}");
        }
    }
    let alone = fastbike(&["modes", "ref11", "--speed", "30", "--figure", "frequencies", "--plot", "alone.svg"]);
    assert_eq!(alone.status, 2, "{}", alone.stderr);
}

#[test]
fn braking_is_told_to_be_frozen() {
    let answer = fastbike(&["modes", "ref11", "--speed", "30", "--acceleration", "-3"]);
    assert!(answer.status == 0 && answer.stderr.contains("frozen time"), "{}", answer.stderr);
}

/// Frequency of the only oscillation with this name, as a complex eigenvalue.
fn eigenvalue(report: &Value, name: &str) -> (f64, f64) {
    let mode = the(&report["points"][0], name, true);
    (number(&mode["re"]), number(&mode["im"]))
}

#[test]
fn the_ten_parameters_that_move_a_mode_most_are_told() {
    let report = json(&[&STRAIGHT[..], &["--sensitivity", "wobble", "--format", "json"]].concat(), 0);
    let told = the(&report["points"][0], "wobble", true)["sensitivity"].as_array().expect("sensitivities").clone();
    assert_eq!(told.len(), 10);
    let share = |s: &Value| number(&s["value"]).abs() * number(&s["re"]).hypot(number(&s["im"]));
    assert!(told.windows(2).all(|pair| share(&pair[0]) >= share(&pair[1])), "most first");
    for entry in &told {
        assert!(number(&entry["error"]) <= 1e-7 * number(&entry["re"]).hypot(number(&entry["im"])), "{entry}");
    }
    assert!(the(&report["points"][0], "weave", true).get("sensitivity").is_none());
    // a change of a thousandth moves the eigenvalue by what the derivative says, to second order
    let (first, path) = (&told[0], told[0]["parameter"].as_str().expect("a path"));
    let step = 1e-3 * number(&first["value"]);
    let at = |value: f64| {
        eigenvalue(&json(&[&STRAIGHT[..], &["--set", &format!("{path}={value:?}"), "--format", "json"]].concat(), 0), "wobble")
    };
    let (up, down) = (at(number(&first["value"]) + step), at(number(&first["value"]) - step));
    let (re, im) = ((up.0 - down.0) / (2.0 * step), (up.1 - down.1) / (2.0 * step));
    let off = (re - number(&first["re"])).hypot(im - number(&first["im"]));
    assert!(off < 1e-4 * re.hypot(im), "{re} {im} instead of {first}");
    let table = fastbike(&[&STRAIGHT[..], &["--sensitivity"]].concat()).stdout;
    for name in ["weave", "wobble", "bounce", "pitch"] {
        assert!(table.contains(&format!("sensitivity of {name},")), "{name}");
    }
}

#[test]
fn single_parameters_are_told_on_request() {
    let paths = ["steering_damper.coefficient", "link.chassis.com.y"];
    let arguments = [&STRAIGHT[..], &["--sensitivity-of", paths[0], "--sensitivity-of", paths[1], "--format", "json"]].concat();
    let report = json(&arguments, 0);
    let told = the(&report["points"][0], "wobble", true)["sensitivity"].as_array().expect("sensitivities").clone();
    assert_eq!(told.iter().filter_map(|s| s["parameter"].as_str()).collect::<Vec<_>>(), paths);
    // a steering damper damps the wobble
    assert!(number(&told[0]["re"]) < -0.1);
    // the mirror image has the same eigenvalues
    assert!(number(&told[1]["re"]).abs() < 1e-6, "{}", told[1]);
    // with one moment about a diameter of its own a wheel is not symmetric any more
    let answer = fastbike(&[&STRAIGHT[..], &["--sensitivity-of", "link.front_wheel_rim.inertia.ixx"]].concat());
    assert!(answer.status == 0 && answer.stderr.contains("not symmetric"), "{}", answer.stderr);
    for (option, name, near) in [("--sensitivity", "wobbel", "`wobble`"), ("--sensitivity-of", "steering_damper.coeficient", paths[0])] {
        let answer = fastbike(&[&STRAIGHT[..], &[option, name]].concat());
        assert!(answer.status == 2 && answer.stderr.contains(near), "{}", answer.stderr);
    }
}

#[test]
fn variants_stand_beside_the_base() {
    let damper = "steering_damper.coefficient=3";
    let report = json(&[&STRAIGHT[..], &["--versus", damper, "--format", "json"]].concat(), 0);
    let variant = &report["versus"][0];
    assert_eq!(variant["variant"].as_str(), Some(damper));
    let alone = json(&[&STRAIGHT[..], &["--set", damper, "--format", "json"]].concat(), 0);
    assert_eq!(eigenvalue(variant, "wobble"), eigenvalue(&alone, "wobble"));
    let csv = fastbike(&[&STRAIGHT[..], &["--versus", damper, "--format", "csv"]].concat()).stdout;
    assert!(csv.starts_with("variant,given.speed,"), "{csv}");
    assert_eq!(csv.lines().filter(|l| l.starts_with(damper)).count(), 13);
    let table = fastbike(&[&STRAIGHT[..], &["--versus", damper]].concat()).stdout;
    let line = table.lines().rev().find(|l| l.starts_with("wobble")).expect("a line of the wobble");
    let cells: Vec<f64> = line.split_whitespace().skip(1).filter_map(|c| c.parse().ok()).collect();
    assert!((cells[1] - cells[0] - cells[2]).abs() < 1e-4 && cells[2] < -1.0, "{line}");
}
