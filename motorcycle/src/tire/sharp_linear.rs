//! Linear laws of Sharp: stiffnesses as polynomials of the load.
//!
//! ```text
//! Fx = Cκ κ      Fy = Cα(N) a − Cγ(N) γ      Mz = −Mα(N) a − Mγ(N) γ      Mx = Mo(N) γ       C(N) = c0 + c1 N + c2 N² + …
//! ```
//!
//! N load, N; κ, a longitudinal and lateral slip; γ camber, rad; Cκ N, Cα, Cγ N/rad, Mα, Mγ, Mo N m/rad. Sharp's tire of 1971 has
//! constant Cα and Cγ and nothing else; that of 1994 has polynomials of the load, aligning and overturning moments.
//!
//! Source: R. S. Sharp, J. Mech. Eng. Sci. 13 (1971) 316–329; R. S. Sharp, Vibrational modes of motorcycles and their design
//! parameter sensitivities, Proc. Vehicle NVH and Refinement, IMechE 1994.
//! Range: slips below about 0.03 and modes of straight running; no saturation, so the utilization is 0. Polynomials hold near the
//! loads they were fitted at and do not vanish at zero load. The overturning moment is what a round cross-section of radius
//! −Mo/N produces by itself: it belongs to a sharp-edged wheel only.

use super::invalid::{InvalidTireData, finite, not_negative};
use super::law::{Friction, Slip, TireLaw};
use mbody::scalar::{Real, SystemScalar};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the linear laws of Sharp; polynomials of the load in N, constant coefficient first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SharpLinearParameters {
    /// Longitudinal slip stiffness Cκ, N; the publications assume wheels that roll without slip.
    pub longitudinal_stiffness: f64,
    /// Cornering stiffness Cα, N/rad.
    pub cornering_stiffness: Vec<f64>,
    /// Camber stiffness Cγ, N/rad.
    pub camber_stiffness: Vec<f64>,
    /// Aligning moment per slip Mα, N m/rad, positive for a moment that turns the slip down.
    #[serde(default = "nothing")]
    pub aligning_stiffness: Vec<f64>,
    /// Aligning moment per camber Mγ, N m/rad, positive for a moment that steers into the lean.
    #[serde(default = "nothing")]
    pub camber_aligning_stiffness: Vec<f64>,
    /// Overturning moment per camber Mo, N m/rad, negative for a moment as of a round cross-section.
    #[serde(default = "nothing")]
    pub overturning_stiffness: Vec<f64>,
}

fn nothing() -> Vec<f64> {
    vec![0.0]
}

/// The linear law with one set of polynomials.
#[derive(Clone, Debug, PartialEq)]
pub struct SharpLinear(SharpLinearParameters);

impl SharpLinearParameters {
    /// The law with these parameters.
    ///
    /// # Errors
    /// Polynomials without coefficients, coefficients that are not finite, a negative longitudinal stiffness.
    pub fn law(self) -> Result<SharpLinear, InvalidTireData> {
        not_negative(&[("longitudinal_stiffness", self.longitudinal_stiffness)])?;
        for (parameter, coefficients) in [
            ("cornering_stiffness", &self.cornering_stiffness),
            ("camber_stiffness", &self.camber_stiffness),
            ("aligning_stiffness", &self.aligning_stiffness),
            ("camber_aligning_stiffness", &self.camber_aligning_stiffness),
            ("overturning_stiffness", &self.overturning_stiffness),
        ] {
            if coefficients.is_empty() {
                return Err(InvalidTireData::NoCoefficients { parameter });
            }
            coefficients.iter().try_for_each(|c| finite(&[(parameter, *c)]))?;
        }
        Ok(SharpLinear(self))
    }
}

impl SharpLinear {
    /// The parameters of the law.
    pub fn parameters(&self) -> &SharpLinearParameters {
        &self.0
    }
}

#[inline]
fn polynomial<S: Real>(coefficients: &[f64], x: S) -> S {
    coefficients.iter().rev().fold(S::zero(), |sum, c| sum * x + *c)
}

impl TireLaw for SharpLinear {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let (p, a, g) = (&self.0, slip.lateral, slip.camber);
        let at_load = |coefficients: &[f64]| polynomial(coefficients, slip.load);
        Friction {
            longitudinal: slip.longitudinal * p.longitudinal_stiffness,
            lateral: at_load(&p.cornering_stiffness) * a - at_load(&p.camber_stiffness) * g,
            overturning_moment: at_load(&p.overturning_stiffness) * g,
            rolling_moment: S::zero(),
            aligning_moment: -(at_load(&p.aligning_stiffness) * a + at_load(&p.camber_aligning_stiffness) * g),
            utilization: S::zero(),
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, _camber: S) -> S {
        polynomial(&self.0.cornering_stiffness, load)
    }

    fn saturates(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tire::conformity;

    fn front_1971() -> SharpLinearParameters {
        SharpLinearParameters {
            longitudinal_stiffness: 1e4,
            cornering_stiffness: vec![11174.0],
            camber_stiffness: vec![938.6],
            aligning_stiffness: nothing(),
            camber_aligning_stiffness: nothing(),
            overturning_stiffness: nothing(),
        }
    }

    fn rear_1994() -> SharpLinearParameters {
        SharpLinearParameters {
            longitudinal_stiffness: 3e4,
            cornering_stiffness: vec![-92.9, 23.129, -4.663e-3, -6.457e-7, 1.887e-10],
            camber_stiffness: vec![27.38, 0.9727, -4.0e-6],
            aligning_stiffness: vec![9.0, 0.3573, 3.378e-5],
            camber_aligning_stiffness: vec![2.056, 0.01282, 4.928e-6],
            overturning_stiffness: vec![0.0, -0.07],
        }
    }

    #[test]
    fn conforms() {
        conformity::holds(&front_1971().law().unwrap());
        conformity::holds(&rear_1994().law().unwrap());
    }

    #[test]
    fn the_tire_of_1971_does_not_see_the_load() {
        let law = front_1971().law().unwrap();
        for load in [500.0, 1005.3] {
            let f = law.friction(&Slip { load, lateral: 0.01, longitudinal: 0.0, camber: 0.1_f64, speed: 30.0 });
            assert!((f.lateral - (111.74 - 93.86)).abs() < 1e-11);
            assert_eq!((f.aligning_moment, f.overturning_moment), (0.0, 0.0));
        }
    }

    #[test]
    fn the_polynomials_of_1994_are_evaluated_in_newton() {
        let law = rear_1994().law().unwrap();
        let z = 1200.0_f64;
        let cornering = -92.9 + 23.129 * z - 4.663e-3 * z.powi(2) - 6.457e-7 * z.powi(3) + 1.887e-10 * z.powi(4);
        assert!((law.cornering_stiffness(z, 0.0) - cornering).abs() < 1e-9);
        let f = law.friction(&Slip { load: z, lateral: 0.0, longitudinal: 0.0, camber: 0.1, speed: 30.0 });
        assert!((f.overturning_moment + 0.07 * z * 0.1).abs() < 1e-12, "acts like a crown of 0.07 m");
    }

    #[test]
    fn an_empty_polynomial_is_refused() {
        let parameters = SharpLinearParameters { camber_stiffness: vec![], ..front_1971() };
        assert_eq!(parameters.law(), Err(InvalidTireData::NoCoefficients { parameter: "camber_stiffness" }));
    }
}
