//! The steering of a rider in two loops: the path asks for lean, lean asks for torque (PID).
//!
//! ```text
//! a_ref = Σ wᵢ V² κ(s + V tᵢ) − K_e e − K_ψ (ψ_e + β₀)            ä_f + 2 z w ȧ_f + w² a_f = w² a_ref
//! τ = τ₀ + K_p (φ₀ − φ) + K_d (φ₀' ȧ_f − φ̇) + K_i ∫(φ₀ − φ) dt + K_δ (δ₀ − δ) − K_δ̇ δ̇
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | a_ref, a_f | m/s² | lateral acceleration that is asked for, positive to the left; the same behind its filter |
//! | φ₀, δ₀, τ₀, β₀ | rad, rad, N m, rad | lean, steering angle, torque and slip angle of the steady state at (V, a_f); they hold the thickness of the tires, which formulas for φ₀ correct for |
//! | φ₀' | rad s²/m | change of φ₀ per a_f |
//! | e, ψ_e, κ, V | m, rad, 1/m, m/s | offset, heading error, curvature of the path, speed |
//!
//! All gains and weights are of the present V and a_f; K_p, K_d > 0 for lean to the right by torque to the left (counter-steering). What the bound of the torque takes away is not integrated.
//!
//! Source: theory manual 10.3, with the lean of steady states instead of `−atan(a/g)` and its correction.
//! Range: that of the table; offsets below the radius of the path.

use super::law::{MOST, Reply, bounded};
use super::schedule::Row;
use super::{Rider, State};
use crate::maneuver::Progress;
use mbody::scalar::Real;

/// Names of what is fed back, in this order, behind those of base and steering.
pub const FEEDBACK: [&str; 4] = ["roll", "roll_rate", "angle", "rate"];

/// What the loops need beside gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeSettings {
    /// Natural frequency of the filter of the reference, rad/s.
    pub frequency: f64,
    /// Its damping ratio.
    pub damping: f64,
}

/// Its states: reference, its rate, integral of the lean.
pub(super) const STATES: [State; 3] = [
    State { name: "rider.reference", unit: "m/s^2", about: "lateral acceleration asked for, filtered", nominal: 1.0, tolerance: 1e-5 },
    State {
        name: "rider.reference_rate",
        unit: "m/s^3",
        about: "rate of the lateral acceleration asked for",
        nominal: 1.0,
        tolerance: 1e-5,
    },
    State { name: "rider.lean_integral", unit: "rad s", about: "integral of the error of the lean", nominal: 0.1, tolerance: 1e-7 },
];

impl Rider {
    /// Torque before its bound, and the rates of the states of the loops, which begin at `first`.
    pub(super) fn cascading<S: Real>(
        &self,
        (z, x): (&[S], &[S]),
        row: &Row,
        at: (S, S),
        progress: &Progress<S>,
        (settings, first): (CascadeSettings, usize),
        reply: &mut Reply<S>,
    ) -> S {
        let (V, entry) = (at.0, |k: usize| row.entry(k, at));
        let (reference, rate, integral) = (x[first], x[first + 1], x[first + 2]);
        let mut asked = S::zero();
        for k in 0..self.layout.preview {
            let seen = self.course.path.curvature(x[0] + V * (k as f64 * self.settings.interval));
            asked += entry(self.layout.preview(k)) * V * V * seen;
        }
        asked -= entry(self.layout.path_gain(0)) * progress.offset;
        asked -= entry(self.layout.path_gain(1)) * (progress.heading_error + entry(self.layout.slip()));
        let [low, high] = self.acceleration_range();
        let middle = 0.5 * (low + high);
        let asked = bounded(asked - middle, 0.5 * (high - low)) + middle;
        let stiffness = settings.frequency * settings.frequency;
        reply.rates[first] = rate;
        reply.rates[first + 1] = (asked - reference) * stiffness - rate * (2.0 * settings.damping * settings.frequency);
        let error = |k: usize| entry(k) - z[5 + k];
        let mut torque = entry(self.layout.torque()) - entry(self.layout.integral()) * integral;
        torque += entry(self.layout.gain(0)) * error(0);
        torque += entry(self.layout.gain(1)) * (entry(self.layout.lead()) * rate - z[6]);
        torque += entry(self.layout.gain(2)) * error(2);
        torque += entry(self.layout.gain(3)) * -z[8];
        let over = torque / self.settings.greatest_torque;
        // the slope of the bound: one below it, nothing beyond
        let share = if over.value().abs() > 1e3 { S::zero() } else { (over.powi(8) + 1.0).powf(-1.125) };
        reply.rates[first + 2] = -error(0) * share;
        torque
    }
}

const _: () = assert!(MOST >= 9, "station, integral of speed, four of a human, three of the loops");
