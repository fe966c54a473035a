//! `map`: steady states over a grid of two prescribed quantities, as a contour figure.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument};
use crate::output::{Angles, Report};
use crate::plan::TrimArguments;
use crate::plot::{Axis, Contour, Figure, Node};
use crate::{Context, Exit, Failure, model, results, steady};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "map", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Signal to draw
    #[arg(long, value_name = "SIGNAL", default_value = "steer.torque")]
    show: String,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command)
        .about("Steady states over a grid of two swept options, as a contour figure")
        .after_help("Example:\n  fastbike map gsxr1000 --speed 10..60:2 --curvature 0..0.05:0.002 --show steer.torque --plot torque.svg")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    if request.swept() != 2 {
        return Err(not_two(request.swept()).into());
    }
    let loaded = model::load(&arguments.model, context)?;
    let shown = results::shown(std::slice::from_ref(&arguments.show), &loaded.assembled.system)?;
    let steady = steady::run(&request, &loaded.assembled.system, &arguments.trim.backend, "map")?;
    let report = results::report("map", &loaded.name, shown, steady);
    results::deliver(context, (&arguments.model, &arguments.output), report, |report| figure(report, &arguments.show))
}

/// A map of fewer or more than two swept options.
fn not_two(swept: usize) -> Finding {
    Finding::error("no_sweep", format!("a map needs two swept options, found {swept}"))
        .with_hint("for example `--speed 10..60:2 --lean 0deg..50deg:2deg`")
}

/// Contours over the two swept quantities: the turn across, the speed upward, as the field draws it.
fn figure(report: &Report, show: &str) -> Result<Figure, Failure> {
    let given = &report.given;
    let distinct = |k: usize| {
        let mut values: Vec<f64> = Vec::new();
        for point in &report.points {
            if !values.contains(&point.given[k]) {
                values.push(point.given[k]);
            }
        }
        values
    };
    let axes: Vec<(usize, Vec<f64>)> = (0..given.len()).map(|k| (k, distinct(k))).filter(|(_, v)| v.len() > 1).collect();
    let [(up, rows), (across, columns)] = &axes[..] else {
        return Err(not_two(axes.len()).into());
    };
    let Some(signal) = report.signal(show) else {
        return Err(argument("show", show, "unknown_signal", format!("there is no signal `{show}`")).into());
    };
    // angles are drawn in degrees
    let shown = |unit| Angles::Degrees.show(unit);
    let value_shown = shown(&report.signals[signal].unit);
    let mut nodes = Vec::with_capacity(rows.len() * columns.len());
    for row in rows {
        for column in columns {
            let point = report.points.iter().find(|p| p.given[*up] == *row && p.given[*across] == *column);
            nodes.push(match point {
                Some(p) if p.ending == problem::Ending::Reached => Node::Value(p.value(signal) * value_shown.factor),
                Some(p) => Node::Infeasible(p.ending.name().to_owned()),
                None => Node::Infeasible("not_converged".to_owned()),
            });
        }
    }
    let scaled = |values: &[f64], k: usize| values.iter().map(|v| v * shown(&given[k].unit).factor).collect::<Vec<f64>>();
    let axis = |k: usize| Axis::new(given[k].name.replace('_', " "), shown(&given[k].unit).unit);
    let title = format!("{} of {} in steady turns", show, report.model);
    let value = Axis::new(show, value_shown.unit);
    let limits = report.limits.iter().filter_map(|p| {
        let row = rows.iter().position(|r| *r == p.given[*up])?;
        Some((row, p.given[*across] * shown(&given[*across].unit).factor, p.value(signal) * value_shown.factor))
    });
    let limits = limits.collect();
    let map = Contour::new(title, (axis(*across), scaled(columns, *across)), (axis(*up), scaled(rows, *up)), value, nodes)?;
    Ok(Figure::Contour(map.with_limits(limits)))
}
