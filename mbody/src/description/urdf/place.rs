//! Where entries stand in the text.

use crate::description::finding::{Finding, Findings};
use roxmltree::{Attribute, Document, Node, ParsingOptions};
use std::collections::HashMap;

/// Deepest nesting of elements; URDF needs six levels, readers call themselves once per level.
const DEEPEST: usize = 64;

/// Lines and columns of entries, by path.
#[derive(Debug)]
pub(super) struct Places {
    file: String,
    text: String,
    /// Offset at which each line begins: looking a position up must not read the text from its start.
    lines: Vec<usize>,
    at: HashMap<String, (usize, usize)>,
}

impl Places {
    pub fn new(file: &str, text: &str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(k, _)| k + 1)).collect();
        Self { file: file.to_string(), text: text.to_string(), lines, at: HashMap::new() }
    }

    /// Line and column of an element.
    pub fn of_node(&self, node: Node) -> (usize, usize) {
        self.position(node.range().start)
    }

    /// Line and column of an attribute.
    pub fn of_attribute(&self, attribute: Attribute) -> (usize, usize) {
        self.position(attribute.range().start)
    }

    fn position(&self, offset: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|start| *start <= offset).max(1);
        let before = self.text.get(self.lines[line - 1]..offset).unwrap_or_default();
        (line, before.chars().count() + 1)
    }

    /// Remembers where an entry stands; the first of several of the same path counts.
    pub fn insert(&mut self, path: String, at: (usize, usize)) {
        self.at.entry(path).or_insert(at);
    }

    /// A finding at a known place.
    pub fn at(&self, finding: Finding, (line, column): (usize, usize)) -> Finding {
        finding.in_file(&self.file).at_line(&self.text, line, column)
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
                None => return finding.in_file(&self.file),
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
        let mut places = Places::new("f.urdf", "one\ntwo\n");
        places.insert("link.a".to_string(), (2, 1));
        let found = places.located(Finding::error("x", "y").at_path("link.a.mass"));
        assert_eq!(found.place(), "f.urdf:2:1 (link.a.mass)");
        assert_eq!(places.located(Finding::error("x", "y").at_path("joint.b")).place(), "f.urdf (joint.b)");
    }
}
