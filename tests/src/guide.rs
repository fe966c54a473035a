//! Guides that are true: every command in a text is run, every file in it written, every quoted line compared.
//!
//! | block | what is done |
//! |---|---|
//! | `sh` | each line is a command; `# status 2` behind it is its exit status, 0 where left out |
//! | `text` | each line must be among what the last command wrote; blanks count as one, lines `…` are skipped |
//! | `yaml FILE`, `xml FILE` | the text becomes the file |
//! | `diff FILE` | the line behind `-`, which occurs once, becomes the one behind `+` |
//!
//! Other blocks are for reading.

use fastbike::console::Captured;
use mbody::assembly::Kinds;
use std::fs;
use std::path::Path;

/// A program of a guide: its name and the kinds that it knows.
pub type Program<'a> = (&'a str, &'a dyn Fn() -> Kinds);

/// A fenced block: what stands behind the fence, and the lines in it.
struct Block<'t> {
    info: &'t str,
    lines: Vec<&'t str>,
}

fn blocks(text: &str) -> Vec<Block<'_>> {
    let (mut found, mut open): (Vec<Block<'_>>, bool) = (Vec::new(), false);
    for line in text.lines() {
        match (line.strip_prefix("```"), open) {
            (Some(_), true) => open = false,
            (Some(info), false) => {
                found.push(Block { info: info.trim(), lines: Vec::new() });
                open = true;
            }
            (None, true) => found.last_mut().into_iter().for_each(|b| b.lines.push(line)),
            (None, false) => {}
        }
    }
    found
}

/// Words of a command; quotes hold blanks together.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in line.chars() {
        match (c, quote) {
            (c, Some(q)) if c == q => quote = None,
            ('\'' | '"', None) => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (c, None) if c.is_whitespace() => words.extend(word.take()),
            (c, _) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

fn one_blank(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Runs a guide in the working folder of the process; returns the number of commands.
///
/// # Panics
/// A command ends otherwise than the guide says, or a quoted line is not there.
pub fn hold(name: &str, text: &str, programs: &[Program<'_>]) -> usize {
    let (mut last, mut count) = (String::new(), 0);
    for block in blocks(text) {
        let (kind, file) = block.info.split_once(' ').unwrap_or((block.info, ""));
        match kind {
            "sh" => {
                for line in block.lines.iter().filter(|l| !l.trim().is_empty()) {
                    let answer = run(name, line, programs);
                    last = format!("{}{}", answer.stdout, answer.stderr);
                    count += 1;
                }
            }
            "text" => {
                let said: Vec<String> = last.lines().map(one_blank).collect();
                for line in block.lines.iter().map(|l| one_blank(l)).filter(|l| !l.is_empty() && l != "…") {
                    assert!(said.contains(&line), "{name}: the guide quotes\n  {line}\nbut the command wrote\n{last}");
                }
            }
            "yaml" | "xml" if !file.is_empty() => write(Path::new(file), &format!("{}\n", block.lines.join("\n"))),
            "diff" => edit(name, Path::new(file), &block.lines),
            _ => {}
        }
    }
    count
}

fn write(path: &Path, text: &str) {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    }
    fs::write(path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

fn edit(name: &str, path: &Path, lines: &[&str]) {
    let mut text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{name}: {}: {e}", path.display()));
    let mut old: Option<&str> = None;
    for line in lines {
        if let Some(removed) = line.strip_prefix('-') {
            old = Some(removed);
        } else if let (Some(added), Some(removed)) = (line.strip_prefix('+'), old.take()) {
            let found = text.matches(removed.trim()).count();
            assert_eq!(found, 1, "{name}: `{}` occurs {found} times in {}", removed.trim(), path.display());
            text = text.replace(removed.trim(), added.trim());
        }
    }
    write(path, &text);
}

fn run(name: &str, line: &str, programs: &[Program<'_>]) -> Captured {
    let (command, status) = line.split_once("# status").unwrap_or((line, "0"));
    let status: u8 = status.trim().parse().unwrap_or_else(|_| panic!("{name}: `{line}` names no status"));
    let words = words(command);
    let (program, arguments) = words.split_first().unwrap_or_else(|| panic!("{name}: an empty command"));
    let (_, kinds) = programs.iter().find(|(n, _)| n == program).unwrap_or_else(|| panic!("{name}: there is no program `{program}`"));
    let answer = fastbike::run_captured(kinds(), arguments);
    assert_eq!(answer.status, status, "{name}: `{line}`\n{}{}", answer.stdout, answer.stderr);
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_blocks_are_read() {
        assert_eq!(
            words("fastbike trim a.yaml --given 'x = 1' --set b=\"2 N\""),
            ["fastbike", "trim", "a.yaml", "--given", "x = 1", "--set", "b=2 N"]
        );
        let found = blocks("a\n```sh\none\ntwo\n```\nb\n```yaml f.yaml\nx: 1\n```\n");
        assert_eq!((found[0].lines.as_slice(), found[1].info), (["one", "two"].as_slice(), "yaml f.yaml"));
    }
}
