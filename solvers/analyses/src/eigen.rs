//! Eigenvalues of a linear model with right and left vectors.
//!
//! `A v = s E v`, `wᴴ A = s wᴴ E`, `wᴴ E v = 1`. E is regular, so the problem is that of `M = T⁻¹ E⁻¹ A T` with a diagonal T: nominal values of
//! the states times powers of two that balance rows and columns. With x, y the vectors of M: `v = T x`, `Eᴴ w = T⁻¹ y`.
//!
//! Vectors of one eigenvalue that occurs several times are made biorthogonal together: `W ← W P⁻ᴴ` with `P = Wᴴ E V`.
//!
//! Source: G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins 2013, 7.2.2 (sensitivity), 7.5 (QR, balancing);
//! QR iteration and back-substitution by `faer`.

use crate::{LinearModel, condition};
use faer::linalg::evd::{ComputeEigenvectors, evd_real, evd_scratch};
use faer::{Mat, MatRef, Par, diag::Diag, dyn_stack::MemBuffer, dyn_stack::MemStack};
use nalgebra::{Complex, DMatrix};
use thiserror::Error;

/// Largest relative residual of a vector that counts as solved.
const ACCURATE: f64 = 1e-10;

/// Eigenvalues closer than this, relative to their magnitude and that of the matrix, are one that occurs several times.
const SAME: f64 = 1e-12;

/// Condition of an eigenvalue above which its vectors are those of a defective one: there are fewer vectors than eigenvalues.
pub const DEFECTIVE: f64 = 1e7;

/// All eigenvalues of `A v = s E v`.
///
/// Order: oscillations by frequency, fastest first, each pair with the positive imaginary part first; then the real ones, from the most
/// negative to the most positive.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Eigenvalues, 1/s.
    pub values: Vec<Complex<f64>>,
    /// Right vectors v, one per column.
    pub right: DMatrix<Complex<f64>>,
    /// Left vectors w, one per column, `wᴴ E v = 1` (unit length where defective).
    pub left: DMatrix<Complex<f64>>,
    /// Condition `‖y‖ ‖x‖ / |yᴴ x|` of every eigenvalue in balanced states: how much it moves with the entries of M.
    pub sensitivity: Vec<f64>,
    /// Condition of E in nominal states, rows scaled to one, as QR with column pivoting estimates it.
    pub condition: f64,
    /// Largest residual `‖A v − s E v‖` and `‖Aᴴ w − s̄ Eᴴ w‖` over all vectors, relative to the size of the terms.
    pub residual: f64,
}

/// Why eigenvalues cannot be found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EigenError {
    /// E is singular.
    #[error("no inertia: some states have no rate of their own")]
    Singular,
    /// An entry is not finite.
    #[error("the matrices have entries that are not finite")]
    NotFinite,
    /// The QR iteration did not end.
    #[error("the iteration for eigenvalues did not converge")]
    NotConverged,
    /// The vectors do not satisfy the equations.
    #[error("eigenvalues are not accurate: relative residual {residual:.1e}")]
    Inaccurate {
        /// Largest relative residual.
        residual: f64,
    },
}

/// Eigenvalues and vectors of a linear model.
///
/// # Errors
/// Singular E, entries that are not finite, no convergence or vectors that fail the check of their residual.
///
/// # Cost
/// O(n³): about 25 n³ operations.
pub fn eigen(model: &LinearModel) -> Result<Spectrum, EigenError> {
    let nominal: Vec<f64> = model.states.iter().map(|s| s.nominal).collect();
    pencil(&model.E, &model.A, &nominal)
}

/// Eigenvalues and vectors of `A v = s E v`; `nominal` are typical magnitudes of the entries of v.
///
/// # Errors
/// See [`eigen`].
pub fn pencil(E: &DMatrix<f64>, A: &DMatrix<f64>, nominal: &[f64]) -> Result<Spectrum, EigenError> {
    let n = A.nrows();
    if E.iter().chain(A.iter()).any(|e| !e.is_finite()) {
        return Err(EigenError::NotFinite);
    }
    if n == 0 {
        let none = || Vectors::zeros(0, 0);
        return Ok(Spectrum { values: Vec::new(), right: none(), left: none(), sensitivity: Vec::new(), condition: 1.0, residual: 0.0 });
    }
    let condition = condition(E, nominal);
    let lu = E.clone().lu();
    let mut M = lu.solve(A).filter(|_| condition < 1e15).ok_or(EigenError::Singular)?;
    let mut T = nominal.to_vec();
    similar(&mut M, &T);
    for (t, b) in T.iter_mut().zip(balance(&mut M)) {
        *t *= b;
    }
    let (values, X, Y) = evd(&M)?;
    let (values, X, Y) = sorted(&values, &X, &Y);
    let scaled =
        |vectors: &DMatrix<Complex<f64>>, factor: &dyn Fn(usize) -> f64| DMatrix::from_fn(n, n, |i, j| vectors[(i, j)] * factor(i));
    let right = scaled(&X, &|i| T[i]);
    let left = scaled(&Y, &|i| 1.0 / T[i]);
    let transposed = E.transpose().lu();
    let solve = |part: DMatrix<f64>| transposed.solve(&part).ok_or(EigenError::Singular);
    let (re, im) = (solve(left.map(|z| z.re))?, solve(left.map(|z| z.im))?);
    let mut left = re.zip_map(&im, Complex::new);
    let sensitivity = (0..n).map(|k| X.column(k).norm() * Y.column(k).norm() / Y.column(k).dotc(&X.column(k)).norm()).collect::<Vec<_>>();
    let size = M.norm();
    let moved = times(E, &right);
    for group in groups(&values, size) {
        biorthogonal(&mut left, &moved, &group);
    }
    let residual = residual((E, A), &T, &values, &right, &left);
    match residual < ACCURATE {
        true => Ok(Spectrum { values, right, left, sensitivity, condition, residual }),
        false => Err(EigenError::Inaccurate { residual }),
    }
}

/// Condition of E in nominal states, every row divided by its largest entry.
fn condition(E: &DMatrix<f64>, nominal: &[f64]) -> f64 {
    let mut scaled = E.clone();
    for (mut column, t) in scaled.column_iter_mut().zip(nominal) {
        column *= *t;
    }
    for mut row in scaled.row_iter_mut() {
        let largest = row.amax();
        row /= if largest > 0.0 { largest } else { 1.0 };
    }
    condition::condition(&scaled)
}

/// `M ← T⁻¹ M T`.
pub(crate) fn similar(M: &mut DMatrix<f64>, T: &[f64]) {
    for (j, column_scale) in T.iter().enumerate() {
        for (i, row_scale) in T.iter().enumerate() {
            M[(i, j)] *= column_scale / row_scale;
        }
    }
}

/// Balances rows and columns by powers of two (Parlett and Reinsch); returns the factors T of `M ← T⁻¹ M T`.
pub(crate) fn balance(M: &mut DMatrix<f64>) -> Vec<f64> {
    let n = M.nrows();
    let mut T = vec![1.0; n];
    // a few sweeps bring all there is to gain
    for _ in 0..8 {
        let mut changed = false;
        for i in 0..n {
            let (mut row, mut column) = (0.0, 0.0);
            for j in (0..n).filter(|&j| j != i) {
                row += M[(i, j)].abs();
                column += M[(j, i)].abs();
            }
            if row == 0.0 || column == 0.0 {
                continue;
            }
            let factor = (0.5 * (row / column).log2()).round().exp2();
            if factor != 1.0 && column * factor + row / factor < 0.95 * (row + column) {
                M.column_mut(i).scale_mut(factor);
                M.row_mut(i).scale_mut(1.0 / factor);
                T[i] *= factor;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    T
}

type Vectors = DMatrix<Complex<f64>>;

/// Eigenvalues, right and left vectors of a real matrix, in the order in which they are found.
fn evd(M: &DMatrix<f64>) -> Result<(Vec<Complex<f64>>, Vectors, Vectors), EigenError> {
    let n = M.nrows();
    let (mut re, mut im) = (Diag::zeros(n), Diag::zeros(n));
    let (mut left, mut right) = (Mat::zeros(n, n), Mat::zeros(n, n));
    let (wanted, par) = (ComputeEigenvectors::Yes, Par::Seq);
    let mut memory = MemBuffer::new(evd_scratch::<f64>(n, wanted, wanted, par, Default::default()));
    evd_real(
        MatRef::from_column_major_slice(M.as_slice(), n, n),
        re.as_mut(),
        im.as_mut(),
        Some(left.as_mut()),
        Some(right.as_mut()),
        par,
        MemStack::new(&mut memory),
        Default::default(),
    )
    .map_err(|_| EigenError::NotConverged)?;
    let mut values: Vec<Complex<f64>> = (0..n).map(|k| Complex::new(re.column_vector()[k], im.column_vector()[k])).collect();
    for k in 1..n {
        if values[k - 1].im > 0.0 {
            values[k] = values[k - 1].conj();
        }
    }
    Ok((values.clone(), complex(&values, &right), complex(&values, &left)))
}

/// A pair of conjugate eigenvalues has real and imaginary part of one vector in two columns.
fn complex(values: &[Complex<f64>], parts: &Mat<f64>) -> Vectors {
    let n = values.len();
    let mut vectors = Vectors::zeros(n, n);
    let mut k = 0;
    while k < n {
        let pair = values[k].im != 0.0 && k + 1 < n;
        for i in 0..n {
            let entry = Complex::new(parts[(i, k)], if pair { parts[(i, k + 1)] } else { 0.0 });
            vectors[(i, k)] = entry;
            if pair {
                vectors[(i, k + 1)] = entry.conj();
            }
        }
        k += if pair { 2 } else { 1 };
    }
    vectors
}

/// Brings eigenvalues into the order of [`Spectrum`], and makes the right vectors unique: the largest entry is 1.
fn sorted(values: &[Complex<f64>], right: &Vectors, left: &Vectors) -> (Vec<Complex<f64>>, Vectors, Vectors) {
    // pairs stay together: they are sorted by their first, whose conjugate follows it
    let mut leads: Vec<usize> = (0..values.len()).filter(|&k| values[k].im >= 0.0).collect();
    leads.sort_by(|&a, &b| values[b].im.total_cmp(&values[a].im).then((values[a].re + 0.0).total_cmp(&(values[b].re + 0.0))));
    let order: Vec<usize> = leads.into_iter().flat_map(|k| if values[k].im > 0.0 { k..k + 2 } else { k..k + 1 }).collect();
    let pick = |vectors: &Vectors| DMatrix::from_fn(values.len(), values.len(), |i, j| vectors[(i, order[j])]);
    let mut right = pick(right);
    for mut column in right.column_iter_mut() {
        // the first of equal entries, so that rounding does not choose
        let largest = column.iter().fold(Complex::new(0.0, 0.0), |a, b| if b.norm() > a.norm() * (1.0 + 1e-9) { *b } else { a });
        if largest.norm() > 0.0 {
            column.iter_mut().for_each(|e| *e /= largest);
        }
    }
    (order.iter().map(|&k| values[k]).collect(), right, pick(left))
}

/// Runs of eigenvalues that are one and the same.
fn groups(values: &[Complex<f64>], size: f64) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, value) in values.iter().enumerate() {
        let same = |group: &Vec<usize>| (values[group[0]] - value).norm() <= SAME * (size + value.norm());
        match groups.iter_mut().find(|g| same(g)) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    groups
}

/// A real matrix times complex vectors.
fn times(M: &DMatrix<f64>, vectors: &Vectors) -> Vectors {
    let n = vectors.ncols();
    let parts = DMatrix::from_fn(vectors.nrows(), 2 * n, |i, j| if j < n { vectors[(i, j)].re } else { vectors[(i, j - n)].im });
    let product = M * parts;
    DMatrix::from_fn(M.nrows(), n, |i, j| Complex::new(product[(i, j)], product[(i, j + n)]))
}

/// Makes `Wᴴ E V = 1` for the vectors of one eigenvalue, `moved` being E times all V; leaves them at unit length where it is defective.
fn biorthogonal(left: &mut Vectors, moved: &Vectors, group: &[usize]) {
    let W = left.select_columns(group);
    let P = W.adjoint() * moved.select_columns(group);
    let inverse = P.clone().try_inverse().filter(|i| i.iter().all(|e| e.re.is_finite() && e.im.is_finite()));
    let unit = || DMatrix::from_fn(group.len(), group.len(), |i, j| Complex::new(if i == j { 1.0 / W.column(i).norm() } else { 0.0 }, 0.0));
    let normalized = &W * inverse.filter(|i| i.norm() * P.norm() < DEFECTIVE).map_or_else(unit, |i| i.adjoint());
    for (k, &column) in group.iter().enumerate() {
        left.column_mut(column).copy_from(&normalized.column(k));
    }
}

/// Largest residual of all vectors, relative to the norms of the matrices, in units: rows of length one, balanced columns T.
fn residual((E, A): (&DMatrix<f64>, &DMatrix<f64>), T: &[f64], values: &[Complex<f64>], right: &Vectors, left: &Vectors) -> f64 {
    let n = values.len();
    let row_scale: Vec<f64> = (0..n).map(|i| (0..n).map(|j| (A[(i, j)].abs() + E[(i, j)].abs()) * T[j]).fold(0.0, f64::max)).collect();
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| m[(i, j)] * T[j] / row_scale[i]);
    let (A, E) = (scaled(A), scaled(E));
    let (size_A, size_E) = (A.norm(), E.norm());
    let X = DMatrix::from_fn(n, n, |i, j| right[(i, j)] / T[i]);
    let W = DMatrix::from_fn(n, n, |i, j| left[(i, j)] * row_scale[i]);
    let (right, left) = ((times(&A, &X), times(&E, &X)), (times(&A.transpose(), &W), times(&E.transpose(), &W)));
    let relative = |(Av, Ev): &(Vectors, Vectors), v: &Vectors, k: usize, s: Complex<f64>| {
        (Av.column(k) - Ev.column(k) * s).norm() / ((size_A + size_E * s.norm()) * v.column(k).norm())
    };
    let both = values.iter().enumerate().map(|(k, s)| relative(&right, &X, k, *s).max(relative(&left, &W, k, s.conj())));
    both.fold(0.0, |worst: f64, r| if r > worst || r.is_nan() { r } else { worst })
}
