//! From text to a system: everything that is wrong is said at once.

use super::description::{BaseDescription, Description, schema};
use super::{Kinds, Site, closing, tree};
use crate::constraint::Constraint;
use crate::description::Library;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings};
use crate::description::quantity::parse_quantity;
use crate::description::schema::Schema;
use crate::description::urdf::{self, Robot};
use crate::dynamics::System;
use crate::force::Force;
use crate::model::{Model, ModelBuilder};
use crate::spatial::Vec3;
use crate::stage::Workspace;
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
    /// Name and kind of each constraint.
    pub constraints: Vec<(String, String)>,
}

/// An override from outside the files: path and text, as in `--set rear_spring.stiffness=58kN/m`.
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
    if document.value().is_null() {
        let finding = Finding::error("empty_file", "the description is empty").in_file(file);
        return (None, finding.with_hint("`fastbike`, `name`, `urdf` and `base` are needed at least").into());
    }
    let (of_tree, of_elements): (Vec<&Override>, Vec<&Override>) = overrides.iter().partition(|o| is_tree_path(&o.0));
    for (path, value) in of_elements {
        override_entry(&mut document, path, value, &mut findings);
    }
    match Schema::new(&schema(kinds)) {
        Ok(schema) => findings.extend(schema.check(&document)),
        Err(errors) => findings.extend(errors),
    }
    let robot = read_tree(&document, library, &of_tree, &mut findings);
    if findings.has_errors() {
        return (None, findings.sorted());
    }
    let description: Description = match document.read("") {
        Ok(description) => description,
        Err(errors) => {
            findings.extend(errors);
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
    change_tree(&mut robot, &overrides.iter().collect::<Vec<_>>(), &mut findings);
    let down = Vec3::new(0.0, 0.0, -gravity);
    let model = tree::model(&robot, base, &Default::default(), down, &|_, _| {}, &mut findings);
    let assembled = model.and_then(|model| match System::new(model, Vec::new()) {
        Ok(system) => Some(Assembled {
            name: robot.name.clone(),
            about: String::new(),
            system: Arc::new(system),
            robot,
            left_out: Vec::new(),
            kinds: Vec::new(),
            constraints: Vec::new(),
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
        findings.push(document.locate(Finding::error("missing_file", format!("file `{name}` was not found")).at_path("urdf")));
        return None;
    };
    let (robot, of_urdf) = urdf::read(name, &text);
    let held = |f: &Finding| f.code == "massless_tip" && robot.as_ref().is_some_and(|r| is_held(document.value(), r, &f.path));
    findings.extend(of_urdf.iter().filter(|f| !held(f)).cloned());
    let mut robot = robot?;
    change_tree(&mut robot, overrides, findings);
    Some(robot)
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

/// Applies overrides to a tree. What is wrong only now is the fault of the overrides, not of the text.
fn change_tree(robot: &mut Robot, overrides: &[&Override], findings: &mut Findings) {
    if overrides.is_empty() {
        return;
    }
    let before = robot.check();
    for (path, value) in overrides {
        set_tree_entry(robot, path, value, findings);
    }
    let changes = overrides.iter().map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>().join(" ");
    for finding in robot.check().iter().filter(|f| before.iter().all(|b| b.message != f.message)) {
        let nowhere = Finding { line: None, column: None, excerpt: None, ..finding.clone() };
        findings.push(nowhere.in_file(&changes));
    }
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

/// Overrides an entry of the description; `joint.<name>.locked` stands under `joints` there, also where the description has no
/// word about this joint.
fn override_entry(document: &mut Document, path: &str, text: &str, findings: &mut Findings) {
    let (mut path, mut text) = (path.to_owned(), text.to_owned());
    if let Some((joint, option)) = path.strip_prefix("joint.").and_then(|rest| rest.rsplit_once('.')) {
        let entry = format!("joints.{joint}");
        if document.get(&entry).is_some() {
            path = format!("{entry}.{option}");
        } else {
            match Document::parse(document.file(), "joints: {}") {
                Ok(empty) => document.merge(empty),
                Err(errors) => findings.extend(errors),
            }
            (path, text) = (entry, format!("{{ {option}: {text} }}"));
        }
    }
    if let Err(errors) = document.set(&path, &text) {
        findings.extend(errors);
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
    let couple = |builder: &mut ModelBuilder, findings: &mut Findings| closing::couple(&description.constraints, kinds, builder, findings);
    let model = tree::model(&robot, description.base, &description.joints, down, &couple, &mut of_tree);
    findings.extend(of_tree.iter().map(|f| document.locate(f.clone())));
    let model = model?;
    let locked: Vec<String> = description.joints.iter().filter(|(_, o)| o.locked).map(|(name, _)| name.clone()).collect();
    let mut of_loops = Findings::new();
    let stated = closing::start_coordinates(&model, &description.start, &mut of_loops);
    let (constraints, tied) = constraints(&description, &model, &stated, &locked, library, kinds, &mut of_loops);
    let closed = match of_loops.has_errors() {
        true => None,
        false => closing::close(&model, constraints, &stated, &mut of_loops),
    };
    findings.extend(of_loops.iter().map(|f| document.locate(f.clone())));
    let closed = closed?;
    let mut design = Workspace::new(&model);
    match &closed.q {
        Some(q) => design.to_coordinates(&model, q.iter().copied()),
        None => design.to_design(&model),
    }
    let (mut forces, mut left_out, mut named) = (Vec::new(), Vec::new(), Vec::new());
    let mut of_elements = Findings::new();
    for (name, value) in &description.elements {
        let Some((tag, parameters)) = closing::entry(value) else { continue };
        let Some(kind) = kinds.element(tag) else { continue };
        let path = format!("elements.{name}.{tag}");
        let mut site = Site {
            element: name,
            path,
            model: &model,
            design: &design.world,
            locked: &locked,
            constraints: &closed.constraints,
            library,
            findings: &mut of_elements,
            left_out: None,
        };
        let built: Option<Force> = (kind.build)(&mut site, parameters);
        match (built, site.left_out.take()) {
            (Some(force), _) => {
                named.push((name.clone(), tag.to_owned()));
                forces.push(force);
            }
            (None, Some(joint)) => left_out.push((name.clone(), joint)),
            (None, None) => {}
        }
    }
    let failed = of_elements.has_errors();
    findings.extend(of_elements.iter().map(|f| document.locate(f.clone())));
    if failed {
        return None;
    }
    match System::constrained(model, closed, forces) {
        Ok(mut system) => {
            let mut of_start = Findings::new();
            system.start(|unknowns| closing::start_values(unknowns, &description.start, &mut of_start));
            findings.extend(of_start.iter().map(|f| document.locate(f.clone())));
            Some(Assembled {
                name: description.name,
                about: description.about.unwrap_or_default(),
                system: Arc::new(system),
                robot,
                left_out,
                kinds: named,
                constraints: tied,
            })
        }
        Err(error) => {
            findings.push(document.locate(Finding::error("signal_clash", error.to_string()).at_path("elements")));
            None
        }
    }
}

/// Constraints in the pose before loops are closed, and name and kind of all of them.
fn constraints(
    description: &Description,
    model: &Model,
    stated: &[(usize, f64)],
    locked: &[String],
    library: &dyn Library,
    kinds: &Kinds,
    findings: &mut Findings,
) -> (Vec<Constraint>, Vec<(String, String)>) {
    let mut before = Workspace::new(model);
    let mut q = closing::reference(model);
    stated.iter().for_each(|&(i, x)| q[i] = x);
    before.to_coordinates(model, q.into_iter());
    let (mut built, mut named) = (Vec::new(), Vec::new());
    for (name, value) in &description.constraints {
        let Some((tag, parameters)) = closing::entry(value) else { continue };
        let Some(kind) = kinds.constraint(tag) else { continue };
        let path = format!("constraints.{name}.{tag}");
        let mut site =
            Site { element: name, path, model, design: &before.world, locked, constraints: &[], library, findings, left_out: None };
        built.extend((kind.build)(&mut site, parameters));
        named.push((name.clone(), tag.to_owned()));
    }
    (built, named)
}
