//! The algebraic Riccati equation of the linear-quadratic regulator.
//!
//! For `ẋ = A x + B u` and the cost `∫ xᵀQx + uᵀRu dt` the best feedback is `u = −K x`, `K = R⁻¹BᵀP`, with the stabilizing solution of
//!
//! ```text
//! AᵀP + P A − P G P + Q = 0,    G = B R⁻¹ Bᵀ
//! ```
//!
//! P spans the stable subspace of the Hamiltonian `H = [A −G; −Q −Aᵀ]`: with `W = sign(H)`, `[W₁₂; W₂₂ + 1] P = −[W₁₁ + 1; W₂₁]`. The sign is the limit
//! of `W ← (c W + (c W)⁻¹)/2`; one or more Newton steps then remove what rounding left: `A_cᵀΔ + Δ A_c + residual = 0`, by the same iteration.
//!
//! Source: J. D. Roberts, Int. J. Control 32 (1980) 677–687 (sign function, written in 1971); R. Byers, Linear Algebra Appl. 85 (1987) 267–279 (scaling);
//! D. L. Kleinman, IEEE Trans. Autom. Control 13 (1968) 114–115 (Newton). Held by the tests below.

use nalgebra::{Complex, DMatrix};
use thiserror::Error;

/// Most iterations for the sign of a matrix; it converges quadratically.
const MOST: usize = 60;

/// Relative change at which the sign iteration has converged.
const SETTLED: f64 = 1e-13;

/// Largest relative residual of an accepted solution.
const ACCURATE: f64 = 1e-9;

/// The solution and its feedback.
#[derive(Clone, Debug)]
pub struct Riccati {
    /// P, symmetric, not negative: `xᵀPx` is the cost to go.
    pub P: DMatrix<f64>,
    /// K, inputs by states.
    pub K: DMatrix<f64>,
    /// `A − B K`.
    pub closed: DMatrix<f64>,
    /// Norm of the residual over the sum of the norms of its terms.
    pub residual: f64,
}

/// Why there is no stabilizing feedback.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RiccatiError {
    /// The weights of the inputs are not positive.
    #[error("the weights of the inputs must be positive")]
    Weights,
    /// An entry is not finite.
    #[error("the matrices have entries that are not finite")]
    NotFinite,
    /// An unstable or neutral motion that no input reaches, or one that the cost does not see on the imaginary axis.
    #[error("no feedback stabilizes this model: some unstable motion cannot be reached by the input, or a neutral one is without weight")]
    NotStabilizable,
    /// The equations are not solved.
    #[error("the Riccati equation is not solved: relative residual {residual:.1e}")]
    Inaccurate {
        /// Relative residual.
        residual: f64,
    },
}

/// Solves the Riccati equation for `ẋ = A x + B u` with weights Q (symmetric, not negative) and R (symmetric, positive).
///
/// `nominal` are typical magnitudes of the states: the iteration works in them.
///
/// # Errors
/// See [`RiccatiError`].
///
/// # Cost
/// O(n³), some twenty inversions of a matrix of twice the size; allocates.
pub fn riccati(
    (A, B): (&DMatrix<f64>, &DMatrix<f64>),
    (Q, R): (&DMatrix<f64>, &DMatrix<f64>),
    nominal: &[f64],
) -> Result<Riccati, RiccatiError> {
    let n = A.nrows();
    if [A, B, Q, R].iter().any(|m| m.iter().any(|e| !e.is_finite())) {
        return Err(RiccatiError::NotFinite);
    }
    let inverse_R = R.clone().cholesky().ok_or(RiccatiError::Weights)?.inverse();
    let scale = |m: &DMatrix<f64>, left: &dyn Fn(usize) -> f64, right: &dyn Fn(usize) -> f64| {
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] * left(i) * right(j))
    };
    let (up, down) = (|i: usize| nominal[i], |i: usize| 1.0 / nominal[i]);
    let (a, b, q) = (scale(A, &down, &up), scale(B, &down, &|_| 1.0), scale(Q, &up, &up));
    let g = &b * &inverse_R * b.transpose();
    let mut hamiltonian = DMatrix::zeros(2 * n, 2 * n);
    hamiltonian.view_mut((0, 0), (n, n)).copy_from(&a);
    hamiltonian.view_mut((0, n), (n, n)).copy_from(&-&g);
    hamiltonian.view_mut((n, 0), (n, n)).copy_from(&-&q);
    hamiltonian.view_mut((n, n), (n, n)).copy_from(&-a.transpose());
    let w = sign(hamiltonian).ok_or(RiccatiError::NotStabilizable)?;
    let one = DMatrix::identity(n, n);
    let (mut left, mut right) = (DMatrix::zeros(2 * n, n), DMatrix::zeros(2 * n, n));
    left.rows_mut(0, n).copy_from(&w.view((0, n), (n, n)));
    left.rows_mut(n, n).copy_from(&(w.view((n, n), (n, n)) + &one));
    right.rows_mut(0, n).copy_from(&-(w.view((0, 0), (n, n)) + &one));
    right.rows_mut(n, n).copy_from(&-w.view((n, 0), (n, n)));
    let qr = left.qr();
    let mut p = qr.r().solve_upper_triangular(&(qr.q().transpose() * right)).ok_or(RiccatiError::NotStabilizable)?;
    let mut relative = f64::INFINITY;
    for _ in 0..4 {
        p = (&p + p.transpose()) * 0.5;
        let (terms, residual) = terms((&a, &g, &q), &p);
        let now = residual.norm() / terms;
        if now.is_nan() || now >= 0.5 * relative {
            break;
        }
        relative = now;
        let closed = &a - &g * &p;
        match lyapunov(&closed, &residual) {
            Some(correction) => p += correction,
            None => break,
        }
    }
    p = (&p + p.transpose()) * 0.5;
    let (size, residual) = terms((&a, &g, &q), &p);
    let residual = residual.norm() / size;
    let P = scale(&p, &down, &down);
    let K = &inverse_R * B.transpose() * &P;
    let closed = A - B * &K;
    let stable = closed.complex_eigenvalues().iter().all(|s: &Complex<f64>| s.re < 0.0);
    match (residual < ACCURATE, stable) {
        (true, true) => Ok(Riccati { P, K, closed, residual }),
        (_, false) => Err(RiccatiError::NotStabilizable),
        (false, true) => Err(RiccatiError::Inaccurate { residual }),
    }
}

/// Sum of the norms of the terms, and the residual.
fn terms((a, g, q): (&DMatrix<f64>, &DMatrix<f64>, &DMatrix<f64>), p: &DMatrix<f64>) -> (f64, DMatrix<f64>) {
    let (pa, pgp) = (p * a, p * g * p);
    (2.0 * pa.norm() + pgp.norm() + q.norm(), &pa + pa.transpose() - pgp + q)
}

/// The sign of a matrix without eigenvalues on the imaginary axis; `None` where it has some.
fn sign(mut w: DMatrix<f64>) -> Option<DMatrix<f64>> {
    for _ in 0..MOST {
        let inverse = w.clone().try_inverse().filter(|i| i.iter().all(|e| e.is_finite()))?;
        let c = (inverse.norm() / w.norm()).sqrt();
        let next = (&w * c + inverse / c) * 0.5;
        let change = (&next - &w).norm() / next.norm();
        w = next;
        if change < SETTLED {
            return Some(w);
        }
    }
    // what circles around rounding has converged, what wanders has not
    ((&w * &w) - DMatrix::identity(w.nrows(), w.nrows())).norm().le(&1e-6).then_some(w)
}

/// Solves `AᵀX + X A + C = 0` for a stable A.
pub(super) fn lyapunov(A: &DMatrix<f64>, C: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut a, mut c) = (A.clone(), C.clone());
    for _ in 0..MOST {
        let inverse = a.clone().try_inverse().filter(|i| i.iter().all(|e| e.is_finite()))?;
        let s = (inverse.norm() / a.norm()).sqrt();
        let next = (&a * s + &inverse / s) * 0.5;
        c = (&c * s + inverse.transpose() * &c * &inverse / s) * 0.5;
        let change = (&next - &a).norm() / next.norm();
        a = next;
        if change < SETTLED {
            return Some(c * 0.5);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(A: &DMatrix<f64>, B: &DMatrix<f64>, Q: &DMatrix<f64>, R: f64) -> Result<Riccati, RiccatiError> {
        riccati((A, B), (Q, &DMatrix::from_element(1, 1, R)), &vec![1.0; A.nrows()])
    }

    #[test]
    fn a_double_integrator_has_its_textbook_solution() {
        // P = [√3 1; 1 √3], K = (1, √3): B. D. O. Anderson, J. B. Moore, Optimal Control, 1990
        let (A, B) = (DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]), DMatrix::from_row_slice(2, 1, &[0.0, 1.0]));
        let found = solve(&A, &B, &DMatrix::identity(2, 2), 1.0).unwrap();
        let root = 3.0_f64.sqrt();
        let expected = DMatrix::from_row_slice(2, 2, &[root, 1.0, 1.0, root]);
        assert!((found.P - expected).norm() < 1e-13);
    }

    #[test]
    fn an_unstable_pole_without_state_weight_is_mirrored() {
        let (A, B) = (DMatrix::from_element(1, 1, 3.0), DMatrix::from_element(1, 1, 2.0));
        let found = solve(&A, &B, &DMatrix::zeros(1, 1), 1.0).unwrap();
        assert!((found.closed[(0, 0)] + 3.0).abs() < 1e-12);
    }

    #[test]
    fn stiff_models_in_mixed_units_are_solved() {
        // relaxation at 4000 1/s beside an unstable motion at 3 1/s and a chain of integrators
        let A = DMatrix::from_row_slice(4, 4, &[0.0, 25.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 9.0, 0.0, 1e-3, 0.0, 0.0, 1e5, -4e3]);
        let B = DMatrix::from_row_slice(4, 1, &[0.0, 0.0, 0.4, 3e4]);
        let Q = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![10.0, 400.0, 0.0, 0.0]));
        let found = riccati((&A, &B), (&Q, &DMatrix::from_element(1, 1, 1.0 / 400.0)), &[1.0, 0.1, 1.0, 1e3]).unwrap();
        assert!(found.residual < 1e-12, "{:e}", found.residual);
    }

    #[test]
    fn what_no_input_reaches_is_refused() {
        let (A, B) = (DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -1.0]), DMatrix::from_row_slice(2, 1, &[0.0, 1.0]));
        assert_eq!(solve(&A, &B, &DMatrix::identity(2, 2), 1.0).unwrap_err(), RiccatiError::NotStabilizable);
        let (zero, one) = (DMatrix::zeros(1, 1), DMatrix::from_element(1, 1, 1.0));
        assert_eq!(solve(&zero, &one, &zero, 1.0).unwrap_err(), RiccatiError::NotStabilizable);
        assert_eq!(solve(&zero, &one, &one, -1.0).unwrap_err(), RiccatiError::Weights);
    }
}
