//! Rolling resistance of a tire.
//!
//! ```text
//! My = −N f re tanh(Ω/Ω0)
//! constant   f = f0
//! quadratic  f = f0 + f2 V²
//! pressure   f = 0.0085 + 0.018/p + 1.59·10⁻⁶ v²/p  below 165 km/h,    f = 0.018/p + 2.91·10⁻⁶ v²/p  above
//! ```
//!
//! My moment about the axle, N m; N load, N; re effective rolling radius, m; Ω spin, rad/s; Ω0 = 0.5 rad/s makes the moment vanish at
//! rest; f coefficient; V speed, m/s; v speed, km/h; p pressure, bar. The two branches of the last form do not meet at 165 km/h
//! (0.036 and 0.043 at 2.25 bar); they are blended by a logistic of width 10 km/h.
//!
//! Source: constants of the quadratic form: R. S. Sharp 1994 (f0 = 0.018, f2 = 6.8·10⁻⁶ s²/m²); form with pressure: V. Cossalter,
//! *Motorcycle Dynamics*, as quoted in the Modelica library MotorcycleDynamics.
//! Range: speeds up to about 90 m/s.

use super::invalid::{InvalidTireData, not_negative, positive};
use mbody::scalar::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Speed at which the two branches of the form with pressure change over, km/h.
const CHANGE_OVER: f64 = 165.0;
/// Width of the logistic between them, km/h.
const WIDTH: f64 = 10.0;
/// Spin below which the moment fades, rad/s.
const FADING_SPIN: f64 = 0.5;

/// How the rolling resistance coefficient depends on speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RollingResistance {
    /// The same at every speed.
    Constant(f64),
    /// `f0 + f2 V²`.
    Quadratic {
        /// Coefficient at rest, f0.
        at_rest: f64,
        /// Growth with the square of the speed, f2, s²/m².
        per_speed_squared: f64,
    },
    /// As the friction law says; nothing beside it.
    Law,
    /// The form with inflation pressure, blended between its two branches.
    Pressure {
        /// Inflation pressure, Pa.
        pressure: f64,
    },
}

impl RollingResistance {
    /// The values of Sharp (1994).
    pub const SHARP_1994: Self = Self::Quadratic { at_rest: 0.018, per_speed_squared: 6.8e-6 };

    /// Itself, if it can be evaluated.
    ///
    /// # Errors
    /// Negative coefficients; a pressure that is not positive.
    pub fn checked(self) -> Result<Self, InvalidTireData> {
        match self {
            Self::Law => {}
            Self::Constant(value) => not_negative(&[("constant", value)])?,
            Self::Quadratic { at_rest, per_speed_squared } => {
                not_negative(&[("at_rest", at_rest), ("per_speed_squared", per_speed_squared)])?;
            }
            Self::Pressure { pressure } => positive(&[("pressure", pressure)])?,
        }
        Ok(self)
    }

    /// Coefficient at a speed, m/s.
    pub fn coefficient<S: Real>(&self, speed: S) -> S {
        match *self {
            Self::Law => S::zero(),
            Self::Constant(value) => S::from_f64(value),
            Self::Quadratic { at_rest, per_speed_squared } => speed * speed * per_speed_squared + at_rest,
            Self::Pressure { pressure } => {
                let (v, per_bar) = (speed * 3.6, 1e5 / pressure);
                let slow = v * v * (1.59e-6 * per_bar) + (0.0085 + 0.018 * per_bar);
                let fast = v * v * (2.91e-6 * per_bar) + 0.018 * per_bar;
                // logistic 1/(1 + e^(−u)), written so that it cannot overflow
                let share = (((v - CHANGE_OVER) / (2.0 * WIDTH)).tanh() + 1.0) * 0.5;
                slow + share * (fast - slow)
            }
        }
    }

    /// Moment about the axle, N m, opposing the spin: load N, effective radius m, spin rad/s, speed m/s.
    pub fn moment<S: Real>(&self, load: S, radius: S, spin: S, speed: S) -> S {
        -(self.coefficient(speed) * load * radius * Self::fading(spin))
    }

    /// Share of the moment at a spin, rad/s: its sense, and nothing at rest.
    #[inline]
    pub(super) fn fading<S: Real>(spin: S) -> S {
        (spin / FADING_SPIN).tanh()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::scalar::Jet;

    #[test]
    fn the_form_with_pressure_follows_its_branches_away_from_the_change_over() {
        let law = RollingResistance::Pressure { pressure: 2.25e5 }.checked().unwrap();
        let (slow, fast) = (0.0085 + 0.018 / 2.25 + 1.59e-6 * 3600.0 / 2.25, 0.018 / 2.25 + 2.91e-6 * 300.0 * 300.0 / 2.25);
        // the logistic is 3e-5 and 1 − 1e-6 there, over branches that differ by 6e-3 and 4e-2
        assert!((law.coefficient(60.0 / 3.6) - slow).abs() < 3e-7);
        assert!((law.coefficient(300.0 / 3.6) - fast).abs() < 1e-7);
        let middle = law.coefficient(165.0 / 3.6);
        assert!((middle - 0.5 * (0.0085 + 0.036 / 2.25 + 4.5e-6 * 165.0 * 165.0 / 2.25)).abs() < 1e-15);
    }

    #[test]
    fn the_coefficient_is_smooth_in_speed() {
        let h = 1e-3;
        for law in [RollingResistance::Pressure { pressure: 2e5 }, RollingResistance::SHARP_1994, RollingResistance::Constant(0.01)] {
            for speed in [0.0, 20.0, 45.8, 80.0] {
                let exact = law.coefficient(Jet::new(speed, 1.0, 0.0)).d;
                let difference = (law.coefficient(speed + h) - law.coefficient(speed - h)) / (2.0 * h);
                assert!((exact - difference).abs() < 1e-9, "{law:?} at {speed}");
            }
        }
    }

    #[test]
    fn the_moment_opposes_the_spin_and_vanishes_at_rest() {
        let law = RollingResistance::SHARP_1994;
        assert!((law.moment(1000.0, 0.3, 100.0, 30.0) + 1000.0 * 0.3 * (0.018 + 6.8e-6 * 900.0)).abs() < 1e-12);
        assert!(law.moment(1000.0, 0.3, -100.0, 30.0) > 0.0);
        assert_eq!(law.moment(1000.0, 0.3, 0.0, 0.0), 0.0);
    }

    #[test]
    fn a_flat_tire_is_refused() {
        let flat = RollingResistance::Pressure { pressure: 0.0 };
        assert_eq!(flat.checked(), Err(InvalidTireData::NotPositive { parameter: "pressure", value: 0.0 }));
    }
}
