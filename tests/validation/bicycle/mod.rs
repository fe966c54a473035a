//! The benchmark bicycle `whipple`: linear equations, eigenvalues, one published nonlinear state, one published motion.

mod linear;
mod nonlinear;
mod signs;
mod source;

use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[&[Row]] = &[source::EVIDENCE, linear::EVIDENCE, nonlinear::EVIDENCE];
