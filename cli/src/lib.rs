//! The command line: arguments become plans, and vehicles, engines and solvers meet.
//!
//! The crate is a library with a thin binary, so that another crate can ship the command with kinds of its own:
//! `main_with(Kinds::standard().with(motorcycle::KINDS).with(my::KINDS))`.

pub mod animation;
pub mod arguments;
pub mod backend;
mod base;
pub mod commands;
pub mod comparison;
pub mod console;
pub mod explain;
pub mod family;
pub mod figures;
pub mod incline;
pub mod interrupt;
mod lateral;
pub mod library;
pub mod maneuver;
pub mod model;
pub mod motion;
pub mod output;
pub mod plan;
pub mod plot;
mod replay;
pub mod report;
pub mod responses;
pub mod results;
pub mod rider;
mod road;
pub mod sensitivities;
pub mod small_motions;
pub mod steady;
mod tire;
mod trust;

use console::{Captured, Console};
use mbody::assembly::Kinds;
use mbody::description::finding::Finding;
use output::Palette;
use std::ffi::OsString;
use std::process::ExitCode;

/// What every command may use.
#[derive(Debug)]
pub struct Context {
    /// The registry of kinds.
    pub kinds: Kinds,
    /// Colors of standard output.
    pub palette: Palette,
    /// Where everything is written.
    pub console: Console,
    /// What was typed after the name of the program.
    pub arguments: Vec<String>,
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done; in a sweep, at least one point was reached.
    Done,
    /// The analysis could not reach its goal.
    Unreached,
}

/// Why a command could not start or write.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The input is wrong.
    #[error(transparent)]
    Findings(#[from] mbody::description::finding::Findings),
    /// An argument is wrong.
    #[error("{0}")]
    Argument(String),
    /// The analysis as asked for has no unique answer.
    #[error(transparent)]
    Trim(#[from] analyses::trim::TrimError),
    /// What the analysis starts from could not be reached.
    #[error("{0}")]
    Unreached(String),
    /// A file could not be written.
    #[error("`{path}` could not be written: {cause}")]
    Write {
        /// The file.
        path: String,
        /// What the system said.
        cause: String,
    },
    /// What was recorded could not be kept or read again.
    #[error(
        "the temporary file of a long recording fails: {cause}; `--record` and a lower `--rate` make it smaller, `TMPDIR` names another place for it"
    )]
    Recording {
        /// What the system said.
        cause: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] plot::PlotError),
}

impl From<Finding> for Failure {
    fn from(finding: Finding) -> Self {
        Self::Findings(finding.into())
    }
}

/// The registry that the shipped binary uses.
pub fn standard_kinds() -> Kinds {
    Kinds::standard().with(motorcycle::KINDS)
}

/// Runs the command line with a registry of kinds; returns 0, 1 or 2 as the exit status.
pub fn main_with(kinds: Kinds) -> ExitCode {
    if let Err(message) = check_processor() {
        eprintln!("error: {message}");
        return ExitCode::from(2);
    }
    let arguments = std::env::args_os().skip(1).collect();
    ExitCode::from(run(kinds, arguments, Console::standard()).1)
}

/// Runs the command line as [`main_with`] does, with arguments from elsewhere, and keeps what it writes.
///
/// `arguments` are those after the name of the program. Paths in them are relative to the working folder of the process.
pub fn run_captured<A: Into<OsString>>(kinds: Kinds, arguments: impl IntoIterator<Item = A>) -> Captured {
    let arguments = arguments.into_iter().map(Into::into).collect();
    let (console, status) = run(kinds, arguments, Console::memory());
    console.captured(status)
}

/// Reads the arguments and runs the command; the exit status comes with the console.
fn run(kinds: Kinds, arguments: Vec<OsString>, console: Console) -> (Console, u8) {
    let typed = arguments.iter().map(|a| a.to_string_lossy().into_owned()).collect();
    let words = std::iter::once(OsString::from("fastbike")).chain(arguments);
    let cli = if console.is_memory() { commands::cli().term_width(100) } else { commands::cli() };
    let matches = match cli.try_get_matches_from(words) {
        Ok(matches) => matches,
        Err(answer) => {
            let status = say(&answer, &console);
            return (console, status);
        }
    };
    let context = Context { kinds, palette: console.palette(), console, arguments: typed };
    let ended = commands::run(&matches, &context);
    let console = context.console;
    let status = match ended {
        Ok(Exit::Done) => 0,
        Ok(Exit::Unreached) => 1,
        // everything was said on standard output
        Err(Failure::Findings(findings)) if findings.is_empty() => 2,
        Err(Failure::Findings(findings)) => {
            console.complain(&report::findings(&findings, console.error_palette()));
            2
        }
        Err(Failure::Trim(error)) => {
            console.complain(&report::findings(&report::trim(&error).into(), console.error_palette()));
            2
        }
        Err(failure) => {
            console.complain(&format!("error: {failure}\n"));
            if matches!(failure, Failure::Write { .. } | Failure::Unreached(_)) { 1 } else { 2 }
        }
    };
    (console, status)
}

/// Help, version, or what is wrong with the arguments, in the words of `clap`.
fn say(answer: &clap::Error, console: &Console) -> u8 {
    let wrong = answer.use_stderr();
    // a terminal that is gone cannot be told so
    match console.is_memory() {
        true if wrong => console.complain(&answer.render().to_string()),
        true => console.print(answer.render().to_string().as_bytes()).unwrap_or_default(),
        false => answer.print().unwrap_or_default(),
    }
    if wrong { 2 } else { 0 }
}

/// An older processor gets a sentence, not an illegal instruction.
///
/// `is_x86_feature_detected!` folds to true in a build for x86-64-v3, so the processor itself is asked.
fn check_processor() -> Result<(), String> {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
    {
        use std::arch::x86_64::__cpuid_count;
        let (leaf1, leaf7) = (__cpuid_count(1, 0), __cpuid_count(7, 0));
        let (fma, avx2, bmi2) = (leaf1.ecx >> 12 & 1, leaf7.ebx >> 5 & 1, leaf7.ebx >> 8 & 1);
        if fma & avx2 & bmi2 == 0 {
            return Err("this build needs a processor of x86-64-v3 (AVX2, FMA, BMI2; about 2013 and later); \
                        build without `target-cpu=x86-64-v3` in .cargo/config.toml for this one"
                .to_owned());
        }
    }
    Ok(())
}
