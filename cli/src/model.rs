//! From the MODEL argument to an assembled system.

use crate::arguments::{ModelArguments, argument};
use crate::library::{Source, bundled_setups};
use crate::{Context, Failure};
use mbody::assembly::{Assembled, BaseDescription, Blueprint, Kinds, Override};
use mbody::description::Library;
use mbody::description::document::Document;
use mbody::description::finding::{Finding, Findings};
use serde_json::Value;
use std::borrow::Cow;
use std::cell::RefCell;
use std::sync::Arc;

/// An assembled model and what was said about it.
#[derive(Debug)]
pub struct Loaded {
    /// Short name, as typed.
    pub name: String,
    /// The system.
    pub assembled: Assembled,
    /// What it was made from: others with other numbers can be made too.
    pub blueprint: Blueprint,
    /// Where that was read.
    pub source: Source,
    /// Warnings and notes.
    pub findings: Findings,
}

/// Splits `PATH=VALUE`; the name of a setup stands for all values in it.
pub fn overrides(settings: &[String]) -> Result<Vec<Override>, Failure> {
    let mut all = Vec::new();
    for setting in settings {
        match setting.split_once('=') {
            Some((path, value)) if !path.is_empty() && !value.is_empty() => all.push((path.trim().to_owned(), value.trim().to_owned())),
            None if is_setup(setting) => all.extend(setup(setting)?),
            _ => {
                let finding = argument("set", setting, "bad_override", "this is neither of the form PATH=VALUE nor a setup");
                return Err(finding.with_hint("for example `--set front_tire.radius=0.3m`, `--set wet.yaml`").into());
            }
        }
    }
    Ok(all)
}

/// Whether a setting is the name of a setup file or of a bundled setup.
fn is_setup(setting: &str) -> bool {
    setting.ends_with(".yaml") || setting.ends_with(".yml") || bundled_setups().contains(&setting)
}

/// Values of a setup, for a model other than its own.
fn setup(name: &str) -> Result<Vec<Override>, Failure> {
    let source = Source::find(name)?;
    let document = Document::parse(&source.file, &source.text(&source.file).unwrap_or_default())?;
    if document.value().get("setup").is_none() {
        let finding = document.finding("", "wrong_file", format!("`{name}` is not a setup"));
        return Err(finding.with_hint("a setup begins with `setup: MODEL`; another model is named in place of this one").into());
    }
    let shown = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let values = document.value().get("adjust").and_then(Value::as_object);
    Ok(values.into_iter().flatten().map(|(key, value)| (key.clone(), shown(value))).collect())
}

/// What was read: the description, and the system where nothing is wrong.
type Read = (Option<(Blueprint, Assembled)>, Findings, Source);

/// Reads and assembles; nothing is thrown away: the findings come with the system or instead of it.
pub fn read(model: &str, set: &[String], context: &Context) -> Result<Read, Failure> {
    read_on(model, set, context, BaseDescription::Fixed, 9.81)
}

/// As [`read`], with the base and the gravity (m/s²) of a plain URDF.
fn read_on(model: &str, set: &[String], context: &Context, base: BaseDescription, gravity: f64) -> Result<Read, Failure> {
    let source = Source::find(model)?;
    let overrides = overrides(set)?;
    let (blueprint, mut findings) = if source.is_urdf() {
        match source.text(&source.file) {
            Some(text) => Blueprint::read_urdf(&source.file, &text, (base, gravity), &overrides),
            None => (None, Finding::error("missing_file", format!("file `{}` cannot be read as text", source.file)).into()),
        }
    } else {
        Blueprint::read(&source.file, &source, &context.kinds, &overrides)
    };
    let assembled = blueprint.and_then(|blueprint| {
        let assembled = blueprint.assemble(&source, &context.kinds, &mut findings)?;
        Some((blueprint, assembled))
    });
    Ok((assembled, findings.sorted(), source))
}

/// Reads and assembles, or fails with everything that is wrong.
pub fn load(arguments: &ModelArguments, context: &Context) -> Result<Loaded, Failure> {
    load_on(arguments, context, BaseDescription::Fixed, 9.81)
}

/// As [`load`], with the base and the gravity (m/s²) of a plain URDF.
pub fn load_on(arguments: &ModelArguments, context: &Context, base: BaseDescription, gravity: f64) -> Result<Loaded, Failure> {
    let (assembled, findings, source) = read_on(&arguments.model, &arguments.set, context, base, gravity)?;
    match assembled {
        Some((blueprint, mut assembled)) => {
            // nobody else has seen the system yet
            if let Some(system) = Arc::get_mut(&mut assembled.system).filter(|_| arguments.reactions) {
                system.report_reactions();
            }
            Ok(Loaded { name: source.name.clone(), assembled, blueprint, source, findings })
        }
        None => Err(Failure::Findings(findings)),
    }
}

/// A library that remembers which texts were read.
struct Recorder<'a> {
    source: &'a Source,
    read: RefCell<Vec<String>>,
}

impl Library for Recorder<'_> {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        let text = self.source.text(name)?;
        let mut read = self.read.borrow_mut();
        if !read.iter().any(|known| known == name) {
            read.push(name.to_owned());
        }
        Some(text)
    }

    fn resolve(&self, name: &str, within: &str) -> String {
        self.source.resolve(name, within)
    }
}

/// Names of all texts that a model reads, the description first; [`Library::text`] of the source knows them.
///
/// # Errors
/// The model cannot be read.
pub fn texts(source: &Source, kinds: &Kinds) -> Result<Vec<String>, Findings> {
    let recorder = Recorder { source, read: RefCell::default() };
    let (blueprint, mut findings) = match source.is_urdf() {
        true => {
            let text = recorder.text(&source.file).unwrap_or_default().into_owned();
            Blueprint::read_urdf(&source.file, &text, (BaseDescription::Fixed, 9.81), &[])
        }
        false => Blueprint::read(&source.file, &recorder, kinds, &[]),
    };
    if let Some(blueprint) = blueprint {
        // tires and tables are read while elements are made
        blueprint.assemble(&recorder, kinds, &mut findings);
    }
    if findings.has_errors() { Err(findings) } else { Ok(recorder.read.into_inner()) }
}
