//! Where a motion starts and which inputs act: a steady state, then what is given.

use crate::arguments::{argument, unknown_name};
use crate::output::Given;
use crate::{Failure, plan, steady};
use analyses::transient::{Drifting, Driven, Start};
use analyses::{Variable, Variables};
use mbody::description::finding::Finding;
use mbody::description::quantity::{Dimension, Dimensioned, dimension::Number, parse_quantity};
use mbody::dynamics::System;
use problem::{Ending, Plant};
use std::sync::Arc;

/// Solver of the steady state.
const BACKEND: &str = "kinsol";

/// A start and the inputs that act.
pub struct Beginning {
    /// All unknowns before anything is given.
    pub start: Start,
    /// Unknowns that are given.
    pub given: Vec<(usize, f64)>,
    /// Inputs over time.
    pub inputs: Driven,
    /// What was prescribed.
    pub told: Vec<(Given, f64)>,
}

impl Beginning {
    /// The stated start with inputs at their defaults.
    pub fn stated(plant: &dyn Plant) -> Self {
        let inputs = plant.inputs().iter().map(|i| i.default).collect();
        Self { start: Start::stated(plant), given: Vec::new(), inputs: Driven::new(inputs), told: Vec::new() }
    }

    /// A steady state with the inputs that it needs; nothing is held.
    ///
    /// # Errors
    /// There is none, or the request asks for several.
    pub fn steady(plant: &dyn Plant, request: &plan::Request, system: &Arc<System>) -> Result<Self, Failure> {
        if request.swept() > 0 {
            let finding = Finding::error("wrong_count", "a motion starts from one steady state, but several are asked for");
            return Err(finding.with_hint("give one value each, for example `--speed 30 --lean 20deg`").into());
        }
        let found = steady::run(request, system, BACKEND, "steady state")?;
        let [point] = &found.points[..] else {
            let message = format!("there are {} steady states to start from", found.points.len());
            return Err(Finding::error("wrong_count", message).with_hint("choose one by `--lean`").into());
        };
        if point.values.is_empty() || point.ending != Ending::Reached {
            return Err(Failure::Unreached(format!("there is no steady state to start from: {}", cause(&point.ending))));
        }
        let n = system.unknowns().len();
        // behind the unknowns of a steady state stand the multipliers that stabilize constraints, and the states of who rides
        let mut start = Start::stated(plant);
        start.held.fill(false);
        start.y[..n].copy_from_slice(&point.values[..n]);
        let value = |name: &str| system.inputs().iter().position(|i| i.signal.name == name).map_or(0.0, |k| point.values[n + k]);
        let mut inputs = Driven::new(plant.inputs().iter().map(|i| value(&i.signal.name)).collect());
        // what has a rate in the steady state goes on with it: the height of a road uphill
        for (k, input) in plant.inputs().iter().enumerate() {
            let rate = input.rate.map(|at| (at, value(&plant.inputs()[at].signal.name)));
            if let Some((at, rate)) = rate.filter(|(_, rate)| *rate != 0.0) {
                inputs.base_mut()[at] = 0.0;
                inputs.add(plant, k, Box::new(Drifting { rate }));
            }
        }
        Ok(Self { start, given: Vec::new(), inputs, told: found.given.into_iter().zip(point.given.clone()).collect() })
    }

    /// Takes `--given`: start values that are held, and constant inputs.
    ///
    /// # Errors
    /// A signal that is not there or follows from others, a value that cannot be read.
    pub fn give(&mut self, given: &[String], plant: &dyn Plant) -> Result<(), Failure> {
        let variables = Variables::of(plant);
        for text in given {
            let wrong = |code, why: String| argument("given", text, code, why);
            let Some((name, value)) = text.split_once('=').map(|(n, v)| (n.trim(), v.trim())) else {
                let finding = wrong("bad_argument", "this is not of the form SIGNAL=VALUE".to_owned());
                return Err(finding.with_hint("for example `--given chassis.forward_speed=20m/s`").into());
            };
            let Some(variable) = variables.find(name) else {
                return Err(unknown_name("given", text, ("signal", name), variables.names()).into());
            };
            let unit = variables.unit(variable);
            let value = quantity(value, &unit).map_err(|(code, why, hint)| Failure::from(wrong(code, why).with_hint_from(hint)))?;
            match variable {
                Variable::Unknown(i) if plant.unknowns()[i].differential => match self.given.iter().any(|(u, _)| *u == i) {
                    true => return Err(wrong("given_twice", format!("`{name}` is given twice")).into()),
                    false => self.given.push((i, value)),
                },
                Variable::Input(i) => self.inputs.base_mut()[i] = value,
                _ => {
                    let finding = wrong("wrong_role", format!("`{name}` follows from the others, so it has no start value"));
                    return Err(finding
                        .with_hint("coordinates, velocities, states and inputs can be given; see `fastbike info MODEL`")
                        .into());
                }
            }
            self.told.push((Given::new(name, unit), value));
        }
        Ok(())
    }
}

/// Why a steady state was not found.
fn cause(ending: &Ending) -> String {
    match ending {
        Ending::Limit { name, signal, value, threshold } => format!("{name}, `{signal}` is {value:.4}, the limit {threshold:.4}"),
        Ending::NotConverged { because } => because.clone(),
        Ending::Reached => "its equations do not hold".to_owned(),
    }
}

/// A value with an optional unit, in the unit of a signal.
pub fn quantity(text: &str, unit: &str) -> Result<f64, (&'static str, String, Option<String>)> {
    let unit = unit.replace("^2", "²").replace("^3", "³");
    let dimension = if unit == "-" { Some(Number::DIMENSION) } else { Dimension::of_unit(&unit) };
    match dimension {
        Some(dimension) => parse_quantity(text, dimension).map_err(|e| (e.code(), e.to_string(), e.hint())),
        // a unit without a name of its own: a bare number
        None => match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(("bad_number", format!("`{text}` is not a number"), Some(format!("write a bare number in {unit}")))),
        },
    }
}
