//! Within which slips, cambers and loads a tire was measured, and what holds beyond.
//!
//! ```text
//! held(x) = x − S(x − hi) + S(lo − x)          x itself inside, lo − w/2 and hi + w/2 far outside
//! ```
//!
//! S one-sided C2 ramp of width w = 2 % of the range. A load below FZMIN is held no lower than FZMIN/2. Forces are computed per load at the
//! held load and multiplied by the true one, so they go to zero with it, and above FZMAX the friction coefficients stay.
//!
//! Source: that values outside are limited to the range is the practice of the published solvers of the Magic Formula; the smooth form is ours.

use super::super::law::{Fit, Slip};
use super::coefficients::Coefficients;
use mbody::scalar::smooth::ramp;
use mbody::scalar::{Real, SystemScalar};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// Width of the ramps, in ranges.
const WIDTH: f64 = 0.02;

/// What holds outside the range of the measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BeyondFit {
    /// The forces of the edge of the range.
    #[default]
    Hold,
    /// The formula goes on.
    Extrapolate,
}

/// Limits of one quantity and the widths of their ramps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    low: f64,
    high: f64,
    low_width: f64,
    width: f64,
}

impl Bounds {
    fn new(low: f64, high: f64) -> Self {
        let width = WIDTH * (high - low);
        Self { low, high, low_width: width, width }
    }

    #[inline]
    fn hold<S: Real>(&self, x: S) -> S {
        let at = x.value();
        if at > self.high {
            x - ramp(x - self.high, self.width)
        } else if at < self.low && self.low_width > 0.0 {
            x + ramp(-(x - self.low), self.low_width)
        } else {
            x
        }
    }
}

/// The range of a fit, in the axes of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Holding {
    load: Bounds,
    lateral: Bounds,
    longitudinal: Bounds,
    camber: Bounds,
}

impl Holding {
    pub fn of(c: &Coefficients) -> Self {
        let steepest = FRAC_PI_2 - 0.01;
        let slope = |angle: f64| angle.clamp(-steepest, steepest).tan();
        let mut load = Bounds::new(c.FZMIN, c.FZMAX);
        load.low_width = load.width.min(c.FZMIN);
        Self {
            load,
            lateral: Bounds::new(slope(c.ALPMIN), slope(c.ALPMAX)),
            longitudinal: Bounds::new(c.KPUMIN, c.KPUMAX),
            camber: Bounds::new(c.CAMMIN, c.CAMMAX),
        }
    }

    /// The slip that the formula is asked.
    #[inline]
    pub fn hold<S: SystemScalar>(&self, slip: &Slip<S>) -> Slip<S> {
        Slip {
            load: self.load.hold(slip.load),
            lateral: self.lateral.hold(slip.lateral),
            longitudinal: self.longitudinal.hold(slip.longitudinal),
            camber: self.camber.hold(slip.camber),
            speed: slip.speed,
        }
    }
}

/// The range in our axes; `alpha` and `gamma` are the signs of slip angle and camber of the file against ours.
pub(super) fn range(c: &Coefficients, alpha: f64, gamma: f64) -> Fit {
    let turned = |low: f64, high: f64, sign: f64| if sign < 0.0 { [-high, -low] } else { [low, high] };
    Fit {
        load: [c.FZMIN, c.FZMAX],
        slip_angle: turned(c.ALPMIN, c.ALPMAX, alpha),
        longitudinal_slip: [c.KPUMIN, c.KPUMAX],
        camber: turned(c.CAMMIN, c.CAMMAX, gamma),
    }
}
