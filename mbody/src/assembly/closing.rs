//! Closing of loops while a system is assembled: start values, the closed pose, independent rows, and what to say about them.

use super::Kinds;
use crate::constraint::Constraint;
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::quantity::{Dimension, judge};
use crate::dynamics::{Closed, Closure};
use crate::model::{Model, ModelBuilder};
use problem::{Off, Unknown};
use serde_json::{Map, Value};

/// The kind and the parameters of an entry `name: { kind: { … } }`.
pub(super) fn entry(value: &Value) -> Option<(&str, &Value)> {
    value.as_object()?.iter().next().map(|(tag, parameters)| (tag.as_str(), parameters))
}

/// Lets the constraints that need no multiplier tie joints to each other.
pub(super) fn couple(constraints: &Map<String, Value>, kinds: &Kinds, builder: &mut ModelBuilder, findings: &mut Findings) {
    for (name, value) in constraints {
        let Some((tag, parameters)) = entry(value) else { continue };
        let Some(kind) = kinds.constraint(tag) else { continue };
        if let Err(error) = (kind.couple)(parameters, builder) {
            findings.push(Finding::error("impossible_gear", error.to_string()).at_path(format!("constraints.{name}.{tag}")));
        }
    }
}

/// Coordinates stated under `start`: independent coordinate and value.
pub(super) fn start_coordinates(model: &Model, start: &Map<String, Value>, findings: &mut Findings) -> Vec<(usize, f64)> {
    let mut stated = Vec::new();
    for body in model.bodies().iter().skip(1) {
        for (k, c) in body.q.clone().zip(body.joint.coordinates()) {
            let name = format!("{}.{}", body.joint_name, c.name);
            let Some(value) = start.get(&name) else { continue };
            match model.layout().independent_q.iter().position(|&i| i == k) {
                Some(i) => stated.extend(value_of(&name, value, c.unit, findings).map(|x| (i, x))),
                None => {
                    let message = format!("`{name}` follows another joint, so it has no start value of its own");
                    findings.push(Finding::error("follower_start", message).at_path(format!("start.{name}")));
                }
            }
        }
    }
    stated
}

/// Writes the start values into the unknowns; names that are no unknown are findings.
pub(super) fn start_values(unknowns: &mut [Unknown], start: &Map<String, Value>, findings: &mut Findings) {
    for (name, value) in start {
        match unknowns.iter_mut().find(|u| u.signal.name == *name) {
            Some(unknown) => unknown.start = value_of(name, value, &unknown.signal.unit.clone(), findings),
            None => {
                let hint = suggestion(name, unknowns.iter().map(|u| u.signal.name.as_str()));
                let message = format!("`{name}` is no coordinate, velocity or state of this model");
                findings.push(Finding::error("unknown_signal", message).at_path(format!("start.{name}")).with_hint_from(hint));
            }
        }
    }
}

fn value_of(name: &str, value: &Value, unit: &str, findings: &mut Findings) -> Option<f64> {
    let path = format!("start.{name}");
    let dimension = Dimension::of_unit(if unit == "-" { "" } else { unit });
    let judged = match dimension {
        Some(dimension) => judge(value, dimension),
        None => value.as_f64().map(Ok),
    };
    match judged {
        Some(Ok(x)) => Some(x),
        Some(Err(error)) => {
            findings.push(Finding::error(error.code(), error.to_string()).at_path(path).with_hint_from(error.hint()));
            None
        }
        None => {
            findings.push(Finding::error("not_a_number", format!("`{name}` needs a number in {unit}")).at_path(path));
            None
        }
    }
}

/// Closes the loops from the stated coordinates and chooses the rows to hold.
///
/// Loops that stay open are errors, a singular position is a warning, redundant rows are a note. Paths are `constraints.<name>`.
pub(super) fn close(model: &Model, constraints: Vec<Constraint>, stated: &[(usize, f64)], findings: &mut Findings) -> Option<Closed> {
    let mut q: Vec<f64> = reference(model);
    for &(i, x) in stated {
        q[i] = x;
    }
    if constraints.is_empty() {
        return Some(Closed { constraints, held: Vec::new(), q: (!stated.is_empty()).then_some(q) });
    }
    let mut closure = Closure::new(model, &constraints);
    if let Err(off) = closure.close(&mut q, &model.layout().held_velocities(model, &stated.iter().map(|s| s.0).collect::<Vec<_>>())) {
        findings.push(open(&off, !stated.is_empty()));
        return None;
    }
    let rows = closure.independent(&q);
    if rows.singular > 0 {
        let message =
            format!("the pose in which the loops close is singular: {} more motions are possible there than nearby", rows.singular);
        findings.push(
            Finding::warning("singular_position", message).at_path("constraints").with_hint("start from another pose, under `start`"),
        );
    }
    for (c, constraint) in constraints.iter().enumerate() {
        let of_this: Vec<&str> = rows.redundant.iter().filter(|r| r.0 == c).map(|&(_, r)| constraint.rows()[r].error.as_ref()).collect();
        if !of_this.is_empty() {
            let what = if of_this.len() == constraint.rows().len() {
                "all of it follows".to_owned()
            } else {
                format!("{} follow", of_this.join(", "))
            };
            let message = format!("redundant: {what} from the tree and the other constraints; these reactions count as zero");
            findings.push(Finding::note("redundant_constraint", message).at_path(format!("constraints.{}", constraint.name())));
        }
    }
    Some(Closed { held: rows.held, q: Some(q), constraints })
}

/// Coordinates with every joint at its reference.
pub(super) fn reference(model: &Model) -> Vec<f64> {
    let tree: Vec<f64> = model.bodies().iter().skip(1).flat_map(|b| b.joint.reference().iter().copied()).collect();
    model.layout().independent_q.iter().map(|&k| tree[k]).collect()
}

fn open(off: &[Off], held: bool) -> Finding {
    let Some(worst) = off.first() else { return Finding::error("open_loop", "the loops do not close") };
    let by = match worst.unit.as_str() {
        "m" => format!("{:.4} mm", worst.by.abs() * 1e3),
        "rad" => format!("{:.4} deg", worst.by.abs().to_degrees()),
        unit => format!("{:.4e} {unit}", worst.by.abs()),
    };
    let (row, name) = worst.row.split_once(" of ").unwrap_or((&worst.row, ""));
    let hint = match held {
        true => "check the lengths; values under `start` are held while loops close: leave one out",
        false => "check the lengths, or state under `start` near which pose the loop closes",
    };
    Finding::error("open_loop", format!("the loop `{name}` does not close: the {row} stays {by}"))
        .at_path(format!("constraints.{name}"))
        .with_hint(hint)
}
