//! Steady motion on an inclined road: uphill, across a bank, on a helix.
//!
//! ```text
//! the surface     z = g R θ + c (R − ρ)          about the axis at R to the left of the base point, at right angles to its velocity V;  straight: a plane
//! at the rear     grade = g cos β − c sin β,     cross slope = c cos β + g sin β,     h = 0
//! in front        grade = g cos β/w² − c u/w,    cross slope = g u/w² + c cos β/w,    h = g p cos β A(X)/(1 + κp sin β) − c p (2 sin β + κp)/(1 + w)
//!                 w² = 1 + 2 κp sin β + (κp)²,   u = κp + sin β,   X = κp cos β/(1 + κp sin β),   A = atan(X)/X
//! ḣ of both = heave rate = rate of the heave = g V
//! ```
//!
//! g slope along the path, positive uphill; c = tan(bank) slope across, positive where the road rises to the left; ρ, θ distance from the axis and angle about it, m and rad; R = V/r, κ = r/V, r yaw rate; β angle of the
//! velocity of the base point against the heading; p wheelbase, m. Base point and speed are horizontal quantities. All inputs are constant in the yawed frame of the base but the heights, which rise with the heave (ADR 20).
//!
//! Source: differential geometry of a helicoidal cone; A by its series to X⁸, 1e-7 at X = 0.3. Range: |κ| p below 0.5.

use crate::Failure;
use crate::arguments::argument;
use crate::road::{ROADS, felt, known_wheelbase};
use analyses::trim::Trim;
use mbody::description::quantity::dimension::{Angle, Number};
use mbody::description::quantity::{Dimensioned, QuantityError, parse_quantity};
use mbody::dynamics::{System, TreePlant};
use motorcycle::road::Relief;
use std::sync::Arc;

/// Greatest slope.
const STEEPEST: f64 = 1.0;

/// Slopes of a road along and across a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Incline {
    /// Along the path, positive uphill.
    pub grade: f64,
    /// Across the path, positive where it rises to the left.
    pub cross_slope: f64,
}

impl Incline {
    /// Reads `--grade` and `--bank`: a slope (5%, 0.05) or an angle (3deg) each; a bare number of a bank is an angle.
    ///
    /// # Errors
    /// Neither a slope nor an angle, or too steep.
    pub fn read(grade: Option<&str>, bank: Option<&str>) -> Result<Self, Failure> {
        let slope = |option: &str, text: &str, angle_first: bool| -> Result<f64, Failure> {
            let (number, angle) = (parse_quantity(text, Number::DIMENSION), parse_quantity(text, Angle::DIMENSION).map(f64::tan));
            let [first, second] = if angle_first { [angle, number] } else { [number, angle] };
            let read = match first {
                Err(QuantityError::WrongDimension { .. }) => second,
                first => first,
            };
            match read {
                Ok(slope) if slope.abs() <= STEEPEST => Ok(slope),
                Ok(slope) => {
                    let why = format!("a slope of {slope:.4} is out of range: it must be between -{STEEPEST} and {STEEPEST}");
                    Err(argument(option, text, "out_of_range", why).with_hint("write `5%` for a slope, `3deg` for an angle").into())
                }
                Err(e) => {
                    Err(argument(option, text, e.code(), e.to_string()).with_hint("write `5%` for a slope, `3deg` for an angle").into())
                }
            }
        };
        Ok(Self {
            grade: grade.map_or(Ok(0.0), |text| slope("grade", text, false))?,
            cross_slope: bank.map_or(Ok(0.0), |text| slope("bank", text, true))?,
        })
    }

    /// How a road is inclined where its path begins.
    pub fn at_start(reliefs: &[Arc<dyn Relief>]) -> Self {
        let shapes = reliefs.iter().filter(|relief| relief.tilts()).map(|relief| relief.shape(0.0, 0.0).first);
        shapes.fold(Self::default(), |sum, [along, across]| Self { grade: sum.grade + along, cross_slope: sum.cross_slope + across })
    }

    /// Lays the road of a steady motion under both wheels, and lets the vehicle rise with it.
    ///
    /// # Errors
    /// The wheels feel no road, or it is not known where they are.
    pub fn lay(&self, trim: &mut Trim, system: &Arc<System>, base: &str, accelerates: bool) -> Result<(), Failure> {
        let mut plant = TreePlant::new(system.clone());
        felt(&plant, "it feels no slopes", "")?;
        let (p, Self { grade: g, cross_slope: c }) = (known_wheelbase(&mut plant)?, *self);
        let [x, y, r] = ["forward_speed", "lateral_speed", "yaw_rate"].map(|name| format!("{base}.{name}"));
        let speed = format!("sqrt({x}^2 + {y}^2)");
        let (sine, cosine, turn) = (format!("({y} / {speed})"), format!("({x} / {speed})"), format!("({p} * {r} / {speed})"));
        let (square, u) = (format!("(1 + 2 * {turn} * {sine} + {turn}^2)"), format!("({turn} + {sine})"));
        let (w, ahead) = (format!("sqrt{square}"), format!("(1 + {turn} * {sine})"));
        let angle = format!("({turn} * {cosine} / {ahead})");
        let series = format!("(1 - {angle}^2 / 3 + {angle}^4 / 5 - {angle}^6 / 7 + {angle}^8 / 9)");
        let climb = format!("({g}) * {speed}");
        let [front, rear] = ROADS;
        let mut ties = vec![
            (format!("{rear}.grade"), format!("({g}) * {cosine} - ({c}) * {sine}")),
            (format!("{rear}.cross_slope"), format!("({c}) * {cosine} + ({g}) * {sine}")),
            (format!("{front}.grade"), format!("({g}) * {cosine} / {square} - ({c}) * {u} / {w}")),
            (format!("{front}.cross_slope"), format!("({g}) * {u} / {square} + ({c}) * {cosine} / {w}")),
            (
                format!("{front}.height"),
                format!("({g}) * {p} * {cosine} / {ahead} * {series} - ({c}) * {p} * (2 * {sine} + {turn}) / (1 + {w})"),
            ),
            (format!("{rear}.height_rate"), climb.clone()),
            (format!("{front}.height_rate"), climb.clone()),
            (format!("{base}.heave_rate"), climb.clone()),
            (format!("rate({base}.heave)"), climb),
        ];
        if accelerates {
            ties.push((format!("rate({base}.heave_rate)"), format!("({g}) * {speed} * rate({x}) / {x}")));
        }
        for (name, formula) in ties {
            trim.tie(&name, &formula)?;
        }
        Ok(())
    }
}
