//! Weights of the curvature that lies ahead.

use nalgebra::{DMatrix, DVector};

/// Steps of the kernel within one interval of the samples.
const FINE: usize = 24;

/// A sum over samples of the path ahead: `Σ weights[i] Δκ(t_i)` with `t_i = i·interval`, Δκ the curvature beside that of the design, 1/m.
///
/// The weights are integrals of the kernel with the quadratic Lagrange polynomials of pairs of intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// Time between two samples, s.
    pub interval: f64,
    /// Weights, in units of the input times m.
    pub weights: Vec<f64>,
    /// Largest size of the kernel in the last interval over its largest size: what a longer preview would still see.
    pub tail: f64,
}

impl Preview {
    /// Weights of the kernel `G exp(A_cᵀ τ) h`: G one row (`R⁻¹Bᵀ`).
    pub(super) fn of((closed, G): (&DMatrix<f64>, &DMatrix<f64>), h: &DVector<f64>, (horizon, intervals): (f64, usize)) -> Self {
        let intervals = intervals.next_multiple_of(2).max(2);
        let interval = horizon / intervals as f64;
        let fine = interval / FINE as f64;
        let step = (closed.transpose() * fine).exp();
        // G exp(A_cᵀ τ) at all fine steps: a row that is multiplied on
        let mut row = G.clone();
        let mut kernel = Vec::with_capacity(intervals * FINE + 1);
        for _ in 0..=intervals * FINE {
            kernel.push((&row * h)[0]);
            row *= &step;
        }
        let mut weights = vec![0.0; intervals + 1];
        for pair in 0..intervals / 2 {
            let first = 2 * pair;
            for k in 0..=2 * FINE {
                // Simpson's rule over the kernel times a polynomial
                let simpson = match k {
                    0 => 1.0,
                    k if k == 2 * FINE => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                } * fine
                    / 3.0;
                let x = k as f64 / FINE as f64;
                let polynomials = [0.5 * (x - 1.0) * (x - 2.0), x * (2.0 - x), 0.5 * x * (x - 1.0)];
                for (node, polynomial) in polynomials.iter().enumerate() {
                    weights[first + node] += simpson * polynomial * kernel[first * FINE + k];
                }
            }
        }
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
        let (all, last) = (largest(&kernel), largest(&kernel[(intervals - 1) * FINE..]));
        Self { interval, weights, tail: if all > 0.0 { last / all } else { 0.0 } }
    }
}
