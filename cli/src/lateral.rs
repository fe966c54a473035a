//! The two ways in which a rider steers, designed at one steady state.

use analyses::LinearModel;
use analyses::regulator::{CascadeDesign, Course, Design, Regulator, RegulatorError, cascade, follow};
use motorcycle::maneuver::LateralLaw;
use motorcycle::rider::Lateral;
use motorcycle::rider::cascade::{CascadeSettings, FEEDBACK};

/// Lean (rad) and its integral (rad s) that count as much as the steering torque: a tenth of a degree-second is what a rider lets go.
const LEAN: (f64, f64) = (0.05, 0.1);
/// Filter of the lateral acceleration that is asked for: theory manual 10.3 (6 to 10 rad/s).
const FILTER: CascadeSettings = CascadeSettings { frequency: 8.0, damping: 0.8 };
/// How far the two loops look ahead, s: theory manual 10.3, and what the lean takes beside.
const AHEAD: f64 = 2.0;

/// Feedback at one steady state.
pub struct Steering {
    /// What is fed back, what is seen ahead, closed loop.
    pub regulator: Regulator,
    /// Gain of the integral of the lean.
    pub integral_gain: f64,
    /// Change of the lean per lateral acceleration.
    pub lead: f64,
}

/// The law of a rider.
pub fn law(written: LateralLaw) -> Lateral {
    match written {
        LateralLaw::Preview => Lateral::Preview,
        LateralLaw::Pid => Lateral::Cascade(FILTER),
    }
}

/// The law of a rider in words.
pub fn about(written: LateralLaw) -> &'static str {
    match written {
        LateralLaw::Preview => "feedback of all states, with preview",
        LateralLaw::Pid => "two loops: the path asks for lateral acceleration (its gains are m/s² per unit), lean asks for torque",
    }
}

/// Previews that are worth trying, s, of those on offer.
pub fn previews(written: LateralLaw, offered: Vec<f64>) -> Vec<f64> {
    match written {
        LateralLaw::Pid if offered.len() > 1 => vec![AHEAD],
        _ => offered,
    }
}

/// Designs the steering about one steady state of the vehicle whose base has this name.
///
/// # Errors
/// No feedback of that kind stabilizes it.
pub fn steer(law: LateralLaw, model: &LinearModel, line: &Course, design: &Design, base: &str) -> Result<Steering, RegulatorError> {
    if law == LateralLaw::Preview {
        return Ok(Steering { regulator: follow(model, line, design)?, integral_gain: 0.0, lead: 0.0 });
    }
    let [lean, lean_rate, angle, rate] = FEEDBACK;
    let beside = vec![format!("{base}.{lean_rate}"), format!("steer.{angle}"), format!("steer.{rate}")];
    let design = Design { deviations: vec![(format!("{base}.{lean}"), LEAN.0)], ..design.clone() };
    let wanted = CascadeDesign { design, integral: LEAN.1, beside, filter: (FILTER.frequency, FILTER.damping) };
    let found = cascade(model, line, &wanted)?;
    Ok(Steering { regulator: found.regulator, integral_gain: found.integral_gain, lead: found.lead })
}
