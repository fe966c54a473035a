//! The steering of a rider with preview: optimal feedback of all states, and of the way ahead.
//!
//! `τ = τ₀ − K (x − x₀) − K_e e − K_ψ (ψ_e + β₀) + Σ wᵢ (κ(s + V tᵢ) − κ₀)`: steady state x₀, τ₀ with its slip angle `β₀ = atan(V_y/V_x)`, gains K and weights w all of the present speed
//! and of the lateral acceleration `a₀ = V² κ₀`, where κ₀ is the curvature ahead under a raised-cosine window of twice the lead t₀: it comes and goes as the lean does. (The law is the tangent of
//! the best one at a₀; where a₀ is far from the state of the vehicle, the torque is off by what the steady states bend.)
//!
//! Symbols: e offset, m; ψ_e heading error, rad; κ curvature of the path, 1/m, positive to the left; τ steering torque, N m; t₀ lead of the schedule, s.
//!
//! Source: theory manual 10.4; R. S. Sharp, Proc. IMechE C 221 (2007) 337–346. Range: that of the table; offsets below the radius of the path.

use super::Rider;
use super::schedule::Row;
use crate::maneuver::Progress;
use mbody::scalar::Real;

/// Shares of eight equal distances within twice the lead: `(1 − cos 2πk/9)/9`, which add up to one.
const WINDOW: [f64; 8] = [
    0.025_995_061_875_669_12,
    0.091_816_869_148_118_86,
    0.166_666_666_666_666_66,
    0.215_521_402_309_545_4,
    0.215_521_402_309_545_4,
    0.166_666_666_666_666_66,
    0.091_816_869_148_118_86,
    0.025_995_061_875_669_12,
];

impl Rider {
    /// Lateral acceleration for which the schedule is read: of the curvature ahead, weighted like the lean that answers it.
    pub(super) fn coming<S: Real>(&self, s: S, V: S) -> S {
        let mut curvature = S::zero();
        for (k, share) in WINDOW.iter().enumerate() {
            let ahead = (k + 1) as f64 * 2.0 * self.settings.lead / (WINDOW.len() + 1) as f64;
            curvature += self.course.path.curvature(s + V * ahead) * *share;
        }
        V * V * curvature
    }

    /// Torque before its bound, with states x of the human behind `human`.
    pub(super) fn previewing<S: Real>(&self, z: &[S], (s, human): (S, &[S]), row: &Row, at: (S, S), progress: &Progress<S>) -> S {
        let (V, a) = at;
        let entry = |k: usize| row.entry(k, at);
        let mut torque = entry(self.layout.torque());
        for k in 0..self.layout.feedback {
            torque -= entry(self.layout.gain(k)) * (z[5 + k] - entry(k));
        }
        torque -= entry(self.layout.path_gain(0)) * progress.offset;
        torque -= entry(self.layout.path_gain(1)) * (progress.heading_error + entry(self.layout.slip()));
        let present = a / (V * V);
        for k in 0..self.layout.preview {
            let seen = self.course.path.curvature(s + V * (k as f64 * self.settings.interval));
            torque += entry(self.layout.preview(k)) * (seen - present);
        }
        let steady = self.human_at(entry(self.layout.torque()));
        for k in 0..self.layout.human {
            torque -= entry(self.layout.human_gain(k)) * (human[k] - steady[k]);
        }
        torque
    }
}
