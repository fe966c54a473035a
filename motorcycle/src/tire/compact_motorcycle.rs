//! Compact motorcycle law: the shape of the Magic Formula on a handful of numbers that can be guessed or measured.
//!
//! ```text
//! θ(x; E) = atan(x − E (x − atan x))
//! Fy = N Dy sin[Ca θ(Ba a; Ea) − Cg θ(Bg γ; Eg)] · cos[Cyκ atan(Byκ κ)]       Ba = Ka/(Ca Dy),  Bg = Kg/(Cg Dy)
//! Fx = N Dx sin[Cx θ(Bx κ; Ex)] · cos[Cxa atan(Bxa a)]                         Bx = Kx/(Cx Dx)
//! Mz = −t0 N Ka a cos[Ct atan(Bt a')] − N mt tan γ cos[atan(Br a')]            a'² = a² + (Kx κ/Ka)²
//! ```
//!
//! N load, N; a lateral slip; κ longitudinal slip; γ camber, rad; D peak friction; Ka, Kg, Kx stiffnesses per load; C, E shape and
//! curvature factors; t0 pneumatic trail, m; mt twisting moment per load, m. Without the combined weights the two forces do not
//! see each other (factors 1, a' = a).
//!
//! Source: our condensation of H. B. Pacejka, *Tire and Vehicle Dynamics*, section 10.6 (camber inside the sine) and of the
//! normalized tires of V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 2.
//! Range: camber below 75 degrees; Ca + Cg < 2, so that the side force does not fold over.

use super::invalid::{InvalidTireData, curvature, lateral_shape, not_negative, positive};
use super::law::{Friction, Slip, TireLaw};
use super::shape::{angle, cos_atan, fading, length};
use mbody::scalar::{Real, SystemScalar};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the compact motorcycle law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompactMotorcycleParameters {
    /// Nominal load N0 to which load dependences refer, N.
    pub nominal_load: f64,
    /// Force forward.
    pub longitudinal: LongitudinalShape,
    /// Side force.
    pub lateral: LateralShape,
    /// Moments about the normal of the road.
    pub aligning: AligningShape,
    /// How the two forces weaken each other; absent: not at all.
    #[serde(default)]
    pub combined: Option<CombinedWeights>,
}

/// Force forward over longitudinal slip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LongitudinalShape {
    /// Slip stiffness per load, Kx.
    pub stiffness: LoadDependence,
    /// Peak friction, Dx.
    pub peak: LoadDependence,
    /// Shape factor, Cx.
    pub shape: f64,
    /// Curvature factor, Ex, at most 1.
    #[serde(default)]
    pub curvature: f64,
}

/// Side force over lateral slip and camber.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LateralShape {
    /// Cornering stiffness per load, Ka, 1/rad.
    pub cornering_stiffness: LoadDependence,
    /// Camber stiffness per load, Kg, 1/rad.
    pub camber_stiffness: LoadDependence,
    /// Peak friction, Dy.
    pub peak: LoadDependence,
    /// Shape factor of the slip part, Ca.
    pub cornering_shape: f64,
    /// Shape factor of the camber part, Cg.
    pub camber_shape: f64,
    /// Curvature factor of the slip part, Ea, at most 1.
    #[serde(default)]
    pub cornering_curvature: f64,
    /// Curvature factor of the camber part, Eg, at most 1.
    #[serde(default)]
    pub camber_curvature: f64,
}

/// Moments about the normal of the road.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AligningShape {
    /// Pneumatic trail at zero slip, t0, m.
    pub pneumatic_trail: f64,
    /// Shape factor of the trail, Ct; 0: a trail that does not shrink with slip.
    #[serde(default)]
    pub trail_shape: f64,
    /// Slope of the trail over slip, Bt.
    #[serde(default)]
    pub trail_slope: f64,
    /// Twisting moment per load and tangent of camber, mt, m.
    pub twisting_moment: f64,
    /// Slope with which the twisting moment fades with slip, Br.
    #[serde(default)]
    pub twisting_slope: f64,
}

/// How the two forces weaken each other: `cos[C atan(B s)]` with the slip s of the other direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CombinedWeights {
    /// Shape factor of the force forward over lateral slip, Cxa, below 2.
    pub longitudinal_shape: f64,
    /// Slope of the force forward over lateral slip, Bxa.
    pub longitudinal_slope: f64,
    /// Shape factor of the side force over longitudinal slip, Cyκ, below 2.
    pub lateral_shape: f64,
    /// Slope of the side force over longitudinal slip, Byκ.
    pub lateral_slope: f64,
}

/// A coefficient that may change with load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LoadDependence {
    /// The same at every load.
    Constant(f64),
    /// `value + slope (N/N0 − 1)`.
    Linear {
        /// Value at nominal load.
        value: f64,
        /// Change per nominal load.
        slope: f64,
    },
    /// `peak (N0/N) sin(2 atan(N/(saturation_load N0)))`: the product with the load rises to `peak·N0` and falls off.
    Saturating {
        /// Largest product of coefficient and load, in nominal loads.
        peak: f64,
        /// Load of this maximum, in nominal loads.
        saturation_load: f64,
    },
}

impl LoadDependence {
    /// The coefficient at a load, given in nominal loads.
    #[inline]
    fn at<S: Real>(&self, ratio: S) -> S {
        match *self {
            Self::Constant(value) => S::from_f64(value),
            Self::Linear { value, slope } => (ratio - 1.0) * slope + value,
            // sin(2 atan u) = 2u/(1 + u²): finite at zero load
            Self::Saturating { peak, saturation_load } => {
                let u = ratio / saturation_load;
                (u * u + 1.0).recip() * (2.0 * peak / saturation_load)
            }
        }
    }

    fn check(&self, parameter: &'static str) -> Result<(), InvalidTireData> {
        match *self {
            Self::Constant(value) => positive(&[(parameter, value)]),
            Self::Linear { value, slope } => {
                super::invalid::finite(&[(parameter, slope)])?;
                positive(&[(parameter, value)])
            }
            Self::Saturating { peak, saturation_load } => positive(&[(parameter, peak), (parameter, saturation_load)]),
        }
    }
}

/// The compact motorcycle law with one set of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct CompactMotorcycle(CompactMotorcycleParameters);

impl CompactMotorcycleParameters {
    /// The law with these parameters.
    ///
    /// # Errors
    /// Loads, stiffnesses, peaks or shape factors that are not positive; negative slopes; curvature factors above 1; a side
    /// force that folds over.
    pub fn law(self) -> Result<CompactMotorcycle, InvalidTireData> {
        let (x, y, z) = (&self.longitudinal, &self.lateral, &self.aligning);
        positive(&[("nominal_load", self.nominal_load), ("longitudinal.shape", x.shape)])?;
        positive(&[("lateral.cornering_shape", y.cornering_shape), ("lateral.camber_shape", y.camber_shape)])?;
        x.stiffness.check("longitudinal.stiffness")?;
        x.peak.check("longitudinal.peak")?;
        y.cornering_stiffness.check("lateral.cornering_stiffness")?;
        y.camber_stiffness.check("lateral.camber_stiffness")?;
        y.peak.check("lateral.peak")?;
        curvature(&[("longitudinal.curvature", x.curvature), ("lateral.cornering_curvature", y.cornering_curvature)])?;
        curvature(&[("lateral.camber_curvature", y.camber_curvature)])?;
        lateral_shape(y.cornering_shape, y.camber_shape)?;
        not_negative(&[("aligning.pneumatic_trail", z.pneumatic_trail), ("aligning.trail_shape", z.trail_shape)])?;
        not_negative(&[("aligning.trail_slope", z.trail_slope), ("aligning.twisting_moment", z.twisting_moment)])?;
        not_negative(&[("aligning.twisting_slope", z.twisting_slope)])?;
        if let Some(w) = &self.combined {
            not_negative(&[("combined.longitudinal_shape", w.longitudinal_shape), ("combined.lateral_shape", w.lateral_shape)])?;
            not_negative(&[("combined.longitudinal_slope", w.longitudinal_slope), ("combined.lateral_slope", w.lateral_slope)])?;
        }
        Ok(CompactMotorcycle(self))
    }
}

impl CompactMotorcycle {
    /// The parameters of the law.
    pub fn parameters(&self) -> &CompactMotorcycleParameters {
        &self.0
    }

    fn ratio<S: Real>(&self, load: S) -> S {
        load / self.0.nominal_load
    }
}

impl TireLaw for CompactMotorcycle {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let CompactMotorcycleParameters { longitudinal: x, lateral: y, aligning: z, combined, .. } = &self.0;
        let Slip { load, lateral: a, longitudinal: kappa, camber, .. } = *slip;
        let ratio = self.ratio(load);

        // pure forces per load
        let (kx, dx) = (x.stiffness.at(ratio), x.peak.at(ratio));
        let theta_x = angle(kx / (dx * x.shape) * kappa, S::from_f64(x.curvature));
        let mut fx = (theta_x * x.shape).sin() * dx;
        let (ka, kg, dy) = (y.cornering_stiffness.at(ratio), y.camber_stiffness.at(ratio), y.peak.at(ratio));
        let theta_a = angle(ka / (dy * y.cornering_shape) * a, S::from_f64(y.cornering_curvature));
        let theta_g = angle(kg / (dy * y.camber_shape) * camber, S::from_f64(y.camber_curvature));
        let mut fy = (theta_a * y.cornering_shape - theta_g * y.camber_shape).sin() * dy;

        // combined slip
        let mut total_slip = a;
        if let Some(w) = combined {
            fx *= fading(w.longitudinal_shape, a * w.longitudinal_slope);
            fy *= fading(w.lateral_shape, kappa * w.lateral_slope);
            total_slip = length(a, kx / ka * kappa);
        }

        let trail = fading(z.trail_shape, total_slip * z.trail_slope) * z.pneumatic_trail;
        let twist = camber.tan() * cos_atan(total_slip * z.twisting_slope) * z.twisting_moment;
        Friction {
            longitudinal: fx * load,
            lateral: fy * load,
            // the shape of the cross-section provides it
            overturning_moment: S::zero(),
            rolling_moment: S::zero(),
            aligning_moment: -(trail * ka * a + twist) * load,
            utilization: length(fx / dx, fy / dy),
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, _camber: S) -> S {
        self.0.lateral.cornering_stiffness.at(self.ratio(load)) * load
    }

    fn saturates(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tire::conformity;

    /// The front tire of the synthetic sport bike used for cross-checks.
    fn reference() -> CompactMotorcycleParameters {
        use LoadDependence::Constant;
        CompactMotorcycleParameters {
            nominal_load: 1300.0,
            longitudinal: LongitudinalShape { stiffness: Constant(20.0), peak: Constant(1.2), shape: 1.5, curvature: 0.0 },
            lateral: LateralShape {
                cornering_stiffness: Constant(14.0),
                camber_stiffness: Constant(0.9),
                peak: Constant(1.25),
                cornering_shape: 1.1,
                camber_shape: 0.7,
                cornering_curvature: 0.0,
                camber_curvature: 0.0,
            },
            aligning: AligningShape {
                pneumatic_trail: 0.025,
                trail_shape: 0.0,
                trail_slope: 0.0,
                twisting_moment: 0.015,
                twisting_slope: 0.0,
            },
            combined: None,
        }
    }

    fn everything() -> CompactMotorcycleParameters {
        let mut p = reference();
        p.longitudinal.stiffness = LoadDependence::Linear { value: 20.0, slope: -3.0 };
        p.lateral.cornering_stiffness = LoadDependence::Saturating { peak: 17.0, saturation_load: 2.2 };
        p.lateral.peak = LoadDependence::Linear { value: 1.3, slope: -0.05 };
        (p.longitudinal.curvature, p.lateral.cornering_curvature, p.lateral.camber_curvature) = (0.2, -1.5, -3.0);
        (p.aligning.trail_shape, p.aligning.trail_slope, p.aligning.twisting_slope) = (1.2, 8.0, 5.0);
        p.combined = Some(CombinedWeights { longitudinal_shape: 1.1, longitudinal_slope: 12.0, lateral_shape: 1.05, lateral_slope: 8.0 });
        p
    }

    #[test]
    fn conforms() {
        conformity::holds(&reference().law().unwrap());
        conformity::holds(&everything().law().unwrap());
    }

    /// Loads, slips and forces of both tires in a steady turn at 30 m/s and 0.6 rad of lean, from an independent program that
    /// prints the slip to five decimals: half a digit of slip is about 0.1 N at N Ka = 19000 N/rad.
    #[test]
    fn the_side_forces_of_the_cross_check_turn_are_met() {
        let mut rear = reference();
        rear.lateral.cornering_stiffness = LoadDependence::Constant(13.0);
        rear.lateral.camber_stiffness = LoadDependence::Constant(0.95);
        for (parameters, load, lateral, camber, side_force, stiffness) in
            [(reference(), 1321.954, -0.00575, 0.60269, -722.911, 14.0), (rear, 1473.896, -0.00716, 0.6, -848.410, 13.0)]
        {
            let f = parameters.law().unwrap().friction(&Slip { load, lateral, longitudinal: 0.0, camber, speed: 30.0 });
            let tolerance = 0.5e-5 * stiffness * load + 0.5e-3 + 0.5e-5 * 0.95 * load;
            assert!((f.lateral - side_force).abs() < tolerance, "{} is not {side_force}", f.lateral);
        }
    }

    #[test]
    fn without_shrinking_the_moment_is_trail_times_linear_side_force_plus_twist() {
        let law = reference().law().unwrap();
        let f = law.friction(&Slip { load: 1000.0, lateral: 0.07, longitudinal: 0.1, camber: 0.5_f64, speed: 30.0 });
        assert!((f.aligning_moment + 1000.0 * (0.025 * 14.0 * 0.07 + 0.015 * 0.5_f64.tan())).abs() < 1e-12);
        let alone = law.friction(&Slip { load: 1000.0, lateral: 0.07, longitudinal: 0.0, camber: 0.5, speed: 30.0 });
        assert_eq!(f.lateral, alone.lateral);
    }

    #[test]
    fn small_slips_show_the_stiffnesses() {
        let law = everything().law().unwrap();
        let at = |a, g| law.friction(&Slip { load: 900.0, lateral: a, longitudinal: 0.0, camber: g, speed: 30.0 }).lateral;
        let (tiny, ratio) = (1e-6, 900.0_f64 / 1300.0);
        let saturating = 17.0 * 1300.0 * (2.0 * (ratio / 2.2).atan()).sin();
        assert!((at(tiny, 0.0) / tiny / saturating - 1.0).abs() < 1e-8);
        assert!((-at(0.0, tiny) / tiny / (0.9 * 900.0) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn faults_are_named() {
        let mut p = reference();
        p.lateral.camber_curvature = 1.5;
        assert_eq!(p.law(), Err(InvalidTireData::CurvatureAboveOne { parameter: "lateral.camber_curvature", value: 1.5 }));
        let mut p = reference();
        p.longitudinal.peak = LoadDependence::Constant(0.0);
        assert_eq!(p.law(), Err(InvalidTireData::NotPositive { parameter: "longitudinal.peak", value: 0.0 }));
    }
}
