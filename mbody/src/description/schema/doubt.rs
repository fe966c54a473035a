//! Quantities that can be read but probably do not mean what they say.
//!
//! A field of a kind declares its usual values under the keyword [`PLAUSIBLE`], in SI: `[0.05, 1]`, or by the names of the entries below
//! it, `{ "stiffness": [500, 2e6] }`. A value outside gets a warning, with the unit that makes it usual where there is one.

use super::Mistake;
use super::message::dimension_of;
use super::walk::{Met, walk};
use crate::description::document::About;
use crate::description::finding::Finding;
use crate::description::quantity::{Dimension, parse_quantity, suspicion};
use serde_json::Value;

/// Schema keyword of usual values.
pub(super) const PLAUSIBLE: &str = "plausible";

/// Units that are meant where they are left out or mistaken, by the unit of the dimension.
const MEANT: &[(&str, &[&str])] = &[
    ("m", &["mm", "cm"]),
    ("kg", &["g"]),
    ("Pa", &["bar", "kPa"]),
    ("N/m", &["N/mm", "kN/m"]),
    ("N s/m", &["kN s/m", "N s/mm"]),
    ("N m/rad", &["kN m/rad", "N m/deg"]),
    ("rad/s", &["rpm"]),
    ("kg m²", &["kg cm²", "kg mm²", "g mm²"]),
    ("m²", &["cm²"]),
    ("N", &["kN"]),
];

/// Every doubt about a value, each once.
pub(super) fn doubts(root: &Value, value: &Value) -> Vec<Mistake> {
    let mut found: Vec<Mistake> = Vec::new();
    let add = |mistake: Mistake, found: &mut Vec<Mistake>| {
        if !found.iter().any(|m| m.pointer == mistake.pointer) {
            found.push(mistake);
        }
    };
    walk(root, value, &mut |met| {
        for mistake in unusual(met) {
            add(mistake, &mut found);
        }
        let doubt = dimension_of(met.schema).and_then(|dimension| suspicion(met.value, dimension));
        let Some(doubt) = doubt else { return true };
        add(Mistake::at(met.pointer, About::Value, Finding::warning("suspicious_unit", doubt)), &mut found);
        false
    });
    found
}

/// Values of an entry, or right below it, that lie outside of what is usual.
fn unusual(met: &Met<'_>) -> Vec<Mistake> {
    match met.plausible {
        Some(Value::Array(range)) => {
            let name = met.pointer.rsplit('/').next().unwrap_or_default();
            let dimension = dimension_of(met.schema);
            dimension
                .and_then(|d| judge(name, met.value, d, range))
                .map(|f| Mistake::at(met.pointer, About::Value, f))
                .into_iter()
                .collect()
        }
        Some(Value::Object(ranges)) => {
            let below = |(key, range): (&String, &Value)| {
                let dimension = dimension_of(met.schema.get("properties")?.get(key)?)?;
                let finding = judge(key, met.value.get(key)?, dimension, range.as_array()?)?;
                Some(Mistake::at(format!("{}/{key}", met.pointer), About::Value, finding))
            };
            ranges.iter().filter_map(below).collect()
        }
        _ => Vec::new(),
    }
}

fn judge(name: &str, value: &Value, dimension: &'static Dimension, range: &[Value]) -> Option<Finding> {
    let [low, high] = range else { return None };
    let (low, high) = (low.as_f64()?, high.as_f64()?);
    let (si, text) = match value {
        Value::Number(n) => (n.as_f64()?, n.to_string()),
        Value::String(text) => (parse_quantity(text, dimension).ok()?, text.trim().to_owned()),
        _ => return None,
    };
    // nothing at all is a choice, not a slip of units
    if si == 0.0 || (low..=high).contains(&si.abs()) {
        return None;
    }
    let number = text.trim_end_matches(|c: char| !c.is_ascii_digit()).split_whitespace().next().unwrap_or_default().to_owned();
    let number: String = number.chars().take_while(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E')).collect();
    let usual = |unit: &&&str| {
        let meant = parse_quantity(&format!("{number} {unit}"), dimension).ok();
        !text.ends_with(**unit) && meant.is_some_and(|m| (low..=high).contains(&m.abs()))
    };
    let shown = if dimension.unit == "1" { String::new() } else { format!(" {}", dimension.unit) };
    let given = if value.is_number() { format!("{text}{shown}") } else { text.clone() };
    let meant = MEANT.iter().find(|(unit, _)| *unit == dimension.unit).and_then(|(_, units)| units.iter().find(usual));
    let message = format!("`{given}` is unusual for `{name}`, {low} to {high}{shown} are usual");
    Some(match meant {
        Some(unit) => Finding::warning("suspicious_unit", message).with_hint(format!("did you mean `{number} {unit}`?")),
        None => Finding::warning("suspicious_value", message).with_hint("if it is meant so, all is well"),
    })
}
