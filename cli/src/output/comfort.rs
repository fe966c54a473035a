//! Ride comfort: one line per point and class of road, JSON, CSV.

use super::palette::styled;
use super::report::{Beside, Report};
use super::table::{self, Column};
use super::{Options, csv, responses};
use analyses::Comfort;
use serde_json::{Value, json};
use std::io;

/// A class of roads.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Its letter.
    pub name: String,
    /// Spectral density at the reference, m³.
    pub level: f64,
}

/// Weighted accelerations at all points of a report.
#[derive(Clone, Debug, Default)]
pub struct ComfortAlong {
    /// The point of the vehicle.
    pub point: String,
    /// Names of the directions, with the names of their weightings.
    pub directions: Vec<(String, String)>,
    /// The classes of roads, rougher ones later.
    pub classes: Vec<Class>,
    /// For a density of 1 m³ at the reference: accelerations grow with its root. In the order of the report's points.
    pub points: Vec<Result<Comfort, String>>,
}

impl ComfortAlong {
    /// a_w of a direction on a class of roads, m/s²; NaN where there is none.
    pub fn weighted(&self, point: usize, direction: usize, class: &Class) -> f64 {
        self.points[point].as_ref().map_or(f64::NAN, |c| c.weighted[direction] * class.level.sqrt())
    }

    /// a_v on a class of roads, m/s²; NaN where there is none.
    pub fn total(&self, point: usize, class: &Class) -> f64 {
        self.points[point].as_ref().map_or(f64::NAN, |c| c.total * class.level.sqrt())
    }

    /// Share of a_v² from above the trusted frequency; NaN where there is none.
    pub fn share_above(&self, point: usize) -> f64 {
        self.points[point].as_ref().map_or(f64::NAN, |c| c.share_above)
    }
}

/// Adds the accelerations to the points of the object.
pub(super) fn add_json(along: &ComfortAlong, object: &mut Value) {
    object["point"] = json!(along.point);
    for (k, point) in along.points.iter().enumerate() {
        match point {
            Ok(comfort) => {
                let class = |class: &Class| {
                    let root = class.level.sqrt();
                    let directions = along.directions.iter().enumerate().map(|(i, (name, weighting))| {
                        json!({ "output": name, "weighting": weighting, "weighted": comfort.weighted[i] * root, "unweighted": comfort.unweighted[i] * root })
                    });
                    json!({
                        "road_class": class.name,
                        "level": class.level,
                        "total": comfort.total * root,
                        "share_above_20_hz": comfort.share_above,
                        "directions": directions.collect::<Vec<_>>(),
                    })
                };
                object["points"][k]["index"] = json!(comfort.total);
                object["points"][k]["comfort"] = along.classes.iter().map(class).collect::<Vec<_>>().into();
            }
            Err(because) => object["points"][k]["refused"] = json!(because),
        }
    }
}

/// One line per point and class.
pub(super) fn write_csv(report: &Report, along: &ComfortAlong, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    let directions = along.directions.iter().map(|(name, _)| format!("weighted.{name}"));
    let columns = ["ending", "road_class", "total", "share_above_20_hz", "index"].map(str::to_owned);
    table.write_record(given.chain(columns).chain(directions))?;
    for (k, at) in report.points.iter().enumerate() {
        let Ok(comfort) = &along.points[k] else { continue };
        for class in &along.classes {
            let given = at.given.iter().map(|v| csv::cell(*v));
            let words = [at.ending.name().to_owned(), class.name.clone()];
            let numbers = [along.total(k, class), comfort.share_above, comfort.total].map(csv::cell);
            let weighted = (0..along.directions.len()).map(|i| csv::cell(along.weighted(k, i, class)));
            table.write_record(given.chain(words).chain(numbers).chain(weighted))?;
        }
    }
    table.flush()
}

/// One line per point: every direction on the first class, the sum on every class.
pub(super) fn write_table(report: &Report, along: &ComfortAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    const UNIT: &str = "m/s^2";
    let points = || 0..report.points.len();
    let (fixed, mut columns) = table::prescribed_columns(report, &report.points, options);
    table::write_given(report, &fixed, options, out)?;
    writeln!(out, "weighted root mean squares at `{}`, 0.5 to 80 Hz (ISO 2631-1)", along.point)?;
    for class in &along.classes {
        for (i, (name, weighting)) in along.directions.iter().enumerate() {
            let quantity = name.rsplit_once('.').map_or(name.as_str(), |(_, quantity)| quantity);
            let title = format!("{quantity} {weighting}");
            if along.classes.len() == 1 {
                columns.push(Column::new(&title, UNIT, points().map(|k| along.weighted(k, i, class)), options.angles));
            }
        }
        let title = format!("road {}: sum", class.name);
        columns.push(Column::new(&title, UNIT, points().map(|k| along.total(k, class)), options.angles));
    }
    columns.push(Column::new("above 20 Hz", "%", points().map(|k| 100.0 * along.share_above(k)), options.angles));
    table::write_columns(&columns, &report.points, options, out)?;
    table::write_summary(report, &report.points, options, out)?;
    for variant in &report.variants {
        let Beside::Comfort(other) = &variant.beside else { continue };
        writeln!(out, "\n{}", styled(options.palette.heading, &format!("versus {} (difference = variant - base)", variant.name)))?;
        let (_, mut columns) = table::prescribed_columns(report, &report.points, options);
        for class in &along.classes {
            let (before, after) = (|k: usize| along.total(k, class), |k: usize| other.total(k, class));
            columns.push(Column::new(&format!("road {}: sum", class.name), UNIT, points().map(after), options.angles));
            columns.push(Column::new("difference", UNIT, points().map(|k| after(k) - before(k)), options.angles));
        }
        table::write_columns(&columns, &report.points, options, out)?;
    }
    responses::refusals(along.points.iter().map(|p| p.as_ref().err()), report, options, out)
}
