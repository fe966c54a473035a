//! What a friction law comes down to at a load: stiffnesses, trail, greatest friction.
//!
//! ```text
//! Cα = ∂Fy/∂a,   Cγ = −∂Fy/∂γ,   Cκ = ∂Fx/∂κ,   trail = −∂Mz/∂a / Cα,   twist = −∂Mz/∂γ           at zero slip and camber
//! μx = max |Fx|/N over κ upright,   μy = max |Fy|/N over a upright
//! ```
//!
//! a lateral slip, κ longitudinal slip, γ camber, rad; N load, N. Derivatives by dual numbers; the greatest forces are looked for among slips up to 1 in
//! steps of 1/2000.
//!
//! Source: definitions of ISO 8855 with the signs of [`super`].

use super::law::{Slip, TireLaw};
use mbody::scalar::{Lanes, Real};

/// Steps in the search of the greatest forces.
const STEPS: u32 = 2000;

/// What a law comes down to at one load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Characteristic {
    /// Load, N.
    pub load: f64,
    /// Cornering stiffness Cα, N/rad.
    pub cornering_stiffness: f64,
    /// Camber stiffness Cγ, N/rad.
    pub camber_stiffness: f64,
    /// Longitudinal slip stiffness Cκ, N.
    pub slip_stiffness: f64,
    /// Pneumatic trail, m.
    pub pneumatic_trail: f64,
    /// Twisting moment per camber, N m/rad.
    pub twisting_stiffness: f64,
    /// Greatest longitudinal friction; none where the law has no peak.
    pub longitudinal_friction: Option<f64>,
    /// Greatest lateral friction; none where the law has no peak.
    pub lateral_friction: Option<f64>,
    /// Lateral relaxation length, m; 0 where the law knows none.
    pub relaxation_length: f64,
}

/// The law at a load (N) and a speed (m/s).
pub fn characteristic(law: &impl TireLaw, load: f64, speed: f64) -> Characteristic {
    let zero = Lanes::<2>::from_f64(0.0);
    let mut seeds = [zero; 3];
    seeds.iter_mut().enumerate().for_each(|(k, seed)| seed.set_derivative(k, 1.0));
    let [lateral, longitudinal, camber] = seeds;
    let f = law.friction(&Slip { load: Lanes::from_f64(load), lateral, longitudinal, camber, speed: Lanes::from_f64(speed) });
    let cornering_stiffness = f.lateral.derivative(0);
    let greatest = |force: &dyn Fn(f64) -> f64| {
        let forces = (1..=STEPS).flat_map(|k| [1.0, -1.0].map(|s| force(s * f64::from(k) / f64::from(STEPS)).abs()));
        law.saturates().then(|| forces.fold(0.0, f64::max) / load)
    };
    let at = |lateral, longitudinal| law.friction(&Slip { load, lateral, longitudinal, camber: 0.0, speed });
    Characteristic {
        load,
        cornering_stiffness,
        camber_stiffness: -f.lateral.derivative(2),
        slip_stiffness: f.longitudinal.derivative(1),
        pneumatic_trail: -f.aligning_moment.derivative(0) / cornering_stiffness,
        twisting_stiffness: -f.aligning_moment.derivative(2),
        longitudinal_friction: greatest(&|slip| at(0.0, slip).longitudinal),
        lateral_friction: greatest(&|slip| at(slip, 0.0).lateral),
        relaxation_length: law.relaxation_lengths(load, 0.0)[0],
    }
}
