//! `explain`: what an entry, a kind, a signal, an ending or a finding means.

use super::{Kind, read};
use crate::arguments::ModelArguments;
use crate::explain::{CODES, Dictionary, ENDINGS, near};
use crate::{Context, Exit, Failure, model};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;
use std::fmt::Write;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "explain", command, run };

#[derive(Debug, Args)]
struct Arguments {
    /// An entry (`rear_shock.spring.stiffness`, `link.chassis.mass`), a kind (`telescopic_fork`), a signal (`chassis.roll`), an ending
    /// (`tire_saturated`) or the code of a finding (`unknown_key`)
    word: String,
    /// Model whose signals and entries are meant
    #[arg(long, value_name = "MODEL", default_value = "gsxr1000")]
    model: String,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("What an entry, a kind, a signal, an ending or a finding means")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let word = arguments.word.trim();
    let dictionary = Dictionary::of(&context.kinds);
    let mut text = String::new();
    for (table, what) in [(CODES, "code of a finding"), (ENDINGS, "ending")] {
        for (_, about) in table.iter().filter(|(name, _)| *name == word) {
            let _ = writeln!(text, "{word} ({what})\n    {about}\n");
        }
    }
    text.push_str(&dictionary.kind(word));
    let (of_model, mut known) = of_model(word, &arguments.model, context)?;
    text.push_str(&of_model);
    if text.is_empty() {
        text = dictionary.entry(word).join("\n");
    }
    if text.is_empty() {
        known.extend(dictionary.words());
        let hint = near(word, &known).map(|near| format!("did you mean `{near}`?"));
        let finding =
            Finding::error("unknown_word", format!("there is nothing called `{word}`, neither in `{}` nor elsewhere", arguments.model));
        let list = || Some("`fastbike info MODEL` lists signals, `fastbike info --kinds` kinds".to_owned());
        return Err(finding.with_hint_from(hint.or_else(list)).into());
    }
    context.console.print(format!("{}\n", text.trim_end()).as_bytes())?;
    Ok(Exit::Done)
}

/// What a model calls so, and all that it has names for.
fn of_model(word: &str, name: &str, context: &Context) -> Result<(String, Vec<String>), Failure> {
    let arguments = ModelArguments { model: name.to_owned(), set: Vec::new(), reactions: true };
    let loaded = model::load(&arguments, context)?;
    let system = &loaded.assembled.system;
    let mut text = String::new();
    let mut known = Vec::new();
    let signals = system.unknowns().iter().map(|u| (&u.signal, "unknown"));
    let signals = signals.chain(system.inputs().iter().map(|i| (&i.signal, "input")));
    for (signal, role) in signals.chain(system.outputs().iter().map(|s| (s, "output"))) {
        known.push(signal.name.to_string());
        if signal.name == word {
            let _ = writeln!(text, "{} [{}] ({role} of {name})\n    {}\n", signal.name, signal.unit, signal.about);
        }
    }
    for parameter in loaded.blueprint.parameters() {
        known.push(parameter.name.clone());
        if parameter.name == word {
            let unit = parameter.dimension().map_or("", |d| d.unit);
            let (value, about) = (parameter.value.si, &parameter.about);
            let range = parameter.range.map(|(low, high)| format!(", from {low} to {high}")).unwrap_or_default();
            let what = if parameter.range.is_some() { "adjustable" } else { "parameter" };
            let _ = writeln!(text, "{word} [{unit}] ({what} of {name}: {value}{range})\n    {about}\n");
        }
    }
    let of_parameter = |path: &str| loaded.blueprint.parameters().iter().any(|p| p.name == path);
    for entry in loaded.blueprint.entries().iter().filter(|e| !of_parameter(&e.path)) {
        known.push(entry.path.clone());
        if entry.path == word {
            let about = if entry.about.is_empty() { "a number of the URDF" } else { &entry.about };
            let _ = writeln!(
                text,
                "{} [{}] (entry of {name}: {})\n    {}\n",
                entry.path,
                entry.dimension.unit,
                entry.value,
                about.replace('\n', " ")
            );
        }
    }
    Ok((text, known))
}
