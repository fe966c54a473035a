//! Ride comfort: weighted acceleration of a point under random excitation.
//!
//! ```text
//! a_w² = ∫ |W(f)|² |H_a(f)|² S(f) df from 0.5 to 80 Hz        a_v² = Σ k_i² a_w,i²
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | H_a | (m/s²)/m | response of the acceleration to the excitation |
//! | S | m²/Hz | one-sided spectral density of the excitation |
//! | W, k_i | – | weighting and factor of a direction |
//! | a_w, a_v | m/s² | weighted acceleration of a direction, of all of them; root mean squares |
//!
//! Source: ISO 2631-1 (1997), 6.1 and 6.5; V. Cossalter, A. Doria, S. Garbin, R. Lot, Vehicle System Dynamics 44 (2006) 299–313 (method); theory
//! manual 9.6. Models of rigid bodies say little above 20 Hz: what comes from there is told.

use crate::FrequencyResponse;
use crate::random::mean_squares;
use crate::weighting::Weighting;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Band of the weightings, Hz.
pub const BAND: (f64, f64) = (0.5, 80.0);
/// Frequency above which the share is told, Hz.
pub const TRUSTED: f64 = 20.0;

/// Share to which the mean squares are integrated.
const TOLERANCE: f64 = 1e-8;

/// How the acceleration in one direction counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// Frequency weighting.
    pub weighting: Weighting,
    /// Factor k in the sum over directions.
    pub factor: f64,
}

/// Weighted accelerations.
#[derive(Clone, Debug, PartialEq)]
pub struct Comfort {
    /// a_w of every direction, m/s².
    pub weighted: Vec<f64>,
    /// Root mean squares without weighting over the same band, m/s².
    pub unweighted: Vec<f64>,
    /// a_v, m/s².
    pub total: f64,
    /// Share of a_v² that comes from above [`TRUSTED`].
    pub share_above: f64,
}

/// Weighted accelerations under an excitation with the density `density` (m²/Hz at a frequency in Hz).
///
/// # Arguments
/// `response`: of one excitation; its outputs are the accelerations along `directions`.
///
/// # Panics
/// There are several excitations, or other directions than outputs.
pub fn comfort(response: &mut FrequencyResponse, directions: &[Direction], density: &dyn Fn(f64) -> f64) -> Comfort {
    assert_eq!((response.inputs.len(), response.outputs.len()), (1, directions.len()), "one excitation, an output per direction");
    let n = directions.len();
    let mut answers = vec![Complex::new(0.0, 0.0); n];
    // weighted, then unweighted
    let mut integrand = |frequency: f64, densities: &mut [f64]| {
        response.at(TAU * frequency, &mut answers);
        let excitation = density(frequency);
        for (k, (answer, direction)) in answers.iter().zip(directions).enumerate() {
            densities[n + k] = answer.norm_sqr() * excitation;
            densities[k] = densities[n + k] * direction.weighting.at(frequency).norm_sqr();
        }
    };
    let (mut below, mut above) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
    mean_squares(&mut integrand, (BAND.0, TRUSTED), TOLERANCE, &mut below);
    mean_squares(&mut integrand, (TRUSTED, BAND.1), TOLERANCE, &mut above);
    let sum = |squares: &[f64]| directions.iter().zip(squares).map(|(d, s)| d.factor * d.factor * s).sum::<f64>();
    let (low, high) = (sum(&below), sum(&above));
    let roots: Vec<f64> = below.iter().zip(&above).map(|(b, a)| (b + a).max(0.0).sqrt()).collect();
    let (weighted, unweighted) = roots.split_at(n);
    Comfort {
        weighted: weighted.to_vec(),
        unweighted: unweighted.to_vec(),
        total: (low + high).max(0.0).sqrt(),
        share_above: if low + high > 0.0 { high / (low + high) } else { 0.0 },
    }
}
