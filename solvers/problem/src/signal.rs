//! A named quantity that enters or leaves a plant.

use std::borrow::Cow;

/// A named quantity with its unit and one sentence of meaning.
///
/// Names are `<element>.<quantity>` in snake case and are public interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// `<element>.<quantity>`, for example `chassis.roll`.
    pub name: String,
    /// SI unit as text, for example `rad/s`; `-` for a pure number.
    pub unit: Cow<'static, str>,
    /// One sentence: what it is and which sense is positive.
    pub about: Cow<'static, str>,
}

impl Signal {
    /// A signal from its name, unit and sentence.
    pub fn new(name: impl Into<String>, unit: impl Into<Cow<'static, str>>, about: impl Into<Cow<'static, str>>) -> Self {
        Self { name: name.into(), unit: unit.into(), about: about.into() }
    }
}
