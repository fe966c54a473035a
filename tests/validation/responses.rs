//! Frequency responses, weightings and rough roads: the slalom of REF-11, the tables of ISO 2631-1, profiles of ISO 8608.

use analyses::weighting::{WD, WK};
use analyses::{Excitation, FrequencyResponse, LinearModel};
use motorcycle::road::{CLASSES, Roughness};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::reference::Table;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_slalom_of_ref11_is_met => (
        "`ref11`: magnitude of roll over steering torque in a slalom between cones every 14 m, 4 to 50 m/s; its peak lies between 7 and 8 m/s",
        "independent prototype, theory manual B.3",
        "half a unit of the last printed digit"
    ),
    weightings_of_the_standard_are_met => (
        "frequency weightings W_k and W_d, 0.5 to 20 Hz",
        "ISO 2631-1 (1997), table 3",
        "1 %: the filters of annex A approximate the table"
    ),
    profiles_have_the_density_of_their_class => (
        "random profiles of classes A to E: power in octaves of the spatial frequency, 0.02 to 2.56 1/m, by Welch's method over eight profiles",
        "ISO 8608 (2016), straight lines of the classes",
        "1 % for the window, and four standard deviations of an estimate over the length of the profiles"
    ),
];

/// Magnitude of roll over steering torque, deg per N m.
fn slalom(model: &LinearModel, speed: f64, spacing: f64) -> f64 {
    let roll = ["chassis.roll".to_owned()];
    let mut response = FrequencyResponse::of(model, &[Excitation::input("steer.torque")], &roll).unwrap_or_else(|e| panic!("{e}"));
    let mut found = [Complex::new(0.0, 0.0)];
    response.at(PI * speed / spacing, &mut found);
    found[0].norm().to_degrees()
}

#[test]
fn the_slalom_of_ref11_is_met() {
    let table = Table::read("ref11_slalom.csv");
    let vehicle = Vehicle::bundled("ref11");
    let at = |speeds: &[f64]| -> Vec<f64> {
        let states = vehicle.steady(&running(speeds), "kinsol");
        states.iter().zip(speeds).map(|(state, speed)| slalom(&state.linear(), *speed, 14.0)).collect()
    };
    let mut agreement = Agreement::on("ref11: slalom");
    let speeds: Vec<f64> = (0..table.len()).map(|row| table.number(row, "speed_m_s")).collect();
    for (row, found) in at(&speeds).into_iter().enumerate() {
        agreement.printed(&format!("{} m/s", speeds[row]), found, table.cell(row, "deg_per_N_m"));
    }
    let finely: Vec<f64> = (0..=460).map(|k| 4.0 + 0.1 * f64::from(k)).collect();
    let curve = at(&finely);
    let peak = (0..curve.len()).fold(0, |best, k| if curve[k] > curve[best] { k } else { best });
    agreement.holds(&format!("peak at {} m/s", finely[peak]), (7.0..8.0).contains(&finely[peak]));
    agreement.assert();
}

#[test]
fn weightings_of_the_standard_are_met() {
    let table = Table::read("iso_2631_weightings.csv");
    let mut agreement = Agreement::on("ISO 2631-1: weightings");
    let percent = relative(0.01).because("the filters of annex A approximate the table");
    for row in 0..table.len() {
        let weighting = [WK, WD].into_iter().find(|w| w.name == table.cell(row, "weighting")).expect("a weighting");
        let frequency = table.number(row, "frequency_hz");
        let found = weighting.at(frequency).norm();
        agreement.near(&format!("{} at {frequency} Hz", weighting.name), found, 1e-3 * table.number(row, "thousandths"), &percent);
    }
    agreement.assert();
}

/// Fast Fourier transform of a power of two, in place (Cooley and Tukey).
fn transform(x: &mut [Complex<f64>]) {
    let n = x.len();
    if n < 2 {
        return;
    }
    let (mut even, mut odd): (Vec<_>, Vec<_>) = x.chunks(2).map(|pair| (pair[0], pair[1])).unzip();
    transform(&mut even);
    transform(&mut odd);
    for k in 0..n / 2 {
        let turned = odd[k] * Complex::from_polar(1.0, -TAU * k as f64 / n as f64);
        (x[k], x[k + n / 2]) = (even[k] + turned, even[k] - turned);
    }
}

/// One-sided spectral density of samples `step` apart, averaged over segments of `length` that overlap by half, under Hann's window. P. D. Welch, IEEE
/// Trans. Audio Electroacoust. 15 (1967) 70–73.
fn welch(samples: &[f64], step: f64, length: usize) -> Vec<f64> {
    let window: Vec<f64> = (0..length).map(|k| (PI * k as f64 / length as f64).sin().powi(2)).collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let mut density = vec![0.0; length / 2];
    let starts: Vec<usize> = (0..=samples.len() - length).step_by(length / 2).collect();
    for &start in &starts {
        let mut segment: Vec<Complex<f64>> = (0..length).map(|k| Complex::new(window[k] * samples[start + k], 0.0)).collect();
        transform(&mut segment);
        density.iter_mut().zip(&segment).for_each(|(d, z)| *d += 2.0 * z.norm_sqr() * step / (power * starts.len() as f64));
    }
    density
}

#[test]
fn profiles_have_the_density_of_their_class() {
    const STEP: f64 = 0.125;
    const SAMPLES: usize = 1 << 15;
    const SEGMENT: usize = 1 << 13;
    const PROFILES: u64 = 8;
    let mut agreement = Agreement::on("ISO 8608: profiles");
    let smooth = Roughness::from(CLASSES[0]);
    // other classes are the same profiles, larger: what a seed gives is told by one of them
    let mut density = vec![0.0; SEGMENT / 2];
    for seed in 0..PROFILES {
        let profile = smooth.profile(seed, 400);
        let heights: Vec<f64> = (0..SAMPLES).map(|k| profile.at(STEP * k as f64).value).collect();
        let estimate = welch(&heights, STEP, SEGMENT);
        density.iter_mut().zip(&estimate).for_each(|(d, e)| *d += e / PROFILES as f64);
    }
    for class in CLASSES {
        let road = Roughness::from(class);
        let larger = (road.profile(3, 50).at(17.0).value / smooth.profile(3, 50).at(17.0).value).powi(2);
        agreement.near(&format!("class {}: size", class.name), larger, class.level / 16e-6, &relative(1e-12).because("double precision"));
        for octave in 0..7 {
            let low = 0.02 * f64::from(1 << octave);
            let width = 1.0 / (STEP * SEGMENT as f64);
            let bins = (low / width).round() as usize..(2.0 * low / width).round() as usize;
            let (from, to) = ((bins.start as f64 - 0.5) * width, (bins.end as f64 - 0.5) * width);
            let found: f64 = density[bins].iter().sum::<f64>() * width * larger;
            let independent = (to - from) * STEP * SAMPLES as f64 * PROFILES as f64;
            let allowed = absolute((0.01 + 4.0 / independent.sqrt()) * road.mean_square((from, to)));
            let allowed = allowed.because("Hann's window, and four standard deviations of the estimate");
            agreement.near(&format!("class {}, from {low} 1/m", class.name), found, road.mean_square((from, to)), &allowed);
        }
    }
    agreement.assert();
}
