//! From text to a system: everything that is wrong is said at once.

use super::description::{BaseDescription, Description, schema};
use super::{Kinds, Site, tree};
use crate::algorithm::kinematics;
use crate::description::Library;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::quantity::parse_quantity;
use crate::description::schema::validate;
use crate::description::urdf::{self, Robot};
use crate::dynamics::System;
use crate::force::Force;
use crate::model::Model;
use crate::scalar::Real;
use crate::spatial::Vec3;
use crate::stage::{Workspace, World};
use serde_json::Value;
use std::sync::Arc;

/// A system that was read from files.
#[derive(Debug)]
pub struct Assembled {
    /// Name for headings.
    pub name: String,
    /// A sentence or two.
    pub about: String,
    /// The system.
    pub system: Arc<System>,
    /// The tree as URDF describes it, with its looks.
    pub robot: Robot,
    /// Elements left out because their joint is locked: element, joint.
    pub left_out: Vec<(String, String)>,
    /// Kind of each element, in the order of the system.
    pub kinds: Vec<(String, String)>,
}

/// An override from outside the files: path and text, as in `--set front_tire.pressure=2.3bar`.
pub type Override = (String, String);

/// Reads a description and assembles it.
///
/// `file` is the name of the description in the library; names inside it are handed to the library as they stand. Errors and
/// warnings of all files come back together; the system is there where no error is among them.
pub fn assemble(file: &str, library: &dyn Library, kinds: &Kinds, overrides: &[Override]) -> (Option<Assembled>, Findings) {
    let mut findings = Findings::new();
    let Some(text) = library.text(file) else {
        findings.push(Finding::error("missing_file", format!("file `{file}` was not found")));
        return (None, findings);
    };
    let mut document = match Document::parse(file, &text) {
        Ok(document) => document,
        Err(errors) => return (None, errors),
    };
    let (of_tree, of_elements): (Vec<&Override>, Vec<&Override>) = overrides.iter().partition(|o| is_tree_path(&o.0));
    for (path, value) in of_elements {
        override_entry(&mut document, path, value, &mut findings);
    }
    findings.extend(validate(&document, &schema(kinds)));
    let robot = read_tree(&document, library, &of_tree, &mut findings);
    if findings.has_errors() {
        return (None, findings.sorted());
    }
    let description: Description = match serde_path_to_error::deserialize(document.value()) {
        Ok(description) => description,
        Err(error) => {
            let path = error.path().to_string();
            findings.push(document.located(Finding::error("invalid_entry", error.into_inner().to_string()).at_path(path)));
            return (None, findings.sorted());
        }
    };
    let Some(robot) = robot else { return (None, findings.sorted()) };
    let assembled = join(description, robot, library, kinds, &document, &mut findings);
    (assembled.filter(|_| !findings.has_errors()), findings.sorted())
}

/// A plain URDF as a system without elements, on a fixed, free or vehicle base.
pub fn assemble_urdf(file: &str, text: &str, base: BaseDescription, gravity: f64, overrides: &[Override]) -> (Option<Assembled>, Findings) {
    let (robot, mut findings) = urdf::read(file, text);
    let Some(mut robot) = robot else { return (None, findings) };
    for (path, value) in overrides {
        set_tree_entry(&mut robot, path, value, &mut findings);
    }
    let down = Vec3::new(0.0, 0.0, -gravity);
    let model = tree::model(&robot, base, &Default::default(), down, &mut findings);
    let assembled = model.and_then(|model| match System::new(model, Vec::new()) {
        Ok(system) => Some(Assembled {
            name: robot.name.clone(),
            about: String::new(),
            system: Arc::new(system),
            robot,
            left_out: Vec::new(),
            kinds: Vec::new(),
        }),
        Err(error) => {
            findings.push(Finding::error("signal_clash", error.to_string()));
            None
        }
    });
    (assembled.filter(|_| !findings.has_errors()), findings.sorted())
}

/// Whether an override goes to the URDF: `link.…`, or `joint.<name>.…` other than the joint options of the description.
fn is_tree_path(path: &str) -> bool {
    let option = [".locked", ".kind", ".pitch"].iter().any(|o| path.ends_with(o));
    path.starts_with("link.") || (path.starts_with("joint.") && !option)
}

/// Reads the URDF that the description names and applies overrides to it.
fn read_tree(document: &Document, library: &dyn Library, overrides: &[&Override], findings: &mut Findings) -> Option<Robot> {
    let name = document.value().get("urdf")?.as_str()?;
    let Some(text) = library.text(name) else {
        findings.push(document.located(Finding::error("missing_file", format!("file `{name}` was not found")).at_path("urdf")));
        return None;
    };
    let (robot, of_urdf) = urdf::read(name, &text);
    findings.extend(of_urdf);
    let mut robot = robot?;
    for (path, value) in overrides {
        set_tree_entry(&mut robot, path, value, findings);
    }
    if !overrides.is_empty() {
        findings.extend(robot.check());
    }
    Some(robot)
}

fn set_tree_entry(robot: &mut Robot, path: &str, text: &str, findings: &mut Findings) {
    let done = robot.dimension_of(path).and_then(|dimension| match parse_quantity(text, dimension) {
        Ok(value) => robot.set(path, value),
        Err(error) => Err(Finding::error(error.code(), error.to_string()).at_path(path).with_hint_from(error.hint()).into()),
    });
    if let Err(errors) = done {
        findings.extend(errors);
    }
}

/// Overrides an entry of the description. `element.parameter` skips the tag of the kind; `joint.<name>.locked` goes to `joints`.
fn override_entry(document: &mut Document, path: &str, text: &str, findings: &mut Findings) {
    let elements = document.value().get("elements").and_then(Value::as_object);
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    let place = if let Some(joint) = path.strip_prefix("joint.") {
        Some(format!("joints.{joint}"))
    } else if let Some(Value::Object(element)) = elements.and_then(|e| e.get(first)) {
        // `element.kind.parameter` and `element.parameter` both work
        let tagged = rest.split('.').next().is_some_and(|tag| element.contains_key(tag));
        let kind = element.keys().next().filter(|_| !tagged);
        Some(kind.map_or_else(|| format!("elements.{path}"), |kind| format!("elements.{first}.{kind}.{rest}")))
    } else {
        document.value().get(first).map(|_| path.to_owned())
    };
    let known = || elements.into_iter().flat_map(|e| e.keys().map(String::as_str)).chain(["gravity", "base", "joint", "link"]);
    match place {
        Some(place) => {
            if let Err(errors) = document.set(&place, text) {
                findings.extend(errors);
            }
        }
        None => {
            let hint = suggestion(first, known());
            findings.push(
                Finding::error("unknown_path", format!("`{path}` names no entry of this description")).at_path(path).with_hint_from(hint),
            );
        }
    }
}

/// Tree and elements become a system.
fn join(
    description: Description,
    robot: Robot,
    library: &dyn Library,
    kinds: &Kinds,
    document: &Document,
    findings: &mut Findings,
) -> Option<Assembled> {
    let down = Vec3::new(0.0, 0.0, -description.gravity.map_or(9.81, |g| g.si()));
    let mut of_tree = Findings::new();
    let model = tree::model(&robot, description.base, &description.joints, down, &mut of_tree);
    findings.extend(of_tree.iter().map(|f| document.located(f.clone())));
    let model = model?;
    let locked: Vec<String> = description.joints.iter().filter(|(_, o)| o.locked).map(|(name, _)| name.clone()).collect();
    let design = design_pose(&model);
    let (mut forces, mut left_out, mut named) = (Vec::new(), Vec::new(), Vec::new());
    let mut of_elements = Findings::new();
    for (name, value) in &description.elements {
        let Some((tag, parameters)) = value.as_object().and_then(|o| o.iter().next()) else { continue };
        let Some(kind) = kinds.element(tag) else { continue };
        let path = format!("elements.{name}.{tag}");
        let mut site = Site {
            element: name,
            path,
            model: &model,
            design: &design,
            locked: &locked,
            library,
            findings: &mut of_elements,
            left_out: None,
        };
        let built: Option<Force> = (kind.build)(&mut site, parameters);
        match (built, site.left_out.take()) {
            (Some(force), _) => {
                named.push((name.clone(), tag.clone()));
                forces.push(force);
            }
            (None, Some(joint)) => left_out.push((name.clone(), joint)),
            (None, None) => {}
        }
    }
    let failed = of_elements.has_errors();
    findings.extend(of_elements.iter().map(|f| document.located(f.clone())));
    if failed {
        return None;
    }
    match System::new(model, forces) {
        Ok(system) => Some(Assembled {
            name: description.name,
            about: description.about.unwrap_or_default(),
            system: Arc::new(system),
            robot,
            left_out,
            kinds: named,
        }),
        Err(error) => {
            findings.push(document.located(Finding::error("signal_clash", error.to_string()).at_path("elements")));
            None
        }
    }
}

/// Poses of all bodies with every joint at its reference.
fn design_pose(model: &Model) -> World<f64> {
    let mut w = Workspace::<f64>::new(model);
    for body in model.bodies().iter().skip(1) {
        for (q, &reference) in w.position.q[body.q.clone()].iter_mut().zip(body.joint.reference()) {
            *q = f64::from_f64(reference);
        }
    }
    kinematics::position(model, &mut w.position);
    kinematics::world(model, &w.position, &mut w.world);
    w.world
}
