//! A random road of a class of ISO 8608, the same for the same seed, behind a transition out of level ground.
//!
//! Equation, symbols, source, range: [`crate::road::Roughness`]. Both wheels run over the same profile, the rear wheel later.

use super::{Onset, Relief, ReliefDescription, USUAL, Uneven};
use crate::road::roughness::{CLASSES, Profile, Roughness};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings, suggestion};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, dimension::Length};
use mbody::scalar::spline::CurvePoint;
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// Number of waves: dense enough that no two stand out.
const WAVES: usize = 300;

/// A random road of a class of ISO 8608.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Iso8608 {
    /// Class, `A` (very good) to `E` (very poor). Give this or `level`.
    class: Option<String>,
    /// Spectral density of the height at 0.1 1/m, m³. Give this or `class`.
    #[schemars(range(min = 1e-9, max = 1.0))]
    level: Option<f64>,
    /// What the road is drawn from: another number gives another road of the class; 1 where left out.
    seed: Option<u64>,
    /// Where it begins on the path; 10 m where left out.
    begin: Option<NonNegativeQuantity<Length>>,
    /// Length over which it reaches its height; 5 m where left out.
    transition: Option<PositiveQuantity<Length>>,
}

#[derive(Debug)]
struct Rough {
    profile: Profile,
    onset: Onset,
}

impl Uneven for Rough {
    fn at(&self, s: f64) -> CurvePoint<f64> {
        self.onset.of(self.profile.at(s), s)
    }
}

impl ReliefDescription for Iso8608 {
    const KIND: &'static str = "iso_8608";
    const ABOUT: &'static str = "a random road of a class of ISO 8608";
    const EXAMPLE: &'static str = "{ class: B, seed: 1 }";
    fn relief(self, _: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let roughness = match (self.class, self.level) {
            (Some(name), None) => {
                let found = CLASSES.iter().find(|c| c.name == name).copied();
                let unknown = || {
                    let finding = Finding::error("unknown_class", format!("there is no class `{name}` of roads")).at_path("class");
                    finding.with_hint_from(suggestion(&name, CLASSES.iter().map(|c| c.name)))
                };
                Roughness::from(found.ok_or_else(unknown)?)
            }
            (None, Some(level)) => Roughness { level, exponent: 2.0 },
            (Some(_), Some(_)) => {
                return Err(Finding::error("given_twice", "`class` and `level` both say how rough the road is").at_path("level").into());
            }
            (None, None) => return Err(Finding::error("missing_entry", "one of `class` and `level` is needed").at_path("").into()),
        };
        let onset = Onset { begin: self.begin.map_or(USUAL.begin, |q| q.si()), length: self.transition.map_or(USUAL.length, |q| q.si()) };
        Ok(Some(Arc::new(Rough { profile: roughness.profile(self.seed.unwrap_or(1), WAVES), onset })))
    }
}
