//! Linear models: tables, JSON, CSV, and files for MATLAB and NumPy.

use super::number::{aligned, number};
use super::palette::styled;
use super::report::Report;
use super::{Options, csv, json, mat, npz, table};
use analyses::LinearModel;
use nalgebra::DMatrix;
use problem::Signal;
use serde_json::{Value, json};
use std::io;

/// A linear model at every point of a report, or why there is none.
#[derive(Clone, Debug, Default)]
pub struct Linear {
    /// In the order of the report's points.
    pub points: Vec<Result<LinearModel, String>>,
}

/// A file format of linear models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Export {
    /// The JSON of standard output.
    Json,
    /// NumPy archive.
    Npz,
    /// MATLAB file, level 5.
    Mat,
}

impl Export {
    /// The format that the end of a file's name asks for.
    pub fn of(path: &std::path::Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "json" => Some(Self::Json),
            "npz" => Some(Self::Npz),
            "mat" => Some(Self::Mat),
            _ => None,
        }
    }
}

/// The letters of the matrices, with the matrices.
fn matrices(model: &LinearModel) -> [(&'static str, &DMatrix<f64>); 5] {
    [("E", &model.E), ("A", &model.A), ("B", &model.B), ("C", &model.C), ("D", &model.D)]
}

/// Names and units of states, inputs and outputs.
fn lists(model: &LinearModel) -> [(&'static str, Vec<&Signal>); 3] {
    [
        ("states", model.states.iter().map(|s| &s.signal).collect()),
        ("inputs", model.inputs.iter().map(|i| &i.signal).collect()),
        ("outputs", model.outputs.iter().collect()),
    ]
}

impl Linear {
    /// Refers all models to other axes; `factor` is +1 or −1 by signal. The row of a state turns with the state.
    pub(super) fn turn(&mut self, factor: &dyn Fn(&str) -> f64) {
        for model in self.points.iter_mut().flatten() {
            let [states, inputs, outputs] = lists(model).map(|(_, list)| list.iter().map(|s| factor(&s.name)).collect::<Vec<f64>>());
            let turned = |m: &mut DMatrix<f64>, rows: &[f64], columns: &[f64]| {
                *m = DMatrix::from_fn(m.nrows(), m.ncols(), |i, k| match m[(i, k)] {
                    0.0 => 0.0,
                    entry => entry * rows[i] * columns[k],
                });
            };
            turned(&mut model.E, &states, &states);
            turned(&mut model.A, &states, &states);
            turned(&mut model.B, &states, &inputs);
            turned(&mut model.C, &outputs, &states);
            turned(&mut model.D, &outputs, &inputs);
        }
    }
}

/// A matrix by rows.
fn rows(m: &DMatrix<f64>) -> Value {
    m.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()).collect::<Vec<_>>().into()
}

/// Adds names to the object and matrices to its points; those of an only point stand at the top too.
pub(super) fn add_json(linear: &Linear, object: &mut Value) {
    if let Some(model) = linear.points.iter().flatten().next() {
        for (name, list) in lists(model) {
            object[name] = list.iter().map(|s| json!({ "name": s.name, "unit": s.unit })).collect::<Vec<_>>().into();
        }
        for (k, input) in model.inputs.iter().enumerate() {
            if let Some(rate) = input.rate {
                object["inputs"][k]["rate"] = json!(model.inputs[rate].signal.name);
            }
        }
        let left_out = model.left_out.iter().map(|l| json!({ "signal": l.signal, "because": l.because }));
        object["left_out"] = left_out.collect::<Vec<_>>().into();
    }
    if let [Ok(model)] = linear.points.as_slice() {
        for (letter, m) in matrices(model) {
            object[letter] = rows(m);
        }
    }
    for (k, point) in linear.points.iter().enumerate() {
        match point {
            Ok(model) => matrices(model).into_iter().for_each(|(letter, m)| object["points"][k][letter] = rows(m)),
            Err(because) => object["points"][k]["refused"] = json!(because),
        }
    }
}

/// One line per entry that is not zero.
pub(super) fn write_csv(report: &Report, linear: &Linear, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    table.write_record(given.chain(["matrix", "row", "column", "value"].map(str::to_owned)))?;
    for (point, model) in report.points.iter().zip(&linear.points) {
        let Ok(model) = model else { continue };
        let [states, inputs, outputs] = lists(model).map(|(_, list)| list);
        for (letter, m) in matrices(model) {
            let row_names = if matches!(letter, "C" | "D") { &outputs } else { &states };
            let column_names = if matches!(letter, "B" | "D") { &inputs } else { &states };
            for i in 0..m.nrows() {
                for k in (0..m.ncols()).filter(|&k| m[(i, k)] != 0.0) {
                    let given = point.given.iter().map(|v| csv::cell(*v));
                    let entry = [letter.to_owned(), row_names[i].name.clone(), column_names[k].name.clone(), csv::cell(m[(i, k)])];
                    table.write_record(given.chain(entry))?;
                }
            }
        }
    }
    table.flush()
}

/// Names with units, then the matrices by rows.
pub(super) fn write_table(report: &Report, linear: &Linear, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    writeln!(out, "E dx/dt = A x + B u, z = C x + D u: deviations from the steady state, SI units, radians")?;
    for (point, model) in report.points.iter().zip(&linear.points) {
        let given = table::prescribed(report, point, options.angles);
        writeln!(out, "\n{}", if given.is_empty() { "no speed: static pose".to_owned() } else { format!("given: {given}") })?;
        writeln!(out, "ending: {}", table::describe(report, point, options))?;
        let model = match model {
            Ok(model) => model,
            Err(because) => {
                writeln!(out, "{}", styled(palette.bad, &format!("refused: {because}")))?;
                continue;
            }
        };
        for (title, list) in lists(model) {
            writeln!(out, "\n{}", styled(palette.heading, &format!("{title} ({})", list.len())))?;
            let (names, units) = (width(list.iter().map(|s| &*s.name)), width(list.iter().map(|s| &*s.unit)));
            for (k, s) in list.iter().enumerate() {
                let about = styled(palette.faint, &s.about);
                writeln!(out, "  {:3}  {:names$}  {:units$}  {about}", k + 1, s.name, s.unit)?;
            }
        }
        let [states, _, outputs] = lists(model).map(|(_, list)| list);
        for (letter, m) in matrices(model) {
            let names = if matches!(letter, "C" | "D") { &outputs } else { &states };
            writeln!(out, "\n{}", styled(palette.heading, &format!("{letter} ({} × {})", m.nrows(), m.ncols())))?;
            write_matrix(m, names, out)?;
        }
        for left_out in &model.left_out {
            writeln!(out, "without `{}`: {}", left_out.signal, left_out.because)?;
        }
    }
    Ok(())
}

fn width<'a>(texts: impl Iterator<Item = &'a str>) -> usize {
    texts.map(|t| t.chars().count()).max().unwrap_or(0)
}

/// Rows with their names; columns have the numbers of the lists.
fn write_matrix(m: &DMatrix<f64>, names: &[&Signal], out: &mut dyn io::Write) -> io::Result<()> {
    let columns: Vec<Vec<String>> = m.column_iter().map(|c| aligned(&c.iter().map(|e| number(*e)).collect::<Vec<_>>())).collect();
    let widths: Vec<usize> = columns.iter().map(|c| width(c.iter().map(String::as_str)).max(3)).collect();
    let names_width = width(names.iter().map(|s| &*s.name));
    let heads: Vec<String> = widths.iter().enumerate().map(|(k, w)| format!("{:>w$}", k + 1)).collect();
    writeln!(out, "  {:names_width$}  {}", "", heads.join("  "))?;
    for (i, signal) in names.iter().enumerate() {
        let cells: Vec<String> = columns.iter().zip(&widths).map(|(c, w)| format!("{:>w$}", c[i])).collect();
        writeln!(out, "  {:names_width$}  {}", signal.name, cells.join("  ").trim_end())?;
    }
    Ok(())
}

/// The only linear model of a report as a file; nothing where there is none.
pub fn export(report: &Report, linear: &Linear, format: Export) -> Option<Vec<u8>> {
    let [Ok(model)] = linear.points.as_slice() else { return None };
    let texts: Vec<(String, Vec<String>)> = lists(model)
        .into_iter()
        .flat_map(|(name, list)| {
            let units = list.iter().map(|s| s.unit.to_string()).collect();
            [(name.to_owned(), list.iter().map(|s| s.name.to_string()).collect()), (format!("{}_units", name.trim_end_matches('s')), units)]
        })
        .collect();
    let point = report.points.first();
    let given =
        point.iter().flat_map(|p| report.given.iter().zip(&p.given)).map(|(g, v)| (format!("given_{}", g.name), DMatrix::repeat(1, 1, *v)));
    let given: Vec<(String, DMatrix<f64>)> = given.collect();
    let numbers: Vec<(&str, &DMatrix<f64>)> = matrices(model).into_iter().chain(given.iter().map(|(n, v)| (n.as_str(), v))).collect();
    Some(match format {
        Export::Json => format!("{:#}\n", json::object(report)).into_bytes(),
        Export::Npz => npz::archive(&numbers, &texts),
        Export::Mat => mat::file(&numbers, &texts),
    })
}
