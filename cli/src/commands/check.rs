//! `check`: reads and assembles a model and says everything that is wrong or suspicious at once.

use super::{Kind, read};
use crate::arguments::ModelArguments;
use crate::{Context, Exit, Failure, model, report};
use clap::{ArgMatches, Args, Command};
use mbody::assembly::Assembled;
use mbody::description::finding::{Findings, Severity};
use serde_json::json;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "check", command, run };

/// Read a model and say everything that is wrong or suspicious at once
#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// Format on standard output: table or json
    #[arg(long, default_value = "table", value_parser = ["table", "json"])]
    format: String,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Read a model and say everything that is wrong or suspicious at once")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let (assembled, findings) = match model::read(&arguments.model.model, &arguments.model.set, context) {
        Ok((assembled, findings, _)) => (assembled, findings),
        Err(Failure::Findings(findings)) => (None, findings),
        Err(other) => return Err(other),
    };
    if arguments.format == "json" {
        context.console.print(format!("{:#}\n", as_json(&arguments.model.model, &findings)).as_bytes())?;
        return if findings.has_errors() { Err(Failure::Findings(Findings::new())) } else { Ok(Exit::Done) };
    }
    match assembled {
        None => Err(Failure::Findings(findings)),
        Some((_, assembled)) => {
            if !findings.is_empty() {
                context.console.print(report::findings(&findings, context.palette).as_bytes())?;
            }
            context.console.print(summary(&assembled).as_bytes())?;
            Ok(Exit::Done)
        }
    }
}

/// One paragraph on a model that is in order.
fn summary(assembled: &Assembled) -> String {
    let system = &assembled.system;
    let model = system.model();
    format!(
        "{}: in order. {} moving bodies, {} degrees of freedom, {} constraints, {} elements, {} element states, {} inputs, {} outputs, {:.3} kg\n",
        assembled.name,
        model.moving().count(),
        system.degrees_of_freedom(),
        assembled.constraints.len(),
        system.elements().len(),
        system.state_count(),
        system.inputs().len(),
        system.outputs().len(),
        model.total_mass()
    )
}

fn as_json(model: &str, findings: &Findings) -> serde_json::Value {
    let rows: Vec<_> = findings
        .iter()
        .map(|f| {
            let severity = match f.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            };
            json!({
                "severity": severity, "code": f.code, "file": f.file, "line": f.line, "column": f.column,
                "path": f.path, "message": f.message, "hint": f.hint, "excerpt": f.excerpt,
            })
        })
        .collect();
    json!({ "fastbike": env!("CARGO_PKG_VERSION"), "command": "check", "model": model, "findings": rows })
}
