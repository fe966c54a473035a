//! Mean squares of random vibrations: integrals of spectral densities over a band of frequencies.
//!
//! ```text
//! σ² = ∫ |H(f)|² S(f) df = ∫ f |H(f)|² S(f) d(ln f)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | f | Hz | frequency |
//! | H | output / input | frequency response |
//! | S | input² / Hz | one-sided spectral density of the input |
//! | σ² | output² | mean square of the output over the band |
//!
//! Source: D. E. Newland, *Random Vibrations, Spectral and Wavelet Analysis*, 3rd ed., Longman 1993, chapter 7. Stationary vibrations of linear systems.

/// Refinements of the steps after which the integral is taken as it is.
const MOST_REFINEMENTS: u32 = 14;

/// Integrals of several densities over one band, by Simpson's rule on a logarithmic scale, halving the steps until none changes by more than `tolerance`
/// of the largest.
///
/// # Arguments
/// `density`: writes the densities at a frequency (Hz), one per entry of `integrals`. `band`: its ends, Hz, positive. `tolerance`: share of the largest
/// integral.
pub fn mean_squares(density: &mut dyn FnMut(f64, &mut [f64]), (low, high): (f64, f64), tolerance: f64, integrals: &mut [f64]) {
    let length = (high / low).ln();
    let mut sample = vec![0.0; integrals.len()];
    // sums of f S(f) at the points of the trapezoidal rule
    let mut sums = vec![0.0; integrals.len()];
    for (end, weight) in [(low, 0.5), (high, 0.5)] {
        density(end, &mut sample);
        sums.iter_mut().zip(&sample).for_each(|(sum, s)| *sum += weight * end * s);
    }
    let mut trapezoids: Vec<f64> = sums.iter().map(|sum| length * sum).collect();
    integrals.copy_from_slice(&trapezoids);
    for refinement in 0..MOST_REFINEMENTS {
        let steps = 1_u32 << refinement;
        for k in 0..steps {
            let frequency = low * (length * (f64::from(k) + 0.5) / f64::from(steps)).exp();
            density(frequency, &mut sample);
            sums.iter_mut().zip(&sample).for_each(|(sum, s)| *sum += frequency * s);
        }
        let (mut change, mut largest) = (0.0, 0.0);
        for ((integral, trapezoid), sum) in integrals.iter_mut().zip(&mut trapezoids).zip(&sums) {
            let finer = length * sum / f64::from(2 * steps);
            let simpson = (4.0 * finer - *trapezoid) / 3.0;
            change = f64::max(change, (simpson - *integral).abs());
            largest = f64::max(largest, simpson.abs());
            (*trapezoid, *integral) = (finer, simpson);
        }
        // narrow peaks hide between coarse steps
        if refinement >= 7 && change <= tolerance * largest {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::mean_squares;

    #[test]
    fn powers_and_peaks_are_integrated() {
        let mut found = [0.0; 3];
        // f⁻², 1, and a resonance with a damping ratio of 0.01: (1 + 4ζ²r²) / ((1 − r²)² + 4ζ²r²)
        let (zeta, natural) = (0.01, 7.3);
        let resonance = |f: f64| {
            let r2 = (f / natural).powi(2);
            1.0 / ((1.0 - r2).powi(2) + 4.0 * zeta * zeta * r2)
        };
        let mut density = |f: f64, s: &mut [f64]| s.copy_from_slice(&[1.0 / (f * f), 1.0, resonance(f)]);
        mean_squares(&mut density, (0.5, 80.0), 1e-10, &mut found);
        assert!((found[0] - (1.0 / 0.5 - 1.0 / 80.0)).abs() < 1e-8, "{}", found[0]);
        assert!((found[1] - 79.5).abs() < 1e-8, "{}", found[1]);
        // white noise, all frequencies: π f₀ / 4ζ; the rest below and above the band by the series of the density
        let all = std::f64::consts::PI * natural / (4.0 * zeta);
        let below = 0.5 + 2.0 * 0.5_f64.powi(3) / (3.0 * natural.powi(2));
        let above = natural.powi(4) / (3.0 * 80.0_f64.powi(3));
        assert!((found[2] - (all - below - above)).abs() < 1e-4 * all, "{} {}", found[2], all - below - above);
    }
}
