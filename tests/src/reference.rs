//! Published numbers: the files of `tests/reference`.

use std::fs;
use std::path::PathBuf;

/// Text of a file of the repository, by its path from the top.
///
/// # Panics
/// The file cannot be read.
pub fn repository_text(path: &str) -> String {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    fs::read_to_string(&file).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Text of a file below `tests/reference`.
///
/// # Panics
/// The file cannot be read.
pub fn text(path: &str) -> String {
    repository_text(&format!("tests/reference/{path}"))
}

/// A JSON file below `tests/reference`.
///
/// # Panics
/// The file cannot be read, or is no JSON.
pub fn json(path: &str) -> serde_json::Value {
    serde_json::from_str(&text(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Numbers of a JSON array; nested arrays row after row.
///
/// # Panics
/// An entry is no number.
pub fn numbers(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap_or_else(|| panic!("{other} is not a number"))],
    }
}

/// A table with comments (`#`), a header and cells as they are printed.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a CSV file below `tests/reference`.
    ///
    /// # Panics
    /// The file cannot be read, or a row has not as many cells as the header.
    pub fn read(path: &str) -> Self {
        let text = text(path);
        let split = |line: &str| -> Vec<String> { line.split(',').map(|cell| cell.trim().to_owned()).collect() };
        let mut lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
        let columns = split(lines.next().unwrap_or_else(|| panic!("{path}: no header")));
        let rows: Vec<Vec<String>> = lines.map(split).collect();
        for row in &rows {
            assert_eq!(row.len(), columns.len(), "{path}: cells of {row:?}");
        }
        Self { columns, rows }
    }

    fn column(&self, name: &str) -> usize {
        self.columns.iter().position(|c| c == name).unwrap_or_else(|| panic!("no column `{name}` in {:?}", self.columns))
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A cell as it is printed.
    pub fn cell(&self, row: usize, column: &str) -> &str {
        &self.rows[row][self.column(column)]
    }

    /// A cell as a number.
    ///
    /// # Panics
    /// It is none.
    pub fn number(&self, row: usize, column: &str) -> f64 {
        let cell = self.cell(row, column);
        cell.parse().unwrap_or_else(|_| panic!("`{cell}` is not a number"))
    }

    /// The first row whose cells in some columns are these texts.
    ///
    /// # Panics
    /// There is none.
    pub fn find(&self, cells: &[(&str, &str)]) -> usize {
        let is = |row: &&Vec<String>| cells.iter().all(|(column, text)| row[self.column(column)] == *text);
        let found = self.rows.iter().position(|row| is(&row));
        found.unwrap_or_else(|| panic!("no row with {cells:?}"))
    }

    /// All cells of a row as numbers.
    ///
    /// # Panics
    /// A cell is no number.
    pub fn numbers(&self, row: usize) -> Vec<f64> {
        self.rows[row].iter().map(|cell| cell.parse().unwrap_or_else(|_| panic!("`{cell}` is not a number"))).collect()
    }
}
