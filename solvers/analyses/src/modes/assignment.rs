//! Cheapest assignment of rows to columns of a square matrix, by shortest augmenting paths with potentials.
//!
//! Source: R. Jonker, A. Volgenant, “A shortest augmenting path algorithm for dense and sparse linear assignment problems”,
//! Computing 38 (1987) 325–340 (the Hungarian method of H. W. Kuhn, 1955, in O(n³)).

use nalgebra::DMatrix;

/// The column of every row.
pub(super) fn cheapest(cost: &DMatrix<f64>) -> Vec<usize> {
    let n = cost.nrows();
    let (mut row_potential, mut column_potential) = (vec![0.0; n], vec![0.0; n + 1]);
    // the row of every column; column n is where a new row starts
    let mut owner: Vec<Option<usize>> = vec![None; n + 1];
    for row in 0..n {
        let mut distance = vec![f64::INFINITY; n + 1];
        let mut before = vec![n; n + 1];
        let mut done = vec![false; n + 1];
        let mut column = n;
        owner[n] = Some(row);
        while let Some(i) = owner[column] {
            done[column] = true;
            let (mut step, mut next) = (f64::INFINITY, n);
            for j in (0..n).filter(|&j| !done[j]) {
                let reduced = cost[(i, j)] - row_potential[i] - column_potential[j];
                if reduced < distance[j] {
                    (distance[j], before[j]) = (reduced, column);
                }
                if distance[j] < step {
                    (step, next) = (distance[j], j);
                }
            }
            for j in 0..=n {
                match (done[j], owner[j]) {
                    (true, Some(i)) => {
                        row_potential[i] += step;
                        column_potential[j] -= step;
                    }
                    _ => distance[j] -= step,
                }
            }
            column = next;
        }
        // hand every row on the path to the column after it
        while column != n {
            owner[column] = owner[before[column]];
            column = before[column];
        }
    }
    let mut assigned = vec![0; n];
    for (column, row) in owner.iter().take(n).enumerate() {
        assigned[row.unwrap_or(column)] = column;
    }
    assigned
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The best of all permutations, tried one by one.
    fn exhaustive(cost: &DMatrix<f64>, row: usize, taken: &mut Vec<usize>) -> f64 {
        if row == cost.nrows() {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for column in 0..cost.nrows() {
            if !taken.contains(&column) {
                taken.push(column);
                best = f64::min(best, cost[(row, column)] + exhaustive(cost, row + 1, taken));
                taken.pop();
            }
        }
        best
    }

    #[test]
    fn no_permutation_is_cheaper() {
        for n in 0..7 {
            for round in 0..20 {
                let cost =
                    DMatrix::from_fn(n, n, |i, j| (((i * 7 + j * 13 + round * 31 + 5) * (i + 3) * (j + 11)) % 101) as f64 / 7.0 - 3.0);
                let assigned = cheapest(&cost);
                let mut columns = assigned.clone();
                columns.sort_unstable();
                assert_eq!(columns, (0..n).collect::<Vec<_>>());
                let total: f64 = assigned.iter().enumerate().map(|(i, &j)| cost[(i, j)]).sum();
                assert!((total - exhaustive(&cost, 0, &mut Vec::new())).abs() < 1e-12, "{cost}");
            }
        }
    }
}
