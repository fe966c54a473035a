//! Does the tool speak the same? The command line contract, command by command: exit status, streams, keys, files.
//!
//! Numbers are parsed and compared as numbers; words only where other programs rely on them.

mod animation;
mod check;
mod comfort;
mod compare;
mod dynamics;
mod explain;
mod frf;
mod handling;
mod info;
mod linearize;
mod map;
mod modes;
mod new;
mod replay;
mod rider;
mod run;
mod schema;
mod setup;
mod slalom;
mod tire;
mod trim;

use fastbike::console::Captured;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Runs `fastbike` with these arguments.
fn fastbike(arguments: &[&str]) -> Captured {
    fastbike::run_captured(fastbike::standard_kinds(), arguments)
}

/// Runs `fastbike` with these arguments, expects the exit status, and reads standard output as JSON.
fn json(arguments: &[&str], status: u8) -> Value {
    let answer = fastbike(arguments);
    assert_eq!(answer.status, status, "{arguments:?}\n{}{}", answer.stdout, answer.stderr);
    serde_json::from_str(&answer.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}\n{}", answer.stdout))
}

/// A fresh folder for the files of a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("an old folder can be removed");
    }
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

/// A file of this folder's parent, by its path from there.
fn evidence(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Keys of an object in their order.
fn keys(value: &Value) -> Vec<&str> {
    value.as_object().map(|o| o.keys().map(String::as_str).collect()).unwrap_or_default()
}

#[test]
fn help_and_version_go_to_standard_output() {
    for arguments in [&["--help"][..], &["trim", "--help"], &["--version"]] {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stderr.as_str()), (0, ""), "{arguments:?}");
        assert!(!answer.stdout.is_empty());
    }
    let version = fastbike(&["--version"]).stdout;
    assert!(version.starts_with("fastbike ") && version.contains("SUNDIALS"), "{version}");
}

#[test]
fn wrong_arguments_end_with_two_and_say_nothing_on_standard_output() {
    let wrong =
        [&[][..], &["trm"], &["trim"], &["trim", "ref11", "--sped", "30"], &["trim", "ref11", "--format", "xml"], &["trim", "nothing"]];
    for arguments in wrong {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(!answer.stderr.is_empty(), "{arguments:?}");
    }
}

/// Kept output has no color, whatever the terminal of the test is.
#[test]
fn there_are_no_escape_codes_where_there_is_no_terminal() {
    for arguments in
        [&["trim", "ref11", "--speed", "20"][..], &["trim", "ref11", "--speed", "x"], &["info", "ref11"], &["--help"], &["tirm"]]
    {
        let answer = fastbike(arguments);
        assert!(!(answer.stdout + &answer.stderr).contains('\u{1b}'), "{arguments:?}");
    }
}
