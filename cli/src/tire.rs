//! A tire by itself: where its law comes from, and its curves.

use crate::arguments::{ModelArguments, argument, unknown_name};
use crate::library;
use crate::model::overrides;
use crate::output::tire::{Along, Sample, TireCurve};
use crate::{Context, Failure, model};
use mbody::description::Library;
use mbody::description::document::Document;
use mbody::description::finding::{Finding, Findings};
use motorcycle::tire::law_description::{AxesDescription, TirDescription, TirUse, read_file};
use motorcycle::tire::{AnyTireLaw, LawDescription, NamedLaw, Place, Slip, StatedTire, TireDescription, TireLaw};
use std::f64::consts::TAU;

/// Points of a curve.
const POINTS: u32 = 81;
/// Directions of an envelope.
const DIRECTIONS: u32 = 180;
/// Slips to either side among which its forces are looked for.
const GRID: i32 = 60;

/// A tire that was found.
pub struct Found {
    /// Model or file.
    pub model: String,
    /// The tire of the model; empty for a file.
    pub tire: String,
    /// The law.
    pub stated: StatedTire,
    /// What was said about it.
    pub findings: Findings,
}

/// The tire of a model, of a property file or of a bundled file.
///
/// # Errors
/// There is none, or it is wrong.
pub fn find(arguments: &ModelArguments, tire: Option<&str>, axes: AxesDescription, context: &Context) -> Result<Found, Failure> {
    if let Some(source) = library::tire(&arguments.model)? {
        if let Some(tire) = tire {
            return Err(argument("tire", tire, "wrong_role", "a file holds one tire; `--tire` chooses among those of a model").into());
        }
        let mut findings = Findings::new();
        let named = of_file(&source, axes, &mut findings);
        return match named {
            Some(named) => Ok(Found {
                model: source.name,
                tire: String::new(),
                stated: StatedTire { named, lateral_stiffness: None },
                findings: findings.sorted(),
            }),
            None => Err(Failure::Findings(findings.sorted())),
        };
    }
    of_model(arguments, tire, context)
}

/// The law of a file: a property file as it was measured, or one of our own form.
fn of_file(source: &library::Source, axes: AxesDescription, findings: &mut Findings) -> Option<NamedLaw> {
    let place = Place { mounted: None, crowned: false, pressure: None };
    let description = match source.file.to_lowercase().ends_with(".tir") {
        true => LawDescription::Tir(TirDescription::Use(TirUse { axes, ..TirUse::plain(&source.file) })),
        false => {
            let text = source.text(&source.file)?;
            read_file(&source.file, &text).map_err(|wrong| findings.extend(wrong)).ok()?
        }
    };
    description.law(&place, source, findings)
}

/// The tire of a model.
fn of_model(arguments: &ModelArguments, tire: Option<&str>, context: &Context) -> Result<Found, Failure> {
    let loaded = model::load(arguments, context)?;
    let source = &loaded.source;
    let none = || Failure::from(Finding::error("no_tire", format!("model `{}` has no element of the kind `tire`", loaded.name)));
    let text = source.text(&source.file).ok_or_else(none)?;
    if source.is_urdf() {
        return Err(none());
    }
    let mut document = Document::parse(&source.file, &text)?;
    for (path, value) in overrides(&arguments.set)? {
        // what belongs to the tree has been changed there
        let _ = document.set(&path, &value);
    }
    let elements = document.value().get("elements").and_then(|e| e.as_object()).ok_or_else(none)?;
    let tires: Vec<(&str, &serde_json::Value)> =
        elements.iter().filter_map(|(name, kind)| Some((name.as_str(), kind.get("tire")?))).collect();
    let chosen = match tire {
        None => tires.first(),
        Some(name) => match tires.iter().find(|(known, _)| *known == name) {
            Some(found) => Some(found),
            None => return Err(unknown_name("tire", name, ("tire", name), tires.iter().map(|(known, _)| *known)).into()),
        },
    };
    let (name, value) = *chosen.ok_or_else(none)?;
    let mut findings = Findings::new();
    match TireDescription::stated(value, source, &mut findings) {
        Some(stated) => Ok(Found { model: loaded.name.clone(), tire: name.to_owned(), stated, findings: loaded.findings }),
        None => Err(Failure::Findings(findings)),
    }
}

/// What the curves span.
pub struct Span {
    /// Loads, N.
    pub loads: Vec<f64>,
    /// Cambers of the curves along slip, rad.
    pub cambers: Vec<f64>,
    /// Largest longitudinal slip.
    pub slip: f64,
    /// Largest slip angle, rad.
    pub slip_angle: f64,
    /// Largest camber of the curves along camber, rad.
    pub camber: f64,
    /// Speed, m/s.
    pub speed: f64,
}

/// All curves of a law.
pub fn curves(law: &AnyTireLaw, span: &Span) -> Vec<TireCurve> {
    let mut curves = Vec::new();
    let sample = |load: f64, [longitudinal_slip, slip_angle, camber]: [f64; 3]| {
        let slip = Slip { load, lateral: slip_angle.tan(), longitudinal: longitudinal_slip, camber, speed: span.speed };
        Sample { longitudinal_slip, slip_angle, camber, friction: law.friction(&slip) }
    };
    let steps = |largest: f64| (0..POINTS).map(move |k| largest * (2.0 * f64::from(k) / f64::from(POINTS - 1) - 1.0));
    for &load in &span.loads {
        for &camber in &span.cambers {
            let along = |along, samples| TireCurve { along, load, camber, samples };
            curves.push(along(Along::LongitudinalSlip, steps(span.slip).map(|s| sample(load, [s, 0.0, camber])).collect()));
            curves.push(along(Along::SlipAngle, steps(span.slip_angle).map(|a| sample(load, [0.0, a, camber])).collect()));
            curves.push(along(Along::Envelope, envelope(span, &|[slip, angle]| sample(load, [slip, angle, camber]))));
        }
        let samples = steps(span.camber).map(|g| sample(load, [0.0, 0.0, g])).collect();
        curves.push(TireCurve { along: Along::Camber, load, camber: 0.0, samples });
    }
    curves
}

/// The greatest force in every direction, among slips within their spans: the convex hull of all forces.
fn envelope(span: &Span, sample: &dyn Fn([f64; 2]) -> Sample) -> Vec<Sample> {
    // closer together where the forces grow
    let steps = |largest: f64| (-GRID..=GRID).map(move |k| f64::from(k) / f64::from(GRID)).map(move |q| largest * q * q.abs());
    let all: Vec<Sample> = steps(span.slip).flat_map(|slip| steps(span.slip_angle).map(move |angle| [slip, angle])).map(sample).collect();
    let greatest = |direction: f64| {
        let (sin, cos) = direction.sin_cos();
        let along = |s: &Sample| s.friction.longitudinal * cos + s.friction.lateral * sin;
        all.iter().max_by(|a, b| along(a).total_cmp(&along(b))).copied()
    };
    (0..=DIRECTIONS).filter_map(|k| greatest(TAU * f64::from(k) / f64::from(DIRECTIONS))).collect()
}
