//! The Magic Formula family of tire property files: MF 5.2, PAC_MC, MF 6.1 and 6.2, one law with the differences in place.
//!
//! The formulas stand in `planar` (forces) and `moments`; coefficients and dialects are tables. Turn slip is left out in all of them, as if the
//! path were straight at every instant (all ζ = 1); so are belt dynamics.
//!
//! # Signs
//!
//! Files are in ISO W axes (x forward, y left, z up; α = +atan(V_sy/V_x), so that PKY1 < 0) or in the adapted SAE axes of the book (y right, z down,
//! PKY1 > 0). With our lateral slip a = −V_sy/V* (positive when the tire slides to the right):
//!
//! ```text
//! ISO W          α = −atan a    γ = γ     Fx  Fy  Mx  Mz  as in the file
//! adapted SAE    α = −atan a    γ = γ     Fx −Fy  Mx −Mz
//! other side     α and γ change their signs, and so do Fy, Mx, Mz
//! ```
//!
//! All moments are about the point P_w where the plane of the wheel meets the road; the element carries them to the point of contact
//! ([`MomentPoint`]). Below VXLOW the shifts of an asymmetric tire fade as `(1 − cos(π V/VXLOW))/2`.
//!
//! Pressure: p = (pressure − NOMPRES)/NOMPRES, 6.x only.

mod coefficients;
mod dialect;
mod fit;
mod moments;
mod planar;
mod relaxation;

#[cfg(test)]
mod tests;

pub use coefficients::{ASYMMETRIC, Coefficients, Dialects, KEYS, Key, Measure, PRESSURE};
pub use dialect::{Camber, DIALECTS, Dialect};
pub use fit::BeyondFit;

use super::law::{Fit, Friction, MomentPoint, Slip, TireLaw};
use super::magic_formula_motorcycle::CamberPeak;
use super::shape::{cos_atan, length};
use fit::Holding;
use mbody::scalar::SystemScalar;
use moments::Forces;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// On which side of the vehicle a tire runs, against the side it was measured for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// As measured.
    #[default]
    Measured,
    /// On the other side.
    Mirrored,
    /// In the middle, without what tells left from right.
    Symmetric,
}

/// Axes of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FileAxes {
    /// y left, z up.
    #[default]
    IsoW,
    /// y right, z down, slip angle positive for a positive force.
    AdaptedSae,
}

/// How camber changes the trail of 6.x tires: `1 + QDZ3 … + QDZ4 γ²`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrailCamber {
    /// By |γ*|, as the book prints it.
    #[default]
    Magnitude,
    /// By γ with its sign, as the solver of the authors is reported to have it.
    Signed,
}

/// How a set of coefficients is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Usage {
    /// On which side.
    pub side: Side,
    /// Axes of the file.
    pub axes: FileAxes,
    /// What holds outside the range of the measurement.
    pub beyond: BeyondFit,
    /// Inflation pressure, Pa; that of the file where there is none.
    pub pressure: Option<f64>,
    /// How camber changes the peak of the side force of a motorcycle tire.
    pub camber_peak: CamberPeak,
    /// How camber changes the trail of 6.x tires.
    pub trail_camber: TrailCamber,
    /// The shape of the cross-section makes the overturning moment, so that the file's is not used.
    pub crowned: bool,
}

/// Signs between our axes and those of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Signs {
    alpha: f64,
    gamma: f64,
    fy: f64,
    mx: f64,
    mz: f64,
}

/// The Magic Formula with one set of coefficients.
#[derive(Clone, Debug)]
pub struct MagicFormula {
    c: Coefficients,
    dialect: &'static Dialect,
    signs: Signs,
    holding: Option<Holding>,
    fit: Fit,
    /// Relative deviation of the pressure from the nominal one.
    pressure: f64,
    /// (p/p0)^QSY8.
    rolling_pressure: f64,
    camber_peak: CamberPeak,
    trail_camber: TrailCamber,
    crowned: bool,
    /// Nominal load Fz0' = LFZO FNOMIN, N.
    nominal_load: f64,
}

/// A state in the quantities of the formula.
pub(super) struct Operating<S> {
    /// Load, N.
    load: S,
    /// Load over Fz0'.
    ratio: S,
    /// Relative deviation of the load from Fz0'.
    d: S,
    kappa: S,
    /// Slip angle, rad, or its tangent for 6.x.
    alpha: S,
    cos_alpha: S,
    /// Camber, rad.
    camber: S,
    /// Camber in the side force: γ LGAY, or sin γ for 6.x.
    lateral_camber: S,
    speed: S,
    /// Share of the shifts, 1 above VXLOW.
    fade: f64,
}

impl MagicFormula {
    /// The law with these coefficients.
    pub fn new(coefficients: Coefficients, dialect: &'static Dialect, usage: Usage) -> Self {
        let trail_camber = dialect.trail_camber(usage.trail_camber);
        let c = if usage.side == Side::Symmetric { coefficients.symmetric(trail_camber) } else { coefficients };
        let mirrored = if usage.side == Side::Mirrored { -1.0 } else { 1.0 };
        let turned = if usage.axes == FileAxes::AdaptedSae { -1.0 } else { 1.0 };
        let signs = Signs { alpha: -mirrored, gamma: mirrored, fy: mirrored * turned, mx: mirrored, mz: mirrored * turned };
        let nominal_pressure = c.NOMPRES;
        let pressure = usage.pressure.unwrap_or(if c.INFLPRES > 0.0 { c.INFLPRES } else { nominal_pressure });
        let known = nominal_pressure > 0.0 && pressure > 0.0;
        Self {
            signs,
            holding: (usage.beyond == BeyondFit::Hold).then(|| Holding::of(&c)),
            fit: fit::range(&c, signs.alpha, signs.gamma),
            pressure: if known { pressure / nominal_pressure - 1.0 } else { 0.0 },
            rolling_pressure: if known { (pressure / nominal_pressure).powf(c.QSY8) } else { 1.0 },
            camber_peak: usage.camber_peak,
            trail_camber,
            crowned: usage.crowned,
            nominal_load: c.FNOMIN * c.LFZO,
            c,
            dialect,
        }
    }

    /// The coefficients in use.
    pub fn coefficients(&self) -> &Coefficients {
        &self.c
    }

    /// The dialect.
    pub fn dialect(&self) -> &'static Dialect {
        self.dialect
    }

    /// A slip of our axes as the formula takes it.
    #[inline]
    fn operating<S: SystemScalar>(&self, slip: &Slip<S>) -> Operating<S> {
        let turned = Slip { lateral: slip.lateral * self.signs.alpha, camber: slip.camber * self.signs.gamma, ..*slip };
        let held = self.holding.as_ref().map_or(turned, |holding| holding.hold(&turned));
        let ratio = held.load / self.nominal_load;
        let v = held.speed.value() / self.c.VXLOW;
        Operating {
            load: held.load,
            ratio,
            d: ratio - 1.0,
            kappa: held.longitudinal,
            alpha: if self.dialect.starred() { held.lateral } else { held.lateral.atan() },
            cos_alpha: cos_atan(held.lateral),
            camber: held.camber,
            lateral_camber: if self.dialect.starred() { held.camber.sin() } else { held.camber * self.c.LGAY },
            speed: held.speed,
            fade: if v < 1.0 { 0.5 * (1.0 - (PI * v).cos()) } else { 1.0 },
        }
    }
}

impl TireLaw for MagicFormula {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let at = self.operating(slip);
        let longitudinal = self.longitudinal(&at);
        let lateral = self.lateral(&at, at.lateral_camber);
        let fx = longitudinal.force * self.longitudinal_weight(&at);
        let weighted = lateral.force * self.lateral_weight(&at, at.lateral_camber);
        let fy = weighted + self.plysteer_of_slip(&at, lateral.friction);
        let (on_trail, ky) = match self.dialect.camber {
            Camber::Shift => (weighted, lateral.stiffness),
            _ => {
                let upright = self.lateral(&at, S::zero());
                let ky = if self.dialect.starred() { lateral.stiffness } else { upright.stiffness };
                (upright.force * self.lateral_weight(&at, S::zero()), ky)
            }
        };
        let mz = self.aligning(&at, &Forces { fx, fy, on_trail, kx: longitudinal.stiffness, lateral: &lateral, ky });
        let mx = if self.crowned { S::zero() } else { self.overturning(&at, fy) };
        let load = slip.load;
        Friction {
            longitudinal: fx * load,
            lateral: fy * load * self.signs.fy,
            overturning_moment: mx * load * self.signs.mx,
            rolling_moment: self.rolling(&at, fx) * load,
            aligning_moment: mz * load * self.signs.mz,
            utilization: length(fx / longitudinal.friction, fy / lateral.friction),
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, camber: S) -> S {
        let at = self.operating(&Slip { load, lateral: S::zero(), longitudinal: S::zero(), camber, speed: S::from_f64(self.c.LONGVL) });
        self.stiffness_per_load(&at) * load * (self.signs.alpha * self.signs.fy)
    }

    fn saturates(&self) -> bool {
        true
    }

    fn fit(&self) -> Option<Fit> {
        Some(self.fit)
    }

    fn moment_point(&self) -> MomentPoint {
        if self.crowned { MomentPoint::WheelPlaneOfCrown } else { MomentPoint::WheelPlane }
    }

    fn relaxation_lengths<S: SystemScalar>(&self, load: S, camber: S) -> [S; 2] {
        let at = self.operating(&Slip { load, lateral: S::zero(), longitudinal: S::zero(), camber, speed: S::from_f64(self.c.LONGVL) });
        self.lengths(&at)
    }

    fn rolls(&self) -> bool {
        true
    }
}
