//! `compare`: the same problem through several backends and tolerances.

use super::run::times;
use super::{Kind, read};
use crate::arguments::{Jacobian, Linear, ModelArguments, OutputArguments, argument, sweep, unknown_name};
use crate::comparison::{Contender, Motion, Settings, sweeps};
use crate::output::comparison::Comparison;
use crate::plan::SteadyArguments;
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use crate::{Context, Exit, Failure, backend, maneuver, model, motion, results};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::{Number, Time};
use problem::{Derivatives, LinearSolver};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "compare", command, run };

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// A maneuver to ride: the name of a bundled one, or the path of a .yaml file
    maneuver: Option<String>,
    /// Override an entry of the maneuver (repeatable)
    #[arg(long, value_name = "PATH=VALUE", requires = "maneuver", allow_hyphen_values = true)]
    change: Vec<String>,
    /// How long; left out: 5 s, or what the maneuver takes
    #[arg(long, value_name = "TIME")]
    duration: Option<String>,
    #[command(flatten)]
    steady: SteadyArguments,
    /// Start value or constant input, as in `run` (repeatable)
    #[arg(long, value_name = "SIGNAL=VALUE", allow_hyphen_values = true)]
    given: Vec<String>,
    /// Backends; left out: all that take the problem
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    backends: Vec<String>,
    /// Formulations of the constraints for implicit backends; left out: the default one
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    formulations: Vec<String>,
    /// Matrices of implicit methods: exact derivatives, differences of residuals
    #[arg(long, value_delimiter = ',', value_enum, default_value = "exact")]
    jacobian: Vec<Jacobian>,
    /// Linear solvers of implicit methods, where they know several
    #[arg(long, value_delimiter = ',', value_enum, default_value = "direct")]
    linear_solver: Vec<Linear>,
    /// Lengths of steps, for methods whose steps are all alike
    #[arg(long, value_name = "TIME,…", default_value = "2ms,1ms,0.5ms")]
    steps: String,
    /// Relative tolerances
    #[arg(long, value_name = "NUMBER,…", default_value = "1e-4,1e-6,1e-8")]
    rtol: String,
    /// How often each is timed; the least time counts
    #[arg(long, value_name = "NUMBER", default_value_t = 3)]
    repeats: usize,
    #[command(flatten)]
    output: OutputArguments,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("The same problem through several backends and tolerances").after_help(
        "With a maneuver, with `--duration` or for a mechanism the problem is a motion; errors refer to a run at a tight tolerance. With a sweep of \
         `--speed` alone it is the sweep of steady states. A backend that fails tells why in its row, and the comparison goes on.\n\n\
         Examples:\n  fastbike compare ref11 lane_change --plot work_precision.svg\n  fastbike compare andrews_squeezer --duration 30ms\n  \
         fastbike compare gsxr1000 --speed 10..60:2 --lateral-acceleration 0..6:0.5",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.steady.gear_override());
    if arguments.repeats == 0 {
        return Err(argument("repeats", "0", "out_of_range", "each must run once at least".to_owned()).into());
    }
    arguments.output.check()?;
    let loaded = model::load(&arguments.model, context)?;
    let system = &loaded.assembled.system;
    let comparison = match arguments.maneuver.is_none() && arguments.duration.is_none() && arguments.steady.moving() {
        true => {
            let names = chosen(&arguments.backends, backend::ALGEBRAIC.iter().map(|b| b.name))?;
            sweeps(&arguments.steady.request(&arguments.given, &[])?, system, &loaded.name, &names, arguments.repeats)?
        }
        false => {
            let maneuver = arguments.maneuver.as_deref().map(|name| maneuver::read(name, &arguments.change)).transpose()?;
            if let Some(maneuver) = &maneuver {
                arguments.steady.speed = Some(format!("{}", maneuver.course.speed.first()));
            }
            let duration = match (&arguments.duration, &maneuver) {
                (Some(duration), _) => duration.clone(),
                (None, Some(maneuver)) => format!("{:.3}", maneuver.longest()),
                (None, None) => "5s".to_owned(),
            };
            let request = motion::Request {
                times: times(&duration, None)?,
                relative_tolerance: 1e-6,
                backend: String::new(),
                formulation: None,
                derivatives: Derivatives::Exact,
                linear_solver: LinearSolver::Direct,
                fixed_step: motion::USUAL_STEP,
                steady: arguments.steady.moving().then(|| arguments.steady.request(&[], &[])).transpose()?,
                given: arguments.given.clone(),
                signals: None,
                until: maneuver.iter().flat_map(|m| m.until.clone()).collect(),
                interrupt: None,
                record: Vec::new(),
                keep: None,
            };
            let names = chosen(&arguments.backends, backend::INTEGRATION.iter().map(|b| b.name))?;
            let contenders = contenders(&names, &arguments.formulations, &arguments.jacobian, &arguments.linear_solver)?;
            let tolerances = sweep::<Number>("rtol", &arguments.rtol)?;
            if let Some(bad) = tolerances.iter().find(|t| !(1e-13..=0.1).contains(*t)) {
                let why = format!("a relative tolerance of `{bad}` is out of range: it must be from 1e-13 to 0.1");
                return Err(argument("rtol", &arguments.rtol, "out_of_range", why).into());
            }
            let steps = sweep::<Time>("steps", &arguments.steps)?;
            if steps.iter().any(|step| *step <= 0.0) {
                return Err(argument("steps", &arguments.steps, "out_of_range", "a step is longer than 0".to_owned()).into());
            }
            let maneuver = arguments.maneuver.as_deref().zip(maneuver);
            let settings = Settings { tolerances, steps, repeats: arguments.repeats };
            Motion { request, system, model: &loaded.name, maneuver }.compare(&contenders, &settings)?
        }
    };
    results::deliver(context, (&arguments.model, &arguments.output), comparison, figure)
}

/// The backends that are named, or all.
fn chosen(named: &[String], known: impl Iterator<Item = &'static str>) -> Result<Vec<String>, Failure> {
    let known: Vec<&str> = known.collect();
    if named.is_empty() {
        return Ok(known.into_iter().map(str::to_owned).collect());
    }
    match named.iter().find(|name| !known.contains(&name.as_str())) {
        None => Ok(named.to_vec()),
        Some(unknown) => Err(unknown_name("backends", unknown, ("backend", unknown), known).into()),
    }
}

/// Implicit backends in every formulation, those with linear equations by every way to their matrices and by every solver that they know, all
/// others once.
fn contenders(
    backends: &[String],
    formulations: &[String],
    jacobians: &[Jacobian],
    linear_solvers: &[Linear],
) -> Result<Vec<Contender>, Failure> {
    let known = || motion::FORMULATIONS.iter().map(|f| f.name());
    if let Some(unknown) = formulations.iter().find(|f| !known().any(|k| k == f.as_str())) {
        return Err(unknown_name("formulations", unknown, ("formulation", unknown), known()).into());
    }
    let mut found = Vec::new();
    for name in backends {
        let Some(row) = backend::integration(name) else { continue };
        let implicit = matches!(row.make, backend::Integrator::Implicit(_)) && !formulations.is_empty();
        let forms = if implicit { formulations.iter().cloned().map(Some).collect() } else { vec![None] };
        let ways = if row.linear_solvers.is_empty() { &[Jacobian::Exact] } else { jacobians };
        let wanted = linear_solvers.iter().map(|&linear| LinearSolver::from(linear));
        let mut solvers: Vec<LinearSolver> = wanted.filter(|linear| row.linear_solvers.contains(linear)).collect();
        // a method that knows none of them takes part all the same
        if solvers.is_empty() {
            solvers.push(LinearSolver::Direct);
        }
        for formulation in forms {
            for &derivatives in ways {
                let of = |&linear_solver: &LinearSolver| Contender {
                    backend: row,
                    formulation: formulation.clone(),
                    derivatives: derivatives.into(),
                    linear_solver,
                };
                found.extend(solvers.iter().map(of));
            }
        }
    }
    Ok(found)
}

/// Work over precision: a curve per backend and form.
fn figure(comparison: &Comparison) -> Result<Figure, Failure> {
    if !comparison.in_time {
        return Err(Finding::error("no_sweep", "steady states have no tolerance to draw over").into());
    }
    let mut curves: Vec<Curve> = Vec::new();
    for row in comparison.rows.iter().filter(|r| r.because.is_none() && r.error > 0.0) {
        let others = || comparison.rows.iter().filter(|r| r.backend == row.backend);
        let form = others().any(|r| r.form != row.form).then_some(row.form.as_str());
        let jacobian = others().any(|r| r.jacobian != row.jacobian).then_some(row.jacobian);
        let linear = others().any(|r| r.linear_solver != row.linear_solver).then_some(row.linear_solver);
        let name = [Some(row.backend.as_str()), form, jacobian, linear].into_iter().flatten().collect::<Vec<_>>().join(", ");
        let point = (row.error, 1e3 * row.wall);
        match curves.iter_mut().find(|c| c.name == name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name, points: vec![point], markers: Markers::Always, variant: 0 }),
        }
    }
    if curves.is_empty() {
        return Err(Finding::error("no_sweep", "no backend reached the end").into());
    }
    let panels = vec![LinePanel { y: Axis::new("Wall time", "ms").logarithmic(), curves }];
    let x = Axis::new(format!("Error against {}", comparison.reference), "-").logarithmic();
    let title = format!("{}: {}", comparison.model, comparison.problem);
    Ok(Figure::Lines(Lines { title, x, panels, bands: Vec::new(), variants: Vec::new() }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contenders_are_backends_in_forms() {
        let names = ["ida".to_owned(), "erk".to_owned()];
        let forms = ["ggl".to_owned(), "velocity".to_owned()];
        let found = |names: &[String], linear: &[Linear]| {
            contenders(names, &forms, &[Jacobian::Exact, Jacobian::Differences], linear).map(|c| c.len()).ok()
        };
        assert_eq!(found(&names, &[Linear::Direct]), Some(5));
        assert_eq!(found(&names, &[Linear::Direct, Linear::Gmres]), Some(9));
        assert_eq!(found(&["ros2".to_owned(), "erk".to_owned()], &[Linear::Gmres]), Some(3));
        assert!(contenders(&names, &["ggi".to_owned()], &[Jacobian::Exact], &[Linear::Direct]).is_err());
    }
}
