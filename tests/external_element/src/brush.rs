//! Brush model: bristles that stick until the friction under the parabolic pressure gives way.
//!
//! ```text
//! σ⃗ = (κ, a − γ c_γ/c)     σ = |σ⃗|     θ = c/(3 μ)
//! F = μ N [3 θσ − 3 (θσ)² + (θσ)³] σ⃗/σ   for θσ < 1          F = μ N σ⃗/σ   beyond
//! M_z = −μ N l θ σ_y (1 − θσ)³
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | N, κ, a, γ | N, -, -, rad | load, longitudinal and lateral slip, camber |
//! | c, c_γ | - | cornering and camber stiffness per load; the longitudinal one is that of cornering |
//! | μ, l | -, m | friction; half of the length of contact |
//! | θσ | - | share of the slip at which all bristles slide |
//!
//! Camber acts as the slip that has the same side force. Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, 3rd ed. 2012, section 3.2 (brush
//! model, isotropic). Range: one friction for all speeds; forces small against those of a sliding tire are those of the linear tire.

use mbody::scalar::SystemScalar;
use motorcycle::tire::{Friction, InvalidTireData, LawParameters, Slip, TireLaw};
use schemars::JsonSchema;
use serde::Deserialize;

/// Slip that keeps the direction of the force differentiable where there is none.
const NO_SLIP: f64 = 1e-7;

/// Parameters of the brush model.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BrushParameters {
    /// Cornering stiffness per load, c, 1/rad.
    pub cornering_stiffness: f64,
    /// Camber stiffness per load, cγ, 1/rad.
    pub camber_stiffness: f64,
    /// Friction, μ.
    pub friction: f64,
    /// Half of the length of contact, l, m.
    pub half_length: f64,
}

/// The brush model.
#[derive(Clone, Debug, PartialEq)]
pub struct Brush(BrushParameters);

impl LawParameters for BrushParameters {
    const KIND: &'static str = "brush";
    const ABOUT: &'static str = "bristles under a parabolic pressure";
    type Law = Brush;
    fn law(self) -> Result<Brush, InvalidTireData> {
        let all = [
            ("cornering_stiffness", self.cornering_stiffness),
            ("camber_stiffness", self.camber_stiffness),
            ("friction", self.friction),
            ("half_length", self.half_length),
        ];
        match all.into_iter().find(|(_, value)| !value.is_finite() || *value <= 0.0) {
            Some((parameter, value)) => Err(InvalidTireData::NotPositive { parameter, value }),
            None => Ok(Brush(self)),
        }
    }
}

impl TireLaw for Brush {
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        let p = &self.0;
        let theta = p.cornering_stiffness / (3.0 * p.friction);
        let (x, y) = (slip.longitudinal, slip.lateral - slip.camber * (p.camber_stiffness / p.cornering_stiffness));
        let s = (x * x + y * y + NO_SLIP * NO_SLIP).sqrt() * theta;
        // force over slip, in units of μ N: 3 − 3s + s² while some bristles stick
        let sticking = s.value() < 1.0;
        let (slope, trail) = match sticking {
            true => {
                let rest = -s + 1.0;
                (((s - 3.0) * s + 3.0) * theta, rest * rest * rest)
            }
            false => (s.recip() * theta, S::zero()),
        };
        let force = slip.load * p.friction;
        Friction {
            longitudinal: force * slope * x,
            lateral: force * slope * y,
            overturning_moment: S::zero(),
            rolling_moment: S::zero(),
            aligning_moment: -(force * trail * y) * (p.half_length * theta),
            utilization: if sticking { slope * s / theta } else { S::one() },
        }
    }

    fn cornering_stiffness<S: SystemScalar>(&self, load: S, _camber: S) -> S {
        // the slope at zero slip, with its rounding
        let theta = self.0.cornering_stiffness / (3.0 * self.0.friction);
        let s = NO_SLIP * theta;
        load * (self.0.friction * theta * ((s - 3.0) * s + 3.0))
    }

    fn saturates(&self) -> bool {
        true
    }
}
