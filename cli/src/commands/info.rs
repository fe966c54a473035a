//! `info`: what a model consists of; without a model, the bundled ones; with `--kinds`, every kind of element.

use super::{Kind, read};
use crate::arguments::ModelArguments;
use crate::explain::{Dictionary, Told};
use crate::library::{Source, bundled_models, bundled_setups};
use crate::output::number::number;
use crate::{Context, Exit, Failure, model};
use clap::{ArgMatches, Args, Command};
use mbody::assembly::{Assembled, BaseDescription, Blueprint};
use mbody::description::Library;
use mbody::description::parameter::Parameter;
use mbody::model::BodyIndex;
use problem::{Signal, UnknownKind};
use std::fmt::Write;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "info", command, run };

#[derive(Debug, Args)]
struct Arguments {
    /// Bundled name, or the path of a .yaml description or a plain .urdf; left out: lists the bundled models
    model: Option<String>,
    /// Override an entry of the description (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// List every kind of element with its parameters and an example
    #[arg(long)]
    kinds: bool,
    /// Put a plain URDF on a free base
    #[arg(long)]
    floating: bool,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Bodies, joints, degrees of freedom, elements, signals and mass properties of a model")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let text = match (&arguments.model, arguments.kinds) {
        (_, true) => kinds(context),
        (None, false) => bundled(context)?,
        (Some(name), false) => {
            let model = ModelArguments { model: name.clone(), set: arguments.set.clone(), reactions: false };
            let base = if arguments.floating { BaseDescription::Free } else { BaseDescription::Fixed };
            let loaded = model::load_on(&model, context, base, 9.81)?;
            about(&loaded.assembled) + &named(&loaded.blueprint)
        }
    };
    context.console.print(text.as_bytes())?;
    Ok(Exit::Done)
}

/// The bundled models with their names.
fn bundled(context: &Context) -> Result<String, Failure> {
    let mut text = String::from("bundled models (fastbike info MODEL tells more):\n");
    for name in bundled_models() {
        let source = Source::find(name)?;
        let about = source.text(&source.file).and_then(|t| t.lines().find_map(|l| l.strip_prefix("name:").map(|n| n.trim().to_owned())));
        let _ = writeln!(text, "  {name:<14} {}", about.unwrap_or_default());
    }
    let _ = writeln!(text, "bundled setups of them: {}", bundled_setups().join(", "));
    let _ = writeln!(text, "{} kinds of elements (fastbike info --kinds)", context.kinds.elements().len());
    Ok(text)
}

/// Every kind of elements, of constraints, then of sections, with parameters and an example.
fn kinds(context: &Context) -> String {
    let dictionary = Dictionary::of(&context.kinds);
    let told = |table: Vec<Told<'_>>| table.into_iter().map(|k| dictionary.kind(k.0)).collect::<String>();
    let (elements, constraints) = (told(dictionary.elements()), told(dictionary.constraints()));
    format!("{elements}constraints\n\n{constraints}sections of the path of a maneuver\n\n{}", told(dictionary.sections()))
}

/// What may be changed by name: adjustables with their ranges, then parameters.
fn named(blueprint: &Blueprint) -> String {
    let mut text = String::new();
    for (title, adjustable) in [("adjustables", true), ("parameters", false)] {
        let of_sort: Vec<&Parameter> = blueprint.parameters().iter().filter(|p| p.range.is_some() == adjustable).collect();
        if !of_sort.is_empty() {
            let _ = writeln!(text, "\n{title}");
        }
        for p in of_sort {
            let unit = p.dimension().map(|d| d.unit).filter(|u| *u != "1").unwrap_or_default();
            let range = p.range.map(|(low, high)| format!("{} to {}", number(low), number(high))).unwrap_or_default();
            let _ = writeln!(text, "  {:<22} {:>12} {unit:<8} {range:<18} {}", p.name, number(p.value.si), p.about);
        }
    }
    text
}

fn about(assembled: &Assembled) -> String {
    let system = &assembled.system;
    let tree = system.model();
    let mut text = format!("{}\n", assembled.name);
    if !assembled.about.is_empty() {
        let _ = writeln!(text, "{}", assembled.about.trim());
    }
    let (nq, nv) = (tree.layout().nq(), tree.layout().nv());
    let _ = writeln!(
        text,
        "\n{} moving bodies, {} degrees of freedom ({nq} coordinates, {nv} velocities, {} tree velocities, {} followers), {} constraint rows, {:.6} kg",
        tree.moving().count(),
        system.degrees_of_freedom(),
        tree.layout().tree_nv,
        tree.layout().followers.len(),
        system.held_rows(),
        tree.total_mass()
    );
    let _ = writeln!(text, "\nbodies and joints (in the order of q and v)");
    for body in tree.moving() {
        let b = tree.body(body);
        let parent = if b.parent == BodyIndex::WORLD { "world" } else { &tree.body(b.parent).name };
        let kind = format!("{:?}", b.joint);
        let kind = kind.split([' ', '{']).next().unwrap_or_default();
        let c = b.mass.center;
        let _ = writeln!(
            text,
            "  {:<18} joint {:<16} {kind:<12} on {parent:<16} {:>10.4} kg  center ({:.4}, {:.4}, {:.4}) m",
            b.name, b.joint_name, b.mass.mass, c.x, c.y, c.z
        );
    }
    let welded = tree.frames().iter().filter(|f| tree.bodies().iter().all(|b| b.name != f.name));
    let welded: Vec<String> = welded.map(|f| format!("{} (on {})", f.name, tree.body(f.body).name)).collect();
    if !welded.is_empty() {
        let _ = writeln!(text, "  welded: {}", welded.join(", "));
    }
    if !assembled.constraints.is_empty() {
        let _ = writeln!(text, "\nconstraints");
    }
    for (name, kind) in &assembled.constraints {
        let _ = writeln!(text, "  {name:<22} {kind}");
    }
    if !assembled.kinds.is_empty() {
        let _ = writeln!(text, "\nelements");
    }
    for (name, kind) in &assembled.kinds {
        let _ = writeln!(text, "  {name:<22} {kind}");
    }
    for (element, joint) in &assembled.left_out {
        let _ = writeln!(text, "  {element:<22} left out: joint `{joint}` is locked");
    }
    let section = |text: &mut String, title: &str, signals: Vec<&Signal>| {
        if !signals.is_empty() {
            let _ = writeln!(text, "\n{title}");
        }
        for s in signals {
            let _ = writeln!(text, "  {:<34} {:<8} {}", s.name, s.unit, s.about);
        }
    };
    let of = |kind: UnknownKind| system.unknowns().iter().filter(move |u| u.kind == kind).map(|u| &u.signal).collect::<Vec<_>>();
    section(&mut text, "coordinates", of(UnknownKind::Position));
    section(&mut text, "velocities", of(UnknownKind::Velocity));
    section(&mut text, "element states", of(UnknownKind::State));
    section(&mut text, "multipliers", of(UnknownKind::Algebraic));
    section(&mut text, "inputs", system.inputs().iter().map(|i| &i.signal).collect());
    section(&mut text, "outputs", system.outputs().iter().collect());
    text
}
