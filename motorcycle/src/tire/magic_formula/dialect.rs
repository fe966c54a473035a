//! The dialects of the Magic Formula that tire property files are written in: one row each.

use super::TrailCamber;
use super::coefficients::{Dialects, KEYS, MC, MF52, MF61, MF62};

/// How camber makes side force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Camber {
    /// By a shift of the slip angle, PHY3 (5.2).
    Shift,
    /// By a camber stiffness from which the shift follows, PKY6 and PKY7 (6.x).
    Stiffness,
    /// By an argument of its own inside the sine (motorcycle).
    Inside,
}

/// A dialect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dialect {
    /// Name in messages.
    pub name: &'static str,
    /// Its bit in the table of keys.
    pub bit: Dialects,
    /// Values of `FITTYP` that mean it.
    pub fit_types: &'static [f64],
    /// Values of `PROPERTY_FILE_FORMAT` that mean it, in capital letters with underscores.
    pub formats: &'static [&'static str],
    /// How camber makes side force.
    pub camber: Camber,
}

/// All dialects.
pub const DIALECTS: &[Dialect] = &[
    Dialect {
        name: "MF 5.2",
        bit: MF52,
        fit_types: &[5.0, 6.0, 21.0, 52.0],
        formats: &["PAC2002", "MF_05", "MF05", "MF52"],
        camber: Camber::Shift,
    },
    Dialect { name: "PAC_MC", bit: MC, fit_types: &[], formats: &["PAC_MC", "PACMC", "MF_MCTYRE", "MCTYRE"], camber: Camber::Inside },
    Dialect { name: "MF 6.1", bit: MF61, fit_types: &[60.0, 61.0], formats: &["MF61", "MF_61"], camber: Camber::Stiffness },
    Dialect { name: "MF 6.2", bit: MF62, fit_types: &[62.0], formats: &["MF62", "MF_62"], camber: Camber::Stiffness },
];

impl Dialect {
    /// Whether the dialect cannot do without a key.
    pub fn needs(&self, key: &str) -> bool {
        KEYS.iter().any(|k| k.name == key && k.needed & self.bit != 0)
    }

    /// How camber changes the trail: as asked for in 6.x, by its sign in 5.2, by its magnitude for motorcycle tires.
    pub fn trail_camber(&self, asked: TrailCamber) -> TrailCamber {
        match self.camber {
            Camber::Shift => TrailCamber::Signed,
            Camber::Stiffness => asked,
            Camber::Inside => TrailCamber::Magnitude,
        }
    }

    /// Whether slip angle and camber enter as tangent and sine.
    pub(super) fn starred(&self) -> bool {
        self.camber == Camber::Stiffness
    }
}
