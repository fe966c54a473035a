//! `explain`: every word that the tool uses has a meaning.

use super::{evidence, fastbike};
use fastbike::explain::{CODES, Dictionary, ENDINGS};
use mbody::assembly::Kinds;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn explained(word: &str) -> String {
    let answer = fastbike(&["explain", word, "--model", "ref11"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (0, ""), "{word}");
    answer.stdout
}

#[test]
fn kinds_entries_signals_and_codes_are_explained() {
    for (word, part) in [
        ("chassis.roll", "lean, positive to the right"),
        ("steer.torque", "[N m] (input of ref11)"),
        ("rear_suspension.spring.stiffness", "[N m/rad] (entry of ref11"),
        ("link.chassis.mass", "[kg] (entry of ref11"),
        ("telescopic_fork", "example: telescopic_fork: "),
        ("cut_joint", "example: cut_joint: "),
        ("double_lane_change", "example: double_lane_change: "),
        ("adjustables", "in descriptions"),
        ("telescopic_fork.spring.preload", "[N]"),
        ("tire_saturated", "(ending)"),
        ("unknown_key", "(code of a finding)"),
    ] {
        let text = explained(word);
        assert!(text.contains(part), "{word}: {text}");
    }
    let adjustable = fastbike(&["explain", "front_sprocket"]).stdout;
    assert!(adjustable.contains("adjustable of gsxr1000: 17, from 15 to 18"), "{adjustable}");
}

#[test]
fn every_limit_of_a_bundled_model_is_an_ending_with_an_explanation() {
    for model in fastbike::library::bundled_models() {
        let context_free = |name: &str| ENDINGS.iter().any(|(known, _)| *known == name);
        let source = fastbike::library::Source::find(model).expect("a bundled model");
        if source.is_urdf() {
            continue;
        }
        let assembled = mbody::assembly::assemble(&source.file, &source, &fastbike::standard_kinds(), &[]).0.expect("a model");
        for limit in problem::Limits::limits(&mbody::dynamics::TreePlant::new(assembled.system)) {
            assert!(context_free(&limit.name), "{model}: `{}` is not explained", limit.name);
        }
    }
}

/// Codes as they stand in the sources, behind the calls that make findings.
fn codes_in_use() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for folder in ["mbody/src", "motorcycle/src", "cli/src", "solvers/analyses/src"] {
        collect(&evidence(&format!("../{folder}")), &mut found);
    }
    found
}

fn collect(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).expect("sources").flatten().map(|e| e.path()) {
        if entry.is_dir() {
            collect(&entry, found);
        } else if entry.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&entry).expect("text");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            for call in ["Finding::error(", "Finding::warning(", "Finding::note(", "Finding::new(severity, "] {
                let starts = code.match_indices(call).map(|(k, _)| code[k + call.len()..].trim_start());
                let first = starts.filter_map(|rest| rest.strip_prefix('"')?.split_once('"'));
                found.extend(first.map(|(word, _)| word.to_owned()));
            }
            // `refuse(key, code, …)`, `argument(option, text, code, …)`: the last word in quotes before the message
            for (call, skipped) in [("refuse(", 1), ("refusal(", 0), ("argument(", 2)] {
                for (k, _) in code.match_indices(call) {
                    let arguments: Vec<&str> = code[k + call.len()..].splitn(skipped + 2, ", ").collect();
                    let word = arguments.get(skipped).and_then(|a| a.trim().strip_prefix('"')?.strip_suffix('"'));
                    found.extend(word.filter(|w| w.chars().all(|c| c.is_ascii_lowercase() || c == '_')).map(str::to_owned));
                }
            }
        }
    }
}

#[test]
fn every_code_is_explained_and_every_explanation_is_of_a_code() {
    let used = codes_in_use();
    assert!(used.len() > 90, "{} codes were found in the sources", used.len());
    let unexplained: Vec<&String> = used.iter().filter(|code| !CODES.iter().any(|(known, _)| known == code)).collect();
    assert!(unexplained.is_empty(), "without explanation: {unexplained:?}");
    // codes of errors that carry them (`fn code`) stand elsewhere in the sources
    let mut text = String::new();
    for folder in ["mbody/src", "motorcycle/src", "cli/src"] {
        read_all(&evidence(&format!("../{folder}")), &mut text);
    }
    let unused: Vec<&str> = CODES.iter().map(|(c, _)| *c).filter(|code| !text.contains(&format!("\"{code}\""))).collect();
    assert!(unused.is_empty(), "explained, but nowhere in use: {unused:?}");
    assert!(CODES.is_sorted_by_key(|(code, _)| *code), "codes are in alphabetical order");
}

fn read_all(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder).expect("sources").flatten().map(|e| e.path()) {
        if entry.is_dir() {
            read_all(&entry, text);
        } else if entry.extension().is_some_and(|e| e == "rs") && !entry.ends_with("explain/codes.rs") {
            text.push_str(&fs::read_to_string(&entry).expect("text"));
        }
    }
}

#[test]
fn every_kind_of_a_registry_is_explained() {
    let kinds: Kinds = fastbike::standard_kinds();
    let dictionary = Dictionary::of(&kinds);
    for kind in dictionary.elements().into_iter().chain(dictionary.constraints()).chain(dictionary.sections()) {
        let text = dictionary.kind(kind.0);
        assert!(text.contains(kind.1) && text.contains("example"), "{}", kind.0);
    }
}
