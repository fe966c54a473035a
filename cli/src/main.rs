//! The `fastbike` binary.

use std::process::ExitCode;

fn main() -> ExitCode {
    fastbike::main_with(fastbike::standard_kinds())
}
