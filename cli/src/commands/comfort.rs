//! `comfort`: weighted acceleration of a point on a rough road, over speed.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, unknown_name};
use crate::figures::quantity;
use crate::model::Loaded;
use crate::output::comfort::{Class, ComfortAlong};
use crate::output::{Beside, Report, Variant};
use crate::plan::{Request, TrimArguments};
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::responses::{Excited, Job, Road, names_of_variants};
use crate::small_motions::{FROZEN, SmallMotions, accelerates};
use crate::steady::Steady;
use crate::{Context, Exit, Failure, model, results, steady};
use analyses::comfort::{Direction, comfort};
use analyses::weighting::{WD, WK};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::{Finding, Severity};
use mbody::dynamics::System;
use motorcycle::road::{CLASSES, RoadClass, Roughness};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "comfort", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Class of the road (ISO 8608): A (very good) to E (very poor); several: `A,C`, `A..E`
    #[arg(long, value_name = "CLASS", default_value = "A")]
    road_class: String,
    /// Point that is judged: an element of the kind `point_sensor`
    #[arg(long, value_name = "ELEMENT", default_value = "saddle")]
    point: String,
    /// The same analysis for a variant: another description, or `PATH=VALUE` as in --set (repeatable)
    #[arg(long, value_name = "FILE|PATH=VALUE")]
    versus: Vec<String>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Weighted acceleration of the saddle on a rough road (ISO 8608, ISO 2631-1), over speed").after_help(
        "Both wheels follow one track, the rear one later. Accelerations count with Wk (vertical) and Wd (horizontal) from 0.5 to 80 Hz, in axes of the\n\
         body; the sum is that of their squares. Models of rigid bodies say little above 20 Hz: the share of the squared sum from there is told.\n\
         JSON holds an `index` too: the sum over the root of the density of the road at 0.1 1/m.\n\n\
         Example:\n  fastbike comfort gsxr1000 --road-class A..C --speed 5..60:1 --plot comfort.svg",
    )
}

/// Directions of a seat: the components of the acceleration and how they count. Source: ISO 2631-1 (1997), 7.2.
const DIRECTIONS: [(&str, Direction); 3] = [
    ("acceleration_x", Direction { weighting: WD, factor: 1.0 }),
    ("acceleration_y", Direction { weighting: WD, factor: 1.0 }),
    ("acceleration_z", Direction { weighting: WK, factor: 1.0 }),
];

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    if request.speed.is_none() {
        let finding = Finding::error("missing_speed", "a road passes under the wheels at a speed");
        return Err(finding.with_hint("add `--speed`, for example `--speed 5..60:1`").into());
    }
    let classes = classes(&arguments.road_class)?;
    let loaded = model::load(&arguments.model, context)?;
    let (steady, along) = shaken(&arguments, (&request, &classes), &loaded, "steady states")?;
    let mut report = results::report("comfort", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Comfort(along);
    for variant in &arguments.versus {
        let loaded = model::load(&arguments.model.variant(variant), context)?;
        let (steady, along) = shaken(&arguments, (&request, &classes), &loaded, variant)?;
        let points = results::in_order_of(&report.signals, steady);
        report.variants.push(Variant { name: variant.clone(), points, beside: Beside::Comfort(along) });
    }
    results::deliver(context, (&arguments.model, &arguments.output), report, figure)
}

/// Steady states of a model and how they are shaken. `what` names the job for the progress bar.
fn shaken(
    arguments: &Arguments,
    (request, classes): (&Request, &[Class]),
    loaded: &Loaded,
    what: &str,
) -> Result<(Steady, ComfortAlong), Failure> {
    let (system, backend) = (&loaded.assembled.system, arguments.trim.backend.as_str());
    let outputs = outputs(&arguments.point, system)?;
    let excited = Excited { inputs: Vec::new(), road: Some(Road::Both) };
    excited.check(system)?;
    let mut steady = steady::run(request, system, backend, what)?;
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    if accelerates(request.acceleration.as_ref()) {
        steady.warnings.push(FROZEN.to_owned());
    }
    let small = SmallMotions { request, system, backend, residual_tolerance: 1e-6 };
    let job = Job { steady: &steady, excited: &excited, outputs: &outputs };
    let directions = DIRECTIONS.map(|(_, direction)| direction);
    let unit = Roughness { level: 1.0, exponent: 2.0 };
    // the speed is the first of the prescribed quantities
    let (points, _) = job.each(&small, |mut response, point| {
        let speed = point.given[0];
        comfort(&mut response, &directions, &|frequency| unit.density_at_speed(frequency, speed))
    });
    let directions = outputs.iter().zip(DIRECTIONS).map(|(name, (_, d))| (name.clone(), d.weighting.name.to_owned()));
    let along = ComfortAlong { point: arguments.point.clone(), directions: directions.collect(), classes: classes.to_vec(), points };
    Ok((steady, along))
}

/// `A`, `A,C` or `A..E`.
fn classes(text: &str) -> Result<Vec<Class>, Failure> {
    let find = |name: &str| -> Result<usize, Failure> {
        let found = CLASSES.iter().position(|c| c.name.eq_ignore_ascii_case(name.trim()));
        found.ok_or_else(|| unknown_name("road-class", text, ("class of roads", name.trim()), CLASSES.iter().map(|c| c.name)).into())
    };
    let class = |k: usize| -> Class {
        let RoadClass { name, level, .. } = CLASSES[k];
        Class { name: name.to_owned(), level }
    };
    match text.split_once("..") {
        None => text.split(',').map(|name| find(name).map(class)).collect(),
        Some((first, last)) => {
            let (first, last) = (find(first)?, find(last)?);
            if first > last {
                let finding = argument("road-class", text, "bad_range", "the range has no classes");
                return Err(finding.with_hint("classes go from A (very good) to E (very poor)").into());
            }
            Ok((first..=last).map(class).collect())
        }
    }
}

/// Accelerations of a point.
fn outputs(point: &str, system: &System) -> Result<Vec<String>, Failure> {
    let sensors = || system.outputs().iter().filter_map(|s| s.name.strip_suffix(".acceleration_z"));
    if !sensors().any(|sensor| sensor == point) {
        let finding = unknown_name("point", point, ("point sensor", point), sensors());
        let listed: Vec<String> = sensors().map(|s| format!("`{s}`")).collect();
        let hint = match listed.is_empty() {
            true => "add an element of the kind `point_sensor` to the description".to_owned(),
            false => format!("points of this model: {}", listed.join(", ")),
        };
        return Err(finding.with_hint(hint).into());
    }
    Ok(DIRECTIONS.iter().map(|(component, _)| format!("{point}.{component}")).collect())
}

/// Weighted accelerations over speed: directions and sum on one class, the sum on several.
fn figure(report: &Report) -> Result<Figure, Failure> {
    let Beside::Comfort(along) = &report.beside else { return Err(Finding::error("no_sweep", "there is nothing to draw").into()) };
    let varies = |k: usize| report.points.windows(2).any(|w| w[0].given[k] != w[1].given[k]);
    if !varies(0) {
        let finding = Finding::error("no_sweep", "the figure of a single speed would be empty");
        return Err(finding.with_hint("sweep the speed, for example `--speed 5..60:1`").into());
    }
    let mut curves: Vec<Curve> = Vec::new();
    let mut add =
        |variant: usize, name: String, at: f64, value: f64| match curves.iter_mut().find(|c| c.name == name && c.variant == variant) {
            Some(curve) => curve.points.push((at, value)),
            None => curves.push(Curve { name, points: vec![(at, value)], markers: Markers::Never, variant }),
        };
    let others = report.variants.iter().filter_map(|v| match &v.beside {
        Beside::Comfort(along) => Some(along),
        _ => None,
    });
    let all: Vec<&ComfortAlong> = std::iter::once(along).chain(others).collect();
    let points =
        all.iter().enumerate().flat_map(|(v, along)| report.points.iter().enumerate().map(move |(k, point)| (v, *along, k, point)));
    for (variant, along, k, point) in points {
        let others: Vec<String> = (1..report.given.len())
            .filter(|&g| varies(g))
            .map(|g| quantity(&report.given[g].name, &report.given[g].unit, point.given[g]))
            .collect();
        let named = |what: &str| std::iter::once(what.to_owned()).chain(others.clone()).collect::<Vec<_>>().join(", ");
        for class in &along.classes {
            if let ([_], true) = (along.classes.as_slice(), others.is_empty()) {
                for (i, (name, weighting)) in along.directions.iter().enumerate() {
                    let component = name.rsplit_once('_').map_or(name.as_str(), |(_, component)| component);
                    add(variant, format!("{component}, {weighting}"), point.given[0], along.weighted(k, i, class));
                }
                add(variant, "sum".to_owned(), point.given[0], along.total(k, class));
            } else {
                add(variant, named(&format!("class {}", class.name)), point.given[0], along.total(k, class));
            }
        }
    }
    // a direction in which nothing moves is no curve
    curves.retain(|c| c.points.iter().any(|p| !p.1.is_finite() || p.1 > 1e-9));
    let road = match along.classes.as_slice() {
        [class] => format!("road class {}", class.name),
        _ => "sum over directions".to_owned(),
    };
    Ok(Figure::Lines(Lines {
        title: format!("Comfort of {} at the {}, {road}", report.model, along.point),
        x: Axis::new("speed", "m/s"),
        panels: vec![LinePanel { y: Axis::new("weighted acceleration", "m/s^2"), curves }],
        bands: Vec::new(),
        variants: names_of_variants(report),
    }))
}
