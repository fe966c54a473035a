//! Named quantities: parameters, from which other entries follow by formulas, and adjustables, which a setup may change within their range.
//!
//! An entry that begins with `=` is a formula ([`super::expression`]) over the names under `parameters:` and `adjustables:`; formulas of
//! parameters may refer to other parameters. An adjustable with a `path` is the entry there: it takes its value from it and stands in for it.

use super::document::{About, Document};
use super::expression::{Expression, ExpressionError, Value as Known, formula, reserved, together};
use super::finding::{Finding, Findings, nearest};
use super::quantity::dimension::{Dimension, Exponents, describe};
use super::quantity::parse::parse;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::HashMap;

/// A number with any unit, or a formula.
#[derive(Clone, Debug, Deserialize)]
#[serde(transparent)]
pub struct AnyQuantity(pub Value);

impl JsonSchema for AnyQuantity {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Quantity of any dimension".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"] })
    }
}

/// A named quantity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterDescription {
    /// Its value: a number with its unit, or a formula of other parameters (`= 0.5 * spring_rate + 2 kN/m`).
    pub value: AnyQuantity,
    /// A sentence: what it is and where the number comes from.
    pub about: Option<String>,
}

/// What is changed on the finished machine: a setup file holds values of adjustables only.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AdjustableDescription {
    /// A sentence: what is turned, and what the number counts.
    pub about: String,
    /// Smallest and largest value, with the unit.
    pub range: [AnyQuantity; 2],
    /// Value of the model; may be left out where `path` names an entry, whose value it is then.
    pub value: Option<AnyQuantity>,
    /// Distance of the values that can be set, counted from the smallest: 1 for clicks.
    pub step: Option<AnyQuantity>,
    /// Entry that has this value: `rear_shock.spring.preload`. Without it, formulas use the name.
    pub path: Option<String>,
}

/// A parameter or adjustable of a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What it is.
    pub about: String,
    /// Value in SI and what it measures.
    pub value: Known,
    /// JSON pointer to the value.
    pub pointer: String,
    /// Whether the value is a formula.
    pub derived: bool,
    /// Smallest and largest value, SI, of an adjustable.
    pub range: Option<(f64, f64)>,
    /// Whether its values lie on steps.
    pub stepped: bool,
}

impl Parameter {
    /// What it measures, where that has a name.
    pub fn dimension(&self) -> Option<&'static Dimension> {
        Dimension::of_exponents(self.value.exponents)
    }

    /// Another value, SI, as it is written in a description.
    pub fn written(&self, si: f64) -> Value {
        written(si, self.value.exponents)
    }
}

/// A value as it is written in a description.
fn written(si: f64, exponents: Exponents) -> Value {
    match exponents == Exponents::default() {
        true if si.fract() == 0.0 && si.abs() < 9e15 => (si as i64).into(),
        true => si.into(),
        false => format!("{si:?} {exponents}").into(),
    }
}

/// Parameters that need each other one after the other at most.
const DEEPEST: usize = 128;

const SECTIONS: [&str; 2] = ["parameters", "adjustables"];

fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// Puts adjustables with a `path` in the place of the entries that they stand for: done once, before anything is overridden.
pub fn link(document: &mut Document, findings: &mut Findings) {
    let of = |value: &Value| value.get("path").and_then(Value::as_str).map(str::to_owned);
    let section = document.value().get("adjustables").and_then(Value::as_object);
    let linked: Vec<(String, String, bool)> =
        section.into_iter().flatten().filter_map(|(name, v)| Some((name.clone(), of(v)?, v.get("value").is_some()))).collect();
    for (name, path, own) in linked {
        let pointer = document.pointer_of(&path).filter(|p| document.value().pointer(p).is_some_and(|v| v.is_number() || v.is_string()));
        let at = format!("adjustables.{name}.path");
        let Some(pointer) = pointer.filter(|p| !SECTIONS.iter().any(|s| p.starts_with(&format!("/{s}/")))) else {
            let known = document.paths();
            let hint = nearest(&path, known.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
            findings.push(document.finding(&at, "unknown_path", format!("there is no number `{path}`")).with_hint_from(hint));
            continue;
        };
        if !own {
            document.copy(&pointer, &format!("/adjustables/{}/value", escaped(&name)));
        }
        document.put(&pointer, format!("= {name}"));
    }
}

/// Changes a parameter or adjustable to what a text from outside says; false where there is none of this name.
///
/// A bare number has the unit of the value that was there.
///
/// # Errors
/// The value measures something else.
pub fn set(document: &mut Document, name: &str, text: &str) -> Result<bool, Findings> {
    let pointer = SECTIONS.iter().map(|s| format!("/{s}/{}/value", escaped(name))).find(|p| document.value().pointer(p).is_some());
    let Some(pointer) = pointer else { return Ok(false) };
    let read = |value: &Value| match value {
        Value::String(text) if formula(text).is_none() => parse(text).ok(),
        Value::Number(n) => Some(super::quantity::parse::Parsed { value: n.as_f64()?, unit: None }),
        _ => None,
    };
    let (old, new) = (document.value().pointer(&pointer).and_then(read), read(&Value::String(text.to_owned())));
    let mut said = text.to_owned();
    if let (Some(old), Some(new)) = (old, new) {
        let was = old.unit.unwrap_or_default();
        match new.unit {
            None if was != Exponents::default() => said = format!("{:?} {was}", new.value),
            Some(is) if together(was, is).is_none() => {
                let message = format!("`{text}` is {}, but `{name}` is {}", describe(is), describe(was));
                return Err(Finding::error("wrong_dimension", message).in_file(format!("{name}={text}")).into());
            }
            _ => {}
        }
    }
    let path = pointer.trim_start_matches('/').replace('/', ".").replace("~1", "/").replace("~0", "~");
    document.set_as(&path, &said, format!("{name}={text}")).map(|()| true)
}

/// Replaces all formulas by their values; gives the parameters that have one.
///
/// `formulas` are the places of formulas outside of the two sections and what they are to measure ([`super::schema::Schema::formulas`]).
pub fn evaluate(document: &mut Document, formulas: &[(String, Option<&'static Dimension>)], findings: &mut Findings) -> Vec<Parameter> {
    let mut solver = Solver::of(document, findings);
    let names: Vec<String> = solver.written.iter().map(|w| w.name.clone()).collect();
    for k in 0..names.len() {
        solver.solve(k, &mut Vec::new(), findings);
    }
    let all: Vec<&str> = names.iter().map(String::as_str).collect();
    let known: HashMap<&str, Option<Known>> = all.iter().copied().zip(solver.values.iter().map(|v| v.unwrap_or(None))).collect();
    let parameters = solver.parameters();
    for (pointer, wanted) in formulas.iter().filter(|(p, _)| !SECTIONS.iter().any(|s| p.starts_with(&format!("/{s}/")))) {
        let Some(text) = document.value().pointer(pointer).and_then(Value::as_str).and_then(formula).map(str::to_owned) else { continue };
        match value_of(&text, &known, &all, *wanted) {
            Ok(Some(value)) => {
                let exponents = if wanted.is_some() { Exponents::default() } else { value.exponents };
                document.put(pointer, written(value.si, exponents));
            }
            // what is wrong with a parameter was said there
            Ok(None) => {}
            Err(finding) => findings.push(document.located(*finding, pointer, About::Value)),
        }
    }
    parameters
}

/// Value of a formula; `None` where a parameter in it has none.
fn value_of(
    text: &str,
    known: &HashMap<&str, Option<Known>>,
    all: &[&str],
    wanted: Option<&'static Dimension>,
) -> Result<Option<Known>, Box<Finding>> {
    let told = |e: ExpressionError| Box::new(Finding::error(e.code(), e.to_string()).with_hint_from(e.hint()));
    let expression = Expression::parse(text).map_err(told)?;
    if expression.names().iter().any(|n| known.get(n).is_some_and(Option::is_none)) {
        return Ok(None);
    }
    let value = expression.value(&|name| known.get(name).copied().flatten(), all).map_err(told)?;
    match wanted.filter(|w| !w.accepts(value.exponents) && together(w.exponents, value.exponents).is_none()) {
        Some(wanted) => {
            let message = format!("`{text}` is {}, expected {wanted}", describe(value.exponents));
            let plain = value.exponents == Exponents::default();
            let hint = plain.then(|| "give the numbers and parameters in it their units".to_owned());
            Err(Box::new(Finding::error("wrong_dimension", message).with_hint_from(hint)))
        }
        None => Ok(Some(value)),
    }
}

/// Holds every adjustable to its range and its steps.
pub fn check_ranges(document: &Document, parameters: &[Parameter], findings: &mut Findings) {
    for parameter in parameters.iter().filter(|p| p.pointer.starts_with("/adjustables/")) {
        let around = parameter.pointer.trim_end_matches("/value");
        let entry = |key: &str| document.value().pointer(&format!("{around}/{key}"));
        let Some([low, high]) = entry("range").and_then(Value::as_array).map(Vec::as_slice) else { continue };
        let (Some(least), Some(most)) = (end(low), end(high)) else {
            let finding = Finding::error("bad_number", "the range is not two numbers with their units");
            findings.push(document.located(finding, &format!("{around}/range"), About::Value));
            continue;
        };
        let value = document.value().pointer(&parameter.pointer).map_or_else(String::new, shown);
        let si = parameter.value.si;
        if least.si > most.si {
            let message = format!("the range from `{}` to `{}` is empty", shown(low), shown(high));
            findings.push(document.located(Finding::error("bad_range", message), &format!("{around}/range"), About::Value));
        } else if !(least.si..=most.si).contains(&si) {
            let message = format!("`{value}` is out of range: `{}` goes from {} to {}", parameter.name, shown(low), shown(high));
            let finding = Finding::error("out_of_range", message).with_hint_from(Some(parameter.about.clone()).filter(|a| !a.is_empty()));
            findings.push(document.located(finding, &parameter.pointer, About::Value));
        } else if let Some((text, step)) = entry("step").and_then(|s| Some((shown(s), end(s)?.si))).filter(|(_, s)| *s > 0.0) {
            let steps = (si - least.si) / step;
            if (steps - steps.round()).abs() > 1e-6 {
                let message = format!("`{value}` lies between two steps: `{}` goes from {} in steps of {text}", parameter.name, shown(low));
                findings.push(document.located(Finding::error("between_steps", message), &parameter.pointer, About::Value));
            }
        }
    }
}

/// A value as it was typed.
fn shown(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A number with its unit.
fn end(value: &Value) -> Option<Known> {
    match value {
        Value::Number(n) => Some(Known { si: n.as_f64()?, exponents: Exponents::default() }),
        Value::String(text) => parse(text).ok().map(|p| Known { si: p.value, exponents: p.unit.unwrap_or_default() }),
        _ => None,
    }
}

/// A parameter as it is written.
struct Written {
    name: String,
    about: String,
    pointer: String,
    value: Value,
    range: Option<(f64, f64)>,
    stepped: bool,
}

/// Values of parameters in the order in which they need each other.
struct Solver<'a> {
    document: &'a Document,
    written: Vec<Written>,
    /// `None` while unknown; then the value, or nothing where something is wrong.
    values: Vec<Option<Option<Known>>>,
}

impl<'a> Solver<'a> {
    fn of(document: &'a Document, findings: &mut Findings) -> Self {
        let mut written: Vec<Written> = Vec::new();
        for section in SECTIONS {
            for (name, entry) in document.value().get(section).and_then(Value::as_object).into_iter().flatten() {
                let path = format!("{section}.{name}");
                let mut refuse = |code, message: String| findings.push(document.finding(&path, code, message));
                if let Some(why) = reserved(name) {
                    refuse("bad_name", format!("`{name}` cannot be the name of a parameter: it is {why}"));
                    continue;
                }
                if written.iter().any(|w| w.name == *name) {
                    refuse("duplicate_name", format!("`{name}` is a parameter and an adjustable"));
                    continue;
                }
                let clash = ["elements", "constraints"].iter().find(|s| document.value().get(s).and_then(|v| v.get(name)).is_some());
                if let Some(other) = clash {
                    refuse("duplicate_name", format!("`{name}` is a parameter and one of the {other}"));
                }
                let Some(value) = entry.get("value") else { continue };
                let ends = entry.get("range").and_then(Value::as_array).map(Vec::as_slice);
                let range = if let Some([low, high]) = ends { end(low).zip(end(high)).map(|(a, b)| (a.si, b.si)) } else { None };
                written.push(Written {
                    name: name.clone(),
                    about: entry.get("about").and_then(Value::as_str).unwrap_or_default().to_owned(),
                    pointer: format!("/{section}/{}/value", escaped(name)),
                    value: value.clone(),
                    range,
                    stepped: entry.get("step").is_some(),
                });
            }
        }
        let values = vec![None; written.len()];
        Self { document, written, values }
    }

    fn solve(&mut self, k: usize, open: &mut Vec<usize>, findings: &mut Findings) {
        if self.values[k].is_some() {
            return;
        }
        let found = |this: &Self, finding: Finding| this.document.located(finding, &this.written[k].pointer, About::Value);
        if let Some(start) = open.iter().position(|o| *o == k) {
            let ring: Vec<&str> = open[start..].iter().chain([&k]).map(|o| self.written[*o].name.as_str()).collect();
            let message = format!("parameters follow from each other in a ring: {}", ring.join(" → "));
            findings.push(found(self, Finding::error("circular_parameter", message)));
            self.values[k] = Some(None);
            return;
        }
        if open.len() > DEEPEST {
            let message = format!("parameters follow from each other more than {DEEPEST} deep");
            findings.push(found(self, Finding::error("circular_parameter", message)));
            self.values[k] = Some(None);
            return;
        }
        let value = match self.written[k].value.clone() {
            Value::String(text) => match formula(&text) {
                Some(formula) => self.formula(k, formula, open, findings),
                None => parse(&text)
                    .map(|p| Known { si: p.value, exponents: p.unit.unwrap_or_default() })
                    .map_err(|e| Box::new(Finding::error(e.code(), e.to_string()).with_hint_from(e.hint())))
                    .map(Some),
            },
            // anything else than a number is for the schema to tell
            other => Ok(end(&other)),
        };
        let value = value.and_then(|value| self.in_its_unit(k, value)).unwrap_or_else(|finding| {
            findings.push(found(self, *finding));
            None
        });
        // part of a ring: that has been told
        self.values[k].get_or_insert(value);
    }

    /// The value of an adjustable measures what its range does.
    fn in_its_unit(&self, k: usize, value: Option<Known>) -> Result<Option<Known>, Box<Finding>> {
        let around = self.written[k].pointer.trim_end_matches("/value");
        let range = self.document.value().pointer(&format!("{around}/range")).and_then(Value::as_array).map(Vec::as_slice);
        let (Some(value), Some([low, high])) = (value, range) else { return Ok(value) };
        match [low, high].into_iter().filter_map(end).find(|e| together(e.exponents, value.exponents).is_none()) {
            None => Ok(Some(value)),
            Some(other) => {
                let (text, is, range) = (shown(&self.written[k].value), describe(value.exponents), describe(other.exponents));
                let message = format!("`{text}` is {is}, but the range from `{}` to `{}` is {range}", shown(low), shown(high));
                Err(Box::new(Finding::error("wrong_dimension", message)))
            }
        }
    }

    fn formula(&mut self, k: usize, text: &str, open: &mut Vec<usize>, findings: &mut Findings) -> Result<Option<Known>, Box<Finding>> {
        open.push(k);
        // a formula that cannot be read needs nothing
        let needed = Expression::parse(text).map(|e| e.names().into_iter().map(str::to_owned).collect::<Vec<_>>()).unwrap_or_default();
        for name in needed {
            if let Some(other) = self.written.iter().position(|w| w.name == name) {
                self.solve(other, open, findings);
            }
        }
        open.pop();
        let all: Vec<&str> = self.written.iter().map(|w| w.name.as_str()).collect();
        let known = all.iter().copied().zip(self.values.iter().map(|v| v.unwrap_or(None))).collect();
        value_of(text, &known, &all, None)
    }

    fn parameters(&self) -> Vec<Parameter> {
        let both = self.written.iter().zip(&self.values);
        let parameter = |(written, value): (&Written, &Option<Option<Known>>)| {
            Some(Parameter {
                name: written.name.clone(),
                about: written.about.clone(),
                value: value.unwrap_or(None)?,
                pointer: written.pointer.clone(),
                derived: written.value.as_str().is_some_and(|t| formula(t).is_some()),
                range: written.range,
                stepped: written.stepped,
            })
        };
        both.filter_map(parameter).collect()
    }
}
