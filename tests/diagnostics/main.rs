//! Do we explain failure? Literate cases in `broken/*.md`, each a thing that a tired engineer did wrong and what the tool answers.
//!
//! A case is prose with fenced blocks:
//!
//! | fence | meaning |
//! |---|---|
//! | `yaml file=NAME`, `urdf file=NAME`, `json file=NAME` | a file beside the others of the case |
//! | `diff file=NAME` | the bundled file of that name with changed lines (`-` old, `+` new, blank: as it is), and the files beside it |
//! | `sh` | the command |
//! | `text exit=N` | standard error, to the letter, and the exit status |
//! | `text shows` | lines that standard output must hold, blanks aside; `…` stands for anything |
//!
//! The tree `broken/plant.urdf` stands beside the files of every case.
//! After a deliberate change of words: `DIAGNOSTICS_UPDATE=1 cargo test -p validation --test diagnostics`, then read the difference.

mod case;
mod fuzz;
mod mutation;

use case::Case;
use std::fs;
use std::path::{Path, PathBuf};

/// Folder of the cases.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("diagnostics/broken")
}

fn cases() -> Vec<Case> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder()).expect("the folder of cases").flatten().map(|e| e.path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "md"));
    paths.sort();
    paths.iter().map(|p| Case::read(p)).collect()
}

#[test]
fn every_mistake_gets_its_message() {
    let update = std::env::var_os("DIAGNOSTICS_UPDATE").is_some();
    let mut failures = Vec::new();
    for case in cases() {
        let answer = case.run();
        if update {
            case.rewrite(&answer);
        }
        if let Err(difference) = case.judge(&answer) {
            failures.push(format!("{}: {difference}", case.name));
        }
    }
    assert!(update || failures.is_empty(), "{} cases differ\n\n{}", failures.len(), failures.join("\n\n"));
}

#[test]
fn the_catalog_is_large_enough() {
    assert!(cases().len() >= 30, "{} cases", cases().len());
}

/// DESIGN §8: one line, lower case, no sign of a programmer's mind, and never a path of this machine.
#[test]
fn every_message_keeps_the_house_style() {
    let root = env!("CARGO_MANIFEST_DIR");
    for case in cases() {
        let text = case.expected();
        for line in text.lines().filter(|l| l.starts_with("error") || l.starts_with("warning")) {
            let message = line.split_once(": ").map_or(line, |(_, m)| m);
            let first = message.chars().next().unwrap_or(' ');
            assert!(!first.is_uppercase() || message.starts_with("URDF"), "{}: `{message}` begins with a capital", case.name);
            for word in ["Some(", "None", "Err(", "panicked", "unwrap", "NaN", "struct", "enum", root] {
                assert!(!message.contains(word), "{}: `{message}` contains `{word}`", case.name);
            }
        }
    }
}
