//! Weights of the curvature that lies ahead.

use nalgebra::{DMatrix, DVector};

/// Steps of the kernel within one interval of the samples.
const FINE: usize = 24;

/// A sum over samples of the path ahead: `Σ weights[i] Δκ(t_i)` with `t_i = i·interval`, Δκ the curvature beside that of the design, 1/m.
///
/// The weights are integrals of the kernel with cubic Hermite polynomials whose slopes are those of parabolas through three neighbors: exact for every quadratic Δκ, and
/// alike at every sample, so that what passes by a sample is felt no more than what passes between two.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// Time between two samples, s.
    pub interval: f64,
    /// Weights, in units of the input times m.
    pub weights: Vec<f64>,
    /// Largest size of the kernel in the last interval over its largest size: what a longer preview would still see.
    pub tail: f64,
}

/// Adds a weight of the slope at a node (per interval): that of the parabola through it and its neighbors.
fn add_slope(weights: &mut [f64], node: usize, weight: f64) {
    let last = weights.len() - 1;
    let (from, shares) = match node {
        0 => (0, [-1.5, 2.0, -0.5]),
        node if node == last => (last - 2, [0.5, -2.0, 1.5]),
        node => (node - 1, [-0.5, 0.0, 0.5]),
    };
    weights[from..].iter_mut().zip(shares).for_each(|(w, share)| *w += weight * share);
}

impl Preview {
    /// Weights of the kernel `G exp(A_cᵀ τ) h`: G one row (`R⁻¹Bᵀ`).
    pub(super) fn of((closed, G): (&DMatrix<f64>, &DMatrix<f64>), h: &DVector<f64>, (horizon, intervals): (f64, usize)) -> Self {
        let intervals = intervals.max(2);
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
        for first in 0..intervals {
            for k in 0..=FINE {
                // Simpson's rule over the kernel times a polynomial
                let simpson = match k {
                    0 | FINE => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                } * fine
                    / 3.0;
                let x = k as f64 / FINE as f64;
                let share = simpson * kernel[first * FINE + k];
                weights[first] += share * (1.0 + 2.0 * x) * (1.0 - x).powi(2);
                weights[first + 1] += share * x * x * (3.0 - 2.0 * x);
                add_slope(&mut weights, first, share * x * (1.0 - x).powi(2));
                add_slope(&mut weights, first + 1, -share * x * x * (1.0 - x));
            }
        }
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
        let (all, last) = (largest(&kernel), largest(&kernel[(intervals - 1) * FINE..]));
        Self { interval, weights, tail: if all > 0.0 { last / all } else { 0.0 } }
    }
}
