//! The benchmark motorcycle `moto11`, which several codes solve: inverse dynamics, one steady turn, a sweep of 400 steady turns.

use analyses::eigen;
use analyses::transient::{Step, evenly};
use analyses::trim::{Trim, TrimProblem, Walk};
use fastbike::backend::{INTEGRATION, Steps};
use fastbike::plan::Turn;
use mbody::algorithm::kinematics;
use mbody::algorithm::rnea::rnea;
use mbody::assembly::{BaseDescription, assemble_urdf};
use mbody::spatial::{Rotation, Vec3};
use mbody::stage::Workspace;
use native::Newton;
use problem::{AlgebraicMethod, Dae};
use sundials::{Kinsol, Strategy};
use validation::agreement::{Agreement, relative};
use validation::course::{By, Course};
use validation::evidence::Row;
use validation::reference::{Table, text};
use validation::vehicle::{State, Vehicle, free, given, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    inverse_dynamics_of_sixty_four_states_agrees => (
        "`moto11` on a free base: inverse dynamics of 64 states",
        "Pinocchio 4.1.0; `tests/reference/moto11/moto11.csv`",
        "relative 1e-10 of the largest entry: two codes in double precision"
    ),
    the_steady_turn_is_met => (
        "`moto11`: steady turn at 36.3 m/s and 4.2 m/s²: roll and pitch in both orders of rotation, steering angle, both torques",
        "codes on Pinocchio (Python, C++) and CasADi agree; `tests/reference/moto11/moto11_checks.yaml`",
        "half a unit of the last printed digit"
    ),
    none_of_four_hundred_turns_fails => (
        "`moto11`: 400 steady turns, 10 to 60 m/s, 0 to 8 m/s², each from its neighbor in the grid as in the benchmark: none fails, by KINSOL and Newton",
        "definition of the benchmark",
        "exact; scaled residual 1e-10"
    ),
    eigenvalues_are_met => (
        "`moto11`: the six oscillations of straight running at 30 m/s",
        "codes on Pinocchio (Python, C++) and CasADi agree; definition of the benchmark",
        "half a unit of the last printed digit"
    ),
    a_pulse_at_the_handlebar_is_met => (
        "`moto11`: 1 s from straight running at 30 m/s with a pulse of 20 N m at the handlebar from 0.1 to 0.2 s, by every integrator that chooses its steps: roll rate, steering angle, lateral position",
        "codes on Pinocchio (Python, C++) and CasADi agree; `tests/reference/moto11/moto11_checks.yaml`",
        "half a unit of the last printed digit; tolerances 1e-11, 1e-13 for order two"
    ),
];

#[test]
fn inverse_dynamics_of_sixty_four_states_agrees() {
    let (assembled, findings) = assemble_urdf("moto11_free.urdf", &text("moto11/moto11_free.urdf"), BaseDescription::Free, 9.81, &[]);
    let system = assembled.unwrap_or_else(|| panic!("{findings}")).system;
    let model = system.model();
    let table = Table::read("moto11/moto11.csv");
    let mut agreement = Agreement::on("moto11: RNEA of 64 states against Pinocchio");
    agreement.holds("64 states", table.len() == 64);
    let two_codes = relative(1e-10).because("two codes in double precision");
    let mut w = Workspace::new(model);
    for row in 0..table.len() {
        // position, quaternion and joints; then velocities, accelerations, forces, all with the linear part of the base first
        let numbers = table.numbers(row);
        w.position.q.copy_from_slice(&numbers[..12]);
        w.velocity.v.copy_from_slice(&numbers[12..23]);
        w.acceleration.vd.copy_from_slice(&numbers[23..34]);
        kinematics::position(model, &mut w.position);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
        rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
        agreement.all_near(&format!("state {}", row + 1), &w.tau, &numbers[34..], &two_codes);
    }
    agreement.assert();
}

/// Steady turn at a speed of the mass center of the chassis; the lateral acceleration is speed times yaw rate.
fn turn(speed: f64, acceleration: f64) -> State {
    let request = turning(&[speed], Turn::YawRate, &[acceleration / speed]);
    let request = given(free(request, "chassis.forward_speed"), "mass_center.point_speed", speed);
    Vehicle::bundled("moto11").state(&request)
}

#[test]
fn the_steady_turn_is_met() {
    let state = turn(10.0 + 50.0 * 10.0 / 19.0, 80.0 / 19.0);
    let (roll, pitch) = (state.get("chassis.roll"), state.get("chassis.pitch"));
    // the same pose as yaw, pitch, roll: R = Rz Ry(θ') Rx(φ')
    let R = Rotation::about_x(roll) * Rotation::about_y(pitch);
    let [x, y, z]: [Vec3<f64>; 3] = R.columns;
    let (other_roll, other_pitch) = (y.z.atan2(z.z), -x.z.asin());
    let mut agreement = Agreement::on("moto11: steady turn");
    for (what, value, text) in [
        ("roll, yaw-roll-pitch, deg", roll.to_degrees(), "-23.694738"),
        ("pitch, yaw-roll-pitch, deg", pitch.to_degrees(), "-0.495606"),
        ("roll, yaw-pitch-roll, deg", other_roll.to_degrees(), "-23.695527"),
        ("pitch, yaw-pitch-roll, deg", other_pitch.to_degrees(), "-0.453825"),
        ("steering angle, deg", state.get("steer.angle").to_degrees(), "0.240263"),
        ("steering torque, N m", state.get("steer.torque"), "1.15657"),
        ("driving torque, N m", state.get("drive.torque"), "101.6514"),
    ] {
        agreement.printed(what, value, text);
    }
    agreement.holds(
        "to the left both tires push to the left",
        ["front", "rear"].iter().all(|end| state.get(&format!("{end}_tire.lateral_force")) > 0.0),
    );
    agreement.assert();
}

/// The first guess of the benchmark in our signals: the mass center, 0.62 m over the base point, starts 0.61 m over the road.
const GUESS: [(&str, f64); 2] = [("chassis.heave", 0.61 - 0.62), ("drive.torque", 50.0)];

/// Sweeps the grid of the benchmark with one method; returns failures and iterations.
fn sweep(method: &mut dyn AlgebraicMethod) -> (Vec<String>, usize) {
    let mut plant = Vehicle::bundled("moto11").plant();
    let mut trim = Trim::steady(&plant);
    let first_speed = 10.0;
    trim.give("mass_center.point_speed", first_speed).expect("an output");
    trim.give("chassis.yaw_rate", 0.0).expect("a velocity");
    for signal in ["steer.torque", "drive.torque"] {
        trim.free(signal, 0.0).expect("an input");
    }
    let speeds = [("chassis.forward_speed", 1.0), ("front_wheel.spin_rate", 0.30), ("rear_wheel.spin_rate", 0.32)];
    speeds.iter().for_each(|(signal, radius)| trim.guess(signal, first_speed / radius));
    GUESS.iter().for_each(|(signal, guess)| trim.guess(signal, *guess));
    let mut problem = TrimProblem::new(&mut plant, &trim).expect("a square system");
    let at = |name: &str| {
        let variable = problem.variables().find(name).expect("a signal");
        problem.unknowns().iter().position(|u| *u == variable).expect("an unknown")
    };
    let (heave, roll, scaled) = (at("chassis.heave"), at("chassis.roll"), speeds.map(|(signal, _)| at(signal)));
    let walk = Walk::default();
    let (mut straight, mut speed_before) = (problem.guess().to_vec(), first_speed);
    let (mut failures, mut iterations) = (Vec::new(), 0);
    for i in 0..20 {
        let speed = 10.0 + 50.0 * f64::from(i) / 19.0;
        let mut x = straight.clone();
        scaled.iter().for_each(|&k| x[k] *= speed / speed_before);
        let mut leaned_before = 0.0;
        for k in 0..20 {
            let acceleration = 8.0 * f64::from(k) / 19.0;
            // the guess leans on (to the negative side in a left turn), and the mass center sinks with the cosine of the lean
            let leaned = (acceleration / 9.81).atan();
            let before = x[roll];
            x[roll] -= leaned - leaned_before;
            x[heave] *= x[roll].cos() / before.cos();
            leaned_before = leaned;
            let outcome = walk.solve(&mut problem, method, &[speed, acceleration / speed], &mut x);
            iterations += outcome.effort.iterations;
            if !outcome.converged() {
                failures.push(format!("{speed:.2} m/s, {acceleration:.2} m/s²: {:?}", outcome.ending));
            }
            if k == 0 {
                (straight, speed_before) = (x.clone(), speed);
            }
        }
    }
    (failures, iterations)
}

#[test]
fn none_of_four_hundred_turns_fails() {
    for method in [&mut Newton::new() as &mut dyn AlgebraicMethod, &mut Kinsol::new(Strategy::LineSearch)] {
        let (failures, iterations) = sweep(method);
        println!("moto11: 400 turns by {}: {} failures, {:.2} iterations each", method.name(), failures.len(), iterations as f64 / 400.0);
        assert!(failures.is_empty(), "{}: {failures:#?}", method.name());
    }
}

#[test]
fn eigenvalues_are_met() {
    const PRINTED: [(&str, &str); 6] = [
        ("-29.5122", "73.2654"),
        ("-80.5883", "56.6364"),
        ("-15.7023", "48.9841"),
        ("-10.9462", "25.3710"),
        ("-2.3634", "16.9032"),
        ("-5.4951", "13.4513"),
    ];
    let spectrum = eigen(&Vehicle::bundled("moto11").state(&running(&[30.0])).linear()).expect("eigenvalues");
    let mut agreement = Agreement::on("moto11: eigenvalues");
    // the 22 states of the benchmark without the five cyclic coordinates, which add zeros
    agreement.holds("17 eigenvalues", spectrum.values.len() == 17);
    agreement.holds("six oscillations", spectrum.values.iter().filter(|s| s.im > 0.0).count() == 6);
    for (pair, (re, im)) in spectrum.values.chunks(2).zip(PRINTED) {
        agreement.printed(&format!("real part of {}", pair[0]), pair[0].re, re);
        agreement.printed(&format!("imaginary part of {}", pair[0]), pair[0].im, im);
    }
    agreement.assert();
}

#[test]
fn a_pulse_at_the_handlebar_is_met() {
    let straight = Vehicle::bundled("moto11").state(&running(&[30.0]));
    let mut agreement = Agreement::on("moto11: pulse at the handlebar");
    // steps of equal length are chosen by whoever simulates; `every_backend` holds those methods
    for backend in INTEGRATION.iter().filter(|backend| backend.steps == Steps::Variable) {
        // errors of order two grow with the tolerance to the power 2/3 only
        let tolerance = if backend.name == "generalized_alpha" { 1e-13 } else { 1e-11 };
        let by = By::Named(backend.name, tolerance, 1e6 * tolerance);
        let mut course = Course::ride(&straight, &evenly(1.0, 11), by, |plant, inputs| {
            let torque = plant.inputs().iter().position(|i| i.signal.name == "steer.torque").expect("an input");
            for (time, height) in [(0.1, 20.0), (0.2, -20.0)] {
                inputs.add(plant, torque, Box::new(Step { time, height }));
            }
        });
        course.holds(&mut agreement, &format!("{by:?}"));
        let last = |name: &str| course.signal(name)[10];
        // the x component of the angular velocity in the frame of the chassis: R = Rz Rx Ry
        let (roll, pitch) = (last("chassis.roll"), last("chassis.pitch"));
        let rate = pitch.cos() * last("chassis.roll_rate") - pitch.sin() * roll.cos() * last("chassis.yaw_rate");
        let steer = last("steer.angle");
        agreement.printed(&format!("{by:?}: roll rate, rad/s"), rate, "0.04420662");
        agreement.printed(&format!("{by:?}: steering angle, rad"), steer, "-0.00368427");
        let center = course.position(10, "chassis", [0.62, 0.0, 0.62]);
        agreement.printed(&format!("{by:?}: lateral position, m"), center.y, "-0.13163319");
    }
    agreement.assert();
}
