//! What happens to files: every way in which a text can be spoiled, by hand, by an editor, on a disk.

use proptest::prelude::*;
use proptest::sample::Index;

/// One spoiling of a text.
#[derive(Clone, Debug)]
pub enum Mutation {
    /// A bit of a byte is flipped; what is no text any more is replaced as a reader of text would.
    FlipBit(Index, u8),
    /// A line is left out.
    DeleteLine(Index),
    /// A line stands twice.
    RepeatLine(Index, Index),
    /// A line moves elsewhere.
    MoveLine(Index, Index),
    /// Two names (before `:` or `=`) change places.
    SwapNames(Index, Index),
    /// A number becomes another one.
    ReplaceNumber(Index, &'static str),
    /// A unit (a word behind a number) becomes another one.
    ReplaceUnit(Index, &'static str),
    /// A word becomes another word of the text.
    ReplaceWord(Index, Index),
    /// A line is indented differently.
    Indent(Index, &'static str),
    /// Something foreign is put in.
    Insert(Index, &'static str),
    /// The end is missing.
    Truncate(Index),
    /// A sign stands very often.
    Stutter(Index, char),
}

const NUMBERS: [&str; 24] = [
    "0",
    "-0",
    "-1",
    "1e999",
    "-1e999",
    "1e308",
    "-1e308",
    "1e-320",
    "NaN",
    ".nan",
    ".inf",
    "-.inf",
    "inf",
    "0x10",
    "1_000",
    "1,5",
    "",
    "1e",
    "--1",
    "99999999999999999999999",
    "1:30",
    "null",
    "true",
    "~",
];

const UNITS: [&str; 20] = [
    "kg",
    "deg",
    "kN/m",
    "bar",
    "N s/m",
    "m",
    "mm",
    "km/h",
    "rad",
    "rpm",
    "N m/rad",
    "1/m",
    "parsec",
    "m^",
    "m^-1e9",
    "m^99999999999",
    "/",
    "kg/m s",
    "µm",
    "°",
];

const FOREIGN: [&str; 30] = [
    "\t",
    "\u{0}",
    "\u{feff}",
    "\r",
    ": ",
    "- ",
    "{",
    "}",
    "[",
    "]",
    "\"",
    "'",
    "&a ",
    "*a",
    "<<: *a\n",
    "!!binary ",
    "| ",
    "> ",
    "# ",
    "---\n",
    "...\n",
    "%YAML 9\n",
    "<",
    ">",
    "</link>",
    "<link name=\"world\"/>",
    "&lt;",
    "<!--",
    "<![CDATA[",
    "<!DOCTYPE a [<!ENTITY b \"&b;&b;\">]>",
];

/// Any one of them.
pub fn mutation() -> impl Strategy<Value = Mutation> {
    let at = any::<Index>;
    prop_oneof![
        (at(), 0..8u8).prop_map(|(i, b)| Mutation::FlipBit(i, b)),
        at().prop_map(Mutation::DeleteLine),
        (at(), at()).prop_map(|(i, j)| Mutation::RepeatLine(i, j)),
        (at(), at()).prop_map(|(i, j)| Mutation::MoveLine(i, j)),
        (at(), at()).prop_map(|(i, j)| Mutation::SwapNames(i, j)),
        (at(), proptest::sample::select(&NUMBERS[..])).prop_map(|(i, n)| Mutation::ReplaceNumber(i, n)),
        (at(), proptest::sample::select(&UNITS[..])).prop_map(|(i, u)| Mutation::ReplaceUnit(i, u)),
        (at(), at()).prop_map(|(i, j)| Mutation::ReplaceWord(i, j)),
        (at(), proptest::sample::select(&["", " ", "  ", "        ", "\t"][..])).prop_map(|(i, s)| Mutation::Indent(i, s)),
        (at(), proptest::sample::select(&FOREIGN[..])).prop_map(|(i, s)| Mutation::Insert(i, s)),
        at().prop_map(Mutation::Truncate),
        (at(), proptest::sample::select(&['[', '{', '<', '-', ' ', '9', 'a', '&', '"'][..])).prop_map(|(i, c)| Mutation::Stutter(i, c)),
    ]
}

impl Mutation {
    /// The spoiled text.
    pub fn apply(&self, text: &str) -> String {
        if text.is_empty() {
            return String::new();
        }
        match self {
            Self::FlipBit(at, bit) => {
                let mut bytes = text.as_bytes().to_vec();
                let at = at.index(bytes.len());
                bytes[at] ^= 1 << bit;
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Self::DeleteLine(at) => lines(text, |lines| {
                lines.remove(at.index(lines.len()));
            }),
            Self::RepeatLine(from, to) => lines(text, |lines| lines.insert(to.index(lines.len()), lines[from.index(lines.len())])),
            Self::MoveLine(from, to) => lines(text, |lines| {
                let line = lines.remove(from.index(lines.len()));
                lines.insert(to.index(lines.len() + 1), line);
            }),
            Self::Indent(at, blanks) => {
                let rows: Vec<&str> = text.lines().collect();
                let k = at.index(rows.len().max(1));
                let turned = rows.iter().enumerate().map(|(i, row)| match i == k {
                    true => format!("{blanks}{}\n", row.trim_start()),
                    false => format!("{row}\n"),
                });
                turned.collect()
            }
            Self::SwapNames(i, j) => {
                let names = spans(text, |c| c.is_alphanumeric() || c == '_', |rest| rest.starts_with([':', '=']));
                swap(text, &names, i, j)
            }
            Self::ReplaceWord(i, j) => {
                let words = spans(text, |c| c.is_alphanumeric() || c == '_', |_| true);
                if words.is_empty() {
                    return text.to_owned();
                }
                let (from, to) = words[j.index(words.len())];
                replace(text, &words, i, &text[from..to])
            }
            Self::ReplaceNumber(i, number) => {
                let numbers = spans(text, |c| c.is_ascii_digit() || "+-.e".contains(c), |_| true);
                let numbers: Vec<_> = numbers.into_iter().filter(|&(a, b)| text[a..b].contains(|c: char| c.is_ascii_digit())).collect();
                replace(text, &numbers, i, number)
            }
            Self::ReplaceUnit(i, unit) => {
                let units = spans(text, |c| c.is_alphabetic() || "/^".contains(c), |_| true);
                let behind = |&(a, _): &(usize, usize)| text[..a].trim_end_matches(' ').ends_with(|c: char| c.is_ascii_digit());
                let units: Vec<_> = units.into_iter().filter(behind).collect();
                replace(text, &units, i, unit)
            }
            Self::Insert(at, foreign) => insert(text, at, foreign),
            Self::Truncate(at) => text[..boundary(text, at.index(text.len()))].to_owned(),
            Self::Stutter(at, sign) => insert(text, at, &sign.to_string().repeat(5000)),
        }
    }
}

fn lines(text: &str, change: impl FnOnce(&mut Vec<&str>)) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    change(&mut lines);
    lines.concat()
}

fn boundary(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn insert(text: &str, at: &Index, what: &str) -> String {
    let at = boundary(text, at.index(text.len()));
    format!("{}{what}{}", &text[..at], &text[at..])
}

/// Runs of signs, as ranges of bytes, of those that are followed by something.
fn spans(text: &str, of: impl Fn(char) -> bool, before: impl Fn(&str) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), '\n')]) {
        match (of(c), start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                start = None;
                if before(&text[at..]) {
                    found.push((from, at));
                }
            }
            _ => {}
        }
    }
    found
}

fn replace(text: &str, spans: &[(usize, usize)], at: &Index, by: &str) -> String {
    if spans.is_empty() {
        return text.to_owned();
    }
    let (from, to) = spans[at.index(spans.len())];
    format!("{}{by}{}", &text[..from], &text[to..])
}

fn swap(text: &str, spans: &[(usize, usize)], i: &Index, j: &Index) -> String {
    if spans.is_empty() {
        return text.to_owned();
    }
    let (a, b) = (spans[i.index(spans.len())], spans[j.index(spans.len())]);
    let (a, b) = if a.0 <= b.0 { (a, b) } else { (b, a) };
    if a == b {
        return text.to_owned();
    }
    format!("{}{}{}{}{}", &text[..a.0], &text[b.0..b.1], &text[a.1..b.0], &text[a.0..a.1], &text[b.1..])
}
