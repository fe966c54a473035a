//! Inputs from a file: first column time, one column per input, SI units. The file of an earlier run will do.

use super::start::quantity;
use crate::Failure;
use crate::arguments::{argument, unknown_name};
use analyses::transient::{Driven, Table};
use analyses::{Variable, Variables};
use problem::Plant;
use std::path::Path;

/// Lets the columns of a file act instead of the constant values of their inputs. Columns of other signals, which a recorded run has, are passed over.
///
/// # Errors
/// The file cannot be read, a column has an unknown name or unit, a value is no number, times decrease, no column is an input.
pub fn act(file: &Path, plant: &dyn Plant, also_known: &[&str], inputs: &mut Driven) -> Result<(), Failure> {
    let shown = file.display().to_string();
    let wrong = |code, why: String| Failure::from(argument("signals", &shown, code, why));
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_path(file);
    let reader = reader.as_mut().map_err(|e| wrong("missing_file", format!("the file cannot be read: {e}")))?;
    let header = reader.headers().map_err(|e| wrong("bad_table", e.to_string()))?.clone();
    let variables = Variables::of(plant);
    let mut columns: Vec<(usize, usize, f64)> = Vec::new();
    for (k, title) in header.iter().enumerate() {
        let (name, unit) = split(title);
        let of = |known: &str| factor(unit, known).ok_or_else(|| wrong("bad_unit", format!("column `{title}`: `{name}` is in {known}")));
        match (k, variables.find(name)) {
            (0, _) if name == "time" => drop(of("s")?),
            (0, _) => return Err(wrong("bad_table", format!("the first column is `{title}`, not `time`"))),
            (_, Some(Variable::Input(i))) => match columns.iter().any(|c| c.1 == i) {
                true => return Err(wrong("given_twice", format!("`{name}` has two columns"))),
                false => columns.push((k, i, of(&variables.unit(Variable::Input(i)))?)),
            },
            (_, Some(_)) => {}
            (_, None) if also_known.contains(&name) => {}
            (_, None) => return Err(unknown_name("signals", &shown, ("signal", name), variables.names()).into()),
        }
    }
    if columns.is_empty() {
        let finding = argument("signals", &shown, "bad_table", "no column is an input of this model");
        return Err(finding.with_hint("`fastbike info MODEL` lists the inputs").into());
    }
    let (mut times, mut values) = (Vec::new(), vec![Vec::new(); columns.len()]);
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|e| wrong("bad_table", e.to_string()))?;
        let number = |k: usize| {
            let cell = record.get(k).unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| wrong("bad_number", format!("row {}, column `{}`: `{cell}` is not a number", row + 1, &header[k])))
        };
        times.push(number(0)?);
        for (values, &(k, _, factor)) in values.iter_mut().zip(&columns) {
            values.push(factor * number(k)?);
        }
    }
    for (values, (_, input, _)) in values.into_iter().zip(columns) {
        let track = Table::new(times.clone(), values)
            .ok_or_else(|| wrong("bad_table", "times must not decrease, and there must be rows".to_owned()))?;
        inputs.base_mut()[input] = 0.0;
        inputs.add(plant, input, Box::new(track));
    }
    Ok(())
}

/// `name [unit]`.
fn split(title: &str) -> (&str, Option<&str>) {
    match title.strip_suffix(']').and_then(|t| t.split_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (title, None),
    }
}

/// What multiplies values in `unit` to be in `known`.
fn factor(unit: Option<&str>, known: &str) -> Option<f64> {
    match unit {
        None => Some(1.0),
        Some(unit) if unit == known => Some(1.0),
        Some(unit) => quantity(&format!("1 {unit}"), known).ok(),
    }
}
