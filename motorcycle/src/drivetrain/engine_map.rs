//! Torque of an engine over speed and throttle, and the throttle that a torque needs.
//!
//! Each throttle setting k has a curve `T_k(ω)`, monotone cubic through its points. At one speed the throttle is the monotone cubic (Fritsch–Butland slopes)
//! through the points `(T_k, θ_k)`, straight on beyond them: a throttle above 1 says how far the demand is beyond the engine.
//!
//! Symbols: ω engine speed, rad/s; T torque, N m; θ throttle, 0 to 1. With two settings the map is linear in θ.
//! Source: F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238–246; slopes of F. N. Fritsch, J. Butland, SIAM J. Sci. Stat.
//! Comput. 5 (1984) 300–304. Range: speeds of the table; beyond, the
//! curves go on straight for a little and level off, so that an engine at a standstill gives finite numbers, not meaningful ones.

use mbody::scalar::{Pchip, Real, spline::CurveError};
use thiserror::Error;

/// Why a table makes no map.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EngineMapError {
    /// Settings and rows do not pair up.
    #[error("the map has {settings} throttle settings but {rows} rows of torque")]
    Rows {
        /// Number of throttle settings.
        settings: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Settings do not run from 0 to 1.
    #[error("the throttle settings must increase from 0 to 1, but they are {settings:?}")]
    Settings {
        /// The settings.
        settings: Vec<f64>,
    },
    /// A row is no curve.
    #[error("the torque at throttle {setting}: {cause}")]
    Row {
        /// Throttle of the row.
        setting: f64,
        /// What is wrong with it.
        cause: CurveError,
    },
    /// More throttle gives no more torque.
    #[error("at {speed:.1} rad/s the torque does not rise from throttle {below} to throttle {above}")]
    NotRising {
        /// Engine speed, rad/s.
        speed: f64,
        /// Lower setting.
        below: f64,
        /// Higher setting.
        above: f64,
    },
}

/// Torque over speed and throttle.
#[derive(Clone, Debug)]
pub struct EngineMap {
    settings: Vec<f64>,
    rows: Vec<Pchip>,
}

impl EngineMap {
    /// The map of torques `rows[k][j]` at the throttle `settings[k]` and the engine speed `speeds[j]`, rad/s.
    ///
    /// # Errors
    /// Settings that do not increase from 0 to 1, rows that are no curves, torque that does not rise with the throttle.
    pub fn new(settings: &[f64], speeds: &[f64], rows: &[Vec<f64>]) -> Result<Self, EngineMapError> {
        if settings.len() != rows.len() {
            return Err(EngineMapError::Rows { settings: settings.len(), rows: rows.len() });
        }
        let increasing = settings.windows(2).all(|s| s[0] < s[1]);
        if settings.len() < 2 || !increasing || settings[0] != 0.0 || settings[settings.len() - 1] != 1.0 {
            return Err(EngineMapError::Settings { settings: settings.to_vec() });
        }
        let row =
            |(&setting, torque): (&f64, &Vec<f64>)| Pchip::new(speeds, torque).map_err(|cause| EngineMapError::Row { setting, cause });
        let curves = settings.iter().zip(rows).map(row).collect::<Result<Vec<_>, _>>()?;
        let map = Self { settings: settings.to_vec(), rows: curves };
        // between its points a monotone cubic may still cross a neighbor, and so may its continuation: look there too
        let (first_beyond, last_beyond) = map.continuation();
        let inside = speeds.windows(2).flat_map(|s| (0..8).map(|part| s[0] + (s[1] - s[0]) * f64::from(part) / 8.0));
        for speed in inside.chain([first_beyond, last_beyond]) {
            let torques: Vec<f64> = map.rows.iter().map(|row| row.value(speed)).collect();
            if let Some(k) = (1..torques.len()).find(|&k| torques[k] <= torques[k - 1]) {
                return Err(EngineMapError::NotRising { speed, below: settings[k - 1], above: settings[k] });
            }
        }
        Ok(map)
    }

    /// Part of the range of speeds by which the curves go on beyond the table.
    const BEYOND: f64 = 0.02;

    /// Speeds between which the curves are evaluated.
    fn continuation(&self) -> (f64, f64) {
        let (first, last) = self.rows[0].range();
        let beyond = Self::BEYOND * (last - first);
        (first - beyond, last + beyond)
    }

    /// The speed at which the curves are evaluated: itself in the table, leveling off beyond; twice differentiable.
    #[inline]
    fn leveled<S: Real>(&self, speed: S) -> S {
        let (first, last) = self.rows[0].range();
        let beyond = Self::BEYOND * (last - first);
        let end = speed.value().clamp(first, last);
        if end == speed.value() {
            return speed;
        }
        ((speed - end) / beyond).tanh() * beyond + end
    }

    /// Torque at full throttle, N m.
    #[inline]
    pub fn full_torque<S: Real>(&self, speed: S) -> S {
        self.rows[self.rows.len() - 1].value(self.leveled(speed))
    }

    /// Throttle that gives a torque at a speed; below 0 or above 1 where the engine cannot give it.
    pub fn throttle<S: Real>(&self, speed: S, torque: S) -> S {
        let speed = self.leveled(speed);
        let last = self.rows.len() - 2;
        let k = (0..last).find(|&k| self.rows[k + 1].value(speed.value()) > torque.value()).unwrap_or(last);
        let row = |i: usize| self.rows[i].value(speed);
        let (low, high) = (row(k), row(k + 1));
        // slopes dθ/dT at both ends of the segment: harmonic means of the chords, one chord alone at the ends of the map
        let (span, rise) = (high - low, self.settings[k + 1] - self.settings[k]);
        let mean = |near: S, far: S, far_rise: f64| {
            let (a, b) = (near + far * 2.0, far + near * 2.0);
            (a + b) / (a * near / rise + b * far / far_rise)
        };
        let chord = span.recip() * rise;
        let start = if k == 0 { chord } else { mean(span, low - row(k - 1), self.settings[k] - self.settings[k - 1]) };
        let end = if k == last { chord } else { mean(span, row(k + 2) - high, self.settings[k + 2] - self.settings[k + 1]) };
        let u = (torque - low) / span;
        if u.value() < 0.0 {
            return (torque - low) * start + self.settings[k];
        }
        if u.value() > 1.0 {
            return (torque - high) * end + self.settings[k + 1];
        }
        let (s0, s1) = (start * span, end * span);
        let (c2, c3) = (-(s0 * 2.0) - s1 + 3.0 * rise, s0 + s1 - 2.0 * rise);
        ((u * c3 + c2) * u + s0) * u + self.settings[k]
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use mbody::scalar::Jet;

    /// A made-up engine: drag at closed throttle, a peak at 900 rad/s.
    pub fn map() -> EngineMap {
        let speeds = [200.0, 500.0, 900.0, 1200.0];
        let rows = [vec![-8.0, -12.0, -18.0, -24.0], vec![35.0, 48.0, 44.0, 20.0], vec![60.0, 85.0, 105.0, 90.0]];
        EngineMap::new(&[0.0, 0.3, 1.0], &speeds, &rows).unwrap()
    }

    #[test]
    fn settings_are_met_and_the_throttle_rises_with_the_torque() {
        let map = map();
        for (speed, closed, part, full) in [(500.0, -12.0, 48.0, 85.0), (1200.0, -24.0, 20.0, 90.0)] {
            for (torque, throttle) in [(closed, 0.0), (part, 0.3), (full, 1.0)] {
                assert!((map.throttle(speed, torque) - throttle).abs() < 1e-14);
            }
            assert_eq!(map.full_torque(speed), full);
        }
        let throttles: Vec<f64> = (0..200).map(|i| map.throttle(640.0, -40.0 + 0.9 * f64::from(i))).collect();
        assert!(throttles.windows(2).all(|t| t[1] > t[0]));
        assert!(throttles[0] < 0.0 && throttles[199] > 1.0);
    }

    #[test]
    fn the_throttle_has_a_continuous_slope() {
        let map = map();
        let slope = |torque: f64| map.throttle(Jet::constant(500.0), Jet::new(torque, 1.0, 0.0)).d;
        for knot in [-12.0, 48.0, 85.0] {
            assert!((slope(knot - 1e-9) - slope(knot + 1e-9)).abs() < 1e-9, "at {knot}");
        }
        let by_speed = map.throttle(Jet::new(640.0, 1.0, 0.0), Jet::constant(30.0)).d;
        let h = 1e-3;
        let difference = (map.throttle(640.0 + h, 30.0) - map.throttle(640.0 - h, 30.0)) / (2.0 * h);
        assert!((by_speed - difference).abs() < 1e-9);
    }

    #[test]
    fn beyond_the_table_the_map_stays_finite_and_smooth() {
        let map = map();
        for end in [200.0, 1200.0] {
            let slope = |speed: f64| map.full_torque(Jet::new(speed, 1.0, 0.0)).d;
            assert!((slope(end - 1e-7) - slope(end + 1e-7)).abs() < 1e-8);
        }
        for speed in [-300.0, 0.0, 2500.0] {
            assert!(map.full_torque(speed).is_finite() && map.throttle(speed, 30.0).is_finite());
        }
    }

    #[test]
    fn two_settings_are_linear_in_the_throttle() {
        let map = EngineMap::new(&[0.0, 1.0], &[100.0, 1000.0], &[vec![-10.0, -20.0], vec![80.0, 100.0]]).unwrap();
        assert!((map.throttle(550.0, -15.0 + 0.25 * 105.0) - 0.25).abs() < 1e-14);
    }

    #[test]
    fn broken_maps_are_refused() {
        let speeds = [100.0, 1000.0];
        let rows = vec![vec![-10.0, -20.0], vec![80.0, -21.0]];
        assert!(matches!(EngineMap::new(&[0.0, 1.0], &speeds, &rows), Err(EngineMapError::NotRising { .. })));
        assert!(matches!(EngineMap::new(&[0.0, 0.9], &speeds, &rows), Err(EngineMapError::Settings { .. })));
        assert!(matches!(EngineMap::new(&[0.0, 0.5, 1.0], &speeds, &rows), Err(EngineMapError::Rows { .. })));
        assert!(matches!(EngineMap::new(&[0.0, 1.0], &[100.0], &rows), Err(EngineMapError::Row { .. })));
    }
}
