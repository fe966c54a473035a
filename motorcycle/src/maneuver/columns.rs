//! Columns of a CSV file by name: what was measured, or recorded in an earlier run.

use mbody::description::Library;
use mbody::description::finding::{Finding, Findings, suggestion};
use mbody::description::quantity::{Dimension, parse_quantity};

/// Splits `name [unit]`.
fn split(title: &str) -> (&str, Option<&str>) {
    match title.strip_suffix(']').and_then(|t| t.split_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (title, None),
    }
}

/// Columns of a file in SI units, each by its name and dimension (none: the number as it stands); titles may carry a unit, `height [mm]`. Other columns are passed over, lines behind `#` too.
///
/// # Errors
/// There is no such file or column, a unit of another dimension, a cell that is no number.
pub fn columns(library: &dyn Library, file: &str, wanted: &[(&str, Option<&'static Dimension>)]) -> Result<Vec<Vec<f64>>, Findings> {
    let missing = || Finding::error("missing_file", format!("file `{file}` was not found beside the maneuver"));
    let text = library.text(file).ok_or_else(missing)?;
    let wrong = |code, why: String| Finding::error(code, format!("file `{file}`: {why}"));
    let mut lines = text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with('#'));
    let titles: Vec<&str> = lines.next().unwrap_or_default().split(',').map(|t| t.trim().trim_matches('"')).collect();
    let mut places = Vec::with_capacity(wanted.len());
    for &(name, dimension) in wanted {
        let names = || titles.iter().map(|t| split(t).0);
        let Some(at) = names().position(|n| n == name) else {
            return Err(wrong("bad_table", format!("there is no column `{name}`")).with_hint_from(suggestion(name, names())).into());
        };
        let factor = match (split(titles[at]).1, dimension) {
            (Some(unit), Some(dimension)) => parse_quantity(&format!("1 {unit}"), dimension),
            _ => Ok(1.0),
        };
        places.push((at, factor.map_err(|e| wrong("bad_unit", format!("column `{}`: {e}", titles[at])))?));
    }
    let mut read = vec![Vec::new(); wanted.len()];
    for (row, line) in lines.enumerate() {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        for (values, &(at, factor)) in read.iter_mut().zip(&places) {
            let cell = cells.get(at).copied().unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|v| v.is_finite());
            let number = || wrong("bad_number", format!("row {}, column `{}`: `{cell}` is not a number", row + 1, titles[at]));
            values.push(value.ok_or_else(number)? * factor);
        }
    }
    Ok(read)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::description::quantity::Dimensioned;
    use mbody::description::quantity::dimension::{Length, Time};
    use std::borrow::Cow;

    struct Text(&'static str);

    impl Library for Text {
        fn text(&self, name: &str) -> Option<Cow<'_, str>> {
            (name == "here.csv").then_some(Cow::Borrowed(self.0))
        }
    }

    #[test]
    fn columns_are_found_by_name_and_converted() {
        let text = Text("# measured\nother,x [cm], time [ms]\n1, 2, 3\n4, 5e1, 6\n");
        let read = columns(&text, "here.csv", &[("time", Some(Time::DIMENSION)), ("x", Some(Length::DIMENSION))]).expect("a table");
        assert_eq!(read, [vec![0.003, 0.006], vec![0.02, 0.5]]);
        let why = |text, file, name| columns(&Text(text), file, &[(name, Some(Length::DIMENSION))]).expect_err("a finding").to_string();
        assert!(why("x\n1", "there.csv", "x").contains("`there.csv` was not found"));
        assert!(why("x\n1", "here.csv", "y").contains("no column `y`"));
        assert!(why("x [s]\n1", "here.csv", "x").contains("column `x [s]`"));
        assert!(why("x\n1\nnan", "here.csv", "x").contains("row 2, column `x`: `nan` is not a number"));
    }
}
