//! Coordinates that no velocity moves: the norm of a quaternion, which its own row draws back.
//!
//! Where a plant has more coordinates than velocities, `δq̇ = N δv + …` has fewer columns than rows. A direction n with `nᵀ N = 0` is moved by nothing, and nothing but its own row depends on
//! it: it is no motion of the bodies. One coordinate of each such direction is expressed by the others, `nᵀ δq = 0`, and its row is left out.
//!
//! Source: linear algebra; ADR 4 for the rows of quaternions.

use super::layout::Layout;
use super::tableau::Tableau;
use nalgebra::DMatrix;
use problem::{Plant, UnknownKind};

/// A direction is moved by nothing where its singular value is below this, in units of the largest.
const UNMOVED: f64 = 1e-9;

/// A coordinate that follows others: `δq = Σ share δx`.
#[derive(Clone, Debug)]
pub(super) struct Following {
    /// Index among the unknowns of the plant.
    pub(super) unknown: usize,
    /// Places among the differential unknowns that are left, and shares.
    pub(super) shares: Vec<(usize, f64)>,
}

/// Takes coordinates that no velocity moves out of layout and tableau.
pub(super) fn leave_out(plant: &dyn Plant, layout: &mut Layout, tableau: &mut Tableau) -> Vec<Following> {
    let count = |kind: UnknownKind| plant.unknowns().iter().filter(|u| u.kind == kind).count();
    if count(UnknownKind::Position) <= count(UnknownKind::Velocity) {
        return Vec::new();
    }
    let of_kind = |kind| -> Vec<usize> {
        (0..layout.differential.len()).filter(|&k| plant.unknowns()[layout.differential[k]].kind == kind).collect()
    };
    let (positions, velocities) = (of_kind(UnknownKind::Position), of_kind(UnknownKind::Velocity));
    let N = DMatrix::from_fn(positions.len(), velocities.len(), |i, k| {
        tableau.M[(layout.rows[positions[i]], tableau.states.start + velocities[k])]
    });
    let directions = reduced(unmoved(&N));
    let out: Vec<usize> = directions.iter().map(|(pivot, _)| positions[*pivot]).collect();
    let left: Vec<usize> = (0..layout.differential.len()).filter(|k| !out.contains(k)).collect();
    let mut following = Vec::new();
    for (pivot, direction) in &directions {
        let others = (0..positions.len()).filter(|i| i != pivot && direction[*i] != 0.0);
        let shares: Vec<(usize, f64)> = others.map(|i| (positions[i], -direction[i])).collect();
        tableau.express(positions[*pivot], &shares);
        let place = |k: usize| left.iter().position(|&l| l == k).expect("the others are left");
        following.push(Following {
            unknown: layout.differential[positions[*pivot]],
            shares: shares.into_iter().map(|(k, share)| (place(k), share)).collect(),
        });
    }
    tableau.remove(&out);
    layout.differential = left.iter().map(|&k| layout.differential[k]).collect();
    layout.rows = left.iter().map(|&k| layout.rows[k]).collect();
    following
}

/// Rows that span the directions n with `nᵀ N = 0`.
fn unmoved(N: &DMatrix<f64>) -> DMatrix<f64> {
    // eigenvectors of N Nᵀ: a thin decomposition of N would leave out directions beyond its columns
    let square = (N * N.transpose()).symmetric_eigen();
    let largest = square.eigenvalues.amax().max(f64::MIN_POSITIVE);
    let rows: Vec<usize> = (0..N.nrows()).filter(|&k| square.eigenvalues[k].abs() <= UNMOVED * largest).collect();
    square.eigenvectors.select_columns(&rows).transpose()
}

/// The same directions by elimination with complete pivoting: each is 1 at a pivot of its own, where the others are 0.
fn reduced(mut rows: DMatrix<f64>) -> Vec<(usize, Vec<f64>)> {
    let mut pivots: Vec<usize> = Vec::new();
    for step in 0..rows.nrows() {
        let entries = (step..rows.nrows()).flat_map(|i| (0..rows.ncols()).map(move |k| (i, k)));
        let Some((row, column)) = entries.max_by(|&a, &b| rows[a].abs().total_cmp(&rows[b].abs())) else { break };
        rows.swap_rows(step, row);
        let pivot = rows.row(step) / rows[(step, column)];
        rows.row_mut(step).copy_from(&pivot);
        for i in (0..rows.nrows()).filter(|&i| i != step) {
            let without = rows.row(i) - &pivot * rows[(i, column)];
            rows.row_mut(i).copy_from(&without);
        }
        pivots.push(column);
    }
    // what rounding leaves of the other quaternions
    let clean = |x: f64| if x.abs() < UNMOVED { 0.0 } else { x };
    pivots.into_iter().enumerate().map(|(row, column)| (column, rows.row(row).iter().map(|&x| clean(x)).collect())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two quaternions at different attitudes: each loses the component that is largest, and the others do not mix.
    #[test]
    fn directions_of_two_quaternions_stay_apart() {
        let (p, q) = ([0.1, -0.2, 0.3, (1.0f64 - 0.14).sqrt()], [(1.0f64 - 0.09).sqrt(), 0.2, -0.1, 0.2]);
        let rates = |q: [f64; 4]| {
            let [x, y, z, w] = q;
            [[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]]
        };
        let mut N = DMatrix::zeros(8, 6);
        for (k, q) in [p, q].into_iter().enumerate() {
            rates(q).iter().enumerate().for_each(|(i, row)| (0..3).for_each(|j| N[(4 * k + i, 3 * k + j)] = 0.5 * row[j]));
        }
        let mut directions = reduced(unmoved(&N));
        directions.sort_by_key(|d| d.0);
        assert_eq!(directions.iter().map(|d| d.0).collect::<Vec<_>>(), [3, 4]);
        for ((pivot, direction), (k, q)) in directions.iter().zip([(0, p), (1, q)]) {
            for i in 0..8 {
                let expected = if i / 4 == k { q[i % 4] / q[pivot % 4] } else { 0.0 };
                assert!((direction[i] - expected).abs() < 1e-12, "{i}: {} {expected}", direction[i]);
            }
        }
    }
}
