//! The text files of the repository, and what of a Rust file is code.

use std::fs;
use std::path::Path;

/// Folders that are built, installed or written by runs.
const NOT_OURS: [&str; 4] = ["target", "runs", "node_modules", "third_party"];
/// Endings of the text files that people write.
const TEXT: [&str; 11] = ["rs", "toml", "md", "yaml", "yml", "urdf", "sh", "py", "js", "ts", "html"];
/// Text files without an ending.
const NAMED: [&str; 2] = ["Makefile", "run"];

/// One text file.
pub struct File {
    /// Path from the top of the repository, with `/`.
    pub path: String,
    /// Its content.
    pub text: String,
}

/// All text files that people write.
pub fn repository() -> Vec<File> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace");
    let mut files = Vec::new();
    collect(top, "", &mut files);
    files.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(files.iter().any(|file| file.path == "Cargo.toml"), "the walk starts at the top of the repository");
    files
}

fn collect(folder: &Path, prefix: &str, files: &mut Vec<File>) {
    for entry in fs::read_dir(folder).expect("folders of the repository are readable") {
        let entry = entry.expect("folders of the repository are readable");
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{prefix}{name}");
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            // hidden folders belong to tools, except where continuous integration and cargo's settings live
            if !NOT_OURS.contains(&name.as_str()) && (!name.starts_with('.') || [".ci", ".cargo"].contains(&name.as_str())) {
                collect(&entry.path(), &format!("{path}/"), files);
            }
        } else if written_by_people(&path, &name) {
            let text = fs::read_to_string(entry.path()).unwrap_or_else(|error| panic!("{path}: {error}"));
            files.push(File { path, text });
        }
    }
}

fn written_by_people(path: &str, name: &str) -> bool {
    // written by tools/ensure-native.sh, not committed
    path != ".cargo/local.toml" && (NAMED.contains(&name) || name.rsplit_once('.').is_some_and(|(_, ending)| TEXT.contains(&ending)))
}

/// The words of a line in lower case: runs of letters, also split where `_`, a digit or a capital begins a new part of a name.
pub fn words(line: &str) -> impl Iterator<Item = String> + '_ {
    let letters = line.split(|c: char| !c.is_alphabetic()).filter(|run| !run.is_empty());
    letters.flat_map(|run| {
        let starts = run.char_indices().zip(std::iter::once('A').chain(run.chars()));
        let humps = starts.filter(|((at, c), before)| *at == 0 || (c.is_uppercase() && before.is_lowercase())).map(|((at, _), _)| at);
        let humps: Vec<usize> = humps.chain([run.len()]).collect();
        humps.windows(2).map(|hump| run[hump[0]..hump[1]].to_lowercase()).collect::<Vec<_>>()
    })
}

/// The text with the inside of comments, strings and characters replaced by blanks; lines stay where they are.
pub fn code_only(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skipped = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => block_comment(rest),
            '"' => 1 + string_end(&rest[1..]),
            'r' if !code.ends_with(|c: char| c.is_alphanumeric() || c == '_') => raw_string(rest),
            '\'' => character(rest),
            _ => 0,
        };
        if skipped == 0 {
            code.push(c);
            rest = &rest[c.len_utf8()..];
        } else {
            code.extend(rest[..skipped].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
            rest = &rest[skipped..];
        }
    }
    code
}

/// Length of the block comment (they nest) at the start of `text`.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        if rest.starts_with(b"/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest.starts_with(b"*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

/// Length up to and with the closing quote of a string whose opening quote stands before `text`.
fn string_end(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Length of the raw string at the start of `text`, 0 if there is none.
fn raw_string(text: &str) -> usize {
    let hashes = text[1..].len() - text[1..].trim_start_matches('#').len();
    if !text[1 + hashes..].starts_with('"') {
        return 0;
    }
    let close = format!("\"{}", "#".repeat(hashes));
    let start = 2 + hashes;
    text[start..].find(&close).map_or(text.len(), |at| start + at + close.len())
}

/// Length of the character literal at the start of `text`, 0 if it is a lifetime.
fn character(text: &str) -> usize {
    let mut chars = text.char_indices().skip(1);
    match chars.next() {
        Some((_, '\\')) => text[3..].find('\'').map_or(0, |at| 3 + at + 1),
        Some(_) => chars.next().filter(|(_, c)| *c == '\'').map_or(0, |(at, _)| at + 1),
        None => 0,
    }
}

#[test]
fn code_is_what_is_neither_comment_nor_text() {
    let text = "a /* b /* c */ d */ e // f\n\"g \\\" h\" i r#\"j \" k\"# l 'm' '\\'' n<'o> p \"q";
    let kept: String = code_only(text).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(kept, "a e i l n<'o> p");
    assert_eq!(code_only(text).lines().count(), text.lines().count());
}

#[test]
fn names_fall_into_words() {
    assert_eq!(words("rear_tire2Force (FrontFork) ABA").collect::<Vec<_>>(), ["rear", "tire", "force", "front", "fork", "aba"]);
}
