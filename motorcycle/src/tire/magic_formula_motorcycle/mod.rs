//! Motorcycle Magic Formula of Sharp, Evangelou and Limebeer: camber acts inside the sine.
//!
//! ```text
//! θ(x; E) = atan(x − E (x − atan x))                           d = (N − N0)/N0
//! Fx = N μx sin[Cx θ(Bx κ; Ex)] · cos[Cxα atan(Bxα a)]         Bx = Kx/(Cx N μx)
//! Fy = N μy sin[Cy θ(By a; Ey) + Cγ θ(Bγ γ; Eγ)] · Gy          By = Ky/(Cy N μy),  Bγ = Kγ/(Cγ N μy),  Gy = cos[Cyκ atan(Byκ κ)]
//! Mz = −Dt cos[Ct θ(Bt lt; Et)]/√(1 + a²) · Gy Fy(γ = 0) + Dr cos[atan(Br lr)]
//! lt² = a² + (Kx κ/Ky0)²       lr² = (a + SHr)² + (Kx κ/Ky0)²
//! ```
//!
//! N load, N; a lateral slip (one variable everywhere; no cosine or tangent is applied); κ longitudinal slip; γ camber, rad;
//! μ peak friction, K stiffness, N; B, C, D, E slope, shape, peak and curvature factors; Dt trail times load over nominal load,
//! Dr residual moment; Ky0 cornering stiffness upright. The coefficients are explained where they are declared.
//!
//! The publication has y to the right: with the slip of our axes `(Fy, Mz)(a, γ) = (Fy, Mz)_published(a, −γ)`.
//!
//! Source: R. S. Sharp, S. Evangelou, D. J. N. Limebeer, "Advances in the modelling of motorcycle dynamics", Multibody System
//! Dynamics 12 (2004) 251–283, read through public transcriptions; H. B. Pacejka, *Tire and Vehicle Dynamics*, section 10.6.
//! Range: loads from 0 to about twice the nominal load, camber to about 1 rad. Beyond, curvature factors may exceed 1 and the
//! curves turn round (the trail of the 160/70 set does so above 2300 N). Both factors |γ| leave a kink in Mz at zero camber when
//! the tire slips; its derivative there is the mean of both sides. rBy3 makes combined slip differ between left and right.

mod coefficients;

pub use coefficients::{
    AligningCoefficients, CamberPeak, LateralCoefficients, LongitudinalCoefficients, MagicFormulaMotorcycleParameters, ResidualSlope,
};

use super::invalid::{InvalidTireData, finite, lateral_shape, positive};
use super::law::{Friction, Slip, TireLaw};
use super::shape::{angle, cos_atan, fading, length, saturation};
use mbody::scalar::{Real, SystemScalar};
use std::f64::consts::FRAC_2_PI;

/// The motorcycle Magic Formula with one set of coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct MagicFormulaMotorcycle(MagicFormulaMotorcycleParameters);

impl MagicFormulaMotorcycleParameters {
    /// The law with these parameters.
    ///
    /// # Errors
    /// Values that are not finite; loads, lengths, shape factors, peaks or stiffnesses that are not positive; a side force that folds over.
    pub fn law(self) -> Result<MagicFormulaMotorcycle, InvalidTireData> {
        let Self { longitudinal: x, lateral: y, aligning: z, .. } = &self;
        positive(&[("nominal_load", self.nominal_load), ("crown_radius", self.crown_radius)])?;
        finite(&x.named())?;
        finite(&y.named())?;
        finite(&z.named())?;
        positive(&[("Cx", x.Cx), ("pDx1", x.pDx1), ("pKx1", x.pKx1)])?;
        positive(&[("Cy", y.Cy), ("pDy1", y.pDy1), ("pKy1", y.pKy1), ("pKy2", y.pKy2), ("pKy3", y.pKy3), ("C_gamma", y.C_gamma)])?;
        lateral_shape(y.Cy, y.C_gamma)?;
        Ok(MagicFormulaMotorcycle(self))
    }
}

/// Load per nominal load and its deviation d.
struct Load<S> {
    ratio: S,
    d: S,
}

/// Side force per load at one camber: friction, stiffness, slope.
struct Side<S> {
    mu: S,
    stiffness: S,
    b: S,
}

/// Forces per load, and what the moment needs of them.
struct Planar<S> {
    mu_x: S,
    fx: S,
    mu_y: S,
    fy: S,
    /// Side force of the upright tire at the same slip.
    fy_upright: S,
    /// Longitudinal slip turned into lateral slip of the same effect, Kx κ/Ky0.
    equivalent_slip: S,
    /// By Cy, for the slope of the residual moment.
    residual_slope: S,
}

impl MagicFormulaMotorcycle {
    /// The parameters of the law.
    pub fn parameters(&self) -> &MagicFormulaMotorcycleParameters {
        &self.0
    }

    /// Camber stiffness at zero slip and camber, N/rad.
    pub fn camber_stiffness<S: Real>(&self, load: S) -> S {
        self.camber_stiffness_per_load(self.load(load).d) * load
    }

    fn load<S: Real>(&self, load: S) -> Load<S> {
        let ratio = load / self.0.nominal_load;
        Load { ratio, d: ratio - 1.0 }
    }

    fn camber_stiffness_per_load<S: Real>(&self, d: S) -> S {
        d * self.0.lateral.pKy7 + self.0.lateral.pKy6
    }

    /// Peak friction, cornering stiffness per load and slope at a squared camber.
    fn side<S: Real>(&self, load: &Load<S>, g2: S) -> Side<S> {
        let p = &self.0.lateral;
        let growth = g2 * p.pDy3 + 1.0;
        let peak = (load.d * p.pDy2).exp() * p.pDy1;
        let mu = match self.0.camber_peak {
            CamberPeak::Divide => peak / growth,
            CamberPeak::Multiply => peak * growth,
        };
        // Ky = pKy1 N0 sin(pKy2 atan u)/(1 + pKy5 γ²) with u = N/(q N0), divided by N
        let q = g2 * p.pKy4 + p.pKy3;
        let stiffness = saturation(p.pKy2, load.ratio / q) * p.pKy1 / (q * (g2 * p.pKy5 + 1.0));
        Side { mu, stiffness, b: stiffness / (mu * p.Cy) }
    }

    /// Forces per load, in the axes of the publication.
    fn planar<S: Real>(&self, load: &Load<S>, a: S, kappa: S, g: S) -> Planar<S> {
        let (x, y, d) = (&self.0.longitudinal, &self.0.lateral, load.d);

        // force forward
        let mu_x = d * x.pDx2 + x.pDx1;
        let stiffness_x = (d * x.pKx2 + x.pKx1) * (d * x.pKx3).exp();
        let ex = ((d * x.pEx3 + x.pEx2) * d + x.pEx1) * (1.0 - x.pEx4 * kappa.sign());
        let pure_x = (angle(stiffness_x / (mu_x * x.Cx) * kappa, ex) * x.Cx).sin() * mu_x;
        let fx = pure_x * fading(x.Cx_alpha, cos_atan(kappa * x.rBx2) * x.rBx1 * a);

        // side force at this camber, and upright
        let g2 = g * g;
        let (side, upright) = (self.side(load, g2), self.side(load, S::zero()));
        let ey = g2 * y.pEy2 + y.pEy1 + g * (y.pEy4 * a.sign());
        let b_gamma = self.camber_stiffness_per_load(d) / (side.mu * y.C_gamma);
        let phase = angle(side.b * a, ey) * y.Cy + angle(b_gamma * g, S::from_f64(y.E_gamma)) * y.C_gamma;
        let gy = fading(y.Cy_kappa, cos_atan((a - y.rBy3) * y.rBy2) * y.rBy1 * kappa);
        let pure_upright = (angle(upright.b * a, S::from_f64(y.pEy1)) * y.Cy).sin() * upright.mu;

        let residual_slope = match self.0.residual_slope {
            ResidualSlope::AtCamber => side.b * y.Cy,
            ResidualSlope::Upright => upright.b * y.Cy,
        };
        Planar {
            mu_x,
            fx,
            mu_y: side.mu,
            fy: phase.sin() * side.mu * gy,
            fy_upright: pure_upright * gy,
            equivalent_slip: stiffness_x / upright.stiffness * kappa,
            residual_slope,
        }
    }

    /// Aligning moment per load, m, in the axes of the publication.
    fn aligning<S: Real>(&self, load: &Load<S>, a: S, g: S, planar: &Planar<S>) -> S {
        let (z, d) = (&self.0.aligning, load.d);
        let (g_abs, g2) = (g.abs(), g * g);
        let cos_alpha = cos_atan(a);

        // pneumatic trail on the side force of the upright tire
        let bt = (d * z.qBz2 + z.qBz1) * (g_abs * z.qBz5 + g2 * z.qBz6 + 1.0);
        let et = ((d * z.qEz3 + z.qEz2) * d + z.qEz1) * (g * (bt * a * z.Ct).atan() * (z.qEz5 * FRAC_2_PI) + 1.0);
        let dt = (d * z.qDz2 + z.qDz1) * (g_abs * z.qDz3 + g2 * z.qDz4 + 1.0) * load.ratio * self.0.crown_radius;
        // cosines are even: the equivalent slips come without their sign
        let lt = length(a, planar.equivalent_slip);
        let trail = (angle(bt * lt, et) * z.Ct).cos() * dt * cos_alpha;

        // residual moment, mostly of camber
        let lr = length(a + (d * z.qHz4 + z.qHz3) * g, planar.equivalent_slip);
        let dr = ((d * z.qDz9 + z.qDz8) * g + (d * z.qDz11 + z.qDz10) * g * g_abs) * self.0.crown_radius * cos_alpha;
        let br = planar.residual_slope * z.qBz10 + z.qBz9;
        dr * cos_atan(br * lr) - trail * planar.fy_upright
    }
}

impl TireLaw for MagicFormulaMotorcycle {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let load = self.load(slip.load);
        let (a, g) = (slip.lateral, -slip.camber);
        let planar = self.planar(&load, a, slip.longitudinal, g);
        Friction {
            longitudinal: planar.fx * slip.load,
            lateral: planar.fy * slip.load,
            // the shape of the cross-section provides it
            overturning_moment: S::zero(),
            rolling_moment: S::zero(),
            aligning_moment: self.aligning(&load, a, g, &planar) * slip.load,
            utilization: length(planar.fx / planar.mu_x, planar.fy / planar.mu_y),
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, camber: S) -> S {
        self.side(&self.load(load), camber * camber).stiffness * load
    }

    fn saturates(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tire::conformity;

    fn bundled(yaml: &str) -> MagicFormulaMotorcycleParameters {
        #[derive(serde::Deserialize)]
        struct File {
            magic_formula_motorcycle: MagicFormulaMotorcycleParameters,
        }
        serde_yaml::from_str::<File>(yaml).unwrap().magic_formula_motorcycle
    }

    fn front() -> MagicFormulaMotorcycleParameters {
        bundled(include_str!("../../../../models/tires/sel04_120_70.yaml"))
    }

    fn rear() -> [MagicFormulaMotorcycleParameters; 2] {
        [
            bundled(include_str!("../../../../models/tires/sel04_160_70.yaml")),
            bundled(include_str!("../../../../models/tires/sel04_180_55.yaml")),
        ]
    }

    #[test]
    fn conforms() {
        let [rear_160, rear_180] = rear();
        for mut parameters in [front(), rear_160, rear_180] {
            // the one asymmetric coefficient, see below
            parameters.lateral.rBy3 = 0.0;
            for (camber_peak, residual_slope) in
                [(CamberPeak::Divide, ResidualSlope::AtCamber), (CamberPeak::Multiply, ResidualSlope::Upright)]
            {
                let law = MagicFormulaMotorcycleParameters { camber_peak, residual_slope, ..parameters.clone() }.law().unwrap();
                conformity::holds(&law);
            }
        }
    }

    #[test]
    fn only_combined_slip_tells_left_from_right() {
        let law = front().law().unwrap();
        let at = |a, kappa, g| law.friction(&Slip { load: 1100.0, lateral: a, longitudinal: kappa, camber: g, speed: 20.0 });
        assert!((at(0.05, 0.0, 0.3).lateral + at(-0.05, 0.0, -0.3).lateral).abs() < 1e-12);
        assert!((at(0.05, 0.05, 0.3).lateral + at(-0.05, 0.05, -0.3).lateral).abs() > 1.0);
        conformity::derivatives_are_exact(&law);
    }

    #[test]
    fn utilization_is_one_at_the_peak() {
        let law = front().law().unwrap();
        let peak =
            |along: fn(f64) -> Slip<f64>| (0..4000).map(|i| law.friction(&along(f64::from(i) * 5e-4)).utilization).fold(0.0, f64::max);
        let sideways = peak(|s| Slip { load: 1100.0, lateral: s, longitudinal: 0.0, camber: -0.6, speed: 20.0 });
        let forward = peak(|s| Slip { load: 1100.0, lateral: 0.0, longitudinal: s, camber: 0.0, speed: 20.0 });
        assert!((sideways - 1.0).abs() < 1e-6 && (forward - 1.0).abs() < 1e-6, "{sideways} {forward}");
    }

    /// Values of an independent program (six printed digits) for the 120/70 tire as one public source code has it: longitudinal peak of
    /// the 160/70 tire, a length of 0.09 m, and a curvature qEz3.
    #[test]
    fn an_independent_program_agrees_to_its_printed_digits() {
        let mut parameters = front();
        (parameters.crown_radius, parameters.aligning.qEz3) = (0.09, -0.0024085);
        (parameters.longitudinal.pDx1, parameters.longitudinal.pDx2) = (1.2017, -0.0922);
        let law = parameters.law().unwrap();
        let table = [
            ([1100.0, 0.0, 0.05, 0.0], [0.0, 827.0408, -12.4753]),
            ([1100.0, 0.0, 0.0, 0.5], [0.0, 518.5992, 24.5150]),
            ([1500.0, 0.0, 0.03, 0.6], [0.0, 1533.8499, 19.9702]),
            ([1500.0, 0.05, 0.03, 0.6], [1386.4244, 1455.4442, 13.5493]),
            ([1500.0, -0.08, -0.02, -0.4], [-1663.6075, -810.7870, -6.4200]),
            ([800.0, 0.0, 0.1, 0.2], [0.0, 954.9931, -2.7944]),
        ];
        for ([load, longitudinal, lateral, camber], expected) in table {
            let f = law.friction(&Slip { load, lateral, longitudinal, camber: -camber, speed: 20.0 });
            for (value, expected) in [f.longitudinal, f.lateral, f.aligning_moment].into_iter().zip(expected) {
                assert!((value - expected).abs() < 0.5e-4 + 1e-9, "{value} is not {expected} at N = {load}, a = {lateral}");
            }
        }
        assert!((law.cornering_stiffness(1100.0, 0.0) - 18358.6899).abs() < 0.5e-4);
        assert!((law.camber_stiffness(1100.0) - 766.4470).abs() < 0.5e-4);
    }

    #[test]
    fn faulty_coefficients_are_named() {
        let mut parameters = front();
        parameters.lateral.Cy = 1.3;
        assert_eq!(parameters.clone().law(), Err(InvalidTireData::FoldsOver { cornering: 1.3, camber: 0.86765 }));
        parameters.lateral.Cy = -1.0;
        assert_eq!(parameters.law(), Err(InvalidTireData::NotPositive { parameter: "Cy", value: -1.0 }));
        let mut parameters = front();
        parameters.aligning.qEz2 = f64::INFINITY;
        assert_eq!(parameters.law(), Err(InvalidTireData::NotFinite { parameter: "qEz2", value: f64::INFINITY }));
    }
}
