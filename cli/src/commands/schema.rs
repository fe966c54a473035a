//! `schema`: the JSON Schema of descriptions and of maneuvers, for editors.

use super::{Kind, read};
use crate::{Context, Exit, Failure};
use clap::{ArgMatches, Args, Command};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "schema", command, run };

#[derive(Debug, Args)]
struct Arguments {
    /// The schema of maneuvers instead of that of descriptions
    #[arg(long)]
    maneuver: bool,
    /// The schema of parts, of descriptions that change what they include, and of setups: nothing in it is required
    #[arg(long, conflicts_with = "maneuver")]
    part: bool,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Print the JSON Schema of descriptions or of maneuvers, for editors")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let schema = match (arguments.maneuver, arguments.part) {
        (true, _) => motorcycle::maneuver::schema(),
        (_, true) => mbody::assembly::part_schema(&context.kinds),
        _ => mbody::assembly::editor_schema(&context.kinds),
    };
    context.console.print(format!("{schema:#}\n").as_bytes())?;
    Ok(Exit::Done)
}
