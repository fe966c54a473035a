//! Vehicles on uneven roads: small bumps are answered as frequency responses say, energy is accounted for, random roads give the comfort that is predicted.

use analyses::transient::{Driven, Simulation, Start, Transient, evenly};
use analyses::{ClosedLoop, Excitation, FrequencyResponse};
use mbody::dynamics::{Formulation, TreePlant};
use motorcycle::maneuver::{Layout, Path};
use motorcycle::road::{BAND, Passing, Relief, Roughness, Tracks, relief};
use nalgebra::Complex;
use problem::{At, Dae};
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::Arc;
use validation::agreement::{Agreement, absolute, relative};
use validation::course::By;
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    small_bumps_are_answered_linearly => (
        "`ref11` and `gsxr1000` over a bump of 0.02 mm at 20 m/s: acceleration of the saddle over time",
        "sum of 600 harmonics of the frequency response to a road under both wheels",
        "1 % of the largest acceleration: second order in the height, harmonics left out"
    ),
    moving_roads_account_for_their_energy => (
        "`ref11` and `gsxr1000` for 2 s over waves of 3 mm: energy gained is what was supplied less what was dissipated",
        "identity",
        "1e-5 of the power turned over: quadrature over 2000 samples"
    ),
    rough_roads_shake_as_predicted => (
        "`ref11` for 40 s on a smooth random road at 20 m/s: r.m.s. of the acceleration of the saddle",
        "integral of the frequency response times the spectrum of ISO 8608",
        "8 %: three standard deviations of a sample of this length"
    ),
];

const ANSWER: &str = "saddle.acceleration_z";

fn road(kind: &str, parameters: &str) -> Arc<dyn Relief> {
    struct Nothing;
    impl mbody::description::Library for Nothing {
        fn text(&self, _: &str) -> Option<std::borrow::Cow<'_, str>> {
            None
        }
    }
    let kind = relief::KINDS.iter().find(|k| k.name == kind).expect("a kind");
    let parameters: Value = serde_yaml::from_str(parameters).expect("parameters");
    (kind.make)(&parameters, &Nothing).expect("a road").expect("an uneven road")
}

fn straight_on(length: f64) -> Path {
    let mut layout = Layout::default();
    layout.straight(length);
    layout.path()
}

/// A ride from a steady state over a road, with the plant.
fn ride(state: &State, relief: Arc<dyn Relief>, times: &[f64], by: By) -> (Simulation, ClosedLoop<TreePlant>) {
    let plant = TreePlant::in_formulation(state.system.clone(), Formulation::Ggl);
    let (y, u) = state.arguments();
    let base = ["x", "y", "yaw", "forward_speed", "lateral_speed", "yaw_rate"].map(|name| format!("chassis.{name}"));
    let tracks = Tracks { base, roads: ["front_road", "rear_road"].map(str::to_owned), wheelbase: state.get("wheelbase") };
    let mut closed = ClosedLoop::new(plant, vec![Box::new(Passing::new(tracks, straight_on(1000.0), vec![relief]))]).expect("a loop");
    let mut transient = Transient::new(&closed, times.to_vec());
    let stated = closed.unknowns().iter().map(|k| k.start.unwrap_or(k.design)).collect();
    transient.start = Start { y: stated, held: vec![false; closed.unknowns().len()] };
    transient.start.y[..y.len()].copy_from_slice(y);
    let names: Vec<&String> = closed.plant().inputs().iter().map(|i| &i.signal.name).collect();
    let value = |name: &String| u[names.iter().position(|n| *n == name).expect("an input")];
    let free = closed.inputs().iter().map(|i| value(&i.signal.name)).collect();
    let simulation = by.run(transient, &mut closed, &Driven::new(free));
    (simulation, closed)
}

/// Response of the saddle to a road under both wheels.
fn response(state: &State, speed: f64) -> FrequencyResponse {
    let delay = state.get("wheelbase") / speed;
    let road = Excitation::delayed("road", [("front_road.height".to_owned(), 0.0), ("rear_road.height".to_owned(), delay)]);
    FrequencyResponse::of(&state.linear(), &[road], &[ANSWER.to_owned()]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn small_bumps_are_answered_linearly() {
    const HARMONICS: usize = 600;
    let (speed, period, height, length, station) = (20.0, 4.0, 2e-5, 1.0, 10.0);
    let mut agreement = Agreement::on("roads: small bumps");
    for model in ["ref11", "gsxr1000"] {
        let state = Vehicle::bundled(model).state(&running(&[speed]));
        let bump = road("cosine_bump", &format!("{{ height: {height}, length: {length}, station: {station} }}"));
        let times = evenly(1.5, 301);
        // all of the bump is longer than the steps of the method, and the vehicle otherwise stands still
        let (ridden, _) = ride(&state, bump.clone(), &times, By::Erk(1e-9, 1e-5));
        agreement.holds(&format!("{model}: {:?}", ridden.ending), ridden.ending.reached());
        let mut response = response(&state, speed);
        let wheelbase = state.get("wheelbase");
        // coefficients of the bump under the front wheel, by the trapezoidal rule, which is exact for what is periodic and smooth
        let samples = 40_000;
        let at = |k: usize| bump.shape(wheelbase + speed * period * k as f64 / samples as f64, 0.0).height;
        let heights: Vec<(usize, f64)> = (0..samples).map(|k| (k, at(k))).filter(|(_, z)| *z != 0.0).collect();
        let mut sums = vec![0.0; times.len()];
        for n in 1..=HARMONICS {
            let omega = TAU * n as f64 / period;
            let turn = |k: usize| Complex::from_polar(2.0 / samples as f64, -TAU * (n * k % samples) as f64 / samples as f64);
            let coefficient: Complex<f64> = heights.iter().map(|&(k, z)| turn(k) * z).sum();
            let mut found = [Complex::new(0.0, 0.0)];
            response.at(omega, &mut found);
            for (sum, t) in sums.iter_mut().zip(&times) {
                *sum += (coefficient * found[0] * Complex::from_polar(1.0, omega * t)).re;
            }
        }
        let largest = sums.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
        let first_order = absolute(0.01 * largest).because("second order in the height, harmonics left out");
        let column = ridden.trajectory.column(ANSWER).expect("recorded");
        for ((found, wanted), t) in column.iter().zip(&sums).zip(&times) {
            agreement.near(&format!("{model} at {t} s, m/s² of {largest}"), *found, *wanted, &first_order);
        }
    }
    agreement.assert();
}

#[test]
fn moving_roads_account_for_their_energy() {
    let mut agreement = Agreement::on("roads: energy");
    for model in ["ref11", "gsxr1000"] {
        let state = Vehicle::bundled(model).state(&running(&[20.0]));
        let waves = road("sine", "{ amplitude: 3 mm, wavelength: 4 m, begin: 5 m }");
        let (duration, count) = (2.0, 2001);
        let (ridden, mut closed) = ride(&state, waves, &evenly(duration, count), By::Adams(1e-10, 1e-4));
        agreement.holds(&format!("{model}: {:?}", ridden.ending), ridden.ending.reached());
        let columns = |names: &mut dyn Iterator<Item = String>| -> Vec<Vec<f64>> {
            names.map(|name| ridden.trajectory.column(&name).expect("recorded").to_vec()).collect()
        };
        let n = closed.plant().unknowns().len();
        let y = &ridden.trajectory.columns[..n];
        let u = columns(&mut closed.plant().inputs().iter().map(|i| i.signal.name.clone()));
        let of = |all: &[Vec<f64>], k: usize| all.iter().map(|c| c[k]).collect::<Vec<f64>>();
        let (mut net, mut turned, mut energy) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..count {
            let (y, u, rates) = (of(y, k), of(&u, k), vec![0.0; n]);
            let account = closed.plant_mut().account_at(At { time: ridden.trajectory.time[k], y: &y, yd: &rates, u: &u });
            net.push(account.elements.supplied - account.elements.dissipated);
            turned.push(account.elements.supplied.abs() + account.elements.dissipated.abs());
            energy.push(account.kinetic + account.gravity + account.elements.stored);
        }
        let integral = |values: &[f64]| {
            let pairs = values.windows(3).step_by(2).map(|w| w[0] + 4.0 * w[1] + w[2]);
            pairs.sum::<f64>() * duration / (count - 1) as f64 / 3.0
        };
        let (gained, whole) = (energy[count - 1] - energy[0], integral(&turned));
        let quadrature = absolute(1e-5 * whole).because("quadrature over 2000 samples");
        agreement.near(&format!("{model}: energy gained, J, of {whole:.0} J turned over"), gained, integral(&net), &quadrature);
        let swing = energy.iter().fold(f64::MIN, |m, e| m.max(*e)) - energy.iter().fold(f64::MAX, |m, e| m.min(*e));
        agreement.holds(&format!("{model}: the road moves the vehicle, {swing} J"), swing > 2.0);
    }
    agreement.assert();
}

#[test]
fn rough_roads_shake_as_predicted() {
    let mut agreement = Agreement::on("roads: ISO 8608");
    let (speed, level) = (20.0, 1e-8);
    let state = Vehicle::bundled("ref11").state(&running(&[speed]));
    let rate = 50;
    let rough = road("iso_8608", &format!("{{ level: {level:e}, seed: 5 }}"));
    let (ridden, _) = ride(&state, rough, &evenly(42.0, 42 * rate + 1), By::Ida(1e-6, 1e-3));
    agreement.holds(&format!("{:?}", ridden.ending), ridden.ending.reached());
    let felt = &ridden.trajectory.column(ANSWER).expect("recorded")[2 * rate..];
    let found = (felt.iter().map(|a| a * a).sum::<f64>() / felt.len() as f64).sqrt();
    let spectrum = Roughness { level, exponent: 2.0 };
    let mut response = response(&state, speed);
    let (low, high, count) = (BAND.0 * speed, BAND.1 * speed, 4000);
    let mut square = 0.0;
    for k in 0..count {
        let frequency = low + (high - low) * (f64::from(k) + 0.5) / f64::from(count);
        let mut at = [Complex::new(0.0, 0.0)];
        response.at(TAU * frequency, &mut at);
        square += at[0].norm_sqr() * spectrum.density_at_speed(frequency, speed) * (high - low) / f64::from(count);
    }
    let sample = relative(0.08).because("three standard deviations of a sample of this length");
    agreement.near("r.m.s. of the acceleration of the saddle, m/s²", found, square.sqrt(), &sample);
    agreement.assert();
}
