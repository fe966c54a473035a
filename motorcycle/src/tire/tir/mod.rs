//! Tire property files (`.tir`): coefficients of the Magic Formula with their dialect, units and side.
//!
//! Everything that is wrong is said at once, with its line; unknown keys are kept and told. The dialect follows from `PROPERTY_FILE_FORMAT`, else from the
//! keys that only motorcycle tires have, else from `FITTYP`, else from the keys of 6.x. Angles of the ranges, lengths, forces and pressures are in the units of the
//! file; coefficients that the file leaves out are 0, scale factors 1.

mod check;
mod scan;
mod units;
mod without_effect;

#[cfg(test)]
mod tests;

pub use scan::{Entry, Scanned, Table, Value};
pub use units::Units;

use super::magic_formula::{Coefficients, DIALECTS, Dialect, FileAxes, KEYS, Key};
use check::Reading;
use mbody::description::finding::{Finding, Findings, suggestion};
use units::place;
use without_effect::without_effect;

/// The side that a tire was measured for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TireSide {
    /// Left.
    #[default]
    Left,
    /// Right.
    Right,
    /// Both.
    Symmetric,
}

/// A tire property file that was read.
#[derive(Clone, Debug)]
pub struct PropertyFile {
    /// Name of the file.
    pub name: String,
    /// Its dialect.
    pub dialect: &'static Dialect,
    /// Coefficients, in SI.
    pub coefficients: Coefficients,
    /// The side that the tire was measured for.
    pub side: TireSide,
    /// Everything the file says, the unknown and the unused too.
    pub scanned: Scanned,
}

/// Reads a property file; what is wrong or suspicious is added to the findings.
///
/// # Errors
/// `None` where there are errors among the findings.
pub fn read(name: &str, text: &str, axes: FileAxes, findings: &mut Findings) -> Option<PropertyFile> {
    let mut own = Findings::new();
    let file = read_all(name, text, axes, &mut own);
    let broken = own.has_errors();
    findings.extend(own.sorted());
    file.filter(|_| !broken)
}

fn read_all(name: &str, text: &str, axes: FileAxes, findings: &mut Findings) -> Option<PropertyFile> {
    let scanned = scan::scan(name, text, findings);
    if scanned.entries.is_empty() {
        let finding = Finding::error("no_tire", "the file has no entries `KEY = value`").in_file(name);
        findings.push(finding.with_hint("a tire property file has sections such as `[MODEL]` and `[LATERAL_COEFFICIENTS]`"));
        return None;
    }
    let units = Units::of(name, text, &scanned, findings);
    let mut reading = Reading { name, text, scanned: &scanned, findings };
    let dialect = dialect(&mut reading);
    let side = side(&mut reading);
    let dialect = dialect?;
    reading.unknown(dialect);
    let coefficients = coefficients(&mut reading, dialect, &units);
    reading.plausible(&coefficients, dialect, axes);
    Some(PropertyFile { name: name.to_owned(), dialect, coefficients, side, scanned })
}

impl Reading<'_> {
    /// The last entry of a key outside `[UNITS]`.
    fn entry(&self, key: &str) -> Option<&Entry> {
        self.scanned.entries.iter().rev().find(|e| e.key == key && e.section != "UNITS")
    }

    fn word(&self, key: &str) -> Option<String> {
        match &self.entry(key)?.value {
            Value::Text(word) => Some(word.to_uppercase().replace(['-', ' '], "_")),
            Value::Number(_) => None,
        }
    }

    /// Keys that nobody knows, keys said twice, and keys of other dialects.
    fn unknown(&mut self, dialect: &Dialect) {
        let mut of_others: Vec<&Entry> = Vec::new();
        let mut met: Vec<&str> = Vec::new();
        for entry in self.scanned.entries.iter().filter(|e| e.section != "UNITS") {
            if met.contains(&entry.key.as_str()) {
                let finding = Finding::warning("repeated_key", format!("key `{}` is here again; the last one holds", entry.key));
                self.findings.push(place(finding, self.name, self.text, entry));
            }
            met.push(&entry.key);
            match KEYS.iter().find(|k| k.name == entry.key) {
                Some(key) if key.used & dialect.bit == 0 && !is_neutral(key, &entry.value) => of_others.push(entry),
                Some(_) => {}
                None if without_effect(&entry.key) => {}
                // headings of the maker carry names and dates
                None if matches!(entry.value, Value::Text(_)) => {}
                None => {
                    let known = KEYS.iter().filter(|k| k.used & dialect.bit != 0).map(|k| k.name);
                    let finding = Finding::warning("unknown_key", format!("unknown key `{}`; it has no effect", entry.key));
                    self.findings.push(place(finding, self.name, self.text, entry).with_hint_from(suggestion(&entry.key, known)));
                }
            }
        }
        let turning = |e: &&Entry| e.section.starts_with("TURNSLIP") && e.value != Value::Number(0.0);
        if let Some(first) = self.scanned.entries.iter().find(turning) {
            let finding = Finding::note("turn_slip", "turn slip has no effect: forces are those of a straight path at every instant");
            self.findings.push(place(finding, self.name, self.text, first));
        }
        if let [first, ..] = of_others[..] {
            let names: Vec<String> = of_others.iter().map(|e| format!("`{}`", e.key)).collect();
            let message = format!("{} {} no effect in {}", names.join(", "), if names.len() == 1 { "has" } else { "have" }, dialect.name);
            self.findings.push(place(Finding::warning("other_dialect", message), self.name, self.text, first));
        }
    }
}

/// Whether a value says nothing.
fn is_neutral(key: &Key, value: &Value) -> bool {
    matches!(value, Value::Number(x) if *x == 0.0 || *x == key.otherwise)
}

fn dialect(reading: &mut Reading<'_>) -> Option<&'static Dialect> {
    let of_key = |key: &str, used: u8| KEYS.iter().any(|k| k.name == key && k.used & used != 0);
    if let Some(format) = reading.word("PROPERTY_FILE_FORMAT")
        && let Some(found) = DIALECTS.iter().find(|d| d.formats.contains(&format.as_str()))
    {
        return Some(found);
    }
    let motorcycle = DIALECTS.iter().find(|d| of_key("PCY2", d.bit));
    if let (Some(found), Some(_)) = (motorcycle, reading.entry("PCY2")) {
        return Some(found);
    }
    if let Some(entry) = reading.entry("FITTYP").cloned() {
        let found = match entry.value {
            Value::Number(number) => DIALECTS.iter().find(|d| d.fit_types.contains(&number)),
            Value::Text(_) => None,
        };
        if found.is_none() {
            let known: Vec<String> = DIALECTS
                .iter()
                .filter(|d| !d.fit_types.is_empty())
                .map(|d| format!("{} ({})", d.fit_types.iter().map(f64::to_string).collect::<Vec<_>>().join(", "), d.name))
                .collect();
            let shown = match &entry.value {
                Value::Number(number) => number.to_string(),
                Value::Text(word) => word.clone(),
            };
            let finding = Finding::error("unknown_dialect", format!("unknown `FITTYP` {shown}: which Magic Formula is meant?"));
            let hint = format!("known are {}; motorcycle tires have `PROPERTY_FILE_FORMAT = 'PAC_MC'`", known.join(", "));
            reading.find(place(finding, reading.name, reading.text, &entry).with_hint(hint));
        }
        return found;
    }
    if let Some(entry) = reading.entry("PROPERTY_FILE_FORMAT").cloned()
        && !matches!(reading.word("PROPERTY_FILE_FORMAT").as_deref(), Some("USER" | "MF_TIRE" | ""))
    {
        let known = DIALECTS.iter().flat_map(|d| d.formats.iter().copied());
        let word = reading.word("PROPERTY_FILE_FORMAT").unwrap_or_default();
        let finding = Finding::error("unknown_dialect", format!("unknown `PROPERTY_FILE_FORMAT` `{word}`: which Magic Formula is meant?"));
        reading.find(place(finding, reading.name, reading.text, &entry).with_hint_from(suggestion(&word, known)));
        return None;
    }
    // 6.1 and 5.2 by the keys that only one of them has
    let newer = reading.entry("PKY4").is_some() || reading.entry("PKY6").is_some();
    DIALECTS.iter().find(|d| of_key("PKY6", d.bit) == newer && !of_key("PCY2", d.bit))
}

fn side(reading: &mut Reading<'_>) -> TireSide {
    match reading.word("TYRESIDE").as_deref() {
        None | Some("LEFT" | "UNKNOWN" | "") => TireSide::Left,
        Some("RIGHT") => TireSide::Right,
        Some("SYMMETRIC") => TireSide::Symmetric,
        Some(other) => {
            let entry = reading.entry("TYRESIDE").cloned();
            let finding =
                Finding::error("unknown_value", format!("unknown `TYRESIDE` `{other}`, expected one of `LEFT`, `RIGHT`, `SYMMETRIC`"));
            if let Some(entry) = entry {
                reading.find(place(finding, reading.name, reading.text, &entry));
            }
            TireSide::Left
        }
    }
}

/// All coefficients, in SI; missing ones that the dialect needs are errors.
fn coefficients(reading: &mut Reading<'_>, dialect: &Dialect, units: &Units) -> Coefficients {
    Coefficients::from_keys(|key| {
        if key.used & dialect.bit == 0 {
            return key.otherwise;
        }
        match reading.entry(key.name).cloned() {
            Some(Entry { value: Value::Number(number), .. }) => number * units.factor(key.measure),
            Some(entry) => {
                let finding = Finding::error("wrong_type", format!("`{}` is a text, expected a number: {}", key.name, key.about));
                reading.find(place(finding, reading.name, reading.text, &entry));
                key.otherwise
            }
            None if key.needed & dialect.bit != 0 => {
                reading.missing(key, dialect);
                key.otherwise
            }
            None => key.otherwise,
        }
    })
}
