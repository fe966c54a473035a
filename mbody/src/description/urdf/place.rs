//! Where entries stand in the text.

use crate::description::finding::{Finding, Findings};
use roxmltree::{Attribute, Document, Node, ParsingOptions};
use std::collections::HashMap;

/// Deepest nesting of elements; URDF needs six levels, readers call themselves once per level.
const DEEPEST: usize = 64;

/// Where an entry stands: number of the text, line and column counted from one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    source: usize,
    pub line: usize,
    column: usize,
}

/// A text that was read.
#[derive(Debug)]
struct Source {
    file: String,
    text: String,
    /// Offset at which each line begins: looking a position up must not read the text from its start.
    lines: Vec<usize>,
}

/// Lines and columns of entries, by path.
#[derive(Debug, Default)]
pub(super) struct Places {
    sources: Vec<Source>,
    at: HashMap<String, Spot>,
}

impl Places {
    /// Goes on to another text: nodes belong to it from now on.
    pub fn begin(&mut self, file: &str, text: &str) {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(k, _)| k + 1)).collect();
        self.sources.push(Source { file: file.to_string(), text: text.to_string(), lines });
    }

    /// Line and column of an element of the present text.
    pub fn of_node(&self, node: Node) -> Spot {
        self.position(node.range().start)
    }

    /// Line and column of an attribute of the present text.
    pub fn of_attribute(&self, attribute: Attribute) -> Spot {
        self.position(attribute.range().start)
    }

    fn position(&self, offset: usize) -> Spot {
        let Some(Source { text, lines, .. }) = self.sources.last() else { return Spot { source: 0, line: 1, column: 1 } };
        let line = lines.partition_point(|start| *start <= offset).max(1);
        let before = text.get(lines[line - 1]..offset).unwrap_or_default();
        Spot { source: self.sources.len() - 1, line, column: before.chars().count() + 1 }
    }

    /// Remembers where an entry stands; the first of several of the same path counts.
    pub fn insert(&mut self, path: String, at: Spot) {
        self.at.entry(path).or_insert(at);
    }

    /// `line 3`, with the name of the text where that is another one than that of `seen_from`.
    pub fn words(&self, at: Spot, seen_from: Spot) -> String {
        match self.sources.get(at.source).filter(|_| at.source != seen_from.source) {
            Some(source) => format!("line {} of `{}`", at.line, source.file),
            None => format!("line {}", at.line),
        }
    }

    /// Names of all texts, where there are several.
    pub fn files(&self) -> Vec<&str> {
        let files = self.sources.iter().map(|s| s.file.as_str());
        if self.sources.len() > 1 { files.collect() } else { Vec::new() }
    }

    /// A finding at a known place.
    pub fn at(&self, finding: Finding, at: Spot) -> Finding {
        match self.sources.get(at.source) {
            Some(source) => finding.in_file(&source.file).at_line(&source.text, at.line, at.column),
            None => finding,
        }
    }

    /// A finding at the place of its path, or of the nearest enclosing entry.
    pub fn located(&self, finding: Finding) -> Finding {
        let mut path = finding.path.as_str();
        loop {
            if let Some(place) = self.at.get(path) {
                return self.at(finding.clone(), *place);
            }
            match path.rfind('.') {
                Some(end) => path = &path[..end],
                None => return finding.in_file(self.sources.first().map_or("", |s| s.file.as_str())),
            }
        }
    }
}

/// Reads XML whose outermost element is `<robot>`.
pub(super) fn parse<'a>(file: &str, text: &'a str) -> Result<Document<'a>, Findings> {
    // far below what exhausts memory, far above any machine
    let options = ParsingOptions { nodes_limit: 2_000_000, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| {
        let at = e.pos();
        let message = format!("this is not XML: {}", without_position(&e.to_string()));
        let finding = Finding::error("not_xml", message).in_file(file).at_line(text, at.row as usize, at.col as usize);
        let xacro = text.contains("xacro:");
        Findings::from(if xacro { finding.with_hint("this looks like xacro; expand it to plain URDF first") } else { finding })
    })?;
    let root = document.root_element();
    let at = document.text_pos_at(root.range().start);
    let (line, column) = (at.row as usize, at.col as usize);
    let refuse = |code, message: String| Err(Finding::error(code, message).in_file(file).at_line(text, line, column).into());
    if root.tag_name().name() != "robot" {
        return refuse("not_urdf", format!("the outermost element is `<{}>`, expected `<robot>`", root.tag_name().name()));
    }
    if root.descendants().any(|node| node.is_element() && node.ancestors().nth(DEEPEST).is_some()) {
        return refuse("not_urdf", format!("elements are nested more than {DEEPEST} levels deep"));
    }
    Ok(document)
}

/// The message of the XML reader says `… at 3:14`; the finding has that already.
fn without_position(message: &str) -> String {
    let plain = message.rfind(" at ").filter(|k| message[k + 4..].chars().all(|c| c.is_ascii_digit() || c == ':'));
    message[..plain.unwrap_or(message.len())].to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_without_a_place_of_their_own_take_that_of_the_enclosing_one() {
        let mut places = Places::default();
        places.begin("f.urdf", "one\ntwo\n");
        places.insert("link.a".to_string(), Spot { source: 0, line: 2, column: 1 });
        let found = places.located(Finding::error("x", "y").at_path("link.a.mass"));
        assert_eq!(found.place(), "f.urdf:2:1 (link.a.mass)");
        assert_eq!(places.located(Finding::error("x", "y").at_path("joint.b")).place(), "f.urdf (joint.b)");
    }
}
