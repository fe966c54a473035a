//! Margins of a loop that is cut at its one input.
//!
//! `L(jω) = K (jω − A)⁻¹ B`. The closed loop is stable as it is (`A − BK` was checked); the margins tell by how much gain and phase may differ until it
//! is not: phase margin where `|L| = 1`, gain margins where L is real and negative (a factor above 1 and one below), and the distance of L from −1.
//! Source: K. J. Åström, R. M. Murray, *Feedback Systems*, Princeton 2008, 9.3.

use crate::hessenberg::Hessenberg;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::{PI, TAU};

/// Frequencies that are looked at, Hz, evenly spaced in their logarithm.
const RANGE: (f64, f64, usize) = (0.01, 100.0, 800);

/// Where the loop has a gain of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Change of the phase that the loop survives there, rad.
    pub phase_margin: f64,
}

/// How much a closed loop may change before it becomes unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// Every frequency at which the loop has a gain of one.
    pub crossings: Vec<Crossing>,
    /// Largest factor below one at which the loop loses its stability; none: it may be opened.
    pub least_factor: Option<f64>,
    /// Smallest factor above one at which the loop loses its stability; none: any.
    pub greatest_factor: Option<f64>,
    /// Smallest distance of L from −1; the inverse of the largest sensitivity.
    pub distance: f64,
    /// Frequencies, Hz, and L there.
    pub response: Vec<(f64, Complex<f64>)>,
}

impl Margins {
    /// Smallest phase margin, rad; π without any crossing.
    pub fn phase_margin(&self) -> f64 {
        self.crossings.iter().map(|c| c.phase_margin).fold(PI, f64::min)
    }

    /// Margins of `u = −K x` on `ẋ = A x + B u` with one input.
    pub(super) fn of(A: &DMatrix<f64>, B: &DMatrix<f64>, K: &DMatrix<f64>) -> Self {
        let hessenberg = A.clone().hessenberg();
        let (Z, H) = hessenberg.unpack();
        let (b, k) = (Z.transpose() * B.column(0), (K * Z).transpose().column(0).into_owned());
        let mut H = Hessenberg::new(&H, 1);
        let mut at = |frequency: f64| loop_at(&mut H, (&b, &k), TAU * frequency);
        let (low, high, count) = RANGE;
        let frequency = |i: f64| low * (high / low).powf(i / (count - 1) as f64);
        let values: Vec<Complex<f64>> = (0..count).map(|i| at(frequency(i as f64))).collect();
        let distance = values.iter().map(|l| (l + 1.0).norm()).fold(f64::INFINITY, f64::min);
        let mut refine = |i: usize, f: &dyn Fn(Complex<f64>) -> f64| {
            let (mut a, mut b) = (i as f64, i as f64 + 1.0);
            let first = f(values[i]);
            for _ in 0..40 {
                let middle = 0.5 * (a + b);
                if f(at(frequency(middle))) * first > 0.0 { a = middle } else { b = middle }
            }
            let frequency = frequency(0.5 * (a + b));
            (frequency, at(frequency))
        };
        let response = values.iter().enumerate().map(|(i, l)| (frequency(i as f64), *l)).collect();
        let mut margins = Self { crossings: Vec::new(), least_factor: None, greatest_factor: None, distance, response };
        for i in 0..count - 1 {
            let (a, b) = (values[i], values[i + 1]);
            if (a.norm() - 1.0) * (b.norm() - 1.0) < 0.0 {
                let (frequency, l) = refine(i, &|l| l.norm() - 1.0);
                margins.crossings.push(Crossing { frequency, phase_margin: PI - l.arg().abs() });
            }
            if a.im * b.im < 0.0 && a.re < 0.0 && b.re < 0.0 {
                margins.real_axis(-refine(i, &|l| l.im).1.re);
            }
        }
        // at rest L is real
        let still = at(0.0).re;
        if still.is_finite() && still < 0.0 {
            margins.real_axis(-still);
        }
        margins
    }

    /// L passes −gain: so much less, or so much more, and it passes −1.
    fn real_axis(&mut self, gain: f64) {
        let factor = 1.0 / gain;
        match factor < 1.0 {
            true => self.least_factor = Some(self.least_factor.map_or(factor, |f| f.max(factor))),
            false => self.greatest_factor = Some(self.greatest_factor.map_or(factor, |f| f.min(factor))),
        }
    }
}

/// `kᵀ (jω − H)⁻¹ b` with H of Hessenberg form.
fn loop_at(H: &mut Hessenberg, (b, k): (&DVector<f64>, &DVector<f64>), omega: f64) -> Complex<f64> {
    H.right[0].copy_from_slice(b.as_slice());
    H.right[1].fill(0.0);
    H.solve(omega);
    let part = |x: &[f64]| k.iter().zip(x).map(|(k, x)| k * x).sum::<f64>();
    Complex::new(part(&H.right[0]), part(&H.right[1]))
}
