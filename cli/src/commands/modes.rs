//! `modes`: modes at a steady state or along a sweep.

use super::{Kind, read};
use crate::animation::{self, Scene};
use crate::arguments::{ModelArguments, OutputArguments};
use crate::output::modes::{Branch, ModesAlong};
use crate::output::{Angles, Beside, Report};
use crate::plan::TrimArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Locus, Markers, RootLocus};
use crate::small_motions::{FROZEN, Shapes, SmallMotions, accelerates};
use crate::{Context, Exit, Failure, model, results, steady};
use clap::{ArgMatches, Args, Command, ValueEnum};
use mbody::description::finding::{Finding, Severity};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "modes", command, run };

/// What the figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Picture {
    /// Eigenvalues in the complex plane
    Locus,
    /// Frequencies and damping ratios of the oscillations over the swept quantity
    Frequencies,
}

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Tell the shapes of the modes: deviations of all unknowns, the largest state being 1 in its typical magnitude
    #[arg(long)]
    shapes: bool,
    /// Animation of all modes at all points to write: one .html file that opens in a browser without a network
    #[arg(long, value_name = "FILE.html")]
    animate: Option<PathBuf>,
    /// What --plot draws
    #[arg(long, value_name = "PICTURE", value_enum, default_value = "locus")]
    figure: Picture,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Modes at a steady state or along a sweep: frequency, damping, names, shapes").after_help(
        "Every mode is told, real ones too. Participation: the share of a signal in the mode, with its rate; all shares add up to 1.\n\
         Along a sweep names are carried from point to point, and changes of stability are searched between the points.\n\n\
         Examples:\n  fastbike modes gsxr1000 --speed 30\n  fastbike modes gsxr1000 --speed 5..80:1 --plot locus.svg\n  \
         fastbike modes ref11 --speed 10..60:1 --lateral-acceleration -5 --figure frequencies --plot frequencies.svg\n  \
         fastbike modes whipple --speed 1..10:0.25 --format csv\n  fastbike modes gsxr1000 --speed 10..60:10 --animate modes.html",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    arguments.animate.as_deref().map(animation::check).transpose()?;
    if arguments.output.plot.is_some() && request.swept() == 0 && arguments.figure == Picture::Frequencies {
        let finding = Finding::error("no_sweep", "the figure of a single point would be empty");
        return Err(finding.with_hint("sweep something, for example `--speed 10..60:2`").into());
    }
    let loaded = model::load(&arguments.model, context)?;
    let mut steady = steady::run(&request, &loaded.assembled.system, &arguments.trim.backend, "steady states")?;
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    if accelerates(request.acceleration.as_ref()) {
        steady.warnings.push(FROZEN.to_owned());
    }
    let (system, backend) = (&loaded.assembled.system, arguments.trim.backend.as_str());
    // trims converge to 1e-10; 1e-6 is what their eigenvalues are told to
    let small = SmallMotions { request: &request, system, backend, residual_tolerance: 1e-6 };
    let shapes = if arguments.shapes || arguments.animate.is_some() { Shapes::Shown } else { Shapes::LeftOut };
    let modes = small.along(&steady, shapes)?;
    let mut report = results::report("modes", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Modes(modes);
    let angles = arguments.output.angles();
    let page = arguments.animate.is_some().then(|| animation::page_of_modes(&Scene::of(&loaded.assembled), &report, angles));
    if let (Beside::Modes(modes), false) = (&mut report.beside, arguments.shapes) {
        modes.leave_out_shapes();
    }
    let exit = results::deliver(context, (&arguments.model, &arguments.output), report, |report| figure(report, arguments.figure));
    if let (Ok(_), Some(path), Some(page)) = (&exit, &arguments.animate, page) {
        animation::write(context, path, &page?)?;
    }
    exit
}

fn figure(report: &Report, picture: Picture) -> Result<Figure, Failure> {
    let Beside::Modes(modes) = &report.beside else { return Err(Finding::error("no_sweep", "there are no modes to draw").into()) };
    match picture {
        Picture::Locus => Ok(locus(report, modes)),
        Picture::Frequencies => frequencies(report, modes),
    }
}

/// `Modes of ref11, lean 20 deg`: what does not vary stands in the title.
fn title(report: &Report, modes: &ModesAlong) -> String {
    let mut title = format!("Modes of {}", report.model);
    for (k, given) in report.given.iter().enumerate() {
        let first = report.points.first().map_or(f64::NAN, |p| p.given[k]);
        if Some(k) != modes.along && report.points.iter().all(|p| p.given[k] == first) {
            title.push_str(&format!(", {}", quantity(&given.name, &given.unit, first)));
        }
    }
    title
}

/// `speed 30 m/s`.
fn quantity(name: &str, unit: &str, value: f64) -> String {
    let shown = Angles::Degrees.show(unit);
    let rounded = (value * shown.factor * 1e6).round() / 1e6;
    format!("{} {rounded} {}", name.replace('_', " "), shown.unit).trim_end().to_owned()
}

fn locus(report: &Report, modes: &ModesAlong) -> Figure {
    let at = |b: &Branch| b.values.iter().map(|z| (z.re, z.im)).collect::<Vec<_>>();
    let mut branches: Vec<Locus> = modes.branches.iter().map(|b| Locus { name: b.name.clone(), points: at(b), begins: b.begins }).collect();
    if branches.is_empty() {
        let points = modes.points.iter().flatten().flat_map(|p| &p.modes);
        branches.extend(points.map(|m| Locus { name: m.name.clone(), points: vec![(m.value.re, m.value.im)], begins: false }));
    }
    let first = modes.along.and_then(|k| {
        let values = modes.branches.iter().filter(|b| b.begins).filter_map(|b| b.swept.first());
        let value = values.copied().next()?;
        Some(quantity(&report.given[k].name, &report.given[k].unit, value))
    });
    Figure::RootLocus(RootLocus { title: title(report, modes), branches, first: first.unwrap_or_default() })
}

/// Whether a piece of a path oscillates beyond the point that it shares with the piece before.
fn oscillates(branch: &Branch) -> bool {
    branch.values.iter().skip(usize::from(!branch.begins && !branch.continues)).any(|z| z.im > 0.0)
}

/// Frequency and damping ratio of everything that oscillates.
fn frequencies(report: &Report, modes: &ModesAlong) -> Result<Figure, Failure> {
    let Some(given) = modes.along.map(|k| &report.given[k]) else {
        return Err(Finding::error("no_sweep", "all points of the sweep are the same").into());
    };
    let across = Angles::Degrees.show(&given.unit);
    let curves = |of: &dyn Fn(f64, f64) -> f64| {
        let mut curves: Vec<Curve> = Vec::new();
        for branch in modes.branches.iter().filter(|b| oscillates(b)) {
            let value = |z: &nalgebra::Complex<f64>| if z.im > 0.0 { of(z.re, z.im) } else { f64::NAN };
            // the first point of a later piece is the last one of the piece before
            let shared = usize::from(!branch.begins && !branch.continues);
            let points = branch.swept.iter().zip(&branch.values).skip(shared).map(|(v, z)| (v * across.factor, value(z)));
            match curves.iter_mut().find(|c| c.name == branch.name) {
                Some(curve) => {
                    curve.points.push((f64::NAN, f64::NAN));
                    curve.points.extend(points);
                }
                None => curves.push(Curve { name: branch.name.clone(), points: points.collect(), markers: Markers::Never }),
            }
        }
        curves
    };
    let panels = vec![
        LinePanel { y: Axis::new("Damped frequency", "Hz"), curves: curves(&|_, im| im / TAU) },
        LinePanel { y: Axis::new("Damping ratio", "-"), curves: curves(&|re, im| -re / re.hypot(im)) },
    ];
    let x = Axis::new(given.name.replace('_', " "), across.unit);
    Ok(Figure::Lines(Lines { title: title(report, modes), x, panels, bands: Vec::new() }))
}
