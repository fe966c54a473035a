//! Answers of a vehicle in steady motion to what oscillates: inputs by name, and a road under both wheels.

use crate::arguments::{ModelArguments, argument, unknown_name};
use crate::base::base_name;
use crate::model::Loaded;
use crate::output::Point;
use crate::output::responses::{PointResponses, Responses};
use crate::output::{Beside, Report, Variant};
use crate::plan::Request;
use crate::small_motions::{FROZEN, SmallMotions, accelerates};
use crate::steady::Steady;
use crate::{Context, Failure, model, results, steady};
use analyses::{Excitation, FrequencyResponse, LinearModel};
use clap::ValueEnum;
use mbody::description::finding::{Finding, Severity};
use mbody::dynamics::{System, TreePlant};
use nalgebra::Complex;
use problem::Signal;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Real parts larger than this are those of unstable modes, 1/s.
const UNSTABLE: f64 = 1e-6;

/// Heights of the road under the wheels.
pub const ROADS: [&str; 2] = ["front_road.height", "rear_road.height"];

/// Under which wheels the road is uneven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Road {
    /// One track: the rear wheel meets what the front wheel has met, later by wheelbase over speed
    Both,
    /// Under the front wheel only
    Front,
    /// Under the rear wheel only
    Rear,
}

/// What oscillates.
#[derive(Clone, Debug, Default)]
pub struct Excited {
    /// Inputs by name.
    pub inputs: Vec<String>,
    /// The road.
    pub road: Option<Road>,
}

impl Excited {
    /// Whether the model has what is named.
    ///
    /// # Errors
    /// Names that are no inputs, with the nearest ones; a road without tires on it.
    pub fn check(&self, system: &System) -> Result<(), Failure> {
        let known = || system.inputs().iter().map(|i| i.signal.name.as_str());
        if let Some(unknown) = self.inputs.iter().find(|name| !known().any(|k| k == **name)) {
            return Err(unknown_name("input", unknown, ("input", unknown), known()).into());
        }
        let needed: &[&str] = match self.road {
            None => &[],
            Some(Road::Both) => &ROADS,
            Some(Road::Front) => &ROADS[..1],
            Some(Road::Rear) => &ROADS[1..],
        };
        match needed.iter().find(|name| !known().any(|k| k == **name)) {
            None => Ok(()),
            Some(missing) => {
                let finding = Finding::error("missing_input", format!("this model has no input `{missing}`, so no road moves its wheels"));
                Err(finding.with_hint("an element `tire` with `road: front_road` or `road: rear_road` has it").into())
            }
        }
    }

    /// The excitations at one steady state.
    ///
    /// # Errors
    /// Why the road does not reach the rear wheel after the front one, in a sentence.
    pub fn at(&self, point: &Point, steady: &Steady, base: Option<&str>) -> Result<Vec<Excitation>, String> {
        let mut excitations: Vec<Excitation> = self.inputs.iter().map(Excitation::input).collect();
        let [front, rear] = ROADS;
        match self.road {
            None => {}
            Some(Road::Front) => excitations.push(Excitation::input(front)),
            Some(Road::Rear) => excitations.push(Excitation::input(rear)),
            Some(Road::Both) => {
                let delay = delay(point, steady, base)?;
                excitations.push(Excitation::delayed("road", [(front.to_owned(), 0.0), (rear.to_owned(), delay)]));
            }
        }
        Ok(excitations)
    }
}

/// From the front contact point to the rear one, s.
fn delay(point: &Point, steady: &Steady, base: Option<&str>) -> Result<f64, String> {
    let value = |name: &str| steady.signals.iter().position(|s| s.name == name).map(|k| point.value(k));
    let speed = base.and_then(|base| value(&format!("{base}.forward_speed"))).unwrap_or(0.0);
    match value("wheelbase") {
        None => Err("this model has no signal `wheelbase`; an element of the kind `single_track` has it".to_owned()),
        Some(_) if speed <= 0.0 => Err("at rest a road does not pass from wheel to wheel; give `--speed`, or `--road front`".to_owned()),
        Some(wheelbase) => Ok(wheelbase / speed),
    }
}

/// Whether all signals are ones that can answer: unknowns and outputs, or `rate(…)` of them.
///
/// # Errors
/// Names that are none, with the nearest ones.
pub fn check_outputs(outputs: &[String], system: &System) -> Result<(), Failure> {
    let known = || system.unknowns().iter().map(|u| u.signal.name.as_str()).chain(system.outputs().iter().map(|s| s.name.as_str()));
    for output in outputs {
        let name = output.strip_prefix("rate(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(output);
        if system.inputs().iter().any(|i| i.signal.name == name) {
            let finding = argument("output", output, "wrong_role", format!("`{name}` is an input: it answers nothing"));
            return Err(finding.with_hint("`fastbike info MODEL` lists unknowns and outputs").into());
        }
        if !known().any(|k| k == name) {
            return Err(unknown_name("output", output, ("signal", name), known()).into());
        }
    }
    Ok(())
}

/// What is computed at every steady state.
pub struct Job<'a> {
    /// The steady states.
    pub steady: &'a Steady,
    /// What oscillates.
    pub excited: &'a Excited,
    /// What answers.
    pub outputs: &'a [String],
}

impl Job<'_> {
    /// Calls `use_it` with the responses at every point, in parallel. How many of the points are unstable comes second.
    pub fn each<T: Send>(
        &self,
        small: &SmallMotions<'_>,
        use_it: impl Fn(FrequencyResponse, &Point) -> T + Sync,
    ) -> (Vec<Result<T, String>>, usize) {
        let base = base_name(&TreePlant::new(small.system.clone()));
        let linear = small.linear_models(self.steady).points;
        let found: Vec<(Result<T, String>, bool)> = (self.steady.points.par_iter().zip(linear))
            .map(|(point, model)| match model {
                Ok(model) => {
                    let response = self.response(&model, point, base.as_deref());
                    (response.map(|response| use_it(response, point)), unstable(&model))
                }
                Err(because) => (Err(because), false),
            })
            .collect();
        let count = found.iter().filter(|(_, unstable)| *unstable).count();
        (found.into_iter().map(|(result, _)| result).collect(), count)
    }

    fn response(&self, model: &LinearModel, point: &Point, base: Option<&str>) -> Result<FrequencyResponse, String> {
        let excitations = self.excited.at(point, self.steady, base)?;
        FrequencyResponse::of(model, &excitations, self.outputs).map_err(|e| e.to_string())
    }

    /// Responses at the frequencies (Hz) of every point.
    pub fn responses(&self, small: &SmallMotions<'_>, frequencies: &(dyn Fn(&Point) -> Vec<f64> + Sync)) -> (Responses, usize) {
        let (found, unstable) = self.each(small, |mut response, point| {
            let frequencies = frequencies(point);
            let mut now = vec![Complex::new(0.0, 0.0); response.inputs.len() * response.outputs.len()];
            let mut values = vec![Vec::with_capacity(frequencies.len()); now.len()];
            for frequency in &frequencies {
                response.at(TAU * frequency, &mut now);
                values.iter_mut().zip(&now).for_each(|(list, value)| list.push(*value));
            }
            (response.inputs, response.outputs, PointResponses { frequencies, values })
        });
        let signals: Option<(Vec<Signal>, Vec<Signal>)> = found.iter().flatten().next().map(|(i, o, _)| (i.clone(), o.clone()));
        let (inputs, outputs) = signals.unwrap_or_default();
        (Responses { inputs, outputs, points: found.into_iter().map(|point| point.map(|(_, _, p)| p)).collect() }, unstable)
    }
}

fn unstable(model: &LinearModel) -> bool {
    analyses::eigen(model).is_ok_and(|spectrum| spectrum.values.iter().any(|s| s.re > UNSTABLE))
}

/// What a reader of responses at unstable points has to know.
pub fn forced(unstable: usize, points: usize) -> Option<String> {
    let which = match (unstable, points) {
        (1, 1) => "the steady state is".to_owned(),
        (1, _) => format!("1 of {points} steady states is"),
        (_, _) => format!("{unstable} of {points} steady states are"),
    };
    let motion = "the response there is the motion that whoever stabilizes it has to sustain";
    (unstable > 0).then(|| format!("{which} unstable: {motion}"))
}

/// What is asked of a model and of its variants.
#[derive(Clone, Copy, Debug)]
pub struct Answers<'a> {
    /// The steady states.
    pub request: &'a Request,
    /// Backend of the steady states.
    pub backend: &'a str,
    /// What oscillates.
    pub excited: &'a Excited,
    /// What answers.
    pub outputs: &'a [String],
}

/// Frequencies at a point, Hz.
type Frequencies<'a> = &'a (dyn Fn(&Point) -> Vec<f64> + Sync);

impl Answers<'_> {
    /// Steady states of a model and their responses. `what` names the job for the progress bar.
    ///
    /// # Errors
    /// The request as a whole is impossible.
    pub fn of(&self, loaded: &Loaded, what: &str, frequencies: Frequencies<'_>) -> Result<(Steady, Responses), Failure> {
        let system = &loaded.assembled.system;
        let mut steady = steady::run(self.request, system, self.backend, what)?;
        steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
        if accelerates(self.request.acceleration.as_ref()) {
            steady.warnings.push(FROZEN.to_owned());
        }
        let small = SmallMotions { request: self.request, system, backend: self.backend, residual_tolerance: 1e-6 };
        let job = Job { steady: &steady, excited: self.excited, outputs: self.outputs };
        let (responses, unstable) = job.responses(&small, &|point: &Point| frequencies(point));
        steady.warnings.extend(forced(unstable, steady.points.len()));
        Ok((steady, responses))
    }

    /// Adds the same of variants of the model to a report.
    ///
    /// # Errors
    /// A variant that cannot be read, or that lacks an input or a signal.
    pub fn versus(
        &self,
        report: &mut Report,
        (model, variants): (&ModelArguments, &[String]),
        context: &Context,
        frequencies: Frequencies<'_>,
    ) -> Result<(), Failure> {
        for variant in variants {
            let loaded = model::load(&model.variant(variant), context)?;
            self.excited.check(&loaded.assembled.system)?;
            check_outputs(self.outputs, &loaded.assembled.system)?;
            let (steady, responses) = self.of(&loaded, variant, frequencies)?;
            let points = results::in_order_of(&report.signals, steady);
            report.variants.push(Variant { name: variant.clone(), points, beside: Beside::Responses(responses) });
        }
        Ok(())
    }
}

/// The responses of the base, then those of the variants.
pub fn with_variants<'a>(report: &'a Report, base: &'a Responses) -> Vec<&'a Responses> {
    let others = report.variants.iter().filter_map(|v| match &v.beside {
        Beside::Responses(responses) => Some(responses),
        _ => None,
    });
    std::iter::once(base).chain(others).collect()
}

/// Names of base and variants for the legend of a figure; none where there is only the base.
pub fn names_of_variants(report: &Report) -> Vec<String> {
    match report.variants.is_empty() {
        true => Vec::new(),
        false => std::iter::once("base".to_owned()).chain(report.variants.iter().map(|v| v.name.clone())).collect(),
    }
}
