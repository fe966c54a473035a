//! The benchmark bicycle `whipple`: linear equations, eigenvalues, one published nonlinear state, one published motion.

mod circles;
mod dynamics;
mod formulas;
mod linear;
mod motion;
mod response;
mod sensitivity;
mod signs;
mod source;

use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[&[Row]] = &[
    source::EVIDENCE,
    dynamics::EVIDENCE,
    linear::EVIDENCE,
    motion::EVIDENCE,
    response::EVIDENCE,
    circles::EVIDENCE,
    formulas::EVIDENCE,
    sensitivity::EVIDENCE,
];
