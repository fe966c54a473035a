//! `schema`: the JSON Schema of descriptions, for editors.

use super::Kind;
use crate::{Context, Exit, Failure};
use clap::{ArgMatches, Command};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "schema", command, run };

fn command(command: Command) -> Command {
    command.about("Print the JSON Schema of descriptions, for editors")
}

fn run(_: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let schema = mbody::assembly::schema(&context.kinds);
    context.console.print(format!("{schema:#}\n").as_bytes())?;
    Ok(Exit::Done)
}
