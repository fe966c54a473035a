//! Commands: one file and one row each.

mod check;
mod comfort;
mod compare;
mod dynamics;
mod explain;
mod frf;
mod handling;
mod info;
mod linearize;
mod map;
mod modes;
mod new;
mod rider;
mod run;
mod schema;
mod setup;
mod slalom;
mod tire;
mod trim;

use crate::{Context, Exit, Failure};
use clap::{ArgMatches, Command};

/// A command.
pub struct Kind {
    /// Name on the command line.
    pub name: &'static str,
    /// Its arguments and help.
    pub command: fn(Command) -> Command,
    /// Runs it.
    pub run: fn(&ArgMatches, &Context) -> Result<Exit, Failure>,
}

/// All commands, in the order of the help.
pub const KINDS: &[Kind] = &[
    trim::KIND,
    map::KIND,
    modes::KIND,
    frf::KIND,
    slalom::KIND,
    comfort::KIND,
    handling::KIND,
    linearize::KIND,
    rider::KIND,
    run::KIND,
    compare::KIND,
    tire::KIND,
    setup::KIND,
    info::KIND,
    check::KIND,
    dynamics::KIND,
    new::KIND,
    explain::KIND,
    schema::KIND,
];

/// Version, profile, processor level, SUNDIALS version, and whether recordings are kept as Parquet too.
fn version() -> String {
    let level = if cfg!(target_feature = "avx2") { "x86-64-v3" } else { std::env::consts::ARCH };
    let parquet = if cfg!(feature = "parquet") { ", Parquet" } else { "" };
    format!("{} ({} build, {level}, SUNDIALS {}{parquet})", env!("CARGO_PKG_VERSION"), env!("FASTBIKE_PROFILE"), sundials::version())
}

/// The whole command line.
pub fn cli() -> Command {
    let root = Command::new("fastbike")
        .about("Motorcycle handling and stability: steady states by inverse dynamics, motions over time")
        .version(version())
        .subcommand_required(true)
        .arg_required_else_help(true)
        .after_help(
            "Quantities are numbers with an optional unit: `30`, `108km/h`, `35deg`, `58 kN/m`; a bare number is SI.\n\
             Signs: lean > 0 to the right; lateral acceleration, curvature and yaw rate > 0 to the left.\n\
             Exit status: 0 done, 1 the goal was not reached, 2 the input is wrong.",
        );
    KINDS.iter().fold(root, |root, kind| root.subcommand((kind.command)(Command::new(kind.name))))
}

/// Runs the command that was asked for.
pub fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let Some((name, arguments)) = matches.subcommand() else {
        return Err(Failure::Argument("no command given; see `fastbike --help`".to_owned()));
    };
    match KINDS.iter().find(|k| k.name == name) {
        Some(kind) => (kind.run)(arguments, context),
        None => Err(Failure::Argument(format!("there is no command `{name}`"))),
    }
}

/// Reads the arguments of a command; clap has checked them already.
fn read<A: clap::FromArgMatches>(matches: &ArgMatches) -> Result<A, Failure> {
    A::from_arg_matches(matches).map_err(|e| Failure::Argument(e.to_string()))
}
