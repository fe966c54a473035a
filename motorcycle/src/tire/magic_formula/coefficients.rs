//! Coefficients of the Magic Formula family, under the names of tire property files.
//!
//! One table serves all dialects: which of them uses a coefficient, which needs it, and what holds where a file leaves it out.
//! In the descriptions d is the relative deviation of the load from the nominal load, p that of the pressure, γ the camber.
//!
//! Source: lists of keys in the manuals of MF 5.2, of its motorcycle version and of 6.x as public programs reproduce them;
//! meaning after H. B. Pacejka, *Tire and Vehicle Dynamics*, chapter 4 and section 10.6.

use super::TrailCamber;

/// A set of dialects, one bit each.
pub type Dialects = u8;

/// MF 5.2 and PAC2002.
pub const MF52: Dialects = 1;
/// PAC_MC and its predecessors for motorcycles.
pub const MC: Dialects = 2;
/// MF 6.1.
pub const MF61: Dialects = 4;
/// MF 6.2.
pub const MF62: Dialects = 8;
const NONE: Dialects = 0;
const ALL: Dialects = MF52 | MC | MF61 | MF62;
const CAR: Dialects = MF52 | MF61 | MF62;
const MF6: Dialects = MF61 | MF62;
const OLD: Dialects = MF52 | MC;

/// Exponents of length, force, angle and time in the unit of a value.
pub type Measure = [i32; 4];

const NUMBER: Measure = [0, 0, 0, 0];
const LENGTH: Measure = [1, 0, 0, 0];
const FORCE: Measure = [0, 1, 0, 0];
const ANGLE: Measure = [0, 0, 1, 0];
const SPEED: Measure = [1, 0, 0, -1];
const STIFFNESS: Measure = [-1, 1, 0, 0];
const DAMPING: Measure = [-1, 1, 0, 1];
/// Pressure: force per area, or what `[UNITS]` says by itself.
pub const PRESSURE: Measure = [-2, 1, 0, 0];

/// A key of a tire property file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in files.
    pub name: &'static str,
    /// Section in which it stands.
    pub section: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Dialects that use it.
    pub used: Dialects,
    /// Dialects that cannot do without it.
    pub needed: Dialects,
    /// Value where it is left out, in SI.
    pub otherwise: f64,
    /// What it measures.
    pub measure: Measure,
}

macro_rules! keys {
    ($($section:literal { $($name:ident $used:ident $needed:ident $otherwise:literal $measure:ident $about:literal;)* })*) => {
        /// Values of all keys, in SI; those that a dialect does not use are never read.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Coefficients {
            $($(#[doc = $about] pub $name: f64,)*)*
        }

        /// All keys that have an effect here.
        pub const KEYS: &[Key] = &[
            $($(Key {
                name: stringify!($name),
                section: $section,
                about: $about,
                used: $used,
                needed: $needed,
                otherwise: $otherwise,
                measure: $measure,
            },)*)*
        ];

        impl Coefficients {
            /// The coefficients as a function of the key gives them.
            pub fn from_keys(mut value: impl FnMut(&Key) -> f64) -> Self {
                let mut keys = KEYS.iter();
                let mut next = || keys.next().map_or(0.0, &mut value);
                Self { $($($name: next(),)*)* }
            }

            /// The coefficient of a name.
            pub fn get_mut(&mut self, name: &str) -> Option<&mut f64> {
                match name {
                    $($(stringify!($name) => Some(&mut self.$name),)*)*
                    _ => None,
                }
            }
        }
    };
}

keys! {
    "MODEL" {
        LONGVL ALL NONE 16.7 SPEED "speed of the measurement";
        VXLOW ALL NONE 1.0 SPEED "speed below which shifts of the curves fade";
    }
    "DIMENSION" {
        UNLOADED_RADIUS ALL ALL 0.0 LENGTH "free radius";
    }
    "OPERATING_CONDITIONS" {
        INFLPRES ALL NONE 0.0 PRESSURE "inflation pressure";
        NOMPRES MF6 NONE 0.0 PRESSURE "nominal inflation pressure, of the fit";
    }
    "VERTICAL" {
        FNOMIN ALL ALL 0.0 FORCE "nominal load";
        VERTICAL_STIFFNESS ALL NONE 0.0 STIFFNESS "vertical stiffness";
        VERTICAL_DAMPING ALL NONE 0.0 DAMPING "vertical damping";
        Q_FZ2 MF6 NONE 0.0 NUMBER "quadratic part of the load over compression";
        PFZ1 MF6 NONE 0.0 NUMBER "change of the vertical stiffness with p";
        BREFF ALL NONE 0.0 NUMBER "slope of the effective radius at low load";
        DREFF ALL NONE 0.0 NUMBER "peak of the effective radius";
        FREFF ALL NONE 0.0 NUMBER "slope of the effective radius at high load";
    }
    "STRUCTURAL" {
        LONGITUDINAL_STIFFNESS MF6 NONE 0.0 STIFFNESS "longitudinal stiffness of the carcass";
        LATERAL_STIFFNESS MF6 NONE 0.0 STIFFNESS "lateral stiffness of the carcass";
        PCFX1 MF6 NONE 0.0 NUMBER "change of the longitudinal stiffness with d";
        PCFX2 MF6 NONE 0.0 NUMBER "change of the longitudinal stiffness with d²";
        PCFX3 MF6 NONE 0.0 NUMBER "change of the longitudinal stiffness with p";
        PCFY1 MF6 NONE 0.0 NUMBER "change of the lateral stiffness with d";
        PCFY2 MF6 NONE 0.0 NUMBER "change of the lateral stiffness with d²";
        PCFY3 MF6 NONE 0.0 NUMBER "change of the lateral stiffness with p";
    }
    "LONG_SLIP_RANGE" {
        KPUMIN ALL NONE -1.5 NUMBER "least longitudinal slip of the fit";
        KPUMAX ALL NONE 1.5 NUMBER "largest longitudinal slip of the fit";
    }
    "SLIP_ANGLE_RANGE" {
        ALPMIN ALL NONE -1.5 ANGLE "least slip angle of the fit";
        ALPMAX ALL NONE 1.5 ANGLE "largest slip angle of the fit";
    }
    "INCLINATION_ANGLE_RANGE" {
        CAMMIN ALL NONE -1.2 ANGLE "least camber of the fit";
        CAMMAX ALL NONE 1.2 ANGLE "largest camber of the fit";
    }
    "VERTICAL_FORCE_RANGE" {
        FZMIN ALL NONE 0.0 FORCE "least load of the fit";
        FZMAX ALL NONE 1e9 FORCE "largest load of the fit";
    }
    "INFLATION_PRESSURE_RANGE" {
        PRESMIN MF6 NONE 0.0 PRESSURE "least pressure of the fit";
        PRESMAX MF6 NONE 1e9 PRESSURE "largest pressure of the fit";
    }
    "SCALING_COEFFICIENTS" {
        LFZO ALL NONE 1.0 NUMBER "factor of the nominal load";
        LCX ALL NONE 1.0 NUMBER "factor of the shape of Fx";
        LMUX ALL NONE 1.0 NUMBER "factor of the longitudinal friction";
        LEX ALL NONE 1.0 NUMBER "factor of the curvature of Fx";
        LKX ALL NONE 1.0 NUMBER "factor of the longitudinal slip stiffness";
        LHX CAR NONE 1.0 NUMBER "factor of the horizontal shift of Fx";
        LVX ALL NONE 1.0 NUMBER "factor of the vertical shift of Fx";
        LGAX OLD NONE 1.0 NUMBER "factor of camber in Fx";
        LCY ALL NONE 1.0 NUMBER "factor of the shape of Fy";
        LMUY ALL NONE 1.0 NUMBER "factor of the lateral friction";
        LEY ALL NONE 1.0 NUMBER "factor of the curvature of Fy";
        LKY ALL NONE 1.0 NUMBER "factor of the cornering stiffness";
        LCC MC NONE 1.0 NUMBER "factor of the shape of the camber part";
        LKC MC NONE 1.0 NUMBER "factor of the camber stiffness";
        LEC MC NONE 1.0 NUMBER "factor of the curvature of the camber part";
        LKYC CAR NONE 1.0 NUMBER "factor of the camber stiffness";
        LKZC ALL NONE 1.0 NUMBER "factor of the camber moment";
        LHY ALL NONE 1.0 NUMBER "factor of the horizontal shift of Fy";
        LVY CAR NONE 1.0 NUMBER "factor of the vertical shift of Fy";
        LGAY OLD NONE 1.0 NUMBER "factor of camber in Fy";
        LTR ALL NONE 1.0 NUMBER "factor of the pneumatic trail";
        LRES ALL NONE 1.0 NUMBER "factor of the residual moment";
        LGAZ OLD NONE 1.0 NUMBER "factor of camber in Mz";
        LXAL ALL NONE 1.0 NUMBER "factor of the influence of the slip angle on Fx";
        LYKA ALL NONE 1.0 NUMBER "factor of the influence of longitudinal slip on Fy";
        LVYKA ALL NONE 1.0 NUMBER "factor of the side force that longitudinal slip makes";
        LS ALL NONE 1.0 NUMBER "factor of the arm of Fx";
        LSGKP OLD NONE 1.0 NUMBER "factor of the longitudinal relaxation length";
        LSGAL OLD NONE 1.0 NUMBER "factor of the lateral relaxation length";
        LMX ALL NONE 1.0 NUMBER "factor of the overturning moment";
        LVMX ALL NONE 1.0 NUMBER "factor of the vertical shift of Mx";
        LMY ALL NONE 1.0 NUMBER "factor of the rolling resistance";
    }
    "LONGITUDINAL_COEFFICIENTS" {
        PCX1 ALL ALL 0.0 NUMBER "shape factor of Fx";
        PDX1 ALL ALL 0.0 NUMBER "longitudinal friction at nominal load";
        PDX2 ALL NONE 0.0 NUMBER "change of the friction with d";
        PDX3 CAR NONE 0.0 NUMBER "decrease of the friction with γ²";
        PEX1 ALL NONE 0.0 NUMBER "curvature factor at nominal load";
        PEX2 ALL NONE 0.0 NUMBER "change of the curvature with d";
        PEX3 ALL NONE 0.0 NUMBER "change of the curvature with d²";
        PEX4 ALL NONE 0.0 NUMBER "difference of the curvature between driving and braking";
        PKX1 ALL ALL 0.0 NUMBER "slip stiffness per load at nominal load";
        PKX2 ALL NONE 0.0 NUMBER "change of the slip stiffness with d";
        PKX3 ALL NONE 0.0 NUMBER "exponent of the slip stiffness in d";
        PHX1 CAR NONE 0.0 NUMBER "horizontal shift at nominal load";
        PHX2 CAR NONE 0.0 NUMBER "change of the shift with d";
        PVX1 ALL NONE 0.0 NUMBER "vertical shift per load at nominal load";
        PVX2 ALL NONE 0.0 NUMBER "change of the vertical shift with d";
        PPX1 MF6 NONE 0.0 NUMBER "change of the slip stiffness with p";
        PPX2 MF6 NONE 0.0 NUMBER "change of the slip stiffness with p²";
        PPX3 MF6 NONE 0.0 NUMBER "change of the friction with p";
        PPX4 MF6 NONE 0.0 NUMBER "change of the friction with p²";
        RBX1 ALL NONE 0.0 NUMBER "slope of the fading of Fx with slip angle";
        RBX2 ALL NONE 0.0 NUMBER "change of this slope with longitudinal slip";
        RBX3 MC_AND_MF6 NONE 0.0 NUMBER "change of this slope with γ²";
        RCX1 ALL NONE 0.0 NUMBER "shape factor of the fading of Fx";
        REX1 ALL NONE 0.0 NUMBER "curvature factor of the fading of Fx";
        REX2 ALL NONE 0.0 NUMBER "change of this curvature with d";
        RHX1 ALL NONE 0.0 NUMBER "shift of the fading of Fx";
        PTX1 OLD NONE 0.0 NUMBER "longitudinal relaxation length at nominal load";
        PTX2 OLD NONE 0.0 NUMBER "change of this length with d";
        PTX3 OLD NONE 0.0 NUMBER "exponent of this length in d";
    }
    "OVERTURNING_COEFFICIENTS" {
        QSX1 ALL NONE 0.0 NUMBER "shift of the overturning moment";
        QSX2 ALL NONE 0.0 NUMBER "overturning moment of camber";
        QSX3 ALL NONE 0.0 NUMBER "overturning moment of the side force";
        QSX4 MF6 NONE 0.0 NUMBER "mixed influence of load, side force and camber";
        QSX5 MF6 NONE 0.0 NUMBER "shape factor of the load in it";
        QSX6 MF6 NONE 0.0 NUMBER "slope of the load in it";
        QSX7 MF6 NONE 0.0 NUMBER "camber in it";
        QSX8 MF6 NONE 0.0 NUMBER "side force in it";
        QSX9 MF6 NONE 0.0 NUMBER "slope of the side force in it";
        QSX10 MF6 NONE 0.0 NUMBER "overturning moment of load and camber";
        QSX11 MF6 NONE 0.0 NUMBER "slope of the load in it";
        QSX12 MF6 NONE 0.0 NUMBER "overturning moment of γ|γ|";
        QSX13 MF6 NONE 0.0 NUMBER "overturning moment of the side force alone";
        QSX14 MF6 NONE 0.0 NUMBER "change of it with |γ|";
        PPMX1 MF6 NONE 0.0 NUMBER "change of the overturning moment of camber with p";
    }
    "LATERAL_COEFFICIENTS" {
        PCY1 ALL ALL 0.0 NUMBER "shape factor of Fy";
        PCY2 MC MC 0.0 NUMBER "shape factor of the camber part";
        PDY1 ALL ALL 0.0 NUMBER "lateral friction at nominal load";
        PDY2 ALL NONE 0.0 NUMBER "change of the friction with d; exponent for motorcycle tires";
        PDY3 ALL NONE 0.0 NUMBER "change of the friction with γ²";
        PEY1 ALL NONE 0.0 NUMBER "curvature factor";
        PEY2 ALL NONE 0.0 NUMBER "change of the curvature with d; with γ² for motorcycle tires";
        PEY3 ALL NONE 0.0 NUMBER "difference of the curvature between left and right";
        PEY4 ALL NONE 0.0 NUMBER "change of this difference with γ";
        PEY5 MC_AND_MF6 NONE 0.0 NUMBER "change of the curvature with γ²; curvature factor of the camber part for motorcycle tires";
        PKY1 ALL ALL 0.0 NUMBER "greatest cornering stiffness over nominal load";
        PKY2 ALL ALL 0.0 NUMBER "load of the greatest cornering stiffness; shape factor over load for motorcycle tires";
        PKY3 ALL MC 0.0 NUMBER "decrease of the cornering stiffness with |γ|; load of the greatest one for motorcycle tires";
        PKY4 MC_AND_MF6 NONE 2.0 NUMBER "shape factor of the cornering stiffness over load; change of the load with γ² for motorcycle tires";
        PKY5 MC_AND_MF6 NONE 0.0 NUMBER "change of the load with γ²; decrease of the stiffness with γ² for motorcycle tires";
        PKY6 MC_AND_MF6 NONE 0.0 NUMBER "camber stiffness per load at nominal load";
        PKY7 MC_AND_MF6 NONE 0.0 NUMBER "change of the camber stiffness with d";
        PHY1 ALL NONE 0.0 NUMBER "horizontal shift at nominal load";
        PHY2 CAR NONE 0.0 NUMBER "change of the shift with d";
        PHY3 MF52 NONE 0.0 NUMBER "change of the shift with γ";
        PVY1 CAR NONE 0.0 NUMBER "vertical shift per load at nominal load";
        PVY2 CAR NONE 0.0 NUMBER "change of the vertical shift with d";
        PVY3 CAR NONE 0.0 NUMBER "change of the vertical shift with γ";
        PVY4 CAR NONE 0.0 NUMBER "change of the vertical shift with γ and d";
        PPY1 MF6 NONE 0.0 NUMBER "change of the cornering stiffness with p";
        PPY2 MF6 NONE 0.0 NUMBER "change of the load of the greatest stiffness with p";
        PPY3 MF6 NONE 0.0 NUMBER "change of the friction with p";
        PPY4 MF6 NONE 0.0 NUMBER "change of the friction with p²";
        PPY5 MF6 NONE 0.0 NUMBER "change of the camber stiffness with p";
        RBY1 ALL NONE 0.0 NUMBER "slope of the fading of Fy with longitudinal slip";
        RBY2 ALL NONE 0.0 NUMBER "change of this slope with slip angle";
        RBY3 ALL NONE 0.0 NUMBER "slip angle about which it changes";
        RBY4 MC_AND_MF6 NONE 0.0 NUMBER "change of this slope with γ²";
        RCY1 ALL NONE 0.0 NUMBER "shape factor of the fading of Fy";
        REY1 ALL NONE 0.0 NUMBER "curvature factor of the fading of Fy";
        REY2 ALL NONE 0.0 NUMBER "change of this curvature with d";
        RHY1 ALL NONE 0.0 NUMBER "shift of the fading of Fy";
        RHY2 ALL NONE 0.0 NUMBER "change of this shift with d";
        RVY1 ALL NONE 0.0 NUMBER "side force of longitudinal slip per friction";
        RVY2 ALL NONE 0.0 NUMBER "change of it with d";
        RVY3 ALL NONE 0.0 NUMBER "change of it with γ";
        RVY4 ALL NONE 0.0 NUMBER "fading of it with slip angle";
        RVY5 ALL NONE 0.0 NUMBER "shape factor of it over longitudinal slip";
        RVY6 ALL NONE 0.0 NUMBER "slope of it over longitudinal slip";
        PTY1 OLD NONE 0.0 NUMBER "greatest lateral relaxation length over free radius";
        PTY2 OLD NONE 0.0 NUMBER "load of the greatest length; shape factor over load for motorcycle tires";
        PTY3 MC NONE 0.0 NUMBER "load of the greatest length for motorcycle tires";
    }
    "ROLLING_COEFFICIENTS" {
        QSY1 ALL NONE 0.0 NUMBER "rolling resistance coefficient";
        QSY2 ALL NONE 0.0 NUMBER "change of it with Fx";
        QSY3 ALL NONE 0.0 NUMBER "change of it with speed";
        QSY4 ALL NONE 0.0 NUMBER "change of it with the fourth power of speed";
        QSY5 MF6 NONE 0.0 NUMBER "change of it with γ²";
        QSY6 MF6 NONE 0.0 NUMBER "change of it with load and γ²";
        QSY7 MF6 NONE 1.0 NUMBER "exponent of the load";
        QSY8 MF6 NONE 0.0 NUMBER "exponent of the pressure";
    }
    "ALIGNING_COEFFICIENTS" {
        QBZ1 ALL NONE 0.0 NUMBER "slope of the trail";
        QBZ2 ALL NONE 0.0 NUMBER "change of the slope with d";
        QBZ3 ALL NONE 0.0 NUMBER "change of the slope with d²";
        QBZ4 ALL NONE 0.0 NUMBER "change of the slope with γ";
        QBZ5 ALL NONE 0.0 NUMBER "change of the slope with |γ|";
        QBZ9 ALL NONE 0.0 NUMBER "slope of the residual moment";
        QBZ10 ALL NONE 0.0 NUMBER "slope of the residual moment per slope of Fy";
        QCZ1 ALL NONE 0.0 NUMBER "shape factor of the trail";
        QDZ1 ALL NONE 0.0 NUMBER "trail at nominal load over free radius";
        QDZ2 ALL NONE 0.0 NUMBER "change of the trail with d";
        QDZ3 ALL NONE 0.0 NUMBER "change of the trail with γ; with |γ| for motorcycle tires";
        QDZ4 ALL NONE 0.0 NUMBER "change of the trail with γ²";
        QDZ6 ALL NONE 0.0 NUMBER "residual moment at nominal load";
        QDZ7 ALL NONE 0.0 NUMBER "change of it with d";
        QDZ8 ALL NONE 0.0 NUMBER "residual moment of camber";
        QDZ9 ALL NONE 0.0 NUMBER "change of it with d";
        QDZ10 MC_AND_MF6 NONE 0.0 NUMBER "residual moment of γ|γ|";
        QDZ11 MC_AND_MF6 NONE 0.0 NUMBER "change of it with d";
        QEZ1 ALL NONE 0.0 NUMBER "curvature factor of the trail";
        QEZ2 ALL NONE 0.0 NUMBER "change of the curvature with d";
        QEZ3 ALL NONE 0.0 NUMBER "change of the curvature with d²";
        QEZ4 ALL NONE 0.0 NUMBER "change of the curvature with the sign of slip";
        QEZ5 ALL NONE 0.0 NUMBER "change of the curvature with γ and the sign of slip";
        QHZ1 ALL NONE 0.0 NUMBER "shift of the trail; of the residual moment for motorcycle tires";
        QHZ2 ALL NONE 0.0 NUMBER "change of the shift with d";
        QHZ3 ALL NONE 0.0 NUMBER "change of the shift with γ";
        QHZ4 ALL NONE 0.0 NUMBER "change of the shift with γ and d";
        SSZ1 ALL NONE 0.0 NUMBER "arm of Fx over free radius";
        SSZ2 ALL NONE 0.0 NUMBER "change of the arm with Fy";
        SSZ3 ALL NONE 0.0 NUMBER "change of the arm with γ";
        SSZ4 ALL NONE 0.0 NUMBER "change of the arm with γ and d";
        PPZ1 MF6 NONE 0.0 NUMBER "change of the trail with p";
        PPZ2 MF6 NONE 0.0 NUMBER "change of the residual moment with p";
    }
}

const MC_AND_MF6: Dialects = MC | MF6;

/// Coefficients that tell left from right: a symmetric tire has none of them.
///
/// RHX1, though it shifts a slip angle, is one of them; RHY1 and RHY2 shift longitudinal slip and are not. SSZ2 keeps its side with Fy.
/// QDZ3 is one of them where it goes with γ and not with |γ|.
pub const ASYMMETRIC: &[&str] = &[
    "RHX1", "QSX1", "PEY3", "PHY1", "PHY2", "PVY1", "PVY2", "RBY3", "RVY1", "RVY2", "QBZ4", "QDZ6", "QDZ7", "QEZ4", "QHZ1", "QHZ2", "SSZ1",
];

impl Coefficients {
    /// The coefficients without those that tell left from right.
    pub fn symmetric(mut self, trail: TrailCamber) -> Self {
        for name in ASYMMETRIC {
            if let Some(value) = self.get_mut(name) {
                *value = 0.0;
            }
        }
        if trail == TrailCamber::Signed {
            self.QDZ3 = 0.0;
        }
        self
    }
}
