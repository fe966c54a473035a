//! Spoiled descriptions and trees: never a panic, never a hang, and an unknown key is never passed over.
//!
//! The corpus: every bundled description, tree and tire file, and the example of every kind of element. What still assembles is
//! evaluated once, derivatives included.
//!
//! A normal run takes 300 spoiled inputs, the same ones every time. The long run takes `FUZZ_CASES` new ones (100000 where that is not set),
//! shared by as many threads as `FUZZ_THREADS` says (2):
//!
//! ```text
//! FUZZ_CASES=100000 cargo test -p validation --test diagnostics -- --ignored --nocapture spoiled
//! ```

use crate::mutation::{Mutation, mutation};
use mbody::assembly::{Assembled, BaseDescription, Kinds, assemble, assemble_urdf};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::dynamics::TreePlant;
use problem::{At, Dae, Differentiable, Matrix, Outputs, Seeds};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc;
use std::time::Duration;

/// A text that takes longer than this to refuse or to accept is a hang; thousands of times the usual, for a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Texts by name, the first of them the one to read.
#[derive(Clone, Debug)]
struct Texts {
    first: String,
    texts: BTreeMap<String, String>,
}

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        self.texts.get(name).map(|text| Cow::Borrowed(text.as_str()))
    }

    fn resolve(&self, name: &str, _: &str) -> String {
        if self.texts.contains_key(name) { name.to_owned() } else { format!("{name}.yaml") }
    }
}

/// A set of texts and the one among them that is spoiled.
#[derive(Clone, Debug)]
struct Sample {
    texts: Texts,
    spoiled: String,
}

impl Sample {
    fn all_of(texts: &Texts) -> impl Iterator<Item = Self> {
        texts.texts.keys().map(|name| Self { texts: texts.clone(), spoiled: name.clone() })
    }

    fn with(&self, text: String) -> Texts {
        let mut texts = self.texts.clone();
        texts.texts.insert(self.spoiled.clone(), text);
        texts
    }

    fn text(&self) -> &str {
        &self.texts.texts[&self.spoiled]
    }
}

fn kinds() -> Kinds {
    fastbike::standard_kinds()
}

fn assembled(texts: &Texts) -> (Option<Assembled>, Findings) {
    match texts.first.ends_with(".urdf") {
        true => assemble_urdf(&texts.first, &texts.texts[&texts.first], BaseDescription::Fixed, 9.81, &[]),
        false => assemble(&texts.first, texts, &kinds(), &[]),
    }
}

/// Files of a folder below `models/`, by name.
fn files(folder: &Path) -> BTreeMap<String, String> {
    let entries = fs::read_dir(folder).expect("a folder of models").flatten();
    let wanted = entries.filter(|e| e.path().extension().is_some_and(|x| x == "yaml" || x == "urdf"));
    wanted.map(|e| (e.file_name().to_string_lossy().into_owned(), fs::read_to_string(e.path()).expect("text"))).collect()
}

/// Folder of a bundled model.
fn models_folder(folder: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(folder).join(name)
}

fn corpus() -> Vec<Sample> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let tires = files(&models.join("tires"));
    let mut samples = Vec::new();
    for folder in ["vehicles", "mechanisms"] {
        let mut models: Vec<_> = fs::read_dir(models.join(folder)).expect("models").flatten().map(|e| e.path()).collect();
        models.sort();
        for model in models.iter().filter(|m| m.is_dir()) {
            let mut own = files(model);
            let keys: Vec<String> = own.keys().cloned().collect();
            // and what it includes
            let included = own.values().find_map(|text| Some(text.lines().find_map(|l| l.strip_prefix("include: "))?.to_owned()));
            own.extend(included.iter().flat_map(|name| files(&models_folder(folder, name))));
            // a tree with links that only constraints hold is none by itself
            let held = own.values().any(|text| text.contains("\nconstraints:"));
            for first in keys.iter().filter(|name| !(held && name.ends_with(".urdf"))) {
                let mut texts = own.clone();
                // only the tires that the description speaks of are worth spoiling
                let named = |name: &str| own.values().any(|text| text.contains(name));
                texts.extend(tires.iter().filter(|(name, _)| named(name)).map(|(n, t)| (n.clone(), t.clone())));
                match first.ends_with(".urdf") {
                    true => texts.retain(|name, _| name == first),
                    false => texts
                        .retain(|name, _| name == first || named(name) || named(&format!("include: {}", name.trim_end_matches(".yaml")))),
                }
                samples.extend(Sample::all_of(&Texts { first: first.clone(), texts }));
            }
        }
    }
    for kind in kinds().elements() {
        let element = kind.example.split_whitespace().collect::<Vec<_>>().join(" ").replace(", ", ",\n      ");
        let text = format!(
            "fastbike: 1\nname: example\nurdf: tree.urdf\nbase: vehicle_base\nelements:\n  example:\n    {}: {element}\n",
            kind.name
        );
        let texts = [("model.yaml".to_owned(), text), ("tree.urdf".to_owned(), kind.tree.to_owned())].into();
        let texts = Texts { first: "model.yaml".to_owned(), texts };
        samples.push(Sample { texts, spoiled: "model.yaml".to_owned() });
    }
    for kind in kinds().constraints() {
        let text = format!(
            "fastbike: 1\nname: example\nurdf: tree.urdf\nbase: vehicle_base\nstart:\n  frame.forward_speed: 3 m/s\nconstraints:\n  example:\n    {}: {}\n",
            kind.name, kind.example
        );
        let texts = [("model.yaml".to_owned(), text), ("tree.urdf".to_owned(), mbody::assembly::EXAMPLE_TREE.to_owned())].into();
        let texts = Texts { first: "model.yaml".to_owned(), texts };
        samples.push(Sample { texts, spoiled: "model.yaml".to_owned() });
    }
    samples
}

/// Residual, outputs and derivatives in the design pose; only whether they come back matters.
fn evaluate(assembled: &Assembled) {
    let mut plant = TreePlant::new(Arc::clone(&assembled.system));
    let y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
    let u: Vec<f64> = plant.inputs().iter().map(|i| i.default).collect();
    let yd = vec![0.0; y.len()];
    let (nf, nz) = (plant.equations().len(), plant.outputs().len());
    let (mut f, mut z) = (vec![0.0; nf], vec![0.0; nz]);
    let at = At { time: 0.0, y: &y, yd: &yd, u: &u };
    let _refused = plant.residual(at, &mut f);
    let seeds = Seeds::zeros(y.len(), u.len(), 2);
    let (mut df, mut dz) = (Matrix::zeros(nf, 2), Matrix::zeros(nz, 2));
    let _refused = plant.along(at, &seeds, (&mut f, &mut z), &mut df, &mut dz);
}

/// Reads, in a thread of its own so that a hang is seen; the panic of that thread is the panic of the caller.
fn read(texts: Texts) -> Result<(), TestCaseError> {
    let (done, wait) = mpsc::channel();
    let reader = std::thread::spawn(move || {
        let (system, findings) = assembled(&texts);
        if let Some(assembled) = &system {
            evaluate(assembled);
        }
        let silent = system.is_none() && !findings.has_errors();
        let unsaid = findings.iter().any(|f| f.message.is_empty() || f.message.contains('\n'));
        // the receiver has gone where it lost its patience
        let _ = done.send((silent, unsaid, findings.to_string()));
    });
    match wait.recv_timeout(PATIENCE) {
        Ok((silent, unsaid, findings)) => {
            prop_assert!(!silent, "refused without a word");
            prop_assert!(!unsaid, "a message of no line or of several:\n{findings}");
        }
        Err(mpsc::RecvTimeoutError::Timeout) => return Err(TestCaseError::fail("it hangs")),
        Err(mpsc::RecvTimeoutError::Disconnected) => {}
    }
    match reader.join() {
        Ok(()) => Ok(()),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

fn spoil(corpus: &[Sample], which: Index, mutations: &[Mutation]) -> Texts {
    let sample = &corpus[which.index(corpus.len())];
    sample.with(mutations.iter().fold(sample.text().to_owned(), |text, m| m.apply(&text)))
}

fn runner(cases: u32, rng: Option<TestRng>) -> TestRunner {
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 2000, ..Config::default() };
    match rng {
        Some(rng) => TestRunner::new_with_rng(config, rng),
        None => TestRunner::new(config),
    }
}

fn spoiled_inputs(cases: u32, rng: Option<TestRng>) {
    let corpus = corpus();
    let strategy = (any::<Index>(), proptest::collection::vec(mutation(), 1..4));
    let outcome = runner(cases, rng).run(&strategy, |(which, mutations)| read(spoil(&corpus, which, &mutations)));
    if let Err(error) = outcome {
        panic!("{error}");
    }
}

#[test]
fn the_corpus_is_in_order() {
    let corpus = corpus();
    assert!(corpus.len() > 30, "{} samples", corpus.len());
    for sample in &corpus {
        let (system, findings) = assembled(&sample.texts);
        assert!(system.is_some(), "{}:\n{findings}", sample.text());
        evaluate(&system.expect("just looked"));
    }
}

#[test]
fn spoiled_inputs_are_refused_in_words() {
    spoiled_inputs(300, Some(TestRng::deterministic_rng(RngAlgorithm::ChaCha)));
}

#[test]
#[ignore = "long: FUZZ_CASES inputs"]
fn spoiled_inputs_by_the_hundred_thousand() {
    let number = |name: &str, default: u32| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let (cases, threads) = (number("FUZZ_CASES", 100_000), number("FUZZ_THREADS", 2).max(1));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| spoiled_inputs(cases.div_ceil(threads), None));
        }
    });
    println!("{} spoiled inputs in {threads} threads", cases.div_ceil(threads) * threads);
}

/// Every mapping whose keys are not names that a user gives, as JSON pointers.
fn mappings(value: &Value, pointer: String, found: &mut Vec<String>) {
    match value {
        Value::Object(entries) => {
            let named = ["/elements", "/joints", "/constraints", "/links", "/parameters", "/adjustables", "/urdf"];
            if !named.contains(&pointer.as_str()) {
                found.push(pointer.clone());
            }
            entries.iter().for_each(|(key, v)| mappings(v, format!("{pointer}/{key}"), found));
        }
        Value::Array(items) => items.iter().enumerate().for_each(|(k, v)| mappings(v, format!("{pointer}/{k}"), found)),
        _ => {}
    }
}

/// In every mapping of every description and tire file, one after another: a key that nobody knows is an error.
#[test]
fn unknown_keys_are_never_passed_over() {
    let mut tried = 0;
    // of what another description includes it may replace a part; each is tried as a description of its own
    let whole = |s: &&Sample| s.spoiled == s.texts.first || !s.text().contains("\nelements:");
    for sample in corpus().iter().filter(|s| s.spoiled.ends_with(".yaml")).filter(whole) {
        let value: Value = serde_yaml::from_str(sample.text()).expect("the corpus is YAML");
        let mut pointers = Vec::new();
        mappings(&value, String::new(), &mut pointers);
        for pointer in pointers {
            let mut spoiled = value.clone();
            let entries: &mut Map<String, Value> = spoiled.pointer_mut(&pointer).and_then(Value::as_object_mut).expect("a mapping");
            entries.insert("no_such_key".to_owned(), json!(1));
            let (system, findings) = assembled(&sample.with(spoiled.to_string()));
            // a tire file holds one law, so that a second key is a second law there
            let second_law = pointer.is_empty() && sample.spoiled != sample.texts.first;
            // an entry that has a kind of its own beside that of what is included is told for that
            let second_kind = findings.iter().any(|f| f.code == "two_kinds");
            let told = findings.iter().any(|f| f.message.contains("no_such_key")) || (second_law && findings.has_errors()) || second_kind;
            assert!(system.is_none() && told, "`no_such_key` at `{pointer}` of {}: {findings}", sample.spoiled);
            tried += 1;
        }
    }
    assert!(tried > 300, "only {tried} mappings were tried");
}

/// An attribute or element that nobody knows is at least told.
#[test]
fn unknown_parts_of_a_tree_are_told() {
    for sample in corpus().iter().filter(|s| s.spoiled.ends_with(".urdf")) {
        for (from, to, word) in [("<mass ", "<mass tint=\"red\" ", "tint"), ("<inertial>", "<inertial><wheight/>", "wheight")] {
            if !sample.text().contains(from) {
                continue;
            }
            let (_, findings) = assembled(&sample.with(sample.text().replacen(from, to, 1)));
            assert!(findings.iter().any(|f| f.message.contains(word)), "`{word}` in {}: {findings}", sample.spoiled);
        }
    }
}
