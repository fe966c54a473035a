//! Friction of the road other than that on which a tire was measured: the method of similarity.
//!
//! ```text
//! Fx, Fy = μ f(κ/μ, a/μ + s)        s = (1/μ − 1) Fγ/C,    Fγ = f_y(0, 0)        M = μ m(κ/μ, a/μ)
//! ```
//!
//! f, m forces and moments of the law at the same load and camber; κ, a longitudinal and lateral slip; μ friction over that of the measurement; Fγ side force of the camber alone, N; C cornering
//! stiffness, N. Peaks scale with μ; stiffnesses against slip and camber are those of the carcass and stay: s makes up for what the scaling takes from the side force of
//! the camber. A law without a peak has the same forces on every road.
//!
//! Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, section 4.2 (similarity method; camber as an equivalent lateral slip). Moments other than by slip
//! scale with μ, as the residual torque of the Magic Formula does (section 4.3.2).
//! Range: dry and wet roads; how the shape of the curves changes on ice or water is not in it.

use super::law::{Friction, Slip, TireLaw};
use mbody::scalar::SystemScalar;

/// Cornering stiffness below which the camber is left alone, N: keeps s finite at vanishing load.
const SOFT: f64 = 1.0;

/// Forces and moments on a road with the friction μ.
#[inline]
pub(super) fn friction<S: SystemScalar>(law: &impl TireLaw, slip: &Slip<S>, mu: Option<S>) -> Friction<S> {
    let Some(mu) = mu else { return law.friction(slip) };
    let per = mu.recip();
    let scaled = Slip { lateral: slip.lateral * per, longitudinal: slip.longitudinal * per, ..*slip };
    let of_camber = law.friction(&Slip { lateral: S::zero(), longitudinal: S::zero(), ..*slip }).lateral;
    let stiffness = law.cornering_stiffness(slip.load, slip.camber);
    let shift = (per - 1.0) * of_camber * stiffness / (stiffness * stiffness + SOFT * SOFT);
    let forces = law.friction(&Slip { lateral: scaled.lateral + shift, ..scaled });
    let moments = law.friction(&scaled);
    Friction {
        longitudinal: forces.longitudinal * mu,
        lateral: forces.lateral * mu,
        overturning_moment: moments.overturning_moment * mu,
        // the work of the rubber between carcass and rim, whatever the road
        rolling_moment: moments.rolling_moment,
        aligning_moment: moments.aligning_moment * mu,
        utilization: forces.utilization,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tire::AnyTireLaw;
    use crate::tire::compact_motorcycle::CompactMotorcycleParameters;
    use crate::tire::linear_normalized::LinearNormalizedParameters;

    /// A law with a peak.
    fn peaked() -> AnyTireLaw {
        let parameters = "{ nominal_load: 1300, longitudinal: { stiffness: { constant: 20 }, peak: { constant: 1.2 }, shape: 1.5 }, \
            lateral: { cornering_stiffness: { constant: 14 }, camber_stiffness: { constant: 0.9 }, peak: { constant: 1.25 }, \
            cornering_shape: 1.2, camber_shape: 0.7 }, aligning: { pneumatic_trail: 0.025, twisting_moment: 0.015 } }";
        // through a plain value: in it a choice is a mapping with one key, as in descriptions
        let value: serde_json::Value = serde_yaml::from_str(parameters).expect("parameters");
        AnyTireLaw::new(serde_json::from_value::<CompactMotorcycleParameters>(value).expect("parameters").law().expect("a law"))
    }

    const SLIP: Slip<f64> = Slip { load: 1500.0, lateral: 0.0, longitudinal: 0.0, camber: 0.0, speed: 20.0 };

    #[test]
    fn peaks_scale_and_stiffnesses_stay() {
        let law = peaked();
        let at = |a: f64, camber: f64, mu| friction(&law, &Slip { lateral: a, camber, ..SLIP }, mu).lateral;
        let peak = |mu| (0..400).map(|k| at(0.002 * f64::from(k), 0.0, mu)).fold(0.0, f64::max);
        assert!((peak(Some(0.5)) / peak(None) - 0.5).abs() < 1e-3);
        let slope = |mu| (at(1e-5, 0.0, mu) - at(-1e-5, 0.0, mu)) / 2e-5;
        assert!((slope(Some(0.5)) / slope(None) - 1.0).abs() < 1e-6);
        // the side force of a small camber is that of the dry road
        assert!((at(0.0, 0.02, Some(0.6)) / at(0.0, 0.02, None) - 1.0).abs() < 0.01);
        assert!((at(0.03, 0.4, Some(1.0)) - at(0.03, 0.4, None)).abs() < 1e-9);
    }

    #[test]
    fn a_law_without_a_peak_is_the_same_on_every_road() {
        let parameters = LinearNormalizedParameters {
            longitudinal_stiffness: 12.0,
            cornering_stiffness: 11.0,
            camber_stiffness: 0.9,
            aligning_stiffness: 0.1,
            twisting_stiffness: 0.0,
        };
        let law = AnyTireLaw::new(parameters.law().expect("a law"));
        let slip = Slip { lateral: 0.03, longitudinal: -0.02, camber: 0.5, ..SLIP };
        let (dry, wet) = (law.friction(&slip), friction(&law, &slip, Some(0.4)));
        for (a, b) in [(dry.lateral, wet.lateral), (dry.longitudinal, wet.longitudinal), (dry.aligning_moment, wet.aligning_moment)] {
            // the guard against a vanishing stiffness, 1/C² = 4e-9
            assert!((a - b).abs() < 1e-8 * a.abs().max(1.0) * 100.0, "{a} {b}");
        }
        assert!(friction(&law, &Slip { load: 0.0, ..slip }, Some(0.4)).lateral.is_finite());
    }
}
