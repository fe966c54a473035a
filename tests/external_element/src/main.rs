//! The command `fastbike` with the elements of this crate.

use std::process::ExitCode;

fn main() -> ExitCode {
    fastbike::main_with(external_element::kinds())
}
