//! Messages for texts that are no YAML: what the parsers say, in words of somebody who wrote a description.

use super::Place;
use crate::description::finding::{Finding, Findings};

/// What a parser says, what it means, and what to do.
const MEANINGS: &[(&str, &str, &str)] = &[
    (
        "mapping values are not allowed",
        "a `:` stands where no entry can begin",
        "check the indentation of this line and of the one before; a text with `: ` in it needs quotes",
    ),
    ("illegal placement of ':'", "a `:` stands where no entry can begin", "is a `]` or `}` missing before it?"),
    ("did not find expected ',' or", "a list or mapping in brackets is not closed", "is a `,`, `]` or `}` missing?"),
    ("did not find expected '-'", "a list goes on without `-`", "items begin with `- ` at one indentation; names do not mix with them"),
    (
        "did not find expected key",
        "this line is not indented like the ones it belongs to",
        "entries that belong together begin in the same column",
    ),
    ("could not find expected ':'", "an entry has no `:`", "write `name: value`"),
    ("simple key expected", "an entry has no `:`", "write `name: value`"),
    ("simple key expect", "an entry has no `:`", "write `name: value`"),
    ("quoted scalar, found unexpected end", "a quotation mark is not closed", "texts in quotes end on `\"` or `'`"),
    ("unknown escape", "an unknown escape with `\\`", "in single quotes, `\\` has no meaning"),
    ("unknown anchor", "there is no anchor of this name before this line", "an anchor `&name` comes before its alias `*name`"),
    ("unexpected character", "a text cannot begin with this character", "put it in quotes"),
    ("cannot start any token", "a text cannot begin with this character", "put it in quotes"),
    ("recursion limit", "entries are nested too deeply", "a bracket is probably not closed"),
    ("more than one document", "a second document begins with `---`", "use one file for each"),
];

/// A finding for what a parser says about a text.
pub(super) fn finding(file: &str, text: &str, said: &str, at: Option<Place>) -> Findings {
    let line_text = at.and_then(|(line, _)| text.lines().nth(line.saturating_sub(1))).unwrap_or_default();
    let indentation = &line_text[..line_text.len() - line_text.trim_start().len()];
    let found = if indentation.contains('\t') {
        Finding::error("bad_yaml", "a tab is used for indentation").with_hint("indent with blanks")
    } else {
        match MEANINGS.iter().find(|(pattern, ..)| said.contains(pattern)) {
            Some((_, message, hint)) => Finding::error("bad_yaml", *message).with_hint(*hint),
            None => Finding::error("bad_yaml", format!("this is not YAML: {}", without_position(said))),
        }
    };
    let found = found.in_file(file);
    match at {
        Some((line, column)) => found.at_line(text, line, column).into(),
        None => found.into(),
    }
}

/// The reader says `… at line 3 column 4, while …`; the finding has the place already.
fn without_position(said: &str) -> &str {
    said.split(" at line ").next().unwrap_or(said)
}
