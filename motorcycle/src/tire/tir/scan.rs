//! Lines of a property file: sections, entries, tables.
//!
//! ```text
//! [SECTION]                 begins a section
//! KEY = value $ remark      a number, a text in quotes, or a word
//! {column column}           begins a table of the section
//! 1.0 0.5                   a row of it
//! $ or !                    begins a remark
//! ```

use mbody::description::finding::{Finding, Findings};

/// What stands right of the equals sign.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number as written, in the units of the file.
    Number(f64),
    /// A text without its quotes.
    Text(String),
}

/// A line `KEY = value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Section, in capital letters.
    pub section: String,
    /// Key, in capital letters.
    pub key: String,
    /// Its value.
    pub value: Value,
    /// Line, counted from one.
    pub line: usize,
    /// Column of the value, counted from one.
    pub column: usize,
}

/// Rows of numbers under a heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Section, in capital letters.
    pub section: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

/// What a property file says, nothing left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scanned {
    /// Sections with the lines where they begin.
    pub sections: Vec<(String, usize)>,
    /// All entries, in their order.
    pub entries: Vec<Entry>,
    /// All tables.
    pub tables: Vec<Table>,
}

/// A number with the exponent of Fortran or C.
fn number(text: &str) -> Option<f64> {
    let plain = text.replace(['d', 'D'], "e");
    // words such as `inf` and `nan` are no numbers here
    let digits = plain.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
    digits.then(|| plain.parse::<f64>().ok()).flatten().filter(|x| x.is_finite())
}

/// The line without its remark.
fn without_remark(line: &str) -> &str {
    let mut quote = None;
    for (k, c) in line.char_indices() {
        match (quote, c) {
            (None, '\'' | '"') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            (None, '$' | '!') => return &line[..k],
            _ => {}
        }
    }
    // a quote that never closes: an apostrophe in a remark
    match quote {
        Some(_) => line.find(['$', '!']).map_or(line, |k| &line[..k]),
        None => line,
    }
}

/// The value of an entry, or why there is none.
fn value(text: &str) -> Result<Value, &'static str> {
    if text.is_empty() {
        return Err("there is no value after the equals sign");
    }
    if let Some(quote) = text.chars().next().filter(|c| matches!(c, '\'' | '"')) {
        return match text[1..].strip_suffix(quote) {
            Some(inside) => Ok(Value::Text(inside.trim().to_owned())),
            None => Err("the quotes are not closed"),
        };
    }
    match number(text) {
        Some(number) => Ok(Value::Number(number)),
        None if text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') => Ok(Value::Text(text.to_owned())),
        None => Err("this is neither a number nor a text in quotes"),
    }
}

/// Reads all lines.
pub fn scan(name: &str, text: &str, findings: &mut Findings) -> Scanned {
    let mut scanned = Scanned::default();
    let mut section = String::new();
    let mut in_table = false;
    for (k, whole) in text.lines().enumerate() {
        // some editors begin a file with a mark of its encoding
        let line = without_remark(whole.trim_start_matches('\u{feff}'));
        let content = line.trim();
        let column = |part: &str| 1 + whole[..part.as_ptr() as usize - whole.as_ptr() as usize].chars().count();
        let mut refuse = |message: String, part: &str| {
            findings.push(Finding::error("tir_syntax", message).in_file(name).at_line(text, k + 1, column(part)));
        };
        if content.is_empty() {
            continue;
        }
        if let Some(rest) = content.strip_prefix('[') {
            match rest.strip_suffix(']') {
                Some(inside) if !inside.trim().is_empty() => section = inside.trim().to_uppercase(),
                _ => refuse("a section is written `[NAME]`".to_owned(), content),
            }
            scanned.sections.push((section.clone(), k + 1));
            in_table = false;
        } else if let Some(inside) = content.strip_prefix('{') {
            let columns = inside.trim_end_matches('}').split_whitespace().map(str::to_owned).collect();
            scanned.tables.push(Table { section: section.clone(), columns, rows: Vec::new() });
            in_table = true;
        } else if let Some((key, of_key)) = content.split_once('=') {
            let (key, of_key) = (key.trim(), of_key.trim());
            match value(of_key) {
                Ok(value) => {
                    let entry = Entry { section: section.clone(), key: key.to_uppercase(), value, line: k + 1, column: column(of_key) };
                    scanned.entries.push(entry);
                }
                Err(why) => refuse(format!("`{key}`: {why}"), if of_key.is_empty() { key } else { of_key }),
            }
        } else {
            let row: Option<Vec<f64>> = content.split_whitespace().map(number).collect();
            match (row, scanned.tables.last_mut().filter(|_| in_table)) {
                (Some(row), Some(table)) => table.rows.push(row),
                _ => refuse("this is no section, no `KEY = value` and no row of a table".to_owned(), content),
            }
        }
    }
    scanned
}
