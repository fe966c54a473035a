//! The command line: arguments become plans, and vehicles, engines and solvers meet.
//!
//! The crate is a library with a thin binary, so that another crate can ship the command with kinds of its own:
//! `main_with(Kinds::standard().with(motorcycle::KINDS).with(my::KINDS))`.

pub mod arguments;
pub mod backend;
pub mod commands;
pub mod keep;
pub mod library;
pub mod model;
pub mod output;
pub mod plan;
pub mod plot;
pub mod report;
pub mod steady;

use mbody::assembly::Kinds;
use output::Palette;
use std::process::ExitCode;

/// What every command may use.
#[derive(Debug)]
pub struct Context {
    /// The registry of kinds.
    pub kinds: Kinds,
    /// Colors of standard output.
    pub palette: Palette,
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
    /// A file could not be written.
    #[error("`{path}` could not be written: {cause}")]
    Write {
        /// The file.
        path: String,
        /// What the system said.
        cause: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] plot::PlotError),
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
    let matches = commands::cli().get_matches();
    let context = Context { kinds, palette: Palette::for_stdout() };
    match commands::run(&matches, &context) {
        Ok(Exit::Done) => ExitCode::SUCCESS,
        Ok(Exit::Unreached) => ExitCode::from(1),
        Err(Failure::Findings(findings)) => {
            eprint!("{}", report::findings(&findings, Palette::for_stderr()));
            ExitCode::from(2)
        }
        Err(failure @ Failure::Write { .. }) => {
            eprintln!("error: {failure}");
            ExitCode::from(1)
        }
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(2)
        }
    }
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
