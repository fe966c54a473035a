//! What of a property file cannot be, or is not likely to be meant.

use super::scan::{Entry, Scanned, Value};
use super::units::place;
use crate::tire::magic_formula::{Coefficients, Dialect, FileAxes, Key};
use mbody::description::finding::{Finding, Findings};

/// A file that is being read.
pub(super) struct Reading<'a> {
    pub name: &'a str,
    pub text: &'a str,
    pub scanned: &'a Scanned,
    pub findings: &'a mut Findings,
}

/// Values outside of these are probably in other units: name, least, largest, unit.
const LIKELY: [(&str, f64, f64, &str); 4] = [
    ("UNLOADED_RADIUS", 0.03, 2.0, "m"),
    ("FNOMIN", 20.0, 2e5, "N"),
    ("VERTICAL_STIFFNESS", 5e3, 1e7, "N/m"),
    ("LONGVL", 0.1, 120.0, "m/s"),
];

impl Reading<'_> {
    pub fn find(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// A finding at the entry of a key, or about the file where there is none.
    fn at(&mut self, key: &str, finding: Finding) {
        let entry: Option<&Entry> = self.scanned.entries.iter().rev().find(|e| e.key == key && e.section != "UNITS");
        let finding = match entry {
            Some(entry) => place(finding, self.name, self.text, entry),
            None => finding.in_file(self.name).at_path(key),
        };
        self.findings.push(finding);
    }

    /// A key that the dialect cannot do without; at its section where that is there.
    pub fn missing(&mut self, key: &Key, dialect: &Dialect) {
        let message = format!("missing key `{}` in section `[{}]`: {}", key.name, key.section, key.about);
        let section = self.scanned.sections.iter().find(|(section, _)| section == key.section);
        let mut finding = Finding::error("missing_key", message).in_file(self.name).at_path(format!("{}.{}", key.section, key.name));
        match section {
            Some((_, line)) => finding = finding.at_line(self.text, *line, 1),
            None => finding = finding.with_hint(format!("the whole section is missing; {} needs it", dialect.name)),
        }
        self.findings.push(finding);
    }

    /// Signs, ranges, magnitudes.
    pub fn plausible(&mut self, c: &Coefficients, dialect: &Dialect, axes: FileAxes) {
        let present =
            |reading: &Self, key: &str| reading.scanned.entries.iter().any(|e| e.key == key && matches!(e.value, Value::Number(_)));
        let positive = [
            ("UNLOADED_RADIUS", c.UNLOADED_RADIUS),
            ("FNOMIN", c.FNOMIN),
            ("PCX1", c.PCX1),
            ("PDX1", c.PDX1),
            ("PKX1", c.PKX1),
            ("PCY1", c.PCY1),
            ("PDY1", c.PDY1),
            ("LONGVL", c.LONGVL),
            ("LFZO", c.LFZO),
            ("LCX", c.LCX),
            ("LMUX", c.LMUX),
            ("LKX", c.LKX),
            ("LCY", c.LCY),
            ("LMUY", c.LMUY),
            ("LKY", c.LKY),
            ("LCC", c.LCC),
        ];
        for (key, value) in positive {
            if value <= 0.0 && present(self, key) {
                self.at(key, Finding::error("out_of_range", format!("`{key}` is {value}, but must be greater than 0")));
            }
        }
        for (key, value) in [("VERTICAL_STIFFNESS", c.VERTICAL_STIFFNESS), ("VERTICAL_DAMPING", c.VERTICAL_DAMPING), ("VXLOW", c.VXLOW)] {
            if value < 0.0 {
                self.at(key, Finding::error("out_of_range", format!("`{key}` is {value}, but must not be negative")));
            }
        }
        for (low, high, [from, to]) in [
            ("KPUMIN", "KPUMAX", [c.KPUMIN, c.KPUMAX]),
            ("ALPMIN", "ALPMAX", [c.ALPMIN, c.ALPMAX]),
            ("CAMMIN", "CAMMAX", [c.CAMMIN, c.CAMMAX]),
            ("FZMIN", "FZMAX", [c.FZMIN, c.FZMAX]),
        ] {
            if from >= to {
                self.at(high, Finding::error("out_of_range", format!("`{high}` ({to}) must be greater than `{low}` ({from})")));
            }
        }
        self.cornering(c, dialect, axes);
        let values = [c.UNLOADED_RADIUS, c.FNOMIN, c.VERTICAL_STIFFNESS, c.LONGVL];
        for ((key, least, largest, unit), value) in LIKELY.into_iter().zip(values) {
            if value > 0.0 && !(least..=largest).contains(&value) && present(self, key) {
                let finding = Finding::warning("suspicious_unit", format!("`{key}` is {value} {unit}, which no tire of a vehicle has"));
                self.at(key, finding.with_hint("do the units in `[UNITS]` fit?"));
            }
        }
    }

    /// The sign of the cornering stiffness tells the axes of the file.
    fn cornering(&mut self, c: &Coefficients, dialect: &Dialect, axes: FileAxes) {
        if !self.scanned.entries.iter().any(|e| e.key == "PKY1") || c.PKY2 == 0.0 {
            return;
        }
        let (shape, load) = if dialect.needs("PCY2") { (c.PKY2, c.PKY3) } else { (c.PKY4, c.PKY2) };
        let stiffness = c.PKY1 * (shape * (1.0 / load).atan()).sin();
        let (wrong, hint) = match axes {
            FileAxes::IsoW => (
                stiffness >= 0.0,
                "in ISO axes it is negative; a file in the adapted SAE axes of the book is told by `law: { tir: { file: …, axes: adapted_sae } }`",
            ),
            FileAxes::AdaptedSae => (stiffness <= 0.0, "in the adapted SAE axes it is positive; leave out `axes: adapted_sae`"),
        };
        if wrong {
            let kind = if stiffness == 0.0 {
                "zero"
            } else if stiffness > 0.0 {
                "positive"
            } else {
                "negative"
            };
            let message = format!("the cornering stiffness at nominal load is {kind}: `PKY1` is {}", c.PKY1);
            self.at("PKY1", Finding::error("cornering_sign", message).with_hint(hint));
        }
    }
}
