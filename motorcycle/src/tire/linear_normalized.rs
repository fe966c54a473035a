//! Linear law with stiffnesses per unit of load.
//!
//! ```text
//! Fx = N kx κ       Fy = N (ka a − kg γ)       Mz = −N (ks a + kt γ)
//! ```
//!
//! N load, N; κ, a longitudinal and lateral slip; γ camber, rad; kx, ka, kg stiffnesses per load; ks self-aligning and kt twisting
//! moment per load, m/rad. Camber turns the side force to the side of the lean, the twisting moment steers into it.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 2; data in this form in the linear models of R. Lot, M. Massaro.
//! Range: slips below about 0.03 and modes of straight running; no saturation, so the utilization is 0.

use super::invalid::{InvalidTireData, not_negative, positive};
use super::law::{Friction, Slip, TireLaw};
use mbody::scalar::SystemScalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the linear law with stiffnesses per unit of load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearNormalizedParameters {
    /// Longitudinal slip stiffness per load, kx.
    pub longitudinal_stiffness: f64,
    /// Cornering stiffness per load, ka, 1/rad.
    pub cornering_stiffness: f64,
    /// Camber stiffness per load, kg, 1/rad.
    pub camber_stiffness: f64,
    /// Self-aligning moment per load and slip, ks, m/rad, positive for a moment that turns the slip down.
    #[serde(default)]
    pub aligning_stiffness: f64,
    /// Twisting moment per load and camber, kt, m/rad, positive for a moment that steers into the lean.
    #[serde(default)]
    pub twisting_stiffness: f64,
}

/// The linear law with stiffnesses per unit of load.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearNormalized(LinearNormalizedParameters);

impl LinearNormalizedParameters {
    /// The law with these parameters.
    ///
    /// # Errors
    /// A cornering stiffness that is not positive; other stiffnesses that are negative.
    pub fn law(self) -> Result<LinearNormalized, InvalidTireData> {
        positive(&[("cornering_stiffness", self.cornering_stiffness)])?;
        not_negative(&[("longitudinal_stiffness", self.longitudinal_stiffness), ("camber_stiffness", self.camber_stiffness)])?;
        not_negative(&[("aligning_stiffness", self.aligning_stiffness), ("twisting_stiffness", self.twisting_stiffness)])?;
        Ok(LinearNormalized(self))
    }
}

impl LinearNormalized {
    /// The parameters of the law.
    pub fn parameters(&self) -> &LinearNormalizedParameters {
        &self.0
    }
}

impl TireLaw for LinearNormalized {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let (p, a, g) = (&self.0, slip.lateral, slip.camber);
        Friction {
            longitudinal: slip.longitudinal * p.longitudinal_stiffness * slip.load,
            lateral: (a * p.cornering_stiffness - g * p.camber_stiffness) * slip.load,
            overturning_moment: S::zero(),
            rolling_moment: S::zero(),
            aligning_moment: -(a * p.aligning_stiffness + g * p.twisting_stiffness) * slip.load,
            utilization: S::zero(),
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, _camber: S) -> S {
        load * self.0.cornering_stiffness
    }

    fn saturates(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tire::conformity;

    fn sport_tourer_front() -> LinearNormalizedParameters {
        LinearNormalizedParameters {
            longitudinal_stiffness: 20.0,
            cornering_stiffness: 16.0,
            camber_stiffness: 0.85,
            aligning_stiffness: 0.2,
            twisting_stiffness: 0.015,
        }
    }

    #[test]
    fn conforms() {
        conformity::holds(&sport_tourer_front().law().unwrap());
    }

    #[test]
    fn signs_are_those_of_a_tire_leaning_right() {
        let law = sport_tourer_front().law().unwrap();
        let f = law.friction(&Slip { load: 1000.0, lateral: 0.0, longitudinal: 0.01, camber: 0.1_f64, speed: 30.0 });
        // pushed to the right and turned to the right, driven forward
        assert!((f.lateral + 85.0).abs() < 1e-12 && (f.aligning_moment + 1.5).abs() < 1e-12 && (f.longitudinal - 200.0).abs() < 1e-12);
    }

    #[test]
    fn a_tire_without_cornering_stiffness_is_refused() {
        let parameters = LinearNormalizedParameters { cornering_stiffness: 0.0, ..sport_tourer_front() };
        assert_eq!(parameters.law(), Err(InvalidTireData::NotPositive { parameter: "cornering_stiffness", value: 0.0 }));
    }
}
