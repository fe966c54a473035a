//! Gaussian elimination of one right-hand side, made for small dense systems that are solved over and over.
//!
//! P A x = P b by row operations on the tableau \[A | b\], the pivot of each column being the largest remaining entry
//! (partial pivoting on equilibrated rows), then back-substitution.
//!
//! Source: G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins 2013, sections 3.4 and 3.5.2.

use problem::Matrix;

/// Numbers that the processor handles at once; rows are padded to a multiple of it.
const LANES: usize = 4;

/// The matrix has no usable pivot in this column: numerically it depends on the columns before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularColumn(pub usize);

/// Tableau for systems of one size; nothing is allocated after [`Elimination::new`].
#[derive(Debug)]
pub struct Elimination {
    size: usize,
    /// Padded length of a row.
    stride: usize,
    /// Row after row \[A | b | padding\].
    tableau: Vec<f64>,
    /// Row being eliminated with, copied out so that the others can be written.
    pivot_row: Vec<f64>,
    /// Reciprocals of the pivots.
    inverse: Vec<f64>,
    /// Largest magnitude in each column before elimination: what a pivot is compared with.
    column_size: Vec<f64>,
}

impl Elimination {
    /// Room for systems of `size` unknowns.
    pub fn new(size: usize) -> Self {
        let stride = (size + 1).next_multiple_of(LANES);
        let zeros = || vec![0.0; size];
        Self { size, stride, tableau: vec![0.0; size * stride], pivot_row: vec![0.0; stride], inverse: zeros(), column_size: zeros() }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Writes the solution p of (R A C) (C⁻¹ p) = R b with R = diag(1 / `row_scale`) and C = diag(`column_scale`).
    ///
    /// The scales change which pivots are chosen and what counts as singular, not the exact solution.
    ///
    /// # Errors
    /// [`SingularColumn`] where the largest pivot left is below rounding error, or is not a number.
    pub fn solve(
        &mut self,
        matrix: &Matrix,
        right: &[f64],
        row_scale: &[f64],
        column_scale: &[f64],
        solution: &mut [f64],
    ) -> Result<(), SingularColumn> {
        self.load(matrix, right, row_scale, column_scale);
        self.equilibrate();
        let threshold = self.size as f64 * f64::EPSILON;
        for k in 0..self.size {
            let (row, pivot) = self.pivot(k);
            if pivot <= threshold * self.column_size[k] {
                return Err(SingularColumn(k));
            }
            self.swap_rows(k, row);
            self.eliminate(k);
        }
        self.substitute_back(solution);
        for (solution, scale) in solution.iter_mut().zip(column_scale) {
            *solution *= scale;
        }
        Ok(())
    }

    /// Fills the tableau with \[R A C | R b\].
    fn load(&mut self, matrix: &Matrix, right: &[f64], row_scale: &[f64], column_scale: &[f64]) {
        let (size, stride) = (self.size, self.stride);
        for (row, (right, scale)) in self.tableau.chunks_exact_mut(stride).zip(right.iter().zip(row_scale)) {
            row[size] = right / scale;
        }
        for (j, column_scale) in column_scale.iter().enumerate() {
            let places = self.tableau[j..].iter_mut().step_by(stride);
            for ((place, entry), row_scale) in places.zip(matrix.column(j)).zip(row_scale) {
                *place = entry * column_scale / row_scale;
            }
        }
    }

    /// Divides every row by its largest entry, then notes the largest entry of every column.
    fn equilibrate(&mut self) {
        let size = self.size;
        self.column_size.fill(0.0);
        for row in self.tableau.chunks_exact_mut(self.stride) {
            let row = &mut row[..=size];
            let largest = row[..size].iter().fold(0.0, |largest: f64, entry| if entry.abs() > largest { entry.abs() } else { largest });
            let factor = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            row.iter_mut().for_each(|entry| *entry *= factor);
            for (column, entry) in self.column_size.iter_mut().zip(row) {
                *column = if entry.abs() > *column { entry.abs() } else { *column };
            }
        }
    }

    /// Row and magnitude of the largest entry left in column `k`.
    fn pivot(&self, k: usize) -> (usize, f64) {
        let column = self.tableau[k * self.stride + k..].iter().step_by(self.stride);
        column.map(|entry| entry.abs()).zip(k..).fold((k, 0.0), |best, (entry, i)| if entry > best.1 { (i, entry) } else { best })
    }

    fn swap_rows(&mut self, k: usize, row: usize) {
        if row != k {
            let (above, below) = self.tableau.split_at_mut(row * self.stride);
            above[k * self.stride..(k + 1) * self.stride].swap_with_slice(&mut below[..self.stride]);
        }
    }

    /// Takes column `k` out of the rows below. Whole groups of lanes are updated: what stands left of column `k` is never read again.
    fn eliminate(&mut self, k: usize) {
        let (stride, start) = (self.stride, k / LANES * LANES);
        self.pivot_row.copy_from_slice(&self.tableau[k * stride..(k + 1) * stride]);
        let inverse = 1.0 / self.pivot_row[k];
        self.inverse[k] = inverse;
        let (source, _) = self.pivot_row[start..].as_chunks::<LANES>();
        for row in self.tableau[(k + 1) * stride..].chunks_exact_mut(stride) {
            let factor = row[k] * inverse;
            if factor == 0.0 {
                continue;
            }
            let (target, _) = row[start..].as_chunks_mut::<LANES>();
            for (target, source) in target.iter_mut().zip(source) {
                for lane in 0..LANES {
                    target[lane] -= factor * source[lane];
                }
            }
        }
    }

    fn substitute_back(&self, solution: &mut [f64]) {
        for (k, row) in self.tableau.chunks_exact(self.stride).enumerate().rev() {
            let known: f64 = row[k + 1..self.size].iter().zip(&solution[k + 1..]).map(|(entry, x)| entry * x).sum();
            solution[k] = (row[self.size] - known) * self.inverse[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[f64]]) -> Matrix {
        let mut matrix = Matrix::zeros(rows.len(), rows.len());
        for (i, row) in rows.iter().enumerate() {
            for (j, &entry) in row.iter().enumerate() {
                matrix[(i, j)] = entry;
            }
        }
        matrix
    }

    fn solve(matrix: &Matrix, right: &[f64]) -> Result<Vec<f64>, SingularColumn> {
        let ones = vec![1.0; right.len()];
        let mut solution = vec![0.0; right.len()];
        Elimination::new(right.len()).solve(matrix, right, &ones, &ones, &mut solution).map(|()| solution)
    }

    #[test]
    fn the_hilbert_matrix_of_order_five_gives_back_ones() {
        let mut hilbert = Matrix::zeros(5, 5);
        let mut right = [0.0; 5];
        for i in 0..5 {
            for j in 0..5 {
                hilbert[(i, j)] = 1.0 / (i + j + 1) as f64;
                right[i] += hilbert[(i, j)];
            }
        }
        // condition number 4.8e5, so rounding may cost six of sixteen digits
        for x in solve(&hilbert, &right).unwrap() {
            assert!((x - 1.0).abs() < 1e-10, "{x}");
        }
    }

    #[test]
    fn zero_on_the_diagonal_needs_a_row_exchange() {
        let solution = solve(&matrix(&[&[0.0, 2.0, 0.0], &[1.0, 0.0, 0.0], &[0.0, 0.0, 4.0]]), &[6.0, 5.0, 8.0]).unwrap();
        assert_eq!(solution, [5.0, 3.0, 2.0]);
    }

    #[test]
    fn rows_and_columns_of_very_different_size_lose_no_digits() {
        let (rows, columns) = ([1e12, 1e-9, 1.0], [1e-8, 1.0, 1e10]);
        let plain = [[4.0, -1.0, 2.0], [1.0, 3.0, -1.0], [2.0, 1.0, 5.0]];
        let mut scaled = Matrix::zeros(3, 3);
        let mut right = [0.0; 3];
        for i in 0..3 {
            for j in 0..3 {
                scaled[(i, j)] = rows[i] * plain[i][j] / columns[j];
                right[i] += rows[i] * plain[i][j];
            }
        }
        for (x, column) in solve(&scaled, &right).unwrap().iter().zip(columns) {
            assert!((x / column - 1.0).abs() < 1e-14, "{x} {column}");
        }
    }

    #[test]
    fn dependent_columns_are_named() {
        assert_eq!(solve(&matrix(&[&[1.0, 2.0, 0.0], &[2.0, 4.0, 1.0], &[3.0, 6.0, 5.0]]), &[1.0; 3]), Err(SingularColumn(1)));
        assert_eq!(solve(&matrix(&[&[0.0, 1.0], &[0.0, 1.0]]), &[1.0; 2]), Err(SingularColumn(0)));
        assert!(solve(&matrix(&[&[f64::NAN, 1.0], &[1.0, 1.0]]), &[1.0; 2]).is_err());
    }
}
