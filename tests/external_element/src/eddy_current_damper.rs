//! Eddy-current damper: a disc that turns between magnets.
//!
//! `T = 2 T_m (ω/ω_m) / (1 + (ω/ω_m)²)`, opposing ω. Symbols: ω rate of the joint, rad/s; T_m greatest torque, N m, at the rate ω_m, rad/s.
//! Slow it is a viscous damper with the coefficient 2 T_m/ω_m; fast it fades, because the field of the currents drives out that of the magnets.
//!
//! Source: J. H. Wouterse, “Critical torque and speed of eddy current brake with widely separated soft iron poles”, IEE Proceedings B 138 (1991)
//! 153–158. Range: steady currents; a cold disc.

use mbody::assembly::{ElementDescription, Site};
use mbody::description::quantity::PositiveQuantity;
use mbody::description::quantity::dimension::{AngularSpeed, Torque};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use schemars::JsonSchema;
use serde::Deserialize;

/// An eddy-current damper on a joint that turns.
#[derive(Clone, Debug)]
pub struct EddyCurrentDamper {
    /// The body carried by the joint.
    pub joint: BodyIndex,
    /// T_m, N m.
    pub greatest: f64,
    /// ω_m, rad/s.
    pub rate: f64,
}

impl EddyCurrentDamper {
    /// Torque against the rate of the joint, N m.
    pub fn torque<S: SystemScalar>(&self, rate: S) -> S {
        let x = rate / self.rate;
        x * (2.0 * self.greatest) / (x * x + 1.0)
    }
}

impl ForceLaw for EddyCurrentDamper {
    fn declare(&self, element: &str) -> Declared {
        let about = "torque of the damper, positive when it opposes a positive rate";
        let output = OutputDeclared { name: format!("{element}.torque"), unit: "N m", about };
        Declared { outputs: vec![output], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let T = self.torque(at.speed(self.joint));
        out.joint(self.joint, -T);
        out.output(0, T);
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let rate = at.speed(self.joint);
        Energy { dissipated: self.torque(rate) * rate, ..Default::default() }
    }
}

/// Eddy-current damper on a joint.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EddyCurrentDamperDescription {
    /// Name of the joint.
    joint: String,
    /// Greatest torque.
    torque: PositiveQuantity<Torque>,
    /// Rate at which it acts.
    rate: PositiveQuantity<AngularSpeed>,
}

impl ElementDescription for EddyCurrentDamperDescription {
    const KIND: &'static str = "eddy_current_damper";
    const ABOUT: &'static str = "eddy-current damper: viscous while slow, fading beyond the rate of its greatest torque";
    const EXAMPLE: &'static str = "{ joint: steer, torque: 20 N m, rate: 6 rad/s }";
    const TREE: &'static str = motorcycle::EXAMPLE_TREE;
    type Law = EddyCurrentDamper;
    fn assemble(self, site: &mut Site<'_>) -> Option<EddyCurrentDamper> {
        let joint = site.joint_with("joint", &self.joint, "rad")?;
        Some(EddyCurrentDamper { joint, greatest: self.torque.si(), rate: self.rate.si() })
    }
}
