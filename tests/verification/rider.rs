//! The virtual rider and what it rides: derivatives, poles, responses, mirror images, energy.

use analyses::eigen::pencil;
use analyses::linearize::{OffTrim, Options};
use analyses::regulator::Regulator;
use analyses::transient::{Driven, Start, Track, Transient};
use analyses::{ClosedLoop, Excitation, FrequencyResponse, LinearModel, linearize};
use fastbike::plan::Turn;
use fastbike::rider::Task;
use mbody::dynamics::TreePlant;
use motorcycle::maneuver::{Course, Layout, RiderDescription, Speed};
use nalgebra::{Complex, DMatrix};
use problem::{At, Controller, Dae, Differentiable, Explicit, Matrix, Outputs, Seeds};
use serde_json::json;
use std::f64::consts::TAU;
use validation::agreement::{Agreement, absolute, relative};
use validation::course::By;
use validation::evidence::Row;
use validation::numbers::Numbers;
use validation::rode::{Care, Rode, read};
use validation::vehicle::{Vehicle, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    derivatives_of_the_closed_loop_are_exact => (
        "`ref11` and `gsxr1000` with their rider in a disturbed turn, with and without delay and muscles: derivatives of all rows and outputs; nothing \
         algebraic is read, nothing is allocated",
        "central differences",
        "1e-6 of the largest entry of a column, 1e-9 of nominal values: step 1e-4 with one extrapolation"
    ),
    poles_are_those_of_the_design => (
        "`ref11` and `gsxr1000` at 25 m/s, straight and in turns of 2 m/s² to both sides: the nonlinear rider on the path, linearized with held speed, has the poles of the \
         regulator, with and without delay and muscles; with its speed loop every pole but that of the shift along the path decays",
        "poles of the linear-quadratic design",
        "straight 1e-6: a node of the table, to ten digits of its speed; in turns 1 %: its edges are approached smoothly, and poles that lie close together are sensitive"
    ),
    small_motions_are_those_of_the_frequency_response => (
        "`ref11` and `gsxr1000` with their rider at 25 m/s in a small side wind that swings with 0.3 to 3 Hz: roll, steering angle and torque over time",
        "frequency response of the linearized closed loop",
        "0.1 % of the amplitude: wind of 0.05 m/s"
    ),
    left_is_like_right => (
        "`ref11` changes to the lane on the left and to that on the right: mirror images",
        "identity",
        "1e-8 rad, m, per second: tolerance 1e-11"
    ),
    energy_is_accounted_for => (
        "lane changes of `ref11` and `gsxr1000`, braking in a curve and a U-turn: energy gained is what was supplied less what was dissipated",
        "identity",
        "1e-6 of the power turned over: quadrature at 1 kHz"
    ),
];

/// A rider on a path of constant curvature, in the middle of it, in the steady state.
struct Riding {
    closed: ClosedLoop<TreePlant>,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
    yaw_rate: f64,
    /// The design at this point.
    regulator: Regulator,
}

/// Target over speed where the speed is a node of the table: `1/√(0.85 · 1.15)`.
const AT_NODE: f64 = 1.011_443_475;

/// With human limits: reaction time and muscles of theory manual 10.6.
fn human() -> RiderDescription {
    serde_json::from_value(json!({ "delay": "0.1 s", "muscles": "30 rad/s" })).expect("a rider")
}

impl Riding {
    fn of(model: &str, (speed, target): (f64, f64), lateral: f64, wishes: &RiderDescription) -> Self {
        let vehicle = Vehicle::bundled(model);
        let request = if lateral == 0.0 { running(&[speed]) } else { turning(&[speed], Turn::LateralAcceleration, &[lateral]) };
        let state = vehicle.state(&request);
        let [along, across, yaw_rate] = ["forward_speed", "lateral_speed", "yaw_rate"].map(|n| state.get(&format!("chassis.{n}")));
        let curvature = yaw_rate / along.hypot(across);
        // nodes of the table: speeds at 0.85 and 1.15 of the target and at their geometric mean, lateral accelerations every 2 m/s² up to 1.15 times what
        // is asked for and 0.5 m/s²
        let sharpest = (6.0 - 0.5) / 1.15 / (target * target);
        let mut layout = Layout::default();
        layout.bend(1000.0, curvature, curvature);
        layout.bend(10.0, sharpest, sharpest);
        let course = Course { path: layout.path(), speed: Speed::Constant(target), torque_pulses: Vec::new() };
        let task = Task { system: &vehicle.system, backend: "kinsol", wishes, front_brake_share: 0.7 };
        let (_, designs) = task.along(&[speed], &[lateral]).unwrap_or_else(|failure| panic!("{model}: {failure}"));
        let regulator = designs.points[0].clone().unwrap_or_else(|why| panic!("{model}: {why}"));
        // far from the start of the path, where the curvature jumps
        let (station, place) = (400.0, course.path.at(400.0));
        let mut rider = task.design(course).unwrap_or_else(|failure| panic!("{model}: {failure}")).rider;
        rider.start_with(state.get("steer.torque"));
        let closed = ClosedLoop::new(vehicle.plant(), vec![Box::new(rider)]).unwrap_or_else(|error| panic!("{model}: {error}"));
        let mut y: Vec<f64> = closed.unknowns().iter().map(|k| k.start.unwrap_or(k.design)).collect();
        let (of_plant, _) = state.arguments();
        y[..of_plant.len()].copy_from_slice(of_plant);
        let u = closed.inputs().iter().map(|i| i.default).collect();
        let mut riding = Self { closed, yd: vec![0.0; y.len()], y, u, yaw_rate, regulator };
        riding.put("rider.station", station);
        // no acceleration is demanded
        riding.put("rider.speed_integral", -2.0 * (target - speed) / 0.7);
        riding.put("chassis.x", place.x);
        riding.put("chassis.y", place.y);
        riding.put("chassis.yaw", place.heading - across.atan2(along));
        riding.solve();
        riding
    }

    fn unknown(&self, name: &str) -> usize {
        self.closed.unknowns().iter().position(|k| k.signal.name == name).unwrap_or_else(|| panic!("no unknown `{name}`"))
    }

    fn put(&mut self, name: &str, value: f64) {
        let at = self.unknown(name);
        self.y[at] = value;
    }

    fn solve(&mut self) {
        self.closed.solve_rates(0.0, &mut self.y, &self.u, &mut self.yd).unwrap_or_else(|error| panic!("{error:?}"));
    }

    fn linear(&mut self) -> LinearModel {
        let options = Options { off_trim: OffTrim::Proceed, ..Options::default() };
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        linearize(&mut self.closed, at, &options).unwrap_or_else(|error| panic!("{error}"))
    }
}

#[test]
fn derivatives_of_the_closed_loop_are_exact() {
    let mut agreement = Agreement::on("derivatives of the closed loop");
    let differences = absolute(1e-9).or_relative(1e-6).because("step 1e-4 with one extrapolation");
    for (model, wishes) in ["ref11", "gsxr1000"].into_iter().flat_map(|m| [(m, RiderDescription::default()), (m, human())]) {
        let mut riding = Riding::of(model, (25.0, 25.0), 3.0, &wishes);
        let mut numbers = Numbers(7);
        let nominal: Vec<f64> = riding.closed.unknowns().iter().map(|k| k.nominal).collect();
        for (y, nominal) in riding.y.iter_mut().zip(&nominal) {
            *y += 0.01 * nominal * numbers.signed();
        }
        riding.solve();
        let (n, nu) = (riding.y.len(), riding.u.len());
        let (rows, outputs) = (riding.closed.equations().len(), riding.closed.outputs().len());
        let scales: Vec<f64> = riding.closed.equations().iter().map(|e| 1.0 / e.nominal).chain(vec![1.0; outputs]).collect();
        let mut seeds = Seeds::zeros(n, nu, n);
        (0..n).for_each(|k| seeds.y[(k, k)] = nominal[k]);
        let (mut r, mut z) = (vec![0.0; rows], vec![0.0; outputs]);
        let (mut dr, mut dz) = (Matrix::zeros(rows, n), Matrix::zeros(outputs, n));
        let Riding { closed, y, yd, u, .. } = &mut riding;
        closed.along(At { time: 0.0, y, yd, u }, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        let counted = allocation_counter::measure(|| {
            let at = At { time: 0.0, y, yd, u };
            closed.residual(at, &mut r).expect("finite");
            closed.evaluate(at, &mut r, &mut z).expect("finite");
            closed.along(at, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        });
        agreement.holds(&format!("{model}: nothing is allocated, {} bytes", counted.bytes_total), counted.count_total == 0);
        let mut values = |k: usize, step: f64| -> Vec<f64> {
            let mut moved = y.clone();
            moved[k] += step * nominal[k];
            closed.evaluate(At { time: 0.0, y: &moved, yd, u }, &mut r, &mut z).expect("finite");
            r.iter().chain(&z).zip(&scales).map(|(v, scale)| v * scale).collect()
        };
        for k in 0..n {
            let mut slope = |h: f64| -> Vec<f64> { values(k, h).iter().zip(values(k, -h)).map(|(a, b)| (a - b) / (2.0 * h)).collect() };
            let h = 1e-4;
            let differences_of_both: Vec<f64> =
                slope(0.5 * h).iter().zip(slope(h)).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect();
            let exact: Vec<f64> = dr.column(k).iter().chain(dz.column(k)).zip(&scales).map(|(v, scale)| v * scale).collect();
            agreement.all_near(&format!("{model}: column {k}"), &exact, &differences_of_both, &differences);
        }
    }
    agreement.assert();
}

#[test]
fn riders_read_nothing_algebraic() {
    for model in ["ref11", "gsxr1000", "moto11"] {
        let vehicle = Vehicle::bundled(model);
        let wishes = human();
        let task = Task { system: &vehicle.system, backend: "kinsol", wishes: &wishes, front_brake_share: 0.7 };
        let rider = task.design(read("lane_change", &[]).course).unwrap_or_else(|failure| panic!("{model}: {failure}")).rider;
        let plant = vehicle.plant();
        for name in rider.measured() {
            let unknown = plant.unknowns().iter().find(|k| k.signal.name == *name).unwrap_or_else(|| panic!("{model}: no `{name}`"));
            assert!(unknown.differential, "{model}: {name}");
        }
        assert!(rider.states().iter().all(|s| s.differential), "{model}");
    }
}

/// E and A of the states that the speed section does not hold; along a circle in axes that turn with the vehicle.
fn held(model: &LinearModel, yaw_rate: f64, without: &dyn Fn(&str) -> bool) -> (DMatrix<f64>, DMatrix<f64>, Vec<f64>) {
    let place = |name: &str| model.state(name).unwrap_or_else(|| panic!("no state `{name}`"));
    let (x, y) = (place("chassis.x"), place("chassis.y"));
    let mut turning = DMatrix::zeros(model.states.len(), model.states.len());
    (turning[(x, y)], turning[(y, x)]) = (yaw_rate, -yaw_rate);
    let A = &model.A + &model.E * turning;
    let kept: Vec<usize> = (0..model.states.len()).filter(|&k| !without(&model.states[k].signal.name)).collect();
    let part = |m: &DMatrix<f64>| DMatrix::from_fn(kept.len(), kept.len(), |i, j| m[(kept[i], kept[j])]);
    (part(&model.E), part(&A), kept.iter().map(|&k| model.states[k].nominal).collect())
}

#[test]
fn poles_are_those_of_the_design() {
    let mut agreement = Agreement::on("poles of rider and vehicle");
    for (model, wishes) in ["ref11", "gsxr1000"].into_iter().flat_map(|m| [(m, RiderDescription::default()), (m, human())]) {
        for lateral in [0.0, 2.0, -2.0] {
            let what = format!("{model} at {lateral} m/s² {:?}", wishes.delay.is_some());
            let mut riding = Riding::of(model, (25.0, AT_NODE * 25.0), lateral, &wishes);
            let linear = riding.linear();
            let speed =
                |name: &str| name == "chassis.forward_speed" || name.ends_with("_wheel.spin_rate") || name == "rider.speed_integral";
            let (E, A, nominal) = held(&linear, riding.yaw_rate, &speed);
            let mut found = pencil(&E, &A, &nominal).unwrap_or_else(|error| panic!("{what}: {error}")).values;
            let close = match lateral == 0.0 {
                true => absolute(1e-6).or_relative(1e-6).because("straight running is a node of the table, to ten digits of its speed"),
                false => absolute(1e-2)
                    .or_relative(1e-2)
                    .because("the edges of the table are approached smoothly, poles close together are sensitive"),
            };
            // beside the design: the station that is caught up with, and the shift along the path
            let beside = [Complex::new(-5.0, 0.0), Complex::new(0.0, 0.0)];
            agreement.holds(&format!("{what}: number of poles"), found.len() == riding.regulator.closed.len() + beside.len());
            for pole in riding.regulator.closed.iter().chain(&beside) {
                let (at, _) =
                    (found.iter().enumerate()).min_by(|a, b| (a.1 - pole).norm().total_cmp(&(b.1 - pole).norm())).expect("poles are left");
                let nearest = found.swap_remove(at);
                let size = pole.norm();
                agreement.near(&format!("{what}: {nearest} against {pole}"), size + (nearest - pole).norm(), size, &close);
            }
            let (E, A, nominal) = held(&linear, riding.yaw_rate, &|_| false);
            let all = pencil(&E, &A, &nominal).unwrap_or_else(|error| panic!("{what}: {error}")).values;
            let staying = all.iter().filter(|s| s.re > -1e-3).count();
            agreement.holds(&format!("{what}: all but one of {all:?} decay"), staying == 1);
        }
    }
    agreement.assert();
}

/// `a sin ωt`.
struct Sine {
    amplitude: f64,
    omega: f64,
}

impl Track for Sine {
    fn value(&self, time: f64) -> f64 {
        self.amplitude * (self.omega * time).sin()
    }
    fn rate(&self, time: f64) -> f64 {
        self.amplitude * self.omega * (self.omega * time).cos()
    }
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
}

#[test]
fn small_motions_are_those_of_the_frequency_response() {
    let mut agreement = Agreement::on("responses over time and frequency");
    let outputs = ["chassis.roll", "steer.angle", "steer.torque", "chassis.yaw_rate"].map(str::to_owned);
    for model in ["ref11", "gsxr1000"] {
        let mut riding = Riding::of(model, (25.0, 25.0), 0.0, &RiderDescription::default());
        let linear = riding.linear();
        let excitation = [Excitation::input("wind.lateral")];
        let mut response = FrequencyResponse::of(&linear, &excitation, &outputs).unwrap_or_else(|error| panic!("{error}"));
        let wind = riding.closed.inputs().iter().position(|i| i.signal.name == "wind.lateral").expect("wind");
        for (frequency, periods) in [(0.5, 2), (1.0, 4), (3.0, 12)] {
            let mut linear_response = vec![Complex::new(0.0, 0.0); outputs.len()];
            response.at(TAU * frequency, &mut linear_response);
            // settled for 10 s, then whole periods
            let (settled, samples) = (10.0, 100 * periods);
            let end = settled + periods as f64 / frequency;
            let times: Vec<f64> =
                [0.0].into_iter().chain((0..=samples).map(|k| settled + (end - settled) * k as f64 / samples as f64)).collect();
            let mut transient = Transient::new(&riding.closed, times);
            transient.start = Start { y: riding.y.clone(), held: vec![false; riding.y.len()] };
            let mut inputs = Driven::new(riding.u.clone());
            let (amplitude, omega) = (0.05, TAU * frequency);
            inputs.add(&riding.closed, wind, Box::new(Sine { amplitude, omega }));
            let simulation = By::Erk(1e-9, 1e-3).run(transient, &mut riding.closed, &inputs);
            assert!(simulation.ending.reached(), "{model}: {:?}", simulation.ending);
            for (name, expected) in outputs.iter().zip(&linear_response) {
                let column = simulation.trajectory.column(name).expect("recorded");
                let mut found = Complex::new(0.0, 0.0);
                for k in 0..samples {
                    let phase = -omega * simulation.trajectory.time[k + 1];
                    // a sine is the imaginary part of the phasor: turned by −90°
                    found += Complex::new(0.0, 2.0) * column[k + 1] * Complex::new(phase.cos(), phase.sin()) / samples as f64;
                }
                let found = found / amplitude;
                let size = expected.norm();
                let told = format!("{model}, {frequency} Hz, {name}: {found} against {expected}");
                agreement.near(&told, size + (found - expected).norm(), size, &relative(1e-3).because("wind of 0.05 m/s"));
            }
        }
    }
    agreement.assert();
}

#[test]
fn left_is_like_right() {
    let mut agreement = Agreement::on("lane changes to both sides");
    let vehicle = Vehicle::bundled("ref11");
    let care = Care { backend: "erk", tolerance: 1e-11, rate: 10.0 };
    let [left, right] = ["3.6 m", "-3.6 m"].map(|width| {
        let changes = [format!("path.1.lane_change.width={width}"), "path.1.lane_change.length=60 m".to_owned()];
        Rode::of(&vehicle, read("lane_change", &changes), care, &[])
    });
    let mirrored = absolute(1e-8).because("tolerance 1e-11 of the integration");
    let sides =
        ["chassis.y", "chassis.roll", "chassis.yaw_rate", "chassis.lateral_speed", "steer.angle", "steer.torque", "rider.path_error"];
    let sames = ["chassis.x", "chassis.forward_speed", "chassis.pitch", "fork.travel", "drive.torque", "rider.station"];
    for (name, sign) in sides.map(|n| (n, -1.0)).into_iter().chain(sames.map(|n| (n, 1.0))) {
        // torques to the same share as the rest
        let scale = if name.ends_with("torque") { 0.01 } else { 1.0 };
        for (k, (l, r)) in left.signal(name).iter().zip(right.signal(name)).enumerate() {
            agreement.near(&format!("sample {k}: {name}"), scale * l, scale * sign * r, &mirrored);
        }
    }
    agreement.holds("it leans", left.peak("chassis.roll") > 0.15);
    agreement.assert();
}

/// Simpson's rule over evenly spaced samples, trapezoid for a last odd one.
fn integral(values: &[f64], step: f64) -> f64 {
    let pairs = (values.len() - 1) / 2;
    let simpson: f64 = (0..pairs).map(|k| values[2 * k] + 4.0 * values[2 * k + 1] + values[2 * k + 2]).sum::<f64>() * step / 3.0;
    let rest: f64 = values[2 * pairs..].windows(2).map(|w| 0.5 * (w[0] + w[1])).sum();
    simpson + rest * step
}

#[test]
fn energy_is_accounted_for() {
    let mut agreement = Agreement::on("energy of maneuvers");
    let care = Care { backend: "cvode_adams", tolerance: 1e-9, rate: 1000.0 };
    let record = ["system.energy", "system.power_in", "system.power_dissipated"];
    for (model, name) in [("ref11", "lane_change"), ("gsxr1000", "lane_change"), ("gsxr1000", "braking_in_curve"), ("ref11", "u_turn")] {
        let mut maneuver = read(name, &[]);
        maneuver.duration = Some(5.0);
        let rode = Rode::of(&Vehicle::bundled(model), maneuver, care, &record);
        // a last sample may lie at the end of the path, between two periods
        let whole = (rode.time().windows(2)).take_while(|w| (w[1] - w[0] - 1e-3).abs() < 1e-9).count();
        let [energy, supplied, dissipated] = record.map(|name| rode.signal(name)[..=whole].to_vec());
        let net: Vec<f64> = supplied.iter().zip(&dissipated).map(|(s, d)| s - d).collect();
        let turned: Vec<f64> = supplied.iter().zip(&dissipated).map(|(s, d)| s.abs() + d.abs()).collect();
        let (gained, balance, turned) = (energy[whole] - energy[0], integral(&net, 1e-3), integral(&turned, 1e-3));
        let quadrature = absolute(1e-6 * turned).because("quadrature at 1 kHz");
        agreement.near(&format!("{model}, {name}: energy gained, J, of {turned:.0} J turned over"), gained, balance, &quadrature);
        agreement.holds(&format!("{model}, {name}: it rides {} s", whole as f64 * 1e-3), whole > 4000);
    }
    agreement.assert();
}
