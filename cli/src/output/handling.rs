//! Handling indices: one line per point, JSON, CSV.

use super::report::Report;
use super::table::{self, Column};
use super::{Angles, Options, csv};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::io;

/// One index.
#[derive(Clone, Debug, PartialEq)]
pub struct Index {
    /// Name in JSON and CSV.
    pub name: &'static str,
    /// Name for readers.
    pub title: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Signals whose quotient it is, with their senses; none: a magnitude.
    pub quotient: Option<[&'static str; 2]>,
}

/// Indices at all points of a report.
#[derive(Clone, Debug, Default)]
pub struct HandlingAlong {
    /// The indices.
    pub indices: Vec<Index>,
    /// One value per index, in the order of the report's points; NaN where there is none.
    pub points: Vec<Vec<f64>>,
    /// What was ridden and how the turns were made, for the head of the table.
    pub about: Vec<String>,
}

impl HandlingAlong {
    /// Refers all indices to other axes.
    pub(super) fn turn(&mut self, factor: &dyn Fn(&str) -> f64) {
        for point in &mut self.points {
            for (value, index) in point.iter_mut().zip(&self.indices) {
                *value *= index.quotient.map_or(1.0, |[above, below]| factor(above) * factor(below));
            }
        }
    }
}

/// The unit and the value of an index as shown: a quotient by an angle is one by degrees.
pub fn shown(index: &Index, angles: Angles) -> (Cow<'static, str>, f64) {
    match (index.unit, angles) {
        ("N m/rad", Angles::Degrees) => ("N m/deg".into(), 1f64.to_radians()),
        (unit, _) => (unit.into(), 1.0),
    }
}

/// Adds the indices to the points of the object.
pub(super) fn add_json(along: &HandlingAlong, object: &mut Value) {
    let units: Map<String, Value> = along.indices.iter().map(|i| (i.name.to_owned(), json!(i.unit))).collect();
    object["index_units"] = units.into();
    for (k, point) in along.points.iter().enumerate() {
        let named = along.indices.iter().zip(point).map(|(i, v)| (i.name.to_owned(), json!(v)));
        object["points"][k]["indices"] = named.collect::<Map<String, Value>>().into();
    }
}

/// One line per point.
pub(super) fn write_csv(report: &Report, along: &HandlingAlong, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    table.write_record(given.chain(["ending".to_owned()]).chain(along.indices.iter().map(|i| i.name.to_owned())))?;
    for (at, point) in report.points.iter().zip(&along.points) {
        let given = at.given.iter().map(|v| csv::cell(*v));
        table.write_record(given.chain([at.ending.name().to_owned()]).chain(point.iter().map(|v| csv::cell(*v))))?;
    }
    table.flush()
}

/// One line per point.
pub(super) fn write_table(report: &Report, along: &HandlingAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (fixed, mut columns) = table::prescribed_columns(report, &report.points, options);
    table::write_given(report, &fixed, options, out)?;
    for line in &along.about {
        writeln!(out, "{line}")?;
    }
    for (i, index) in along.indices.iter().enumerate() {
        let (unit, factor) = shown(index, options.angles);
        // the unit is that of the reader already
        columns.push(Column::new(index.title, &unit, along.points.iter().map(|p| p[i] * factor), Angles::Radians));
    }
    table::write_columns(&columns, &report.points, options, out)?;
    table::write_summary(report, &report.points, options, out)
}
