//! Plants that differ in numbers only: what sensitivities and sweeps of parameters ask for.

use crate::Plant;
use std::borrow::Cow;

/// A number of a plant's description that may change without changing its signals.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Path by which a user overrides it: `rear_shock.spring.stiffness`.
    pub name: String,
    /// SI unit; `1` for a pure number.
    pub unit: Cow<'static, str>,
    /// Value of the family's own member, SI.
    pub value: f64,
    /// Typical magnitude, greater than zero: small steps are measured by it.
    pub nominal: f64,
    /// What it is, in a sentence; empty where nobody says.
    pub about: Cow<'static, str>,
}

/// Index of a parameter among [`Family::parameters`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParameterId(pub usize);

/// One member of a family in the two forms that an analysis needs.
///
/// The unknowns of `linear` begin with those of `steady`; what follows is zero in steady motion. Without constraints both are the same.
pub struct Member {
    /// Constraints as they are: the form of steady states.
    pub steady: Box<dyn Plant>,
    /// Constraints and their rates (Gear, Gupta, Leimkuhler): the form of linear models.
    pub linear: Box<dyn Plant>,
}

/// Why a family has no member with some values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoMember {
    /// In mechanical words.
    pub because: String,
}

impl std::fmt::Display for NoMember {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.because)
    }
}

impl std::error::Error for NoMember {}

/// Re-assembly with other parameters. Members have the same unknowns, inputs and outputs in the same order.
pub trait Family: Sync {
    /// Everything that may change.
    fn parameters(&self) -> &[Parameter];
    /// The member with some values changed (SI), all others as they are.
    ///
    /// # Errors
    /// There is none with these values.
    fn with(&self, changes: &[(ParameterId, f64)]) -> Result<Member, NoMember>;
}
