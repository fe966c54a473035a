//! Frequency responses: a table with magnitudes and phases, JSON, CSV.

use super::palette::styled;
use super::report::{Beside, Report};
use super::table::{self, Column};
use super::{Angles, Options, csv};
use nalgebra::Complex;
use problem::Signal;
use serde_json::{Value, json};
use std::io;

/// Responses at one point.
#[derive(Clone, Debug)]
pub struct PointResponses {
    /// Hz.
    pub frequencies: Vec<f64>,
    /// One entry per pair of [`Responses::pairs`], one value per frequency.
    pub values: Vec<Vec<Complex<f64>>>,
}

/// Responses at all points of a report.
#[derive(Clone, Debug, Default)]
pub struct Responses {
    /// What oscillates.
    pub inputs: Vec<Signal>,
    /// What answers.
    pub outputs: Vec<Signal>,
    /// In the order of the report's points.
    pub points: Vec<Result<PointResponses, String>>,
}

impl Responses {
    /// Input and output of every response, all outputs of the first input first.
    pub fn pairs(&self) -> impl Iterator<Item = (&Signal, &Signal)> {
        self.inputs.iter().flat_map(|input| self.outputs.iter().map(move |output| (input, output)))
    }

    /// Whether every point has one frequency, so that points are the lines of a table and the abscissae of a figure.
    pub fn single(&self) -> bool {
        self.points.iter().flatten().all(|p| p.frequencies.len() == 1)
    }

    /// Refers all responses to other axes.
    pub(super) fn turn(&mut self, factor: &dyn Fn(&str) -> f64) {
        let factors: Vec<f64> = self.pairs().map(|(input, output)| factor(&input.name) * factor(&output.name)).collect();
        for point in self.points.iter_mut().flatten() {
            for (values, factor) in point.values.iter_mut().zip(&factors) {
                values.iter_mut().filter(|z| **z != Complex::new(0.0, 0.0)).for_each(|z| *z *= *factor);
            }
        }
    }
}

/// Unit of an output over an input as shown, and the factor from SI: `deg/(N m)`.
pub fn quotient(input: &Signal, output: &Signal, angles: Angles) -> (String, f64) {
    let (above, below) = (angles.show(&output.unit), angles.show(&input.unit));
    let inside = |unit: &str| if unit.contains([' ', '/']) { format!("({unit})") } else { unit.to_owned() };
    let unit = match (above.unit, below.unit) {
        (above, "") => above.to_owned(),
        ("", below) => format!("1/{}", inside(below)),
        (above, below) if above == below => String::new(),
        (above, below) => format!("{}/{}", if above.contains('/') { inside(above) } else { above.to_owned() }, inside(below)),
    };
    (unit, above.factor / below.factor)
}

/// Adds the responses to the points of the object.
pub(super) fn add_json(responses: &Responses, object: &mut Value) {
    for (k, point) in responses.points.iter().enumerate() {
        let point = match point {
            Ok(point) => point,
            Err(because) => {
                object["points"][k]["refused"] = json!(because);
                continue;
            }
        };
        object["points"][k]["frequency_hz"] = json!(point.frequencies);
        let list = responses.pairs().zip(&point.values).map(|((input, output), values)| {
            let of = |part: &dyn Fn(&Complex<f64>) -> f64| values.iter().map(part).collect::<Vec<f64>>();
            json!({
                "input": input.name,
                "output": output.name,
                "unit": quotient(input, output, Angles::Radians).0,
                "re": of(&|z| z.re),
                "im": of(&|z| z.im),
                "magnitude": of(&|z| z.norm()),
                "phase": of(&|z| z.arg()),
            })
        });
        object["points"][k]["responses"] = list.collect::<Vec<_>>().into();
    }
}

/// One line per point, response and frequency.
pub(super) fn write_csv(report: &Report, responses: &Responses, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    let columns = ["ending", "input", "output", "frequency_hz", "re", "im", "magnitude", "phase"];
    table.write_record(given.chain(columns.map(str::to_owned)))?;
    for (at, point) in report.points.iter().zip(&responses.points) {
        let Ok(point) = point else { continue };
        for ((input, output), values) in responses.pairs().zip(&point.values) {
            for (frequency, z) in point.frequencies.iter().zip(values) {
                let words = [at.ending.name().to_owned(), input.name.clone(), output.name.clone()];
                let numbers = [*frequency, z.re, z.im, z.norm(), z.arg()].map(csv::cell);
                table.write_record(at.given.iter().map(|v| csv::cell(*v)).chain(words).chain(numbers))?;
            }
        }
    }
    table.flush()
}

/// Magnitude and phase of a response in two columns.
fn columns((input, output): (&Signal, &Signal), values: &[Complex<f64>], options: &Options) -> [Column; 2] {
    let (unit, factor) = quotient(input, output, options.angles);
    let name = format!("{} / {}", output.name, input.name);
    let phase = Column::new("phase", "rad", values.iter().map(|z| z.arg()), options.angles);
    // the unit is that of the reader already
    [Column::new(&name, &unit, values.iter().map(|z| z.norm() * factor), Angles::Radians), phase]
}

/// A table of frequencies per point, or one of points where each has a single frequency; then what is different in variants.
pub(super) fn write_table(report: &Report, responses: &Responses, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    match report.points.len() > 1 && responses.single() {
        true => write_points(report, responses, options, out)?,
        false => write_sweeps(report, responses, options, out)?,
    }
    for variant in &report.variants {
        let Beside::Responses(other) = &variant.beside else { continue };
        let heading = format!("versus {} (difference = variant - base, of the magnitudes)", variant.name);
        writeln!(out, "\n{}", styled(options.palette.heading, &heading))?;
        write_difference(report, (responses, other), options, out)?;
    }
    Ok(())
}

/// Magnitudes of a variant beside their differences: a line per point, or per frequency of each point.
fn write_difference(
    report: &Report,
    (base, other): (&Responses, &Responses),
    options: &Options,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let magnitudes = |of: &Responses, point: usize, pair: usize| -> Vec<f64> {
        of.points[point].as_ref().map_or(Vec::new(), |p| p.values[pair].iter().map(|z| z.norm()).collect())
    };
    let pairs: Vec<(String, String, f64)> = (base.pairs())
        .map(|(input, output)| {
            let (unit, factor) = quotient(input, output, options.angles);
            (format!("{} / {}", output.name, input.name), unit, factor)
        })
        .collect();
    let add = |all: &mut Vec<Column>, points: &[usize]| {
        for (k, (name, unit, factor)) in pairs.iter().enumerate() {
            let of = |which: &Responses| points.iter().flat_map(|&p| magnitudes(which, p, k)).map(|m| m * factor).collect::<Vec<f64>>();
            let (before, after) = (of(base), of(other));
            let difference = after.iter().zip(&before).map(|(a, b)| a - b);
            all.push(Column::new(name, unit, after.iter().copied(), Angles::Radians));
            all.push(Column::new("difference", unit, difference, Angles::Radians));
        }
    };
    let both: Vec<usize> = (0..report.points.len()).filter(|&k| base.points[k].is_ok() && other.points[k].is_ok()).collect();
    let mut write = |all: &[Column], rows: usize| -> io::Result<()> {
        writeln!(out, "{}", styled(options.palette.heading, &table::line(all, &|c| c.name.clone())))?;
        writeln!(out, "{}", styled(options.palette.faint, table::line(all, &|c| c.unit.clone()).trim_end()))?;
        (0..rows).try_for_each(|row| writeln!(out, "{}", table::line(all, &|c| c.cells[row].clone()).trim_end()))
    };
    if report.points.len() > 1 && base.single() {
        let points: Vec<super::Point> = both.iter().map(|&k| report.points[k].clone()).collect();
        let (_, mut all) = table::prescribed_columns(report, &points, options);
        add(&mut all, &both);
        return write(&all, both.len());
    }
    for &k in &both {
        let frequencies = base.points[k].as_ref().map_or(Vec::new(), |p| p.frequencies.clone());
        let given = table::prescribed(report, &report.points[k], options.angles);
        let mut all = vec![Column::new("frequency", "Hz", frequencies.iter().copied(), options.angles)];
        add(&mut all, &[k]);
        if !given.is_empty() {
            all[0].name = format!("{given}: frequency");
        }
        write(&all, frequencies.len())?;
    }
    Ok(())
}

/// A table of frequencies per point.
fn write_sweeps(report: &Report, responses: &Responses, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    for (at, point) in report.points.iter().zip(&responses.points) {
        let given = table::prescribed(report, at, options.angles);
        writeln!(out, "\n{}", if given.is_empty() { "no speed: static pose".to_owned() } else { format!("given: {given}") })?;
        writeln!(out, "ending: {}", table::describe(report, at, options))?;
        let point = match point {
            Ok(point) => point,
            Err(because) => {
                writeln!(out, "{}", styled(palette.bad, &format!("no response: {because}")))?;
                continue;
            }
        };
        let mut all = vec![Column::new("frequency", "Hz", point.frequencies.iter().copied(), options.angles)];
        all.extend(responses.pairs().zip(&point.values).flat_map(|(pair, values)| columns(pair, values, options)));
        writeln!(out, "\n{}", styled(palette.heading, &table::line(&all, &|c| c.name.clone())))?;
        writeln!(out, "{}", styled(palette.faint, table::line(&all, &|c| c.unit.clone()).trim_end()))?;
        for row in 0..point.frequencies.len() {
            writeln!(out, "{}", table::line(&all, &|c| c.cells[row].clone()).trim_end())?;
        }
    }
    Ok(())
}

/// One line per point.
fn write_points(report: &Report, responses: &Responses, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (fixed, mut all) = table::prescribed_columns(report, &report.points, options);
    table::write_given(report, &fixed, options, out)?;
    let none = Complex::new(f64::NAN, f64::NAN);
    let frequencies = responses.points.iter().map(|p| p.as_ref().map_or(f64::NAN, |p| p.frequencies[0]));
    all.push(Column::new("frequency", "Hz", frequencies, options.angles));
    for (k, pair) in responses.pairs().enumerate() {
        let values: Vec<Complex<f64>> = responses.points.iter().map(|p| p.as_ref().map_or(none, |p| p.values[k][0])).collect();
        all.extend(columns(pair, &values, options));
    }
    table::write_columns(&all, &report.points, options, out)?;
    table::write_summary(report, &report.points, options, out)?;
    refusals(responses.points.iter().map(|p| p.as_ref().err()), report, options, out)
}

/// Why points that were reached have no result, each cause once.
pub(super) fn refusals<'a>(
    points: impl Iterator<Item = Option<&'a String>>,
    report: &Report,
    options: &Options,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let mut told: Vec<&String> = Vec::new();
    for (because, at) in points.zip(&report.points) {
        if let Some(because) = because.filter(|b| at.ending == problem::Ending::Reached && !told.contains(b)) {
            writeln!(out, "{}", styled(options.palette.bad, &format!("no result: {because}")))?;
            told.push(because);
        }
    }
    Ok(())
}
