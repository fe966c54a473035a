//! Systems `(jω − M) x = b` with an upper Hessenberg matrix M: O(n²) for every ω, without allocation.
//!
//! Source: A. J. Laub, IEEE Trans. Autom. Control 26 (1981) 407–408 (frequency responses by Hessenberg form).

use nalgebra::{Complex, DMatrix};

/// The matrix and its work arrays. Real and imaginary parts lie apart, so that rows are added without shuffling.
#[derive(Clone, Debug)]
pub(crate) struct Hessenberg {
    states: usize,
    columns: usize,
    /// M by rows.
    rows: Vec<f64>,
    matrix: [Vec<f64>; 2],
    /// One row per state: right-hand sides, then solutions.
    pub right: [Vec<f64>; 2],
}

impl Hessenberg {
    /// Room for M, which has nothing below its first subdiagonal, and for some right-hand sides.
    pub fn new(M: &DMatrix<f64>, columns: usize) -> Self {
        let n = M.nrows();
        let pair = |length: usize| [vec![0.0; length], vec![0.0; length]];
        Self { states: n, columns, rows: M.transpose().as_slice().to_vec(), matrix: pair(n * n), right: pair(n * columns) }
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Overwrites the right-hand sides with the solutions of `(jω − M) x = b`. Gaussian elimination: only the next row can be the pivot.
    pub fn solve(&mut self, omega: f64) {
        let (n, m) = (self.states, self.columns);
        let ([re, im], [rr, ri]) = (&mut self.matrix, &mut self.right);
        im.fill(0.0);
        for (to, from) in re.iter_mut().zip(&self.rows) {
            *to = -from;
        }
        im.iter_mut().step_by(n + 1).for_each(|entry| *entry = omega);
        for k in 0..n.saturating_sub(1) {
            let (row, next) = (k * n, (k + 1) * n);
            let size = |at: usize, im: &[f64], re: &[f64]| re[at] * re[at] + im[at] * im[at];
            if size(next + k, im, re) > size(row + k, im, re) {
                swap(re, row + k, next + k, n - k);
                swap(im, row + k, next + k, n - k);
                swap(rr, k * m, (k + 1) * m, m);
                swap(ri, k * m, (k + 1) * m, m);
            }
            let factor = Complex::new(re[next + k], im[next + k]) / Complex::new(re[row + k], im[row + k]);
            if factor != Complex::new(0.0, 0.0) {
                subtract(factor, (row + k + 1, next + k + 1, n - k - 1), re, im);
                subtract(factor, (k * m, (k + 1) * m, m), rr, ri);
            }
        }
        for k in (0..n).rev() {
            let pivot = Complex::new(1.0, 0.0) / Complex::new(re[k * n + k], im[k * n + k]);
            for e in 0..m {
                let mut sum = Complex::new(rr[k * m + e], ri[k * m + e]);
                for j in k + 1..n {
                    let (a, b, x, y) = (re[k * n + j], im[k * n + j], rr[j * m + e], ri[j * m + e]);
                    sum -= Complex::new(a * x - b * y, a * y + b * x);
                }
                let solution = sum * pivot;
                (rr[k * m + e], ri[k * m + e]) = (solution.re, solution.im);
            }
        }
    }
}

/// Swaps two rows of one part.
fn swap(part: &mut [f64], a: usize, b: usize, length: usize) {
    let (upper, lower) = part.split_at_mut(b);
    upper[a..a + length].swap_with_slice(&mut lower[..length]);
}

/// Subtracts `factor` times the row that starts at the first place from the one at the second.
fn subtract(factor: Complex<f64>, (from, to, length): (usize, usize, usize), re: &mut [f64], im: &mut [f64]) {
    let ((re_upper, re_lower), (im_upper, im_lower)) = (re.split_at_mut(to), im.split_at_mut(to));
    let rows = re_lower[..length].iter_mut().zip(&mut im_lower[..length]);
    for ((x, y), (a, b)) in rows.zip(re_upper[from..from + length].iter().zip(&im_upper[from..from + length])) {
        *x -= factor.re * a - factor.im * b;
        *y -= factor.re * b + factor.im * a;
    }
}
