//! Documents: a YAML text as a tree of values, every one of which knows its line.
//!
//! The values come from `serde_yaml`, used in this module only; lines and columns, duplicate keys and other things it does not say
//! come from a second pass over the text with `saphyr-parser`.
//!
//! Entries are named by dotted paths, `elements.shock.spring_damper.stiffness`; items of a list by their number from zero.
//! A path may leave out the section at the front and the tag of a kind: `shock.stiffness` names the same entry, if no other one
//! is called so.

mod path;
mod scan;
mod syntax;

use super::finding::{Finding, Findings, nearest};
use path::{dotted, step};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::{HashMap, HashSet};

/// A line and a column, counted from one.
type Place = (usize, usize);

/// Where an entry stands.
#[derive(Clone, Copy, Debug)]
struct Mark {
    source: usize,
    /// Of an entry of a mapping, its name.
    key: Option<Place>,
    value: Place,
}

/// A text from which values came; empty for a change made by [`Document::set`].
#[derive(Clone, Debug)]
struct Source {
    file: String,
    text: String,
}

/// A YAML text as a tree of values with positions.
#[derive(Clone, Debug)]
pub struct Document {
    value: Value,
    sources: Vec<Source>,
    /// The source that gives the whole its name.
    main: usize,
    /// By JSON pointer.
    marks: HashMap<String, Mark>,
}

/// Which part of an entry a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// Its name.
    Key,
    /// What stands behind the name.
    Value,
}

impl Document {
    /// Reads a text; `file` is its name in messages.
    ///
    /// # Errors
    /// The text is no YAML, or it says something twice, or something that a tree of names, numbers and texts cannot hold.
    pub fn parse(file: &str, text: &str) -> Result<Self, Findings> {
        let (marks, findings) = scan::scan(file, text);
        if findings.has_errors() {
            return Err(findings.sorted());
        }
        let value = read(text).map_err(|e| syntax::finding(file, text, &e.0, e.1))?;
        let source = Source { file: file.to_string(), text: text.to_string() };
        Ok(Self { value, sources: vec![source], main: 0, marks })
    }

    /// The values.
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// Name of the text.
    pub fn file(&self) -> &str {
        &self.sources[self.main].file
    }

    /// The entry of a path.
    pub fn get(&self, path: &str) -> Option<&Value> {
        self.value.pointer(&self.find(path)?)
    }

    /// The entry of a path, as some type.
    ///
    /// # Errors
    /// There is no such entry, or it does not fit the type; reports one mistake, so check against the schema first.
    pub fn read<T: DeserializeOwned>(&self, path: &str) -> Result<T, Findings> {
        let pointer = self.find(path).ok_or_else(|| self.unknown_path(path))?;
        let value = self.value.pointer(&pointer).unwrap_or(&Value::Null);
        serde_path_to_error::deserialize(value).map_err(|error| {
            let mut at = pointer;
            for segment in error.path() {
                use serde_path_to_error::Segment;
                match segment {
                    Segment::Seq { index } => at = step(&at, &index.to_string()),
                    Segment::Map { key } => at = step(&at, key),
                    Segment::Enum { variant } => at = step(&at, variant),
                    Segment::Unknown => break,
                }
            }
            self.located(Finding::error("invalid_entry", error.into_inner().to_string()), &at, About::Value).into()
        })
    }

    /// An error about the entry of a path, with its place.
    pub fn finding(&self, path: &str, code: &'static str, message: impl Into<String>) -> Finding {
        self.locate(Finding::error(code, message).at_path(path))
    }

    /// The finding, with the place that its path names, or of the nearest enclosing entry where it names none.
    pub fn locate(&self, finding: Finding) -> Finding {
        // it is about another file
        if finding.line.is_some() {
            return finding;
        }
        let mut path = finding.path.as_str();
        loop {
            if let Some(pointer) = self.find(path) {
                let whole = finding.path.clone();
                return Finding { path: whole, ..self.located(finding, &pointer, About::Value) };
            }
            path = path.rfind('.').map_or("", |end| &path[..end]);
        }
    }

    /// The finding, with path and place of the entry that a JSON pointer names, or of the nearest enclosing one.
    pub fn located(&self, finding: Finding, pointer: &str, about: About) -> Finding {
        let finding = Finding { path: dotted(pointer), ..finding };
        let mut at = pointer;
        let mark = loop {
            match (self.marks.get(at), at.rfind('/')) {
                (Some(mark), _) => break mark,
                (None, Some(end)) => at = &at[..end],
                (None, None) => return finding.in_file(self.file()),
            }
        };
        // a block of entries begins below its name, which says more
        let block = self.value.pointer(at).is_some_and(|v| v.is_object() || v.is_array());
        let key = mark.key.filter(|_| about == About::Key || block || at != pointer);
        let (line, column) = key.unwrap_or(mark.value);
        let source = &self.sources[mark.source];
        let finding = finding.in_file(&source.file);
        // a change made by `set` is its own excerpt
        if source.text.is_empty() { finding } else { finding.at_line(&source.text, line, column) }
    }

    /// Changes an entry to what `text` says in YAML: a number, a quantity, a list …; nothing at all removes the entry.
    ///
    /// An entry that is not there yet is added where the entries around it are there; whether its name is right is for the schema.
    ///
    /// # Errors
    /// There is nothing under that name, not even around it; the nearest known path is named.
    pub fn set(&mut self, path: &str, text: &str) -> Result<(), Findings> {
        self.set_as(path, text, format!("{path}={text}"))
    }

    /// As [`Document::set`], with the name that the change has in messages.
    pub(super) fn set_as(&mut self, path: &str, text: &str, said: String) -> Result<(), Findings> {
        let pointer = match self.find(path) {
            Some(pointer) => pointer,
            None => {
                let (around, name) = path.rsplit_once('.').ok_or_else(|| self.unknown_path(path))?;
                let around = self.find(around).map(|p| self.inside_tag(p)).ok_or_else(|| self.unknown_path(path))?;
                if !self.value.pointer(&around).is_some_and(Value::is_object) {
                    return Err(self.unknown_path(path));
                }
                step(&around, name)
            }
        };
        let value = read(text).unwrap_or_else(|_| Value::String(text.to_string()));
        self.sources.push(Source { file: said, text: String::new() });
        let mark = Mark { source: self.sources.len() - 1, key: None, value: (1, 1) };
        let (around, name) = path::split(&pointer).unwrap_or_default();
        match self.value.pointer_mut(around) {
            Some(Value::Object(entries)) if value.is_null() => {
                entries.shift_remove(&name);
            }
            Some(Value::Object(entries)) => {
                entries.insert(name, value);
            }
            Some(Value::Array(items)) => {
                if let Some(item) = name.parse::<usize>().ok().and_then(|k| items.get_mut(k)) {
                    *item = value;
                }
            }
            _ => self.value = value,
        }
        self.forget(&pointer);
        self.marks.insert(pointer, mark);
        Ok(())
    }

    /// Changes an entry that is there to another value, a number in SI for instance; its place in the text stays that of the old value.
    pub fn put(&mut self, pointer: &str, value: impl Into<Value>) {
        if let Some(entry) = self.value.pointer_mut(pointer) {
            *entry = value.into();
        }
    }

    /// Takes an entry of the outermost mapping out; its place stays known.
    pub(super) fn take(&mut self, name: &str) -> Option<Value> {
        self.value.as_object_mut()?.shift_remove(name)
    }

    /// Puts the value of an outermost entry under a name of its own below it: `urdf: a` becomes `urdf: { main: a }`.
    pub(super) fn wrap(&mut self, entry: &str, name: &str) {
        let pointer = step("", entry);
        if let Some(value) = self.value.pointer_mut(&pointer) {
            *value = Value::Object(Map::from_iter([(name.to_owned(), value.take())]));
            if let Some(mark) = self.marks.get(&pointer) {
                self.marks.insert(step(&pointer, name), *mark);
            }
        }
    }

    /// Some entries under other pointers, with their places: `(from, to)` each.
    pub(super) fn picked(&self, moves: &[(String, String)]) -> Self {
        let mut picked = Self { value: Value::Object(Map::new()), marks: HashMap::new(), ..self.clone() };
        for (from, to) in moves {
            let Some(value) = self.value.pointer(from) else { continue };
            picked.insert(to, value.clone());
            let moved =
                |p: &String| p.strip_prefix(from).filter(|rest| rest.is_empty() || rest.starts_with('/')).map(|r| format!("{to}{r}"));
            picked.marks.extend(self.marks.iter().filter_map(|(p, mark)| Some((moved(p)?, *mark))));
        }
        picked
    }

    /// Puts a value at a pointer, making the mappings around it where they are missing.
    fn insert(&mut self, pointer: &str, value: Value) {
        let mut at = &mut self.value;
        for name in pointer.split('/').skip(1) {
            if !at.is_object() {
                *at = Value::Object(Map::new());
            }
            let Value::Object(entries) = at else { return };
            at = entries.entry(path::unescaped(name)).or_insert(Value::Null);
        }
        *at = value;
    }

    /// Puts a value at a pointer, at the place of another entry.
    pub(super) fn copy(&mut self, from: &str, to: &str) {
        let Some(value) = self.value.pointer(from).cloned() else { return };
        self.insert(to, value);
        if let Some(mark) = self.marks.get(from) {
            self.marks.insert(to.to_owned(), *mark);
        }
    }

    /// JSON pointer to the entry of a path.
    pub fn pointer_of(&self, path: &str) -> Option<String> {
        self.find(path)
    }

    /// Name of the text in which the entry at a JSON pointer, or the nearest one around it, stands.
    pub fn file_of(&self, pointer: &str) -> &str {
        let mut at = pointer;
        loop {
            match (self.marks.get(at), at.rfind('/')) {
                // a change from outside stands in no file
                (Some(mark), _) if !self.sources[mark.source].text.is_empty() => return &self.sources[mark.source].file,
                (_, Some(end)) => at = &at[..end],
                (_, None) => return self.file(),
            }
        }
    }

    /// The shortest path that names the entry at a JSON pointer, without section and tag where that is enough.
    pub fn path_of(&self, pointer: &str) -> String {
        self.short(pointer)
    }

    /// Lays another document over this one: entries are joined, everything else is replaced, `null` removes (RFC 7386).
    ///
    /// `chosen` are pointers to entries of the overlay that choose one of several kinds: where the kind is another one than here, the
    /// whole entry is replaced. Together they have the name of the overlay.
    pub fn merge(&mut self, overlay: Self, chosen: &[String]) {
        let shift = self.sources.len();
        self.sources.extend(overlay.sources);
        self.main = shift + overlay.main;
        let mut joining = Joining { chosen: chosen.iter().map(String::as_str).collect(), joined: HashSet::new() };
        join(&mut self.value, overlay.value, "", &mut joining);
        // an entry that both have keeps its place, its contents have theirs
        for (pointer, mark) in overlay.marks {
            if pointer.is_empty() || !joining.joined.contains(&pointer) || !self.marks.contains_key(&pointer) {
                self.marks.insert(pointer, Mark { source: mark.source + shift, ..mark });
            }
        }
    }

    /// Every path to a number, text or truth value, without section and tag where that is enough.
    pub fn paths(&self) -> Vec<String> {
        let mut pointers = Vec::new();
        leaves(&self.value, String::new(), &mut pointers);
        pointers.into_iter().map(|pointer| self.short(&pointer)).collect()
    }

    fn short(&self, pointer: &str) -> String {
        let steps: Vec<&str> = pointer.split('/').skip(1).collect();
        let without =
            |k: usize| dotted(&steps.iter().enumerate().filter(|(j, _)| *j != 0 && *j != k).fold(String::new(), |p, (_, s)| p + "/" + s));
        let tag =
            (2..steps.len()).find(|k| self.inside_tag(format!("/{}", steps[..*k].join("/"))) == format!("/{}", steps[..=*k].join("/")));
        let shorter = [tag.map(without), Some(without(0))];
        shorter.into_iter().flatten().find(|s| self.find(s).as_deref() == Some(pointer)).unwrap_or_else(|| dotted(pointer))
    }

    fn unknown_path(&self, path: &str) -> Findings {
        let known = self.paths();
        let hint = nearest(path, known.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
        let finding = Finding::error("unknown_path", format!("there is no entry `{path}` in `{}`", self.file()));
        finding.at_path(path).with_hint_from(hint).into()
    }

    /// Pointer to the entry of a path.
    fn find(&self, path: &str) -> Option<String> {
        if let Some(pointer) = path::find(&self.value, path, path::Tags::Exact) {
            return Some(pointer);
        }
        let sections = self.value.as_object().into_iter().flatten();
        let within = sections.filter(|(_, v)| v.is_object()).find_map(|(name, section)| {
            let rest = path::find(section, path, path::Tags::Skipped)?;
            Some(step("", name) + &rest)
        });
        within.or_else(|| path::find(&self.value, path, path::Tags::Skipped))
    }

    /// The entries of a kind, where a pointer names the element.
    fn inside_tag(&self, pointer: String) -> String {
        match self.value.pointer(&pointer).and_then(path::tag) {
            Some((tag, _)) => step(&pointer, tag),
            None => pointer,
        }
    }

    fn forget(&mut self, pointer: &str) {
        self.marks.retain(|p, _| p != pointer && !p.strip_prefix(pointer).is_some_and(|rest| rest.starts_with('/')));
    }
}

/// Values of a text, or a message and where it applies.
fn read(text: &str) -> Result<Value, (String, Option<Place>)> {
    let message = |e: serde_yaml::Error| (e.to_string(), e.location().map(|l| (l.line(), l.column())));
    let mut value: serde_yaml::Value = serde_yaml::from_str(text).map_err(message)?;
    value.apply_merge().map_err(message)?;
    serde_json::to_value(value).map_err(|e| (e.to_string(), None))
}

/// What is known and found while documents are joined, as JSON pointers.
struct Joining<'a> {
    chosen: HashSet<&'a str>,
    joined: HashSet<String>,
}

fn join(base: &mut Value, overlay: Value, pointer: &str, joining: &mut Joining<'_>) {
    let Value::Object(changes) = overlay else {
        *base = overlay;
        return;
    };
    let other_kind = base.as_object().is_some_and(|b| changes.keys().all(|tag| !b.contains_key(tag)));
    if !base.is_object() || (other_kind && joining.chosen.contains(pointer)) {
        *base = Value::Object(Map::new());
    }
    let Value::Object(entries) = base else { return };
    joining.joined.insert(pointer.to_string());
    for (key, change) in changes {
        if change.is_null() {
            entries.shift_remove(&key);
        } else {
            let pointer = step(pointer, &key);
            join(entries.entry(key).or_insert(Value::Null), change, &pointer, joining);
        }
    }
}

fn leaves(value: &Value, pointer: String, found: &mut Vec<String>) {
    match value {
        Value::Object(entries) => entries.iter().for_each(|(key, v)| leaves(v, step(&pointer, key), found)),
        Value::Array(items) => items.iter().enumerate().for_each(|(k, v)| leaves(v, step(&pointer, &k.to_string()), found)),
        _ => found.push(pointer),
    }
}

#[cfg(test)]
mod tests;
