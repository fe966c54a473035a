//! A description that was read once: systems with other numbers are made from it without reading it again.

use super::Kinds;
use super::assembled::{Assembled, Override, bare, join};
use super::description::{BaseDescription, Description, schema};
use crate::description::Library;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings};
use crate::description::quantity::{Dimension, judge, parse_quantity};
use crate::description::schema::Schema;
use crate::description::urdf::{self, Robot};
use serde_json::Value;

/// What the text of a description says, and what of it are numbers that may vary.
#[derive(Clone, Debug)]
pub struct Blueprint {
    text: Text,
    robot: Robot,
    entries: Vec<Entry>,
}

/// Where the numbers beside the tree come from.
#[derive(Clone, Debug)]
enum Text {
    Description(Document),
    Urdf { base: BaseDescription, gravity: f64 },
}

/// A number of a description that may vary continuously.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Path by which it is overridden: `rear_shock.spring.stiffness`, `link.chassis.mass`.
    pub path: String,
    /// What it measures.
    pub dimension: &'static Dimension,
    /// Value, SI.
    pub value: f64,
    /// What it is; empty for entries of the URDF.
    pub about: String,
    /// JSON pointer into the document; none for an entry of the URDF.
    pointer: Option<String>,
}

impl Blueprint {
    /// Reads a description with everything that is wrong in it; see [`super::assemble`].
    pub fn read(file: &str, library: &dyn Library, kinds: &Kinds, overrides: &[Override]) -> (Option<Self>, Findings) {
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
        let mut entries = Vec::new();
        match Schema::new(&schema(kinds)) {
            Ok(schema) => {
                findings.extend(schema.check(&document));
                entries = entries_of(&document, &schema);
            }
            Err(errors) => findings.extend(errors),
        }
        let robot = read_tree(&document, library, &of_tree, &mut findings);
        match robot.filter(|_| !findings.has_errors()) {
            Some(robot) => {
                entries.extend(entries_of_tree(&robot));
                (Some(Self { text: Text::Description(document), robot, entries }), findings)
            }
            None => (None, findings),
        }
    }

    /// Reads a plain URDF, on a base in a field of gravity (m/s²); see [`super::assemble_urdf`].
    pub fn read_urdf(file: &str, text: &str, (base, gravity): (BaseDescription, f64), overrides: &[Override]) -> (Option<Self>, Findings) {
        let (robot, mut findings) = urdf::read(file, text);
        let Some(mut robot) = robot else { return (None, findings) };
        change_tree(&mut robot, &overrides.iter().collect::<Vec<_>>(), &mut findings);
        let entries = entries_of_tree(&robot);
        (Some(Self { text: Text::Urdf { base, gravity }, robot, entries }), findings)
    }

    /// Every number that may vary: those of elements and constraints without the entries of tables, then mass properties of links and places
    /// of joints.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The tree.
    pub(super) fn into_robot(self) -> Robot {
        self.robot
    }

    /// The system; what is wrong with it is added to the findings.
    pub fn assemble(&self, library: &dyn Library, kinds: &Kinds, findings: &mut Findings) -> Option<Assembled> {
        let assembled = match &self.text {
            Text::Urdf { base, gravity } => bare(self.robot.clone(), (*base, *gravity), findings),
            Text::Description(document) => match document.read::<Description>("") {
                Ok(description) => join(description, self.robot.clone(), library, kinds, document, findings),
                Err(errors) => {
                    findings.extend(errors);
                    None
                }
            },
        };
        assembled.filter(|_| !findings.has_errors())
    }

    /// The system with some numbers changed: indices of [`Blueprint::entries`] with values in SI. Values are not held against the schema again.
    ///
    /// # Errors
    /// No system has these values.
    pub fn with(&self, changes: &[(usize, f64)], library: &dyn Library, kinds: &Kinds) -> Result<Assembled, Findings> {
        let mut changed = Self { entries: Vec::new(), ..self.clone() };
        for &(entry, value) in changes {
            let entry = &self.entries[entry];
            match (&entry.pointer, &mut changed.text) {
                (Some(pointer), Text::Description(document)) => document.put(pointer, value),
                _ => changed.robot.set(&entry.path, value)?,
            }
        }
        let mut findings = Findings::new();
        changed.assemble(library, kinds, &mut findings).ok_or(findings)
    }
}

/// Lists longer than this are tables, not points.
const POINT: usize = 3;

/// Numbers of elements and constraints, and gravity.
fn entries_of(document: &Document, schema: &Schema) -> Vec<Entry> {
    let varies = |pointer: &str| ["/elements/", "/constraints/", "/gravity", "/joints/"].iter().any(|s| pointer.starts_with(s));
    let in_table = |pointer: &str| {
        let lists = pointer.match_indices('/').map(|(end, _)| &pointer[..end]);
        lists.filter_map(|p| document.value().pointer(p)?.as_array()).any(|list| list.len() > POINT || list.iter().any(Value::is_array))
    };
    let numbers = schema.numbers(document.value()).into_iter().filter(|n| varies(&n.pointer) && !in_table(&n.pointer));
    let entry = |number: crate::description::schema::Number| {
        let value = judge(document.value().pointer(&number.pointer)?, number.dimension)?.ok()?;
        Some(Entry {
            path: document.path_of(&number.pointer),
            dimension: number.dimension,
            value,
            about: number.about,
            pointer: Some(number.pointer),
        })
    };
    numbers.filter_map(entry).collect()
}

/// Mass properties of links and places of joints.
fn entries_of_tree(robot: &Robot) -> Vec<Entry> {
    let varies = |path: &str| [".mass", ".com.", ".inertia.", ".origin.", ".rpy."].iter().any(|part| path.contains(part));
    let entries = robot.settable().into_iter().filter(|s| varies(&s.path));
    entries.map(|s| Entry { path: s.path, dimension: s.dimension, value: s.value, about: String::new(), pointer: None }).collect()
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
