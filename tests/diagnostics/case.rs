//! One literate case: read, run, judged.

use fastbike::console::Captured;
use std::fs;
use std::path::{Path, PathBuf};

/// A fenced block.
struct Block {
    /// What stands behind the fence: `yaml file=bad.yaml`.
    info: String,
    text: String,
}

impl Block {
    fn tag(&self) -> &str {
        self.info.split_whitespace().next().unwrap_or_default()
    }

    fn entry(&self, key: &str) -> Option<&str> {
        self.info.split_whitespace().find_map(|w| w.strip_prefix(key)?.strip_prefix('='))
    }

    fn has(&self, word: &str) -> bool {
        self.info.split_whitespace().any(|w| w == word)
    }
}

/// A literate case.
pub struct Case {
    /// Name of the file without ending.
    pub name: String,
    path: PathBuf,
    source: String,
    blocks: Vec<Block>,
}

impl Case {
    /// Reads a file.
    pub fn read(path: &Path) -> Self {
        let source = fs::read_to_string(path).expect("a case is text");
        let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let mut blocks: Vec<Block> = Vec::new();
        let mut inside = false;
        for line in source.lines() {
            match (line.strip_prefix("```"), inside) {
                (Some(_), true) => inside = false,
                (Some(info), false) => {
                    inside = true;
                    blocks.push(Block { info: info.to_owned(), text: String::new() });
                }
                (None, true) => {
                    if let Some(block) = blocks.last_mut() {
                        block.text.push_str(line);
                        block.text.push('\n');
                    }
                }
                (None, false) => {}
            }
        }
        let case = Self { name, path: path.to_owned(), source, blocks };
        assert!(case.source.starts_with("# "), "{}: a case begins with a title", case.name);
        assert!(case.find("sh").is_some() && case.find("text").is_some(), "{}: no command or no answer", case.name);
        case
    }

    fn find(&self, tag: &str) -> Option<&Block> {
        self.blocks.iter().find(|b| b.tag() == tag)
    }

    /// The block of standard error.
    fn answer(&self) -> Option<&Block> {
        self.blocks.iter().find(|b| b.tag() == "text" && !b.has("shows"))
    }

    /// What standard error is to say.
    pub fn expected(&self) -> &str {
        self.answer().map_or("", |b| &b.text)
    }

    /// Writes the files and runs the command.
    pub fn run(&self) -> Captured {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("diagnostics").join(&self.name);
        fs::create_dir_all(&folder).expect("a folder for the case");
        let plant = self.path.with_file_name("plant.urdf");
        fs::copy(plant, folder.join("plant.urdf")).expect("the tree of the cases");
        for block in &self.blocks {
            if let Some(name) = block.entry("file") {
                let text = if block.tag() == "diff" { self.changed(name, &block.text, &folder) } else { block.text.clone() };
                fs::write(folder.join(name), text).expect("a file of the case");
            }
        }
        let command = self.find("sh").map_or("", |b| b.text.trim());
        let mut words = words(command);
        assert_eq!(words.first().map(String::as_str), Some("fastbike"), "{}: the command is `{command}`", self.name);
        words.remove(0);
        for word in &mut words {
            if folder.join(&*word).is_file() {
                *word = folder.join(&*word).display().to_string();
            }
        }
        let answer = fastbike::run_captured(fastbike::standard_kinds(), words);
        let here = format!("{}/", folder.display());
        Captured { status: answer.status, stdout: answer.stdout.replace(&here, ""), stderr: answer.stderr.replace(&here, "") }
    }

    /// The bundled file `name` with changed lines; copies the files beside it.
    fn changed(&self, name: &str, difference: &str, folder: &Path) -> String {
        let stem = name.split('.').next().unwrap_or_default();
        let bundled = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/vehicles").join(stem);
        for entry in fs::read_dir(&bundled).expect("a bundled vehicle").flatten() {
            fs::copy(entry.path(), folder.join(entry.file_name())).expect("a bundled file");
        }
        let mut text = fs::read_to_string(bundled.join(name)).expect("a bundled file");
        for hunk in difference.split("@@\n") {
            let side = |other: char| {
                let lines = hunk.lines().filter(|l| !l.starts_with(other));
                lines.map(|l| format!("{}\n", l.get(1..).unwrap_or_default())).collect::<String>()
            };
            let (old, new) = (side('+'), side('-'));
            assert_eq!(text.matches(&old).count(), 1, "{}: not exactly once in `{name}`:\n{old}", self.name);
            text = text.replace(&old, &new);
        }
        text
    }

    /// Whether the answer is the expected one, or how they differ.
    pub fn judge(&self, answer: &Captured) -> Result<(), String> {
        let block = self.answer().ok_or("no block of standard error")?;
        let status = block.entry("exit").unwrap_or("2");
        if answer.status.to_string() != status {
            return Err(format!("exit status {} instead of {status}\n{}{}", answer.status, answer.stdout, answer.stderr));
        }
        if trimmed(&answer.stderr) != trimmed(&block.text) {
            return Err(format!("--- expected\n{}--- answered\n{}", block.text, answer.stderr));
        }
        let blank_free = |l: &str| l.split_whitespace().collect::<Vec<_>>().join(" ");
        let shown: Vec<String> = answer.stdout.lines().map(blank_free).collect();
        for line in self.blocks.iter().filter(|b| b.has("shows")).flat_map(|b| b.text.lines()).map(blank_free) {
            if !shown.iter().any(|shown| fits(shown, &line)) {
                return Err(format!("standard output does not hold `{line}`\n{}", answer.stdout));
            }
        }
        Ok(())
    }

    /// Puts what was answered in place of the expected text.
    pub fn rewrite(&self, answer: &Captured) {
        let Some(block) = self.answer() else { return };
        let old = format!("```{}\n{}```", block.info, block.text);
        let text = trimmed(&answer.stderr);
        let text = if text.is_empty() { text } else { text + "\n" };
        let new = format!("```text exit={}\n{text}```", answer.status);
        fs::write(&self.path, self.source.replace(&old, &new)).expect("the case can be written");
    }
}

/// Whether a line is the expected one, in which `…` stands for anything.
fn fits(line: &str, expected: &str) -> bool {
    let mut rest = line;
    let parts: Vec<&str> = expected.split('…').collect();
    for (k, part) in parts.iter().enumerate() {
        match rest.find(part) {
            Some(0) => rest = &rest[part.len()..],
            Some(at) if k > 0 => rest = &rest[at + part.len()..],
            _ => return false,
        }
    }
    rest.is_empty() || expected.ends_with('…')
}

/// Without blanks at the ends of lines and empty lines at the end.
fn trimmed(text: &str) -> String {
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n").trim_end().to_owned()
}

/// Words as a shell takes them, with single quotes.
fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (k, part) in command.split('\'').enumerate() {
        match k % 2 {
            0 => words.extend(part.split_whitespace().map(str::to_owned)),
            _ => words.push(part.to_owned()),
        }
    }
    words
}
