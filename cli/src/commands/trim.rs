//! `trim`: steady state by inverse dynamics.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments};
use crate::output::{Angles, Beside, Report, Variant};
use crate::plan::TrimArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::{Context, Exit, Failure, model, results, steady};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;
use problem::Signal;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "trim", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// The same analysis for a variant: another description, or `PATH=VALUE` as in --set (repeatable)
    #[arg(long, value_name = "FILE|PATH=VALUE")]
    versus: Vec<String>,
    /// Signals in the table of a sweep (repeatable); the figure shows them too
    #[arg(long, value_name = "SIGNAL")]
    show: Vec<String>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Steady state: static, straight, cornering, braking or accelerating, top speed").after_help(
        "Examples:\n  fastbike trim gsxr1000 --speed 30 --lean 35deg\n  fastbike trim gsxr1000 --speed 108km/h --lateral-acceleration -5\n  \
         fastbike trim ref11 --speed 10..60:5 --lean 20deg --plot lean.svg\n  \
         fastbike trim gsxr1000 --speed 40 --acceleration -6 --front-brake-share 0.8",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    if arguments.output.plot.is_some() && request.swept() == 0 {
        let finding = Finding::error("no_sweep", "the figure of a single point would be empty");
        return Err(finding.with_hint("sweep something, for example `--speed 10..60:2`").into());
    }
    let loaded = model::load(&arguments.model, context)?;
    let shown = results::shown(&arguments.show, &loaded.assembled.system)?;
    let mut steady = steady::run(&request, &loaded.assembled.system, &arguments.trim.backend, "trim")?;
    steady
        .warnings
        .extend(loaded.findings.iter().filter(|f| f.severity != mbody::description::finding::Severity::Note).map(|f| f.to_string()));
    let mut report = results::report("trim", &loaded.name, shown, steady);
    for variant in &arguments.versus {
        let variant = versus(variant, &arguments, &report.signals, context)?;
        report.variants.push(variant);
    }
    results::deliver(context, (&arguments.model, &arguments.output), report, figure)
}

/// The same analysis for a variant.
fn versus(variant: &str, arguments: &Arguments, signals: &[Signal], context: &Context) -> Result<Variant, Failure> {
    let loaded = model::load(&arguments.model.variant(variant), context)?;
    let steady = steady::run(&arguments.trim.request()?, &loaded.assembled.system, &arguments.trim.backend, variant)?;
    let points = results::in_order_of(signals, steady);
    Ok(Variant { name: variant.to_owned(), points, beside: Beside::Nothing })
}

/// Lines over the quantity that is swept, one panel per shown signal.
fn figure(report: &Report) -> Result<Figure, Failure> {
    let given = &report.given;
    let varies = |k: usize| report.points.windows(2).any(|w| w[0].given[k] != w[1].given[k]);
    let swept: Vec<usize> = (0..given.len()).filter(|&k| varies(k)).collect();
    let Some(&x) = swept.first() else {
        return Err(Finding::error("no_sweep", "all points of the sweep are the same").into());
    };
    let defaults = ["steer.torque", "steer.angle", "chassis.roll", "front_tire.normal_force", "rear_tire.normal_force"];
    let shown: Vec<usize> = match report.shown.is_empty() {
        true => defaults.iter().filter_map(|n| report.signal(n)).collect(),
        false => report.shown.clone(),
    };
    // angles are drawn in degrees
    let across = Angles::Degrees.show(&given[x].unit);
    let panels = shown.iter().map(|&s| {
        let signal = &report.signals[s];
        let upward = Angles::Degrees.show(&signal.unit);
        let mut curves: Vec<Curve> = Vec::new();
        let base = report.points.iter().map(|p| (if report.variants.is_empty() { "" } else { "base" }, p));
        let variants = report.variants.iter().flat_map(|v| v.points.iter().map(move |p| (v.name.as_str(), p)));
        for (variant, point) in base.chain(variants) {
            // variants and a second swept quantity name the curves
            let labels = swept[1..].iter().map(|&k| label(&given[k].name, &given[k].unit, point.given[k]));
            let name: Vec<String> = labels.chain((!variant.is_empty()).then(|| variant.to_owned())).collect();
            let name = name.join(", ");
            let at = (point.given[x] * across.factor, point.value(s) * upward.factor);
            match curves.iter_mut().find(|c| c.name == name) {
                Some(curve) => curve.points.push(at),
                None => curves.push(Curve { name, points: vec![at], markers: Markers::WhenFew, variant: 0 }),
            }
        }
        LinePanel { y: Axis::new(signal.name.clone(), upward.unit), curves }
    });
    Ok(Figure::Lines(Lines {
        title: format!("Steady states of {}", report.model),
        x: Axis::new(given[x].name.replace('_', " "), across.unit),
        panels: panels.collect(),
        bands: Vec::new(),
        variants: Vec::new(),
    }))
}

fn label(name: &str, unit: &str, value: f64) -> String {
    let shown = Angles::Degrees.show(unit);
    let rounded = (value * shown.factor * 1e6).round() / 1e6;
    format!("{} {rounded} {}", name.replace('_', " "), shown.unit)
}
