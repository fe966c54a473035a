//! Triangular factors of a small dense matrix, for several right-hand sides one after the other.
//!
//! P R A C = L U by columns (right-looking, partial pivoting), C given, R such that the largest entry of every row of R A C is one.
//!
//! Source: G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins 2013, sections 3.4 and 3.5.2.

use crate::elimination::SingularColumn;
use problem::Matrix;

/// Factors of one matrix; nothing is allocated after [`Factorization::new`].
#[derive(Debug, Default)]
pub struct Factorization {
    /// L below the diagonal, U on and above it.
    factors: Matrix,
    /// Row that was exchanged with row k.
    exchanged: Vec<usize>,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
}

impl Factorization {
    /// Room for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        Self { factors: Matrix::zeros(size, size), exchanged: vec![0; size], row_scale: vec![1.0; size], column_scale: vec![1.0; size] }
    }

    /// Factorizes `entry(i, j)`, an entry of A, with column scales C.
    ///
    /// # Errors
    /// [`SingularColumn`] where no pivot is left, or one is not a number.
    pub fn factorize(&mut self, column_scale: &[f64], entry: impl Fn(usize, usize) -> f64) -> Result<(), SingularColumn> {
        let n = self.exchanged.len();
        self.column_scale.copy_from_slice(column_scale);
        self.row_scale.fill(0.0);
        for j in 0..n {
            let column = self.factors.column_mut(j).iter_mut().zip(&mut self.row_scale);
            for (i, (place, largest)) in column.enumerate() {
                *place = entry(i, j) * column_scale[j];
                *largest = largest.max(place.abs());
            }
        }
        self.row_scale.iter_mut().for_each(|scale| *scale = if *scale > 0.0 { scale.recip() } else { 1.0 });
        for j in 0..n {
            self.factors.column_mut(j).iter_mut().zip(&self.row_scale).for_each(|(place, scale)| *place *= scale);
        }
        let threshold = n as f64 * f64::EPSILON;
        for k in 0..n {
            let column = &self.factors.column(k)[k..];
            let (offset, pivot) =
                column.iter().enumerate().fold((0, 0.0), |best, (i, x)| if x.abs() > best.1 { (i, x.abs()) } else { best });
            if pivot.is_nan() || pivot <= threshold * f64::MIN_POSITIVE.sqrt() || !pivot.is_finite() {
                return Err(SingularColumn(k));
            }
            self.exchanged[k] = k + offset;
            self.eliminate(k);
        }
        Ok(())
    }

    /// Exchanges rows and eliminates below the pivot of column k.
    fn eliminate(&mut self, k: usize) {
        let (n, other) = (self.exchanged.len(), self.exchanged[k]);
        let (before, after) = self.factors.as_mut_slice().split_at_mut((k + 1) * n);
        if other != k {
            (0..=k).for_each(|j| before.swap(j * n + k, j * n + other));
        }
        let multipliers = &mut before[k * n..];
        let inverse = multipliers[k].recip();
        multipliers[k + 1..].iter_mut().for_each(|x| *x *= inverse);
        for column in after.chunks_exact_mut(n) {
            column.swap(k, other);
            let top = column[k];
            if top != 0.0 {
                column[k + 1..].iter_mut().zip(&multipliers[k + 1..]).for_each(|(x, multiplier)| *x -= multiplier * top);
            }
        }
    }

    /// Replaces b by the solution of A x = b.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.exchanged.len();
        b.iter_mut().zip(&self.row_scale).for_each(|(b, scale)| *b *= scale);
        // rows of L were exchanged whole, so all exchanges come first
        (0..n).for_each(|k| b.swap(k, self.exchanged[k]));
        for k in 0..n {
            let (top, below) = b[k..].split_first_mut().expect("k < n");
            below.iter_mut().zip(&self.factors.column(k)[k + 1..]).for_each(|(x, l)| *x -= l * *top);
        }
        for k in (0..n).rev() {
            let column = self.factors.column(k);
            b[k] /= column[k];
            let x = b[k];
            b[..k].iter_mut().zip(&column[..k]).for_each(|(b, u)| *b -= u * x);
        }
        b.iter_mut().zip(&self.column_scale).for_each(|(x, scale)| *x *= scale);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_solve_badly_scaled_systems_that_need_exchanges() {
        let a = [[0.0, 2e6, 1.0], [1e-6, 0.0, 3e-6], [4.0, 5.0, 6.0]];
        let mut factors = Factorization::new(3);
        factors.factorize(&[1.0, 1e-3, 1e2], |i, j| a[i][j]).unwrap();
        for x in [[1.0, 2.0, 3.0], [-1.0, 0.5, 1e3]] {
            let mut b = a.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>());
            factors.solve(&mut b);
            for (found, x) in b.iter().zip(x) {
                assert!((found - x).abs() <= 1e-12 * x.abs(), "{found} {x}");
            }
        }
        // every column needs an exchange
        let n = 6;
        let entry =
            |i: usize, j: usize| ((7 * i * i + 3 * j * j + 5 * i * j + 1) % 11) as f64 - 4.0 + if (i + 1) % n == j { 20.0 } else { 0.0 };
        let mut factors = Factorization::new(n);
        factors.factorize(&[1.0; 6], entry).unwrap();
        let x: Vec<f64> = (0..n).map(|i| (i as f64 - 2.5).powi(3)).collect();
        let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| entry(i, j) * x[j]).sum()).collect();
        factors.solve(&mut b);
        assert!(b.iter().zip(&x).all(|(found, x)| (found - x).abs() < 1e-11), "{b:?}");
        let mut factors = Factorization::new(3);
        assert_eq!(factors.factorize(&[1.0; 3], |i, _| i as f64), Err(SingularColumn(1)));
        assert!(factors.factorize(&[1.0; 3], |_, _| f64::NAN).is_err());
    }
}
