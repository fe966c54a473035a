//! Eigenvalues and vectors of pencils that are known by hand.

#![allow(non_snake_case)]

use analyses::eigen::{DEFECTIVE, EigenError, Spectrum, pencil};
use nalgebra::{Complex, DMatrix};

fn spectrum(E: &DMatrix<f64>, A: &DMatrix<f64>) -> Spectrum {
    pencil(E, A, &vec![1.0; A.nrows()]).unwrap_or_else(|error| panic!("{error}"))
}

fn complex(m: &DMatrix<f64>) -> DMatrix<Complex<f64>> {
    m.map(|e| Complex::new(e, 0.0))
}

/// `A V = E V S` and `Wᴴ E V = 1`, both to rounding.
fn holds(E: &DMatrix<f64>, A: &DMatrix<f64>, found: &Spectrum) {
    let (A, E) = (complex(A), complex(E));
    let S = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(found.values.clone()));
    assert!((&A * &found.right - &E * &found.right * S).norm() < 1e-12 * A.norm() * found.right.norm());
    let identity = found.left.adjoint() * &E * &found.right;
    assert!((&identity - DMatrix::identity(A.nrows(), A.nrows())).norm() < 1e-11, "{identity}");
    assert!(found.residual < 1e-13, "{}", found.residual);
}

/// Two oscillators and two decays, mixed by a matrix without structure.
fn mixed() -> (DMatrix<f64>, DMatrix<f64>) {
    let mut D = DMatrix::zeros(6, 6);
    D.view_mut((0, 0), (2, 2)).copy_from(&DMatrix::from_row_slice(2, 2, &[-1.0, 5.0, -5.0, -1.0]));
    D.view_mut((2, 2), (2, 2)).copy_from(&DMatrix::from_row_slice(2, 2, &[0.5, 20.0, -20.0, 0.5]));
    D[(4, 4)] = -300.0;
    D[(5, 5)] = 0.02;
    let X = DMatrix::from_fn(6, 6, |i, j| ((3 * i + 5 * j * j + i * j) as f64).sin() + if i == j { 2.0 } else { 0.0 });
    let E = DMatrix::from_fn(6, 6, |i, j| 1.0 / (1.0 + (i + 2 * j) as f64) + if i == j { 1.0 } else { 0.0 });
    let A = &E * &X * D * X.try_inverse().expect("regular");
    (E, A)
}

#[test]
fn values_come_in_order_and_vectors_satisfy_their_equations() {
    let (E, A) = mixed();
    let found = spectrum(&E, &A);
    let expected = [(0.5, 20.0), (0.5, -20.0), (-1.0, 5.0), (-1.0, -5.0), (-300.0, 0.0), (0.02, 0.0)];
    for (value, (re, im)) in found.values.iter().zip(expected) {
        assert!((value - Complex::new(re, im)).norm() < 1e-11, "{value} instead of {re} {im:+}i");
    }
    assert_eq!(found.values[0], found.values[1].conj());
    holds(&E, &A, &found);
}

#[test]
fn units_do_not_matter() {
    let (E, A) = mixed();
    let plain = spectrum(&E, &A);
    let (rows, columns) = ([1e9, 1.0, 1e-7, 1e3, 1.0, 1e-2], [1e-6, 1e4, 1.0, 1e-3, 1e8, 1.0]);
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(6, 6, |i, j| m[(i, j)] * rows[i] / columns[j]);
    let (E, A) = (scaled(&E), scaled(&A));
    for found in [pencil(&E, &A, &columns), pencil(&E, &A, &[1.0; 6])] {
        let found = found.expect("eigenvalues");
        for (a, b) in found.values.iter().zip(&plain.values) {
            assert!((a - b).norm() < 1e-10 * b.norm().max(1.0), "{a} instead of {b}");
        }
    }
    let found = pencil(&E, &A, &columns).expect("eigenvalues");
    assert!((found.condition / plain.condition - 1.0).abs() < 1e-9, "{} {}", found.condition, plain.condition);
}

#[test]
fn an_eigenvalue_may_occur_several_times() {
    // two equal oscillators and two equal decays, not diagonal
    let mut D = DMatrix::zeros(6, 6);
    for k in [0, 2] {
        D.view_mut((k, k), (2, 2)).copy_from(&DMatrix::from_row_slice(2, 2, &[0.0, 3.0, -3.0, 0.0]));
    }
    (D[(4, 4)], D[(5, 5)]) = (-2.0, -2.0);
    let found = spectrum(&DMatrix::identity(6, 6), &D);
    holds(&DMatrix::identity(6, 6), &D, &found);
}

#[test]
fn a_defective_eigenvalue_is_seen() {
    // a free mass: two zeros, one vector
    let found = spectrum(&DMatrix::identity(2, 2), &DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]));
    assert_eq!(found.values, [Complex::new(0.0, 0.0); 2]);
    assert!(found.sensitivity.iter().all(|s| *s > DEFECTIVE), "{:?}", found.sensitivity);
    assert!(found.left.iter().all(|e| e.re.is_finite()), "{}", found.left);
}

#[test]
fn refusals() {
    assert_eq!(
        pencil(&DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, 1.0]), &DMatrix::identity(2, 2), &[1.0; 2]).err(),
        Some(EigenError::Singular)
    );
    assert_eq!(pencil(&DMatrix::identity(1, 1), &DMatrix::from_row_slice(1, 1, &[f64::NAN]), &[1.0]).err(), Some(EigenError::NotFinite));
    assert!(spectrum(&DMatrix::zeros(0, 0), &DMatrix::zeros(0, 0)).values.is_empty());
}
