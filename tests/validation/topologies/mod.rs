//! Vehicles of every topology, from files alone: each goes through the same steps; what each is there for is held by a calculation by hand.

mod shafts;
mod sidecar;
mod statics;

use fastbike::plan::Turn;
use fastbike::small_motions::{Shapes, SmallMotions};
use fastbike::{standard_kinds, steady};
use mbody::dynamics::TreePlant;
use motorcycle::steering::STANDS;
use problem::{Dae, Ending, EquationKind};
use std::fs;
use std::path::Path;
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::instant::Instant;
use validation::rode::{Care, Rode, read};
use validation::vehicle::{State, Vehicle, accelerating, leaning, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[&[Row]] = &[GOING, sidecar::EVIDENCE, statics::EVIDENCE, shafts::EVIDENCE];

/// Rows of the table.
const GOING: &[Row] = validation::evidence![
    every_vehicle_goes => (
        "every folder of `models/vehicles`: `check` without a remark, static pose, straight running, a corner to either side, modes, the beginning of a lane change with the virtual rider",
        "plausible ranges (Sharp, Evangelou, Limebeer 2004; Cossalter 2006): weave below 4.5 Hz, wobble 3.5 to 11.5 Hz, hops 7 to 25 Hz, bounce and pitch 0.8 to 12 Hz",
        "the ranges; 0.6 m from the path; a vehicle that cannot be steered or driven is not ridden"
    ),
    loops_stay_closed => (
        "`tilting_three_wheeler`, `telelever`, `duolever`: all loops closed in straight running, at leans to 40°, while braking; along a lane change of the three-wheeler",
        "the loops as written in the files",
        "1e-9 m"
    ),
    the_inner_wheel_turns_more => (
        "`tilting_three_wheeler`: the bar turned by 0.2 rad without lean turns the inner wheel more than the outer one, by less than full Ackermann steering; the mean follows the bar",
        "cot δ_o − cot δ_i = b/p (Ackermann)",
        "signs; a share between 0.1 and 1 of the full difference"
    ),
];

/// Folders of vehicles.
fn vehicles() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/vehicles");
    let entries = fs::read_dir(folder).expect("the folder of vehicles").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A speed at which a vehicle of this mass feels at home, m/s.
fn usual_speed(vehicle: &Vehicle) -> f64 {
    if vehicle.system.model().total_mass() < 150.0 { 5.0 } else { 15.0 }
}

fn has(vehicle: &Vehicle, signal: &str) -> bool {
    steady::signals(&vehicle.plant()).iter().any(|s| s.name == signal)
}

#[test]
fn every_vehicle_goes() {
    let mut agreement = Agreement::on("every vehicle");
    let found = vehicles();
    agreement.holds("sixteen folders or more", found.len() >= 16);
    for name in &found {
        let checked = fastbike::run_captured(standard_kinds(), ["check", name]);
        agreement.holds(&format!("{name}: check: {}{}", checked.stdout, checked.stderr), checked.status == 0 && checked.stderr.is_empty());
        let vehicle = Vehicle::bundled(name);
        let speed = usual_speed(&vehicle);
        let corner = match has(&vehicle, STANDS) {
            true => turning(&[speed], Turn::LateralAcceleration, &[-1.5, 1.5]),
            false => leaning(&[speed], &[-0.2, 0.2]),
        };
        for (what, request) in [("static", Default::default()), ("straight", running(&[speed])), ("corner", corner)] {
            for state in vehicle.steady(&request, "kinsol") {
                agreement.holds(&format!("{name}: {what}: {:?}", state.point.ending), state.point.ending == Ending::Reached);
            }
        }
        let request = running(&[speed]);
        let straight = steady::run(&request, &vehicle.system, "kinsol", "modes").unwrap_or_else(|failure| panic!("{name}: {failure}"));
        let small = SmallMotions { request: &request, system: &vehicle.system, backend: "kinsol", residual_tolerance: 1e-6 };
        let along = small.along(&straight, Shapes::LeftOut).unwrap_or_else(|failure| panic!("{name}: {failure}"));
        let modes = &along.points[0].as_ref().unwrap_or_else(|why| panic!("{name}: {why}")).modes;
        for (mode, low, high) in BANDS {
            for value in modes.iter().filter(|m| m.name == mode && m.value.im > 0.0).map(|m| m.value) {
                let frequency = value.norm() / std::f64::consts::TAU;
                agreement.holds(&format!("{name}: {mode} at {frequency} Hz"), (low..=high).contains(&frequency));
            }
        }
        // nothing drives the benchmark bicycle, so nobody can hold its speed in a curve
        if has(&vehicle, "steer.torque") && has(&vehicle, "drive.torque") {
            let mut maneuver = read("lane_change", &[format!("speed={speed}"), "path.0.straight.length=5".to_owned()]);
            maneuver.duration = Some(DURATION);
            let rode = Rode::of(&vehicle, maneuver, Care { rate: 20.0, ..Care::USUAL }, &["rider.path_error"]);
            agreement.holds(&format!("{name}: the ride: {}", rode.ending()), rode.ending() == "reached");
            agreement.near(&format!("{name}: offset from the path"), rode.peak("rider.path_error"), 0.0, &absolute(0.6).because("a lane"));
        }
    }
    agreement.assert();
}

/// How long a ride is tried, s.
const DURATION: f64 = 1.2;
/// Plausible frequencies, Hz.
const BANDS: [(&str, f64, f64); 7] = [
    ("weave", 0.05, 4.5),
    ("wobble", 3.5, 11.5),
    ("front hop", 7.0, 25.0),
    ("rear hop", 7.0, 25.0),
    ("side hop", 7.0, 25.0),
    ("bounce", 0.8, 12.0),
    ("pitch", 0.8, 12.0),
];

/// Largest error of the constraints on coordinates, m or rad.
fn open(state: &State) -> f64 {
    let mut plant = TreePlant::new(state.system.clone());
    let mut residual = vec![0.0; plant.equations().len()];
    state.at(|at| plant.residual(at, &mut residual)).expect("finite");
    let rows = residual.iter().zip(plant.equations()).filter(|(_, e)| e.kind == EquationKind::Constraint);
    rows.map(|(r, _)| r.abs()).fold(0.0, f64::max)
}

#[test]
fn loops_stay_closed() {
    let mut agreement = Agreement::on("loops");
    let closed = absolute(1e-9).because("a nanometer");
    for (name, rows) in [("tilting_three_wheeler", 5), ("telelever", 3), ("duolever", 5)] {
        let vehicle = Vehicle::bundled(name);
        agreement.holds(&format!("{name}: {rows} rows, none redundant"), vehicle.system.held_rows() == rows);
        let braking = accelerating(running(&[20.0]), -4.0);
        let requests = [Default::default(), running(&[20.0]), leaning(&[15.0], &[-0.7, -0.3, 0.3, 0.7]), braking];
        for state in requests.iter().flat_map(|request| vehicle.steady(request, "kinsol")) {
            agreement.holds(&format!("{name}: {:?}", state.point.ending), state.point.ending == Ending::Reached);
            agreement.near(&format!("{name}: {:?}", state.point.given), open(&state), 0.0, &closed);
        }
    }
    let maneuver = read("lane_change", &["speed=15".to_owned()]);
    let care = Care { tolerance: 1e-8, rate: 20.0, ..Care::USUAL };
    let rode = Rode::of(&Vehicle::bundled("tilting_three_wheeler"), maneuver, care, &["rider.path_error"]);
    agreement.holds(rode.ending(), rode.ending() == "end_of_path");
    let drift = rode.history.outcome.drift.position.as_ref().expect("constraints");
    agreement.near("tilting_three_wheeler: along a lane change", drift.off.by, 0.0, &closed);
    agreement.assert();
}

#[test]
fn the_inner_wheel_turns_more() {
    let mut agreement = Agreement::on("Ackermann");
    let mut trike = Instant::of("tilting_three_wheeler");
    for angle in [0.2, -0.2] {
        trike.put(&[("steer.angle", angle), ("tilt.angle", 0.0)]);
        let wheels = [trike.get("front_left_steer.angle"), trike.get("front_right_steer.angle")];
        let (inner, outer) = if angle > 0.0 { (wheels[0], wheels[1]) } else { (wheels[1], wheels[0]) };
        // kingpins 0.36 m apart, wheelbase 1.49 m
        let full = (1.0 / outer.tan() - 1.0 / inner.tan()).abs() / (0.36 / 1.49);
        agreement.holds(&format!("inner {inner}, outer {outer}"), inner.abs() > outer.abs() && inner * outer > 0.0);
        agreement.holds(&format!("{full} of full Ackermann"), (0.1..1.0).contains(&full));
        agreement.near("mean", 0.5 * (inner + outer), angle, &relative(0.02).because("levers of equal length"));
    }
    agreement.assert();
}
