//! Derivatives of a controller's answer along directions, from its own Jacobian.

use problem::{AnswerAlong, Matrix};

/// Writes `J (dz, dx)`: rows of the Jacobian are commands, rates, outputs, its columns what is measured, then states.
pub(crate) fn along_directions(jacobian: &Matrix, (by_measured, by_states): (&Matrix, &Matrix), along: AnswerAlong<'_>) {
    let m = by_measured.rows();
    let mut row = 0;
    for part in [along.commands, along.rates, along.outputs] {
        for i in 0..part.rows() {
            for j in 0..part.columns() {
                let by_z: f64 = by_measured.column(j).iter().enumerate().map(|(k, d)| jacobian[(row, k)] * d).sum();
                let by_x: f64 = by_states.column(j).iter().enumerate().map(|(k, d)| jacobian[(row, m + k)] * d).sum();
                part[(i, j)] = by_z + by_x;
            }
            row += 1;
        }
    }
}
