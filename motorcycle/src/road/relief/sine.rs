//! Even waves: `z = a sin(2π (s − s₀)/λ)` behind a transition out of level ground.
//!
//! Symbols: a amplitude, m; λ wavelength, m; s₀ where they begin, m. At the speed V they are felt with the frequency V/λ.
//! Source: elementary. Range: wavelengths above that of the contact patch, 0.1 m or so.

use super::{Onset, Relief, ReliefDescription, USUAL, Uneven};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity, dimension::Length};
use mbody::scalar::spline::CurvePoint;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Even waves.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Sine {
    /// Amplitude: half of what lies between crest and trough.
    amplitude: Quantity<Length>,
    /// From crest to crest.
    wavelength: PositiveQuantity<Length>,
    /// Where they begin on the path; 10 m where left out.
    begin: Option<NonNegativeQuantity<Length>>,
    /// Length over which they reach their amplitude; 5 m where left out.
    transition: Option<PositiveQuantity<Length>>,
}

#[derive(Debug)]
struct Waves {
    amplitude: f64,
    number: f64,
    onset: Onset,
}

impl Uneven for Waves {
    fn at(&self, s: f64) -> CurvePoint<f64> {
        let (sine, cosine) = (self.number * (s - self.onset.begin)).sin_cos();
        let (a, k) = (self.amplitude, self.number);
        self.onset.of(CurvePoint { value: a * sine, slope: a * k * cosine, curvature: -a * k * k * sine }, s)
    }
}

impl ReliefDescription for Sine {
    const KIND: &'static str = "sine";
    const ABOUT: &'static str = "even waves";
    const EXAMPLE: &'static str = "{ amplitude: 10 mm, wavelength: 5 m, begin: 20 m, transition: 5 m }";
    fn relief(self, _: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        let onset = Onset { begin: self.begin.map_or(USUAL.begin, |q| q.si()), length: self.transition.map_or(USUAL.length, |q| q.si()) };
        Ok(Some(Arc::new(Waves { amplitude: self.amplitude.si(), number: TAU / self.wavelength.si(), onset })))
    }
}
