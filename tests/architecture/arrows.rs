//! Who may depend on whom.

use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// The packages of the workspace, and for each the packages of the workspace that it may depend on.
const ARROWS: [(&str, &[&str]); 9] = [
    ("problem", &[]),
    ("mbody", &["problem"]),
    ("motorcycle", &["mbody", "problem"]),
    ("native", &["problem"]),
    ("sundials", &["problem"]),
    ("analyses", &["problem"]),
    ("fastbike", &["mbody", "motorcycle", "problem", "native", "sundials", "analyses"]),
    ("validation", &["mbody", "motorcycle", "problem", "native", "sundials", "analyses", "fastbike"]),
    // an example of a crate outside
    ("external_element", &["mbody", "motorcycle", "problem", "fastbike", "validation"]),
];
/// Outside packages that one package of ours may depend on alone.
const RESERVED: [(&str, &str); 1] = [("sundials-sys", "sundials")];

/// Every dependency against the arrows, development and build dependencies included.
pub fn violations() -> Vec<String> {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("cargo lists packages");
    let mut violations = Vec::new();
    for package in packages {
        let (name, manifest) = (text(&package["name"]), text(&package["manifest_path"]));
        let Some((_, allowed)) = ARROWS.iter().find(|(known, _)| *known == name) else {
            violations.push(format!("{}: package `{name}` is in no row of ARROWS", place(manifest, name)));
            continue;
        };
        for dependency in package["dependencies"].as_array().expect("cargo lists dependencies") {
            let dependency = text(&dependency["name"]);
            let ours = ARROWS.iter().any(|(known, _)| *known == dependency);
            let reserved = RESERVED.iter().any(|(outside, owner)| *outside == dependency && *owner != name);
            if reserved || (ours && !allowed.contains(&dependency)) {
                violations.push(format!("{}: `{name}` must not depend on `{dependency}`", place(manifest, dependency)));
            }
        }
    }
    violations
}

fn metadata() -> Value {
    let cargo = env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let output = Command::new(cargo)
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .expect("cargo runs, since it runs this test");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo writes JSON")
}

/// `cargo run`, and with it `make run`, needs one command to choose.
pub fn commands_of_plain_cargo() -> Vec<String> {
    let metadata = metadata();
    let defaults = metadata["workspace_default_members"].as_array().expect("cargo lists the default members");
    let packages = metadata["packages"].as_array().expect("cargo lists packages");
    let targets = packages
        .iter()
        .filter(|package| defaults.contains(&package["id"]))
        .flat_map(|package| package["targets"].as_array().expect("cargo lists targets"));
    targets.filter(|target| target["kind"] == serde_json::json!(["bin"])).map(|target| text(&target["name"]).to_string()).collect()
}

fn text(value: &Value) -> &str {
    value.as_str().expect("cargo writes names and paths as text")
}

/// `file:line` of the first line of a manifest that starts with the name.
fn place(manifest: &str, name: &str) -> String {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace");
    let lines = fs::read_to_string(manifest).unwrap_or_default();
    let line = lines.lines().position(|line| line.trim_start().starts_with(name)).map_or(1, |at| at + 1);
    let path = Path::new(manifest).strip_prefix(top).unwrap_or(Path::new(manifest));
    format!("{}:{line}", path.display())
}
