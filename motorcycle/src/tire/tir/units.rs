//! Units of a property file: what `[UNITS]` says.
//!
//! Coefficients of the formulas have no dimension, or are per radian whatever the unit of angles; only radii, loads, stiffnesses, dampings, speeds,
//! pressures and the ranges are in the units of the file.

use super::scan::{Entry, Scanned, Value};
use crate::tire::magic_formula::{Measure, PRESSURE};
use mbody::description::finding::{Finding, Findings, suggestion};

const LENGTHS: &[(&str, f64)] = &[
    ("meter", 1.0),
    ("m", 1.0),
    ("mm", 1e-3),
    ("millimeter", 1e-3),
    ("cm", 1e-2),
    ("centimeter", 1e-2),
    ("km", 1e3),
    ("inch", 0.0254),
    ("in", 0.0254),
    ("foot", 0.3048),
    ("ft", 0.3048),
];
const FORCES: &[(&str, f64)] = &[
    ("newton", 1.0),
    ("n", 1.0),
    ("kilonewton", 1e3),
    ("knewton", 1e3),
    ("kn", 1e3),
    ("pound_force", 4.448_221_615_260_5),
    ("lbf", 4.448_221_615_260_5),
    ("kilogram_force", 9.806_65),
    ("kgf", 9.806_65),
];
const ANGLES: &[(&str, f64)] = &[
    ("radian", 1.0),
    ("radians", 1.0),
    ("rad", 1.0),
    ("degree", std::f64::consts::PI / 180.0),
    ("degrees", std::f64::consts::PI / 180.0),
    ("deg", std::f64::consts::PI / 180.0),
];
const TIMES: &[(&str, f64)] = &[
    ("second", 1.0),
    ("sec", 1.0),
    ("s", 1.0),
    ("millisecond", 1e-3),
    ("ms", 1e-3),
    ("minute", 60.0),
    ("min", 60.0),
    ("hour", 3600.0),
    ("h", 3600.0),
];
const MASSES: &[(&str, f64)] = &[
    ("kg", 1.0),
    ("kilogram", 1.0),
    ("gram", 1e-3),
    ("g", 1e-3),
    ("pound_mass", 0.453_592_37),
    ("lbm", 0.453_592_37),
    ("slug", 14.593_903),
    ("tonne", 1e3),
];
const PRESSURES: &[(&str, f64)] =
    &[("pascal", 1.0), ("pa", 1.0), ("kpa", 1e3), ("kilopascal", 1e3), ("bar", 1e5), ("psi", 6_894.757_293_168), ("mpa", 1e6)];

/// Factors from the units of a file to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    length: f64,
    force: f64,
    angle: f64,
    time: f64,
    /// Where it has a unit of its own.
    pressure: Option<f64>,
}

impl Units {
    /// What the section says; SI for what it leaves out.
    pub fn of(name: &str, text: &str, scanned: &Scanned, findings: &mut Findings) -> Self {
        let mut units = Self { length: 1.0, force: 1.0, angle: 1.0, time: 1.0, pressure: None };
        if !scanned.sections.iter().any(|(section, _)| section == "UNITS") {
            let finding =
                Finding::warning("missing_section", "section `[UNITS]` is missing; meters, newtons, radians and seconds are taken");
            findings.push(finding.in_file(name));
        }
        for entry in scanned.entries.iter().filter(|e| e.section == "UNITS") {
            let (known, unit): (&[(&str, f64)], &mut f64) = match entry.key.as_str() {
                "LENGTH" => (LENGTHS, &mut units.length),
                "FORCE" => (FORCES, &mut units.force),
                "ANGLE" => (ANGLES, &mut units.angle),
                "TIME" => (TIMES, &mut units.time),
                "PRESSURE" => (PRESSURES, units.pressure.insert(1.0)),
                // no mass has an effect here
                "MASS" => (MASSES, &mut 1.0),
                other => {
                    let hint = suggestion(other, ["LENGTH", "FORCE", "ANGLE", "MASS", "TIME", "PRESSURE"]);
                    let finding = Finding::warning("unknown_key", format!("unknown quantity `{other}` in `[UNITS]`"));
                    findings.push(place(finding, name, text, entry).with_hint_from(hint));
                    continue;
                }
            };
            let written = match &entry.value {
                Value::Text(word) => word.to_lowercase(),
                Value::Number(number) => number.to_string(),
            };
            match known.iter().find(|(word, _)| *word == written) {
                Some((_, factor)) => *unit = *factor,
                None => {
                    let finding = Finding::error("unknown_unit", format!("unknown unit `{written}` for `{}`", entry.key));
                    findings
                        .push(place(finding, name, text, entry).with_hint_from(suggestion(&written, known.iter().map(|(word, _)| *word))));
                }
            }
        }
        units
    }

    /// Factor of a value of this measure.
    pub fn factor(&self, measure: Measure) -> f64 {
        if let (PRESSURE, Some(pressure)) = (measure, self.pressure) {
            return pressure;
        }
        let [length, force, angle, time] = measure;
        self.length.powi(length) * self.force.powi(force) * self.angle.powi(angle) * self.time.powi(time)
    }
}

/// A finding at the value of an entry.
pub fn place(finding: Finding, name: &str, text: &str, entry: &Entry) -> Finding {
    let path = if entry.section.is_empty() { entry.key.clone() } else { format!("{}.{}", entry.section, entry.key) };
    finding.in_file(name).at_path(path).at_line(text, entry.line, entry.column)
}
