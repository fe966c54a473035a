//! `check`: everything at once, as text on standard error or as JSON on standard output.

use super::{fastbike, folder, json, keys};
use std::fs;

#[test]
fn a_bundled_model_is_in_order() {
    for model in ["ref11", "moto11", "gsxr1000", "tree38"] {
        let answer = fastbike(&["check", model]);
        assert_eq!((answer.status, answer.stderr.as_str()), (0, ""), "{model}: {}", answer.stdout);
        assert!(answer.stdout.contains(": in order. "), "{model}: {}", answer.stdout);
    }
    let answer = fastbike(&["check", "gsxr1000"]).stdout;
    assert!(answer.contains("6 moving bodies, 11 degrees of freedom") && answer.contains("250.650 kg"), "{answer}");
}

#[test]
fn findings_as_json_have_the_keys_of_the_contract() {
    let folder = folder("check");
    let file = folder.join("bad.yaml");
    let text = "fastbike: 1\nname: bad\nurdf: missing.urdf\nbase: fixed\nelements:\n  a: { joint_force: { jiont: x } }\n  b: { joint_farce: { joint: x } }\n";
    fs::write(&file, text).expect("a file can be written");
    let path = file.display().to_string();
    let answer = fastbike(&["check", &path, "--format", "json"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (2, ""));
    let report = json(&["check", &path, "--format", "json"], 2);
    assert_eq!(keys(&report), ["fastbike", "command", "model", "findings"]);
    assert_eq!((report["command"].as_str(), report["model"].as_str()), (Some("check"), Some(path.as_str())));
    let rows = report["findings"].as_array().expect("a list of findings");
    let found: Vec<_> = rows.iter().map(|r| (r["code"].as_str().unwrap_or_default(), r["line"].as_u64().unwrap_or_default())).collect();
    assert_eq!(found, [("missing_file", 3), ("unknown_key", 6), ("unknown_kind", 7)]);
    for row in rows {
        for key in ["severity", "code", "file", "line", "path", "message", "hint"] {
            assert!(row.get(key).is_some(), "`{key}` is missing in {row}");
        }
        assert_eq!((row["severity"].as_str(), row["file"].as_str()), (Some("error"), Some("bad.yaml")));
    }
    assert_eq!(rows[1]["path"].as_str(), Some("elements.a.joint_force.jiont"));
    assert_eq!(rows[1]["hint"].as_str(), Some("did you mean `joint`?"));
}

#[test]
fn a_model_in_order_has_no_findings_in_json() {
    let report = json(&["check", "ref11", "--format", "json"], 0);
    assert_eq!(report["findings"].as_array().map(Vec::len), Some(0));
}

/// What is no description at all is refused in both formats with the same findings, and nothing is said twice.
#[test]
fn what_is_no_description_is_refused() {
    let folder = folder("no_description");
    let path = |name: &str| folder.join(name).display().to_string();
    fs::create_dir(folder.join("folder.yaml")).expect("a folder can be made");
    fs::write(folder.join("binary.yaml"), [0x7f, 0x45, 0x4c, 0x46, 0xff, 0xfe, 0x00]).expect("a file can be written");
    fs::write(folder.join("binary.urdf"), [0xff; 64]).expect("a file can be written");
    fs::write(folder.join("empty.yaml"), "").expect("a file can be written");
    fs::write(folder.join("empty.urdf"), "").expect("a file can be written");
    fs::write(folder.join("number.yaml"), "9".repeat(10_000)).expect("a file can be written");
    let cases = [
        ("folder.yaml", "no_description"),
        ("binary.yaml", "not_text"),
        ("binary.urdf", "not_text"),
        ("empty.yaml", "empty_file"),
        ("empty.urdf", "not_xml"),
        ("number.yaml", "wrong_type"),
        ("missing.yaml", "missing_file"),
        ("", "no_description"),
    ];
    for (name, code) in cases {
        let report = json(&["check", &path(name), "--format", "json"], 2);
        let codes: Vec<_> = report["findings"].as_array().into_iter().flatten().map(|f| f["code"].as_str().unwrap_or_default()).collect();
        assert_eq!(codes, [code], "{name}");
        let answer = fastbike(&["check", &path(name)]);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{name}");
        assert!(answer.stderr.contains(&format!("error[{code}]")), "{name}: {}", answer.stderr);
    }
}
