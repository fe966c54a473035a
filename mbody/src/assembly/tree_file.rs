//! The tree of a description: one URDF file or several parts, with what the description and overrides change in it.

use super::assembled::Override;
use crate::description::Library;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::quantity::{judge, parse_quantity};
use crate::description::urdf::{self, Robot};
use serde_json::Value;

/// Reads the files that the description names; each is relative to the text in which its name stands.
pub(super) fn read(document: &Document, library: &dyn Library, findings: &mut Findings) -> Option<Robot> {
    let mut names: Vec<(String, &str)> = Vec::new();
    match document.value().get("urdf")? {
        Value::String(name) => names.push(("urdf".to_owned(), name)),
        Value::Object(parts) => names.extend(parts.iter().filter_map(|(part, name)| Some((format!("urdf.{part}"), name.as_str()?)))),
        _ => return None,
    }
    let mut texts = Vec::new();
    for (path, name) in &names {
        let within = document.pointer_of(path).map_or(document.file(), |pointer| document.file_of(&pointer));
        let full = library.resolve(name, within);
        match library.text(&full) {
            Some(text) => texts.push((full, text)),
            None => findings.push(document.finding(path, "missing_file", format!("file `{name}` was not found"))),
        }
    }
    if texts.len() < names.len() || texts.is_empty() {
        return None;
    }
    let parts: Vec<(&str, &str)> = texts.iter().map(|(file, text)| (file.as_str(), text.as_ref())).collect();
    let (robot, of_urdf) = urdf::read_parts(&parts);
    let held = |f: &Finding| f.code == "massless_tip" && robot.as_ref().is_some_and(|r| is_held(document.value(), r, &f.path));
    findings.extend(of_urdf.iter().filter(|f| !held(f)).cloned());
    robot
}

/// Whether a constraint holds the massless link of a path `link.<name>`, or one behind it: its motion follows from the others then.
fn is_held(description: &Value, robot: &Robot, path: &str) -> bool {
    let Some(link) = path.strip_prefix("link.") else { return false };
    let mut links = Vec::new();
    constrained_links(description.get("constraints").unwrap_or(&Value::Null), &mut links);
    links.iter().any(|&held| {
        let mut at = held;
        loop {
            if at == link {
                return true;
            }
            match robot.joints.iter().find(|j| j.child == at) {
                Some(joint) => at = &joint.parent,
                None => return false,
            }
        }
    })
}

/// All values under a key `link`.
fn constrained_links<'a>(value: &'a Value, links: &mut Vec<&'a str>) {
    if let Some(entries) = value.as_object() {
        links.extend(entries.get("link").and_then(Value::as_str));
        entries.values().for_each(|v| constrained_links(v, links));
    }
}

/// The tree with what stands under `links:` and `joints:` of a description, then with overrides. What is wrong only now is the fault of
/// those, not of the URDF.
pub(super) fn changed_tree(robot: &Robot, document: Option<&Document>, overrides: &[Override], findings: &mut Findings) -> Robot {
    let mut changed = robot.clone();
    let mut known: Vec<Finding> = robot.check().into_iter().collect();
    let mut places: Vec<(String, String)> = Vec::new();
    for (section, owner) in [("links", "link"), ("joints", "joint")] {
        let Some(document) = document else { break };
        for (name, options) in document.value().get(section).and_then(Value::as_object).into_iter().flatten() {
            // a joint that does not exist is told with its other options
            let there = if section == "links" { robot.link(name).is_some() } else { robot.joint(name).is_some() };
            if !there && section == "links" {
                let hint = suggestion(name, robot.links.iter().map(|l| l.name.as_str()));
                let path = format!("links.{name}");
                findings.push(document.finding(&path, "unknown_link", format!("link `{name}` does not exist")).with_hint_from(hint));
            }
            for (entry, value) in numbers(options).into_iter().filter(|_| there) {
                let (path, at) = (format!("{owner}.{name}.{entry}"), format!("{section}.{name}.{entry}"));
                // entries and their units are judged by the schema
                if let Ok(Some(Ok(si))) = changed.dimension_of(&path).map(|dimension| judge(value, dimension)) {
                    findings.extend(changed.set(&path, si).err().into_iter().flatten().map(|f| f.at_path(&at)));
                }
                places.push((path, at));
            }
        }
        for finding in fresh(&changed, &mut known) {
            // the entry that is most like the path in the URDF
            let about = finding.path.replace(".inertial", "");
            let alike = |path: &str| path.bytes().zip(about.bytes()).take_while(|(a, b)| a == b).count();
            let place = places.iter().max_by_key(|(path, _)| alike(path)).map_or(section, |(_, at)| at.as_str());
            findings.push(document.locate(Finding { path: place.to_owned(), ..finding }));
        }
    }
    for (path, value) in overrides {
        set(&mut changed, path, value, findings);
    }
    if !overrides.is_empty() {
        let changes = overrides.iter().map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>().join(" ");
        findings.extend(fresh(&changed, &mut known).into_iter().map(|f| f.in_file(&changes)));
    }
    changed
}

/// What is wrong with the tree and was not known, without a place.
fn fresh(robot: &Robot, known: &mut Vec<Finding>) -> Vec<Finding> {
    let new: Vec<Finding> = robot.check().into_iter().filter(|f| known.iter().all(|k| k.message != f.message)).collect();
    known.extend(new.iter().cloned());
    new.into_iter().map(Finding::without_place).collect()
}

/// Path of the entry of the tree that an entry under `links` or `joints` changes: `link.arm.com.x` of `/links/arm/com/x`.
pub(super) fn tree_path(pointer: &str) -> Option<String> {
    let (owner, rest) = match pointer.strip_prefix("/links/") {
        Some(rest) => ("link", rest),
        None => ("joint", pointer.strip_prefix("/joints/")?),
    };
    Some(format!("{owner}.{}", rest.replace('/', ".").replace("~1", "/").replace("~0", "~")))
}

/// Numbers of the options of a link or joint that change the URDF, by their path below it.
fn numbers(options: &Value) -> Vec<(String, &Value)> {
    let of_urdf = |key: &str| !matches!(key, "locked" | "kind" | "pitch");
    let mut found = Vec::new();
    for (key, value) in options.as_object().into_iter().flatten().filter(|(key, _)| of_urdf(key)) {
        match value {
            Value::Object(inner) => found.extend(inner.iter().map(|(k, v)| (format!("{key}.{k}"), v))),
            _ => found.push((key.clone(), value)),
        }
    }
    found
}

fn set(robot: &mut Robot, path: &str, text: &str, findings: &mut Findings) {
    let done = robot.dimension_of(path).and_then(|dimension| match parse_quantity(text, dimension) {
        Ok(value) => robot.set(path, value),
        Err(error) => Err(Finding::error(error.code(), error.to_string()).at_path(path).with_hint_from(error.hint()).into()),
    });
    if let Err(errors) = done {
        findings.extend(errors);
    }
}
