//! `new`: a bundled description with everything that it reads, as a folder to edit.

use super::{Kind, read};
use crate::library::{Source, bundled_file};
use crate::{Context, Exit, Failure, model};
use clap::{ArgMatches, Args, Command};
use mbody::description::Library;
use mbody::description::finding::Finding;
use std::fs;
use std::path::{Path, PathBuf};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "new", command, run };

#[derive(Debug, Args)]
struct Arguments {
    /// Folder to make; its last name becomes the name of the description
    name: PathBuf,
    /// Bundled model or setup to start from
    #[arg(long, value_name = "MODEL")]
    from: String,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Copy a bundled description with everything it reads into a folder to edit")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let folder = &arguments.name;
    let shown = folder.display().to_string();
    let refuse = |code, message: String, hint: &str| Failure::from(Finding::error(code, message).in_file(&shown).with_hint(hint));
    let Some(name) = folder.file_name().and_then(|n| n.to_str()).filter(|n| !n.contains('.')) else {
        return Err(refuse("bad_name", format!("`{shown}` is no name of a folder"), "for example `fastbike new my_bike --from gsxr1000`"));
    };
    if folder.exists() {
        return Err(refuse("exists_already", format!("`{shown}` exists already"), "choose another name; nothing is overwritten"));
    }
    let source = Source::find(&arguments.from)?;
    if !source.is_bundled() {
        let hint = "copy its folder, or begin a description with `include:` and its path";
        return Err(refuse("unknown_model", format!("`{}` is no bundled model", arguments.from), hint));
    }
    let mut files: Vec<(String, String)> = Vec::new();
    for (k, text) in model::texts(&source, &context.kinds)?.iter().enumerate() {
        let last = text.rsplit(['/', ':']).next().unwrap_or(text);
        let ending = last.rsplit_once('.').map_or("yaml", |(_, ending)| ending);
        let file = if k == 0 { format!("{name}.{ending}") } else { last.to_owned() };
        files.push((file, edited(&source.text(text).unwrap_or_default())));
        let stem = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
        if let Some(sources) = bundled_file(&format!("vehicles/{stem}/SOURCE.md")).or(bundled_file(&format!("mechanisms/{stem}/SOURCE.md")))
        {
            let file = format!("SOURCE_{stem}.md");
            if !files.iter().any(|(known, _)| *known == file) {
                files.push((file, sources.to_owned()));
            }
        }
    }
    files.push(("fastbike.schema.json".to_owned(), format!("{:#}\n", mbody::assembly::editor_schema(&context.kinds))));
    files.push(("part.schema.json".to_owned(), format!("{:#}\n", mbody::assembly::part_schema(&context.kinds))));
    write_all(folder, &files)?;
    let main = folder.join(&files[0].0).display().to_string();
    let mut text = format!("{main} and {} files beside it\n\n", files.len() - 1);
    let next = ["check", "info", "trim"].map(|command| format!("fastbike {command} {main}\n"));
    text.push_str(&format!("next:\n  {}", next.join("  ")));
    text.push_str("an editor that reads the schemas beside it completes and explains every entry; `fastbike explain ENTRY` does so here\n");
    context.console.print(text.as_bytes())?;
    Ok(Exit::Done)
}

/// The text with the schema beside it, where it names one.
fn edited(text: &str) -> String {
    const MARK: &str = "# yaml-language-server: $schema=";
    match text.strip_prefix(MARK).and_then(|rest| rest.split_once('\n')) {
        Some((path, rest)) => format!("{MARK}{}\n{rest}", path.rsplit('/').next().unwrap_or(path)),
        None => text.to_owned(),
    }
}

fn write_all(folder: &Path, files: &[(String, String)]) -> Result<(), Failure> {
    let failed = |path: &Path, e: std::io::Error| Failure::Write { path: path.display().to_string(), cause: e.to_string() };
    fs::create_dir_all(folder).map_err(|e| failed(folder, e))?;
    for (name, text) in files {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|e| failed(&path, e))?;
    }
    Ok(())
}
