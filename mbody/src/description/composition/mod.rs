//! One description from several texts: `include`, and setups that stand on an engineering model.
//!
//! Included texts come first, in their order, then the text itself, which wins: mappings are joined key by key, everything else is
//! replaced, `null` removes. Where an entry chooses a kind (`spring_damper: …`) and the other text chooses another one, the whole entry is
//! replaced. Every entry keeps its place in its own text.

mod setup;

use super::Library;
use super::document::Document;
use super::finding::{Finding, Findings, nearest};
use super::nearest::names;
use super::schema::Schema;
use serde_json::Value;

/// Texts within texts at most.
const DEEPEST: usize = 16;
/// Texts in all at most.
const MOST: usize = 256;

/// Reads a text with everything that it includes or stands on; `None` where something is wrong.
pub(crate) fn read(file: &str, library: &dyn Library, schema: &Schema, findings: &mut Findings) -> Option<Document> {
    let mut composer = Composer { library, schema, findings, open: Vec::new(), count: 0 };
    let document = composer.text(file)?;
    if document.value().get("part").is_some() {
        let finding = document.finding("part", "wrong_file", format!("`{file}` is a part of descriptions, not one itself"));
        findings.push(finding.with_hint(format!("a description includes it: `include: {file}`")));
        return None;
    }
    match document.value().get("setup") {
        Some(_) => composer.setup(document),
        None => composer.compose(document),
    }
}

struct Composer<'a> {
    library: &'a dyn Library,
    schema: &'a Schema,
    findings: &'a mut Findings,
    /// Texts that are being read, outermost first.
    open: Vec<String>,
    count: usize,
}

impl Composer<'_> {
    /// A text by its full name.
    fn text(&mut self, file: &str) -> Option<Document> {
        let Some(text) = self.library.text(file) else {
            self.findings.push(Finding::error("missing_file", format!("file `{file}` was not found")));
            return None;
        };
        match Document::parse(file, &text) {
            Ok(document) => Some(document),
            Err(errors) => {
                self.findings.extend(errors);
                None
            }
        }
    }

    /// The document over what it includes.
    fn compose(&mut self, mut document: Document) -> Option<Document> {
        let before = self.findings.count(super::finding::Severity::Error);
        let included = included(&document, self.findings);
        let file = document.file().to_owned();
        self.open.push(file.clone());
        let mut whole: Option<Document> = None;
        for (path, name) in included {
            let Some(part) = self.include(&document, &path, &name, &file) else { continue };
            whole = Some(match whole {
                Some(whole) => self.laid_over(whole, part),
                None => part,
            });
        }
        self.open.pop();
        for word in ["include", "part"] {
            document.take(word);
        }
        (self.findings.count(super::finding::Severity::Error) == before).then(|| match whole {
            Some(whole) => self.laid_over(whole, document),
            None => document,
        })
    }

    /// What stands behind one entry of `include`.
    fn include(&mut self, document: &Document, path: &str, name: &str, within: &str) -> Option<Document> {
        let full = self.library.resolve(name, within);
        let refusal = |code, message: String, hint: Option<String>| document.finding(path, code, message).with_hint_from(hint);
        if name.ends_with(".urdf") {
            self.findings.push(refusal(
                "wrong_file",
                format!("`{name}` is a URDF file"),
                Some(format!("name it under `urdf: {{ part: {name} }}`")),
            ));
            return None;
        }
        if let Some(k) = self.open.iter().position(|f| *f == full) {
            let ring: Vec<&str> = self.open[k..].iter().map(String::as_str).chain([full.as_str()]).collect();
            self.findings.push(refusal("circular_include", format!("files include each other in a ring: {}", ring.join(" → ")), None));
            return None;
        }
        self.count += 1;
        if self.open.len() > DEEPEST || self.count > MOST {
            self.findings.push(refusal(
                "too_many_files",
                format!("files include files {DEEPEST} levels deep, or more than {MOST} in all"),
                None,
            ));
            return None;
        }
        if self.library.text(&full).is_none() {
            let hint = format!("the name is relative to `{within}`; the name of a bundled model or part is written without folder");
            self.findings.push(refusal("missing_file", format!("file `{name}` was not found"), Some(hint)));
            return None;
        }
        let part = self.text(&full)?;
        if part.value().get("setup").is_some() {
            let hint = "include the model that it stands on, and write its values where they belong";
            self.findings.push(refusal("wrong_file", format!("`{name}` is a setup, which stands at the top"), Some(hint.to_owned())));
            return None;
        }
        if !part.value().is_object() {
            self.findings.push(refusal("wrong_file", format!("`{name}` holds no entries"), None));
            return None;
        }
        self.compose(part)
    }

    fn laid_over(&self, mut below: Document, mut above: Document) -> Document {
        // a single tree is the part `main` of several
        let several = |d: &Document| d.value().get("urdf").is_some_and(Value::is_object);
        let single = |d: &Document| d.value().get("urdf").is_some_and(Value::is_string);
        match (several(&below), several(&above)) {
            (true, false) if single(&above) => above.wrap("urdf", "main"),
            (false, true) if single(&below) => below.wrap("urdf", "main"),
            _ => {}
        }
        let chosen = self.schema.choices(above.value());
        below.merge(above, &chosen);
        below
    }
}

/// Path and name of everything that a document includes.
fn included(document: &Document, findings: &mut Findings) -> Vec<(String, String)> {
    let item = |path: String, value: &Value, findings: &mut Findings| match value.as_str() {
        Some(name) => Some((path, name.to_owned())),
        None => {
            findings.push(document.finding(&path, "wrong_type", "this is not the name of a file"));
            None
        }
    };
    match document.value().get("include") {
        None => Vec::new(),
        Some(Value::Array(items)) => items.iter().enumerate().filter_map(|(k, v)| item(format!("include.{k}"), v, findings)).collect(),
        Some(one) => item("include".to_owned(), one, findings).into_iter().collect(),
    }
}

/// The nearest of some names, else all of them.
fn advice(name: &str, known: &[String], all: &str) -> String {
    match nearest(name, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`? {all}"),
        None => all.to_owned(),
    }
}

fn listed(known: &[&str]) -> String {
    names(known)
}
