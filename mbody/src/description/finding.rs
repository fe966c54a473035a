//! Findings: what is wrong or suspicious in an input, where, and what to do about it.
//!
//! ```text
//! error[unknown_key]: unknown key `stifness`
//!   --> plant.yaml:12:5 (elements.shock.spring_damper.stifness)
//!    12 | stifness: 58 kN/m
//!       | ^
//!    hint: did you mean `stiffness`?
//! ```

pub use super::nearest::{nearest, suggestion};
use serde::Serialize;
use std::fmt;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input can be used, but probably does not mean what it says.
    Warning,
    /// Worth knowing, changes nothing: for instance an extension that is read by other programs only.
    Note,
}

impl Severity {
    /// `error`, `warning` or `note`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// One thing that is wrong or suspicious in an input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Stable name of this sort of finding, in snake case.
    pub code: &'static str,
    /// Name of the file, or of the option on the command line.
    pub file: String,
    /// Line, counted from one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Column in characters, counted from one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
    /// Dotted path of the entry; empty where the file as a whole is meant.
    pub path: String,
    /// The line of the text, without indentation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub excerpt: Option<String>,
    /// Characters of the excerpt before the column.
    #[serde(skip)]
    pub caret: Option<usize>,
    /// What is wrong: one line, lower case, names in back-ticks.
    pub message: String,
    /// What to do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

impl Finding {
    /// A finding without a place yet.
    pub fn new(severity: Severity, code: &'static str, message: impl Into<String>) -> Self {
        Self {
            severity,
            code,
            file: String::new(),
            line: None,
            column: None,
            path: String::new(),
            excerpt: None,
            caret: None,
            message: one_line(message.into()),
            hint: None,
        }
    }

    /// An error without a place yet.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    /// A warning without a place yet.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    /// A note without a place yet.
    pub fn note(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, message)
    }

    /// The same finding in a file.
    pub fn in_file(mut self, file: impl Into<String>) -> Self {
        self.file = file.into();
        self
    }

    /// The same finding about an entry.
    pub fn at_path(mut self, path: impl Into<String>) -> Self {
        self.path = path.into();
        self
    }

    /// The same finding at a line and column of `text`, both counted from one, with that line as excerpt.
    pub fn at_line(mut self, text: &str, line: usize, column: usize) -> Self {
        self.line = Some(line);
        self.column = Some(column);
        self.excerpt = excerpt(text, line);
        let indentation = text.lines().nth(line.saturating_sub(1)).map_or(0, |l| l.chars().take_while(|c| c.is_whitespace()).count());
        let length = self.excerpt.as_ref().map_or(0, |e| e.chars().count());
        self.caret = column.checked_sub(1 + indentation).filter(|before| *before < length);
        self
    }

    /// The same finding, known by its path only: what it is about stands in no text, or in another one.
    pub fn without_place(self) -> Self {
        Self { line: None, column: None, excerpt: None, caret: None, ..self }
    }

    /// The same finding with advice.
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(one_line(hint.into()));
        self
    }

    /// The same finding with advice, where there is any.
    pub fn with_hint_from(mut self, hint: Option<String>) -> Self {
        self.hint = hint.map(one_line).or(self.hint);
        self
    }

    /// Writes the finding piece by piece; `write` may color each piece by its [`Part`].
    pub fn render(&self, write: &mut dyn FnMut(Part, &str) -> fmt::Result) -> fmt::Result {
        write(Part::Severity(self.severity), &format!("{}[{}]", self.severity.word(), self.code))?;
        write(Part::Message, &format!(": {}", self.message))?;
        let place = self.place();
        if !place.is_empty() {
            write(Part::Frame, "\n  --> ")?;
            write(Part::Place, &place)?;
        }
        if let (Some(line), Some(excerpt)) = (self.line, &self.excerpt) {
            write(Part::Frame, &format!("\n{line:>5} | "))?;
            write(Part::Excerpt, excerpt)?;
            if let Some(column) = self.caret {
                write(Part::Frame, &format!("\n      | {:column$}^", ""))?;
            }
        }
        if let Some(hint) = &self.hint {
            write(Part::Frame, "\n   hint: ")?;
            write(Part::Hint, hint)?;
        }
        Ok(())
    }

    /// `file:line:column (path)`, as much of it as is known.
    pub fn place(&self) -> String {
        let mut place = self.file.clone();
        for number in [self.line, self.column].into_iter().flatten() {
            place.push_str(&format!(":{number}"));
        }
        match (self.path.is_empty(), place.is_empty()) {
            (true, _) => place,
            (false, true) => self.path.clone(),
            (false, false) => format!("{place} ({})", self.path),
        }
    }
}

/// What a piece of a rendered finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `error[code]`.
    Severity(Severity),
    /// What is wrong.
    Message,
    /// Arrows, line numbers and labels.
    Frame,
    /// File, line, column and path.
    Place,
    /// The line of the input.
    Excerpt,
    /// Advice.
    Hint,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.render(&mut |_, piece| f.write_str(piece))
    }
}

impl std::error::Error for Finding {}

/// Several findings at once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Findings(Vec<Finding>);

impl Findings {
    /// Nothing found.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one.
    pub fn push(&mut self, finding: Finding) {
        self.0.push(finding);
    }

    /// All of them, in the present order.
    pub fn iter(&self) -> std::slice::Iter<'_, Finding> {
        self.0.iter()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many of one severity there are.
    pub fn count(&self, severity: Severity) -> usize {
        self.iter().filter(|f| f.severity == severity).count()
    }

    /// Whether the input cannot be used.
    pub fn has_errors(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// The same findings ordered by file, line and column; findings without a line come first within their file.
    pub fn sorted(mut self) -> Self {
        self.0.sort_by(|a, b| (&a.file, a.line, a.column, a.severity).cmp(&(&b.file, b.line, b.column, b.severity)));
        self
    }

    /// `value` with what remains to be said about it, or the findings alone where there are errors among them.
    pub fn into_result<T>(self, value: T) -> Result<(T, Self), Self> {
        if self.has_errors() { Err(self.sorted()) } else { Ok((value, self.sorted())) }
    }

    /// `2 errors, 1 warning`; empty where nothing was found.
    pub fn summary(&self) -> String {
        let parts = [Severity::Error, Severity::Warning, Severity::Note].into_iter().filter_map(|severity| {
            let n = self.count(severity);
            (n > 0).then(|| format!("{n} {}{}", severity.word(), if n == 1 { "" } else { "s" }))
        });
        parts.collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, finding) in self.iter().enumerate() {
            if k > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{finding}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Findings {}

impl From<Finding> for Findings {
    fn from(finding: Finding) -> Self {
        Self(vec![finding])
    }
}

impl Extend<Finding> for Findings {
    fn extend<T: IntoIterator<Item = Finding>>(&mut self, findings: T) {
        self.0.extend(findings);
    }
}

impl FromIterator<Finding> for Findings {
    fn from_iter<T: IntoIterator<Item = Finding>>(findings: T) -> Self {
        Self(findings.into_iter().collect())
    }
}

impl IntoIterator for Findings {
    type Item = Finding;
    type IntoIter = std::vec::IntoIter<Finding>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Findings {
    type Item = &'a Finding;
    type IntoIter = std::slice::Iter<'a, Finding>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// The text with control characters shown as such (`\n`): names and texts of an input go into messages as they are.
fn one_line(text: String) -> String {
    match text.contains(char::is_control) {
        true => text.chars().map(|c| if c.is_control() { c.escape_debug().to_string() } else { c.to_string() }).collect(),
        false => text,
    }
}

/// A line of a text, counted from one, without indentation and shortened to what fits on a screen.
fn excerpt(text: &str, line: usize) -> Option<String> {
    const LONGEST: usize = 120;
    let line = text.lines().nth(line.checked_sub(1)?)?.trim();
    if line.is_empty() {
        return None;
    }
    let mut short: String = line.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if line.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    Some(short)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Finding {
        Finding::error("unknown_key", "unknown key `stifness`")
            .in_file("plant.yaml")
            .at_path("elements.shock.spring_damper.stifness")
            .at_line("shock:\n    stifness: 58 kN/m\n", 2, 5)
            .with_hint("did you mean `stiffness`?")
    }

    #[test]
    fn reads_like_a_compiler_message() {
        let text = "error[unknown_key]: unknown key `stifness`\n  --> plant.yaml:2:5 (elements.shock.spring_damper.stifness)\n    \
                    2 | stifness: 58 kN/m\n      | ^\n   hint: did you mean `stiffness`?";
        assert_eq!(example().to_string(), text);
    }

    #[test]
    fn renders_in_parts_that_give_the_plain_text() {
        let (mut text, mut parts) = (String::new(), Vec::new());
        let done = example().render(&mut |part, piece| {
            parts.push(part);
            text.push_str(piece);
            Ok(())
        });
        assert!(done.is_ok());
        assert_eq!(text, example().to_string());
        assert!(parts.contains(&Part::Severity(Severity::Error)) && parts.contains(&Part::Hint));
    }

    #[test]
    fn shows_as_much_of_the_place_as_is_known() {
        assert_eq!(Finding::error("x", "y").to_string(), "error[x]: y");
        assert_eq!(Finding::error("x", "y").at_path("a.b").place(), "a.b");
        assert_eq!(Finding::error("x", "y").in_file("f").place(), "f");
    }

    #[test]
    fn sorts_by_place_and_counts() {
        let mut findings = Findings::new();
        findings.push(Finding::warning("w", "second").in_file("a").at_line("", 7, 1));
        findings.extend([Finding::error("e", "first").in_file("a").at_line("", 3, 9)]);
        assert_eq!(findings.summary(), "1 error, 1 warning");
        assert!(findings.has_errors());
        let sorted = findings.sorted();
        assert_eq!(sorted.iter().map(|f| f.message.as_str()).collect::<Vec<_>>(), ["first", "second"]);
        assert!(sorted.into_result(()).is_err());
        assert!(Findings::from(Finding::warning("w", "only")).into_result(1).is_ok());
    }

    #[test]
    fn becomes_json_without_empty_entries() {
        let json = serde_json::to_string(&Findings::from(Finding::note("n", "m").in_file("f"))).unwrap_or_default();
        assert_eq!(json, r#"[{"severity":"note","code":"n","file":"f","path":"","message":"m"}]"#);
    }

    #[test]
    fn a_message_is_one_line() {
        let finding = Finding::error("e", "expected '>' not '\n'").with_hint("a\tb");
        assert_eq!((finding.message.as_str(), finding.hint.as_deref()), ("expected '>' not '\\n'", Some("a\\tb")));
    }

    #[test]
    fn shortens_long_lines() {
        let long = Finding::error("e", "m").at_line(&"x".repeat(5000), 1, 1);
        assert_eq!(long.excerpt.map(|e| e.chars().count()), Some(121));
    }
}
