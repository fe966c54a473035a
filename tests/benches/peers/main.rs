//! How fast the engine is, as a quotient to what the best peers need for the same equations.
//!
//! `cargo bench -p validation` measures every case and prints the table. What counts is the least processor time of the measuring
//! thread over many batches: on a shared machine the mean of wall-clock time says more about the neighbors. Where a Python with the
//! package `pin` is named by `PINOCCHIO_PYTHON`, Pinocchio's inverse and forward dynamics are timed in the same run.
#![allow(non_snake_case)]

mod clock;
mod instructions;
mod kernels;
mod modes;
mod motion;
mod peer;
mod plants;
mod ride;
mod scaling;
mod sweep;

use clock::Clock;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Some(mut clock) = instructions::counted() {
        kernels::run(&mut clock);
        plants::run(&mut clock);
        return ExitCode::SUCCESS;
    }
    if instructions::asked() {
        return if instructions::run() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    let mut clock = Clock::from_arguments();
    kernels::run(&mut clock);
    plants::run(&mut clock);
    sweep::run(&mut clock);
    modes::run(&mut clock);
    motion::run(&mut clock);
    ride::run(&mut clock);
    scaling::run(&mut clock);
    let measured = clock.finish();
    peer::print(&measured);
    scaling::print(&measured);
    ExitCode::SUCCESS
}
