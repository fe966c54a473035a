//! The second pass over a YAML text: positions, and what the reader of values lets pass.

use super::path::step;
use super::{Mark, Place, syntax};
use crate::description::finding::{Finding, Findings};
use saphyr_parser::{Event, Marker, Parser, ScalarStyle};
use std::collections::HashMap;

/// So many entries at most: an alias of aliases of aliases must not fill the memory.
const MOST_MARKS: usize = 200_000;

/// Positions of all entries by JSON pointer, and what is wrong.
pub(super) fn scan(file: &str, text: &str) -> (HashMap<String, Mark>, Findings) {
    let mut scanner =
        Scanner { file, text, marks: HashMap::new(), findings: Findings::new(), open: Vec::new(), anchors: HashMap::new(), documents: 0 };
    let mut parser = Parser::new_from_str(text);
    while let Some(next) = parser.next_event() {
        match next {
            Ok((event, span)) => scanner.event(event, place(&span.start)),
            Err(error) => {
                let finding = syntax::finding(file, text, error.info(), Some(place(error.marker())));
                scanner.findings.extend(finding);
                break;
            }
        }
    }
    scanner.lift_merged();
    (scanner.marks, scanner.findings)
}

fn place(marker: &Marker) -> Place {
    (marker.line(), marker.col() + 1)
}

/// A mapping or a list that has begun and not ended.
struct Open {
    pointer: String,
    kind: Kind,
}

enum Kind {
    Mapping {
        /// Names so far, and where they stand.
        seen: HashMap<String, Place>,
        /// The name whose value comes next.
        key: Option<(String, Place)>,
    },
    List {
        items: usize,
    },
    /// Stands where a name belongs, and has been reported.
    Misplaced,
}

struct Scanner<'a> {
    file: &'a str,
    text: &'a str,
    marks: HashMap<String, Mark>,
    findings: Findings,
    open: Vec<Open>,
    /// Pointer of each anchored value.
    anchors: HashMap<usize, String>,
    documents: usize,
}

impl Scanner<'_> {
    fn report(&mut self, finding: Finding, pointer: &str, (line, column): Place) {
        let path = super::path::dotted(pointer);
        self.findings.push(finding.in_file(self.file).at_path(path).at_line(self.text, line, column));
    }

    fn event(&mut self, event: Event, at: Place) {
        match event {
            Event::DocumentStart(_) => {
                self.documents += 1;
                if self.documents == 2 {
                    self.report(Finding::error("bad_yaml", "a second document begins here, expected one"), "", at);
                }
            }
            Event::Scalar(text, style, anchor, tag) => self.scalar(&text, style, anchor, tag.is_some(), at),
            Event::Alias(anchor) => {
                if let Some(pointer) = self.value(0, false, at) {
                    self.repeat(anchor, &pointer);
                }
            }
            Event::MappingStart(anchor, tag) => {
                let kind = Kind::Mapping { seen: HashMap::new(), key: None };
                self.begin(kind, anchor, tag.is_some(), at);
            }
            Event::SequenceStart(anchor, tag) => self.begin(Kind::List { items: 0 }, anchor, tag.is_some(), at),
            Event::MappingEnd | Event::SequenceEnd => {
                let closed = self.open.pop();
                if closed.is_some_and(|open| matches!(open.kind, Kind::Misplaced)) {
                    self.take_key(String::new(), at);
                }
            }
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => {}
        }
    }

    fn begin(&mut self, kind: Kind, anchor: usize, tagged: bool, at: Place) {
        let within_misplaced = self.open.last().is_some_and(|open| matches!(open.kind, Kind::Misplaced));
        if within_misplaced {
            self.open.push(Open { pointer: String::new(), kind: Kind::Misplaced });
        } else if self.awaits_key() {
            let pointer = self.open.last().map(|open| open.pointer.clone()).unwrap_or_default();
            self.report(Finding::error("bad_key", "a list or mapping stands where a name belongs"), &pointer, at);
            self.open.push(Open { pointer: String::new(), kind: Kind::Misplaced });
        } else if let Some(pointer) = self.value(anchor, tagged, at) {
            self.open.push(Open { pointer, kind });
        }
    }

    fn scalar(&mut self, text: &str, style: ScalarStyle, anchor: usize, tagged: bool, at: Place) {
        if self.awaits_key() {
            self.key(text, style, at);
            return;
        }
        let Some(pointer) = self.value(anchor, tagged, at) else { return };
        let word = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
        if style == ScalarStyle::Plain && matches!(word.as_str(), ".nan" | ".inf") {
            self.report(Finding::error("bad_number", format!("`{text}` is not a finite number")), &pointer, at);
        }
    }

    fn awaits_key(&self) -> bool {
        self.open.last().is_some_and(|open| matches!(open.kind, Kind::Mapping { key: None, .. }))
    }

    fn key(&mut self, text: &str, style: ScalarStyle, at: Place) {
        let Some(pointer) = self.open.last().map(|open| open.pointer.clone()) else { return };
        let number_or_nothing = text.is_empty() || text == "~" || text.parse::<f64>().is_ok();
        let word = matches!(text, "null" | "true" | "false");
        if style == ScalarStyle::Plain && (number_or_nothing || word) {
            let finding = Finding::error("bad_key", format!("`{text}` stands where a name belongs"));
            self.report(finding.with_hint("put it in quotes to use it as a name"), &pointer, at);
        }
        let before = match self.open.last().map(|open| &open.kind) {
            Some(Kind::Mapping { seen, .. }) if text != "<<" => seen.get(text).copied(),
            _ => None,
        };
        if let Some((line, _)) = before {
            let finding = Finding::error("duplicate_key", format!("`{text}` stands here twice"))
                .with_hint(format!("the first one is on line {line}"));
            self.report(finding, &step(&pointer, text), at);
        }
        self.take_key(text.to_string(), at);
    }

    fn take_key(&mut self, name: String, at: Place) {
        if let Some(Open { kind: Kind::Mapping { seen, key }, .. }) = self.open.last_mut() {
            seen.entry(name.clone()).or_insert(at);
            *key = Some((name, at));
        }
    }

    /// Remembers that a value begins; its pointer, unless it stands at an impossible place.
    fn value(&mut self, anchor: usize, tagged: bool, at: Place) -> Option<String> {
        let (pointer, key) = match self.open.last_mut() {
            None => (String::new(), None),
            Some(Open { pointer, kind: Kind::Mapping { key, .. } }) => {
                let (name, place) = key.take()?;
                (step(pointer, &name), Some(place))
            }
            Some(Open { pointer, kind: Kind::List { items } }) => {
                *items += 1;
                (step(pointer, &(*items - 1).to_string()), None)
            }
            Some(Open { kind: Kind::Misplaced, .. }) => return None,
        };
        if tagged {
            self.report(
                Finding::error("bad_yaml", "tags with `!` are not used here").with_hint("put a text that begins with `!` in quotes"),
                &pointer,
                at,
            );
        }
        if anchor != 0 {
            self.anchors.insert(anchor, pointer.clone());
        }
        self.mark(pointer.clone(), Mark { source: 0, key, value: at });
        Some(pointer)
    }

    fn mark(&mut self, pointer: String, mark: Mark) {
        if self.marks.len() < MOST_MARKS {
            self.marks.entry(pointer).or_insert(mark);
        }
    }

    /// An alias has the entries of its anchor, standing where the anchor stands.
    fn repeat(&mut self, anchor: usize, pointer: &str) {
        let Some(original) = self.anchors.get(&anchor).cloned() else { return };
        self.copy(&original, pointer);
    }

    fn copy(&mut self, from: &str, to: &str) {
        let inner = |p: &str| p.strip_prefix(from).filter(|rest| rest.starts_with('/')).map(|rest| format!("{to}{rest}"));
        let copies: Vec<(String, Mark)> = self.marks.iter().filter_map(|(p, mark)| Some((inner(p)?, *mark))).collect();
        for (pointer, mark) in copies {
            self.mark(pointer, mark);
        }
    }

    /// What stands under `<<` belongs to the mapping around it.
    fn lift_merged(&mut self) {
        let mut merged: Vec<String> = self.marks.keys().filter(|p| p.ends_with("/<<")).cloned().collect();
        merged.sort();
        for pointer in merged {
            let around = pointer.trim_end_matches("/<<").to_string();
            let items: Vec<String> = (0..).map(|k| step(&pointer, &k.to_string())).take_while(|p| self.marks.contains_key(p)).collect();
            for from in items.into_iter().chain([pointer]) {
                self.copy(&from, &around);
            }
        }
    }
}
