//! From the MODEL argument to an assembled system.

use crate::arguments::{ModelArguments, argument};
use crate::library::Source;
use crate::{Context, Failure};
use mbody::assembly::{Assembled, BaseDescription, Blueprint, Override};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
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

/// Splits `PATH=VALUE`.
pub fn overrides(settings: &[String]) -> Result<Vec<Override>, Failure> {
    let split = |s: &String| match s.split_once('=') {
        Some((path, value)) if !path.is_empty() && !value.is_empty() => Ok((path.trim().to_owned(), value.trim().to_owned())),
        _ => Err(argument("set", s, "bad_override", "this is not of the form PATH=VALUE")
            .with_hint("for example `--set front_tire.radius=0.3m`")
            .into()),
    };
    settings.iter().map(split).collect()
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
