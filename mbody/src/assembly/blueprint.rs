//! A description that was read once: systems with other numbers are made from it without reading it again.

use super::Kinds;
use super::assembled::{Assembled, Override, bare, join};
use super::description::{BaseDescription, Description, schema};
use super::tree_file::{self, changed_tree};
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings};
use crate::description::parameter::{self, Parameter};
use crate::description::quantity::{Dimension, judge};
use crate::description::schema::Schema;
use crate::description::urdf::{self, Robot};
use crate::description::{Library, composition};
use serde_json::Value;

/// What the text of a description says, and what of it are numbers that may vary.
#[derive(Clone, Debug)]
pub struct Blueprint {
    text: Text,
    /// The tree as its files have it.
    robot: Robot,
    /// Changes of the tree from outside.
    overrides: Vec<Override>,
    entries: Vec<Entry>,
    parameters: Vec<Parameter>,
}

/// Where the numbers beside the tree come from.
#[derive(Clone, Debug)]
enum Text {
    /// With formulas as they are written, and where those stand.
    Description(Document, Vec<(String, Option<&'static Dimension>)>),
    Urdf {
        base: BaseDescription,
        gravity: f64,
    },
}

/// A number of a description that may vary continuously.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Path by which it is overridden: `rear_shock.spring.stiffness`, `link.chassis.mass`, the name of a parameter.
    pub path: String,
    /// What it measures.
    pub dimension: &'static Dimension,
    /// Value, SI.
    pub value: f64,
    /// What it is; empty for entries of the URDF.
    pub about: String,
    /// Whether a formula gives its value: it follows the parameters in it, until it is changed itself.
    pub derived: bool,
    /// JSON pointer into the document; none for an entry of the URDF.
    pointer: Option<String>,
}

impl Blueprint {
    /// Reads a description with everything that is wrong in it; see [`super::assemble`].
    pub fn read(file: &str, library: &dyn Library, kinds: &Kinds, overrides: &[Override]) -> (Option<Self>, Findings) {
        let mut findings = Findings::new();
        let schema = match Schema::new(&schema(kinds)) {
            Ok(schema) => schema,
            Err(errors) => return (None, errors),
        };
        let Some(mut document) = composition::read(file, library, &schema, &mut findings) else { return (None, findings.sorted()) };
        if document.value().is_null() {
            let finding = Finding::error("empty_file", "the description is empty").in_file(file);
            return (None, finding.with_hint("`fastbike`, `name`, `urdf` and `base` are needed at least").into());
        }
        parameter::link(&mut document, &mut findings);
        let (of_tree, of_elements): (Vec<Override>, Vec<Override>) = overrides.iter().cloned().partition(|o| is_tree_path(&o.0));
        for (path, value) in &of_elements {
            override_entry(&mut document, path, value, &mut findings);
        }
        let formulas = schema.formulas(document.value());
        let mut evaluated = document.clone();
        let parameters = parameter::evaluate(&mut evaluated, &formulas, &mut findings);
        parameter::check_ranges(&evaluated, &parameters, &mut findings);
        findings.extend(unsaid(schema.check(&evaluated), &findings));
        let derived: Vec<&str> = formulas.iter().map(|(pointer, _)| pointer.as_str()).collect();
        let mut entries = entries_of(&evaluated, &schema, &parameters, &derived);
        let robot = tree_file::read(&evaluated, library, &mut findings);
        let changed = robot.as_ref().map(|robot| changed_tree(robot, Some(&evaluated), &of_tree, &mut findings));
        match (robot, changed) {
            (Some(robot), Some(changed)) if !findings.has_errors() => {
                entries.extend(entries_of_tree(&changed, &derived));
                (Some(Self { text: Text::Description(document, formulas), robot, overrides: of_tree, entries, parameters }), findings)
            }
            _ => (None, findings),
        }
    }

    /// Reads a plain URDF, on a base in a field of gravity (m/s²); see [`super::assemble_urdf`].
    pub fn read_urdf(file: &str, text: &str, (base, gravity): (BaseDescription, f64), overrides: &[Override]) -> (Option<Self>, Findings) {
        let (robot, mut findings) = urdf::read(file, text);
        let Some(robot) = robot else { return (None, findings) };
        let changed = changed_tree(&robot, None, overrides, &mut findings);
        let (entries, overrides) = (entries_of_tree(&changed, &[]), overrides.to_vec());
        (Some(Self { text: Text::Urdf { base, gravity }, robot, overrides, entries, parameters: Vec::new() }), findings)
    }

    /// Every number that may vary: parameters, those of elements and constraints without the entries of tables, then mass properties of links
    /// and places of joints.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Parameters and adjustables, as they were read.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The tree, with what the description and overrides change in it.
    pub(super) fn into_robot(self) -> Robot {
        changed_tree(&self.robot, None, &self.overrides, &mut Findings::new())
    }

    /// The system; what is wrong with it is added to the findings.
    pub fn assemble(&self, library: &dyn Library, kinds: &Kinds, findings: &mut Findings) -> Option<Assembled> {
        self.changed(&[], library, kinds, findings)
    }

    /// The system with some numbers changed: indices of [`Blueprint::entries`] with values in SI. Values are not held against the schema again,
    /// nor against the ranges of adjustables; formulas follow.
    ///
    /// # Errors
    /// No system has these values.
    pub fn with(&self, changes: &[(usize, f64)], library: &dyn Library, kinds: &Kinds) -> Result<Assembled, Findings> {
        let mut findings = Findings::new();
        let changes: Vec<(&Entry, f64)> = changes.iter().map(|&(entry, value)| (&self.entries[entry], value)).collect();
        self.changed(&changes, library, kinds, &mut findings).ok_or(findings)
    }

    fn changed(&self, changes: &[(&Entry, f64)], library: &dyn Library, kinds: &Kinds, findings: &mut Findings) -> Option<Assembled> {
        let set = |robot: &mut Robot, findings: &mut Findings| {
            for (entry, value) in changes.iter().filter(|(e, _)| e.pointer.is_none()) {
                if let Err(errors) = robot.set(&entry.path, *value) {
                    findings.extend(errors);
                }
            }
        };
        let (text, formulas) = match &self.text {
            Text::Description(document, formulas) => (document, formulas),
            Text::Urdf { base, gravity } => {
                let mut robot = changed_tree(&self.robot, None, &self.overrides, &mut Findings::new());
                set(&mut robot, findings);
                return bare(robot, (*base, *gravity), findings).filter(|_| !findings.has_errors());
            }
        };
        let mut document = text.clone();
        for (entry, value) in changes {
            let Some(pointer) = &entry.pointer else { continue };
            match self.parameters.iter().find(|p| p.pointer == *pointer) {
                Some(parameter) => document.put(pointer, parameter.written(*value)),
                None => document.put(pointer, *value),
            }
        }
        parameter::evaluate(&mut document, formulas, findings);
        // what is wrong with the tree as it is written was told when it was read
        let mut robot = changed_tree(&self.robot, Some(&document), &self.overrides, &mut Findings::new());
        set(&mut robot, findings);
        let assembled = match document.read::<Description>("") {
            Ok(description) => join(description, robot, library, kinds, &document, findings),
            Err(errors) => {
                findings.extend(errors);
                None
            }
        };
        assembled.filter(|_| !findings.has_errors())
    }
}

/// What the schema has to say where nothing was said yet: a formula without value is no number, too.
fn unsaid(found: Findings, before: &Findings) -> Vec<Finding> {
    let said = |f: &Finding| before.iter().any(|b| b.path == f.path && b.line == f.line && b.file == f.file);
    found.into_iter().filter(|f| !said(f)).collect()
}

/// Lists longer than this are tables, not points.
const POINT: usize = 3;

/// Parameters, numbers of elements and constraints, and gravity.
fn entries_of(document: &Document, schema: &Schema, parameters: &[Parameter], derived: &[&str]) -> Vec<Entry> {
    let varies = |pointer: &str| {
        let screw = pointer.starts_with("/joints/") && pointer.ends_with("/pitch");
        screw || ["/elements/", "/constraints/", "/gravity"].iter().any(|s| pointer.starts_with(s))
    };
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
            derived: derived.contains(&number.pointer.as_str()),
            pointer: Some(number.pointer),
        })
    };
    // clicks do not vary continuously
    let named = parameters.iter().filter(|p| !p.stepped).filter_map(|p| {
        let (value, pointer) = (p.value.si, Some(p.pointer.clone()));
        Some(Entry { path: p.name.clone(), dimension: p.dimension()?, value, about: p.about.clone(), derived: p.derived, pointer })
    });
    named.chain(numbers.filter_map(entry)).collect()
}

/// Mass properties of links and places of joints; `derived` are pointers to formulas of the description.
fn entries_of_tree(robot: &Robot, derived: &[&str]) -> Vec<Entry> {
    let varies = |path: &str| [".mass", ".com.", ".inertia.", ".origin.", ".rpy."].iter().any(|part| path.contains(part));
    let formulas: Vec<String> = derived.iter().filter_map(|p| tree_file::tree_path(p)).collect();
    let entry = |s: urdf::Settable| Entry {
        derived: formulas.contains(&s.path),
        path: s.path,
        dimension: s.dimension,
        value: s.value,
        about: String::new(),
        pointer: None,
    };
    robot.settable().into_iter().filter(|s| varies(&s.path)).map(entry).collect()
}

/// Whether an override goes to the URDF: `link.…`, or `joint.<name>.…` other than the joint options of the description.
fn is_tree_path(path: &str) -> bool {
    let option = [".locked", ".kind", ".pitch"].iter().any(|o| path.ends_with(o));
    path.starts_with("link.") || (path.starts_with("joint.") && !option)
}

/// Overrides an entry of the description; `joint.<name>.locked` stands under `joints` there, also where the description has no
/// word about this joint.
fn override_entry(document: &mut Document, path: &str, text: &str, findings: &mut Findings) {
    match parameter::set(document, path, text) {
        Ok(true) => return,
        Ok(false) => {}
        Err(errors) => return findings.extend(errors),
    }
    let (mut path, mut text) = (path.to_owned(), text.to_owned());
    if let Some((joint, option)) = path.strip_prefix("joint.").and_then(|rest| rest.rsplit_once('.')) {
        let entry = format!("joints.{joint}");
        if document.get(&entry).is_some() {
            path = format!("{entry}.{option}");
        } else {
            match Document::parse(document.file(), "joints: {}") {
                Ok(empty) => document.merge(empty, &[]),
                Err(errors) => findings.extend(errors),
            }
            (path, text) = (entry, format!("{{ {option}: {text} }}"));
        }
    }
    if let Err(errors) = document.set(&path, &text) {
        findings.extend(errors);
    }
}
