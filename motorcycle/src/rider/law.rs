//! The laws of the virtual rider, generic over the scalar.
//!
//! **Where it is.** Arc length s on the path, a state, offset e (positive to the left of the path) and heading error ψ_e: [`crate::maneuver::Path::progress`].
//!
//! **Steering.** One of two laws, [`super::preview`] or [`super::cascade`], gives the torque. It is bounded smoothly by `τ/(1 + (τ/τ_max)⁸)^⅛`, then delayed (Padé, second order) and
//! lagged by the muscles where that is asked for.
//!
//! **Speed.** Demanded acceleration `b = b_t + k_v (V_t − V) + k_i ∫(V_t − V) dt` with the target V_t of the maneuver and its rate b_t; wheel torque
//! `T = T₀ + M b`. The engine takes what is positive, the brakes what is negative, with the front share `p = p₀ − p₁ b`; near zero both change over by a smooth ramp.
//! The engine gives `min(T, T_full(Ω))`, smoothly. Where it gives all it can, the integral of a speed that is too low stands still: `d/dt ∫ = (V_t − V) (1 − f g)`, f from 0 to 1 where T passes T_full, g from 0 to 1 where
//! V_t passes V; it begins to move where the demand is within reach again.
//!
//! Symbols: V_x, V_y speed of the base point, m/s; τ steering torque, N m; M wheel torque per acceleration, N s²; T_full wheel torque at full throttle, N m, over the speed Ω of the joint that the engine turns with, rad/s.
//!
//! Source: theory manual 10.1 (arc length as a state), 10.2, 10.6. Range: speeds within the table of the schedule; beyond it the gains of its edge hold. Offsets below the
//! radius of the path.

use super::schedule::Row;
use super::{Lateral, Rider};
use mbody::scalar::Real;
use mbody::scalar::smooth::{ramp, step};

/// Wheel torque over which drive and brakes change over, N m.
const CHANGE_OVER: f64 = 10.0;

/// Speed error over which the integral of the speed comes to a standstill at full throttle, m/s.
const TOO_SLOW: f64 = 0.1;

/// Least speed that the rider reckons with, m/s: he divides by it.
const SLOW: f64 = 0.5;

/// The speed as the rider reckons with it: itself above twice the least one, which it approaches smoothly below.
fn reckoned<S: Real>(speed: S) -> S {
    ramp(speed, 2.0 * SLOW) + SLOW
}

/// Most commands, states and outputs.
pub(super) const MOST: usize = 9;

/// What the laws give.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reply<S> {
    pub commands: [S; MOST],
    pub rates: [S; MOST],
    pub outputs: [S; MOST],
}

/// A value bounded smoothly: `x/(1 + (x/bound)⁸)^⅛`.
pub(super) fn bounded<S: Real>(x: S, bound: f64) -> S {
    let u = x / bound;
    // far beyond the bound the power would overflow
    if u.value().abs() > 1e6 {
        return S::from_f64(bound * x.sign());
    }
    x / (u.powi(8) + 1.0).powf(0.125)
}

impl Rider {
    /// Speed and lateral acceleration for which the schedule is read.
    pub(super) fn scheduled<S: Real>(&self, z: &[S], x: &[S]) -> (S, S) {
        let V = reckoned(z[3]);
        let [low, high] = self.acceleration_range();
        let a = match self.settings.lateral {
            Lateral::Preview => self.coming(x[0], V),
            Lateral::Cascade(_) => x[self.loop_states()],
        };
        // the edges of the table are approached, not met
        let middle = 0.5 * (low + high);
        (V, bounded(a - middle, 0.5 * (high - low)) + middle)
    }

    /// Commands, rates of the states and outputs. z: x, y, heading, forward and lateral speed, then what is fed back; `row` is that of [`Rider::scheduled`].
    pub(super) fn law<S: Real>(&self, time: f64, z: &[S], x: &[S], row: &Row, at: (S, S)) -> Reply<S> {
        let mut reply = Reply::default();
        let entry = |k: usize| row.entry(k, at);
        let s = x[0];
        let progress = self.course.path.progress(s, [z[0], z[1], z[2], z[3], z[4]]);
        reply.rates[0] = progress.rate;
        let human = &x[self.human_states()..];
        let torque = match self.settings.lateral {
            Lateral::Preview => self.previewing(z, (s, human), row, at, &progress),
            Lateral::Cascade(settings) => self.cascading((z, x), row, at, &progress, (settings, self.loop_states()), &mut reply),
        };
        let torque = bounded(torque, self.settings.greatest_torque);
        reply.commands[0] = self.human(torque, human, &mut reply.rates) + self.course.pulses(time);
        // speed
        let (target, wanted) = self.course.speed.at(time, s, progress.along);
        if let Some(integral) = self.speed_state() {
            let (lag, sum) = (target - z[3], x[integral]);
            let demanded = wanted + lag * self.settings.speed_gain + sum * self.settings.speed_integral_gain;
            let per = entry(self.layout.torque_per_acceleration());
            let whole = entry(self.layout.drive()) + per * demanded;
            let driven = ramp(whole + 0.5 * CHANGE_OVER, CHANGE_OVER);
            let braked = ramp(-whole + 0.5 * CHANGE_OVER, CHANGE_OVER) * self.settings.brake_per_drive;
            let share = -demanded * self.settings.front_share[1] + self.settings.front_share[0];
            let share = clamped(share);
            let (given, full) = self.given(driven, z);
            reply.rates[integral] = lag * (-full * step(lag, TOO_SLOW) + 1.0);
            reply.commands[1] = given;
            reply.commands[2] = braked * share;
            reply.commands[3] = braked * (-share + 1.0);
        }
        let place = &progress.place;
        let (offset, error) = (progress.offset, progress.heading_error);
        reply.outputs[..7].copy_from_slice(&[offset, error, place.curvature, target, place.x, place.y, at.1]);
        reply
    }

    /// What the engine gives of a wheel torque that is asked for, and how far it is at its limit, 0 to 1. z ends with the speed of the joint that it turns with.
    fn given<S: Real>(&self, asked: S, z: &[S]) -> (S, S) {
        let (Some((_, full)), Some(&turning)) = (&self.settings.full_throttle, z.last()) else { return (asked, S::zero()) };
        let (first, last) = full.range();
        let inside = (first..=last).contains(&turning.value());
        let most = full.value(if inside { turning } else { S::from_f64(turning.value().clamp(first, last)) });
        let beyond = asked - most + 0.5 * CHANGE_OVER;
        (asked - ramp(beyond, CHANGE_OVER), step(beyond, CHANGE_OVER))
    }

    /// States of delay and muscles where the torque is steady.
    pub(super) fn human_at<S: Real>(&self, torque: S) -> [S; 4] {
        let zero = S::zero();
        match (self.settings.delay, self.settings.lag) {
            (Some(delay), Some(_)) => [torque * (delay * delay / 12.0), zero, torque, zero],
            (Some(delay), None) => [torque * (delay * delay / 12.0), zero, zero, zero],
            _ => [torque, zero, zero, zero],
        }
    }

    /// Delay and lag of a human: rates of their states; returns the torque at the bar.
    fn human<S: Real>(&self, torque: S, x: &[S], rates: &mut [S; MOST]) -> S {
        let (mut out, mut k, first) = (torque, 0, self.human_states());
        if let Some(delay) = self.settings.delay {
            // (s² − b s + a)/(s² + b s + a) with a = 12/T², b = 6/T
            let (a, b) = (12.0 / (delay * delay), 6.0 / delay);
            rates[first + k] = x[k + 1];
            rates[first + k + 1] = out - x[k] * a - x[k + 1] * b;
            out -= x[k + 1] * (2.0 * b);
            k += 2;
        }
        if let Some((frequency, damping)) = self.settings.lag {
            rates[first + k] = x[k + 1];
            rates[first + k + 1] = (out - x[k]) * (frequency * frequency) - x[k + 1] * (2.0 * damping * frequency);
            out = x[k];
        }
        out
    }
}

/// A share between 0 and 1, with smooth corners.
fn clamped<S: Real>(share: S) -> S {
    let below = ramp(share + 0.05, 0.1);
    -ramp(-below + 1.05, 0.1) + 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_what_they_are_but_never_zero() {
        assert!(reckoned(25.0) == 25.0 && reckoned(1.0) == 1.0);
        assert!(reckoned(0.0) == SLOW && reckoned(-3.0) == SLOW && reckoned(0.5) > SLOW && reckoned(0.5) < 1.0);
    }

    #[test]
    fn bounds_leave_small_values_alone() {
        assert!((bounded(10.0, 40.0) - 10.0).abs() < 1e-4);
        assert!((bounded(1e9, 40.0) - 40.0).abs() < 1e-9 && (bounded(-80.0, 40.0) + 40.0).abs() < 0.1);
        for share in [0.2, 0.5, 0.9] {
            assert!((clamped(share) - share).abs() < 1e-14);
        }
        assert!(clamped(1.5) == 1.0 && clamped(-1.0) == 0.0);
    }
}
