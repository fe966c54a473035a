//! Random roughness of roads: classes, spectral density, profiles.
//!
//! ```text
//! G(n) = G(n₀) (n/n₀)^−w       S(f) = G(f/V) / V       z(x) = Σ_k √(2 ∫_k G dn) cos(2π n_k x + φ_k)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | n, n₀ | 1/m | spatial frequency; n₀ = 0.1 1/m |
//! | G | m³ | one-sided spectral density of the height over the spatial frequency; w = 2 for the classes |
//! | f, V | Hz, m/s | frequency felt at speed V |
//! | S | m²/Hz | one-sided spectral density of the height over the frequency |
//! | z, x | m | height of the road, distance along it |
//! | n_k, φ_k | 1/m, rad | frequency drawn in the k-th of bands that are equally wide on a logarithmic scale, phase drawn from all |
//!
//! Every wave carries the mean square of its band exactly. The frequencies are drawn and not spaced evenly, so that no profile repeats itself.
//!
//! Source: ISO 8608 (2016), 5.1 and table C.1 (geometric means of the classes); M. Shinozuka, C.-M. Jan, J. Sound Vib. 25 (1972) 111–128 (sums of
//! cosines); random numbers: G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014 (SplitMix64). Range: 0.011 to 2.83 1/m; beyond it the line goes on.

use mbody::scalar::spline::CurvePoint;
use std::f64::consts::TAU;

/// Spatial frequency to which the level refers, 1/m.
const REFERENCE: f64 = 0.1;
/// Band in which the standard states its line, 1/m.
pub const BAND: (f64, f64) = (0.011, 2.83);

/// A class of roads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadClass {
    /// Its letter.
    pub name: &'static str,
    /// Spectral density at 0.1 1/m, m³: geometric mean of the class.
    pub level: f64,
    /// What such a road is like.
    pub about: &'static str,
}

/// The classes, from smooth to rough: each has four times the density of the one before.
pub const CLASSES: [RoadClass; 5] = [
    RoadClass { name: "A", level: 16e-6, about: "very good" },
    RoadClass { name: "B", level: 64e-6, about: "good" },
    RoadClass { name: "C", level: 256e-6, about: "average" },
    RoadClass { name: "D", level: 1024e-6, about: "poor" },
    RoadClass { name: "E", level: 4096e-6, about: "very poor" },
];

/// Spectral density of the height of a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Density at 0.1 1/m, m³.
    pub level: f64,
    /// Exponent w, larger than one.
    pub exponent: f64,
}

impl From<RoadClass> for Roughness {
    fn from(class: RoadClass) -> Self {
        Self { level: class.level, exponent: 2.0 }
    }
}

impl Roughness {
    /// Density over the spatial frequency (1/m), m³.
    pub fn density(&self, frequency: f64) -> f64 {
        self.level * (frequency / REFERENCE).powf(-self.exponent)
    }

    /// Density over the frequency (Hz) felt at a speed (m/s), m²/Hz.
    pub fn density_at_speed(&self, frequency: f64, speed: f64) -> f64 {
        self.density(frequency / speed) / speed
    }

    /// Mean square of the height between two spatial frequencies, m².
    pub fn mean_square(&self, (low, high): (f64, f64)) -> f64 {
        let power = 1.0 - self.exponent;
        let integral = |n: f64| (n / REFERENCE).powf(power) * REFERENCE / power;
        self.level * (integral(high) - integral(low))
    }

    /// A profile of `waves` cosines over the band of the standard; the same seed gives the same profile.
    pub fn profile(&self, seed: u64, waves: usize) -> Profile {
        self.profile_in(BAND, seed, waves)
    }

    /// A profile with spatial frequencies (1/m) from a band only.
    pub fn profile_in(&self, (low, high): (f64, f64), seed: u64, waves: usize) -> Profile {
        let mut random = SplitMix(seed);
        let ratio = high / low;
        let edge = |k: usize| low * ratio.powf(k as f64 / waves as f64);
        let wave = |k: usize| {
            let (from, to) = (edge(k), edge(k + 1));
            let frequency = from * (to / from).powf(random.share());
            Wave { amplitude: (2.0 * self.mean_square((from, to))).sqrt(), number: TAU * frequency, phase: TAU * random.share() }
        };
        Profile { waves: (0..waves).map(wave).collect() }
    }
}

/// A cosine of a profile.
#[derive(Clone, Copy, Debug)]
struct Wave {
    /// m.
    amplitude: f64,
    /// rad/m.
    number: f64,
    /// rad.
    phase: f64,
}

/// The height of a road along a line.
#[derive(Clone, Debug)]
pub struct Profile {
    waves: Vec<Wave>,
}

impl Profile {
    /// Height (m), slope and second derivative (1/m) at a distance (m) along the line.
    pub fn at(&self, distance: f64) -> CurvePoint<f64> {
        let mut at = CurvePoint { value: 0.0, slope: 0.0, curvature: 0.0 };
        for wave in &self.waves {
            let (sin, cos) = (wave.number * distance + wave.phase).sin_cos();
            at.value += wave.amplitude * cos;
            at.slope -= wave.amplitude * wave.number * sin;
            at.curvature -= wave.amplitude * wave.number * wave.number * cos;
        }
        at
    }
}

/// SplitMix64.
struct SplitMix(u64);

impl SplitMix {
    /// A number from 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_numbers_are_those_of_the_reference_code() {
        // first output of the published splitmix64.c for the seed 1234567
        let mut random = SplitMix(1_234_567);
        assert_eq!(random.share(), (6_457_827_717_110_365_317_u64 >> 11) as f64 / (1_u64 << 53) as f64);
    }

    #[test]
    fn classes_are_four_times_apart() {
        assert!(CLASSES.windows(2).all(|pair| (pair[1].level / pair[0].level - 4.0).abs() < 1e-12));
        let road = Roughness::from(CLASSES[0]);
        assert!((road.density(0.1) - 16e-6).abs() < 1e-18 && (road.density(0.2) - 4e-6).abs() < 1e-18);
        // at 20 m/s a wave of 10 m is felt at 2 Hz
        assert!((road.density_at_speed(2.0, 20.0) - 16e-6 / 20.0).abs() < 1e-18);
    }

    #[test]
    fn waves_carry_the_mean_square_and_slopes_are_derivatives() {
        let road = Roughness { level: 64e-6, exponent: 2.3 };
        let profile = road.profile(7, 300);
        let carried: f64 = profile.waves.iter().map(|w| w.amplitude * w.amplitude / 2.0).sum();
        assert!((carried / road.mean_square(BAND) - 1.0).abs() < 1e-12);
        for x in [0.0, 13.7, 4e3] {
            let h = 1e-4;
            let difference = (profile.at(x + h).value - profile.at(x - h).value) / (2.0 * h);
            assert!((profile.at(x).slope - difference).abs() < 1e-5, "{} {difference}", profile.at(x).slope);
        }
        assert_eq!(road.profile(7, 300).at(5.0).value, profile.at(5.0).value);
        assert_ne!(road.profile(8, 300).at(5.0).value, profile.at(5.0).value);
    }
}
