//! `schema`: the JSON Schema of descriptions, of maneuvers and of tire laws, for editors.

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
    /// The schema of tire law files instead of that of descriptions
    #[arg(long, conflicts_with = "maneuver")]
    tire: bool,
    /// The schema of parts, of descriptions that change what they include, and of setups: nothing in it is required
    #[arg(long, conflicts_with_all = ["maneuver", "tire"])]
    part: bool,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Print the JSON Schema of descriptions, of maneuvers or of tire laws, for editors")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let schema = match (arguments.maneuver, arguments.tire, arguments.part) {
        (true, ..) => motorcycle::maneuver::schema(),
        (_, true, _) => motorcycle::tire::law_description::schema(),
        (_, _, true) => mbody::assembly::part_schema(&context.kinds),
        _ => mbody::assembly::editor_schema(&context.kinds),
    };
    context.console.print(format!("{schema:#}\n").as_bytes())?;
    Ok(Exit::Done)
}
