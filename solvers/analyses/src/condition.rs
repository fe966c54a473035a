//! How nearly singular a matrix is, for the price of a factorization.
//!
//! QR with column pivoting: `|R₁₁| / |Rₙₙ|` is never larger than the condition number, and in practice not smaller by more than a factor of n.
//!
//! Source: G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins 2013, 5.4.2; N. J. Higham, SIAM Rev. 29 (1987) 575–596.

use nalgebra::DMatrix;

/// The estimate; infinite for a singular matrix, 1 for an empty one.
pub(crate) fn condition(M: &DMatrix<f64>) -> f64 {
    if M.is_empty() {
        return 1.0;
    }
    let diagonal = M.clone().col_piv_qr().r().diagonal().map(f64::abs);
    diagonal.max() / diagonal.min()
}

#[cfg(test)]
mod tests {
    use super::condition;
    use nalgebra::DMatrix;

    #[test]
    fn the_estimate_is_near_the_quotient_of_singular_values() {
        for n in 1..9 {
            // Hilbert's matrix: 1 to 1.5e10
            let hilbert = DMatrix::from_fn(n, n, |i, j| 1.0 / (i + j + 1) as f64);
            let values = hilbert.singular_values();
            let (estimate, exact) = (condition(&hilbert), values.max() / values.min());
            assert!(estimate <= exact * (1.0 + 1e-6) && estimate * n as f64 >= exact, "{n}: {estimate:e} for {exact:e}");
        }
        assert!(condition(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0])) > 1e15);
    }
}
