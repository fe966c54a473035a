//! Steady circles of the bicycle without a hand on the handlebar.
//!
//! The family leaves straight running at the capsize speed, where a small lean holds itself; the lean has a maximum at 24°, and the speed falls to zero as the
//! handlebar turns on. Its numbers are our own result, not a reference: what is held is that the full equations are satisfied and that the family begins at the
//! published speed.

use analyses::trim::{Trim, TrimPoint, TrimProblem, Walk};
use mbody::dynamics::{Formulation, TreePlant};
use problem::{At, Dae, Explicit, UnknownKind};
use sundials::{Kinsol, Strategy};
use validation::agreement::{Agreement, absolute};
use validation::evidence::{Row, hold_text};
use validation::reference::Table;
use validation::vehicle::{Vehicle, leaning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_bicycle_runs_in_circles_by_itself => (
        "`whipple`: a family of steady circles without steering torque, steered by 0.5 to 75°, satisfies the full equations: no velocity changes",
        "the equations themselves; found by the trim, accelerations from the explicit form",
        "1e-10 m/s², rad/s² and 1e-10 of each row in nominal units: tolerance 1e-12 of the method"
    ),
    circles_begin_at_the_capsize_speed => (
        "`whipple`: for a vanishing steering angle the speed of that family is the capsize speed",
        "Meijaard et al. (2007), section 4 (d)",
        "1e-7 m/s: extrapolation over steering angles of 0.005, 0.01 and 0.02 rad, sixth order"
    ),
];

/// Steering angles of the family and of the printed table, degrees to the left.
const STEER: [f64; 14] = [0.5, 1.0, 2.0, 5.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 75.0];

/// Walks through steering angles, rad; lean, speed and yaw rate are found, the steering torque is zero.
fn family(angles: &[f64]) -> Vec<TrimPoint> {
    let vehicle = Vehicle::bundled("whipple");
    // a small lean to the left near the capsize speed
    let near = vehicle.state(&leaning(&[6.03], &[-0.02]));
    let mut plant = vehicle.plant();
    let mut trim = Trim::steady(&plant);
    for unknown in plant.unknowns() {
        trim.guess(&unknown.signal.name, near.get(&unknown.signal.name));
    }
    let goal = trim.give("steer.angle", angles[0]).unwrap_or_else(|error| panic!("{error}"));
    trim.give("steer.torque", 0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut problem = TrimProblem::new(&mut plant, &trim).unwrap_or_else(|error| panic!("{error}"));
    let mut method = Kinsol::new(Strategy::LineSearch);
    let mut walk = Walk { largest_steps: vec![0.1], ..Walk::default() };
    walk.options.residual_tolerance = 1e-12;
    let mut goals: Vec<f64> = problem.goals().into_iter().map(|(_, value)| value).collect();
    let mut x = problem.guess().to_vec();
    let start = walk.solve(&mut problem, &mut method, &goals, &mut x);
    assert!(start.converged(), "{start:?}");
    let mut points = Vec::new();
    for &angle in angles {
        let from = goals.clone();
        goals[goal] = angle;
        let point = walk.reach(&mut problem, &mut method, (&from, &x), &goals).unwrap_or_else(|error| panic!("{error}"));
        assert!(point.solved, "{angle} rad: {:?}", point.ending);
        x.clone_from(&point.x);
        points.push(point);
    }
    points
}

#[test]
fn the_bicycle_runs_in_circles_by_itself() {
    let mut plant = TreePlant::in_formulation(Vehicle::bundled("whipple").system, Formulation::Ggl);
    let mut agreement = Agreement::on("whipple: hands-free circles");
    let double = absolute(1e-10).because("tolerance of the method");
    let mut table = String::from("| steer (°) | lean (°) | speed (m/s) | yaw rate (rad/s) | radius (m) |\n|---|---|---|---|---|\n");
    for (steer, point) in STEER.iter().zip(family(&STEER.map(f64::to_radians))) {
        let mut y = point.y.clone();
        y.resize(plant.unknowns().len(), 0.0);
        let mut yd = vec![0.0; y.len()];
        plant.solve_rates(0.0, &mut y, &[0.0], &mut yd).expect("accelerations");
        let get = |name: &str| y[plant.unknowns().iter().position(|u| u.signal.name == name).expect("a signal")];
        for (unknown, rate) in plant.unknowns().iter().zip(&yd) {
            let grows = unknown.kind == UnknownKind::Position && unknown.cyclic;
            if !grows {
                agreement.near(&format!("steer {steer}°: rate of {}", unknown.signal.name), *rate, 0.0, &double);
            }
        }
        let (speed, yaw_rate, lean) = (get("chassis.forward_speed"), get("chassis.yaw_rate"), get("chassis.roll"));
        table += &format!("| {steer:.1} | {:.3} | {speed:.4} | {yaw_rate:.5} | {:.4} |\n", lean.to_degrees(), speed / yaw_rate);
        let mut residual = vec![0.0; plant.equations().len()];
        plant.residual(At { time: 0.0, y: &y, yd: &yd, u: &[0.0] }, &mut residual).expect("a residual");
        for (equation, by) in plant.equations().iter().zip(&residual) {
            agreement.near(&format!("steer {steer}°: {}", equation.name), by / equation.nominal, 0.0, &double);
        }
    }
    agreement.assert();
    hold_text("hands_free", &table);
}

#[test]
fn circles_begin_at_the_capsize_speed() {
    let system = Vehicle::bundled("whipple").system;
    let at = system.unknowns().iter().position(|u| u.signal.name == "chassis.forward_speed").expect("a speed");
    let speed = |point: &TrimPoint| point.y[at];
    let found: Vec<f64> = family(&[0.005, 0.01, 0.02]).iter().map(speed).collect();
    let speeds = Table::read("bicycle/speeds.csv");
    let capsize = speeds.number(speeds.find(&[("what", "capsize")]), "printed");
    let mut agreement = Agreement::on("whipple: hands-free circles begin at the capsize speed");
    // left and right circles have one speed: it is even in the steering angle
    let rule = absolute(1e-7).because("squares of three angles of a hundredth, times some thousand");
    let [fine, coarse] = [0, 1].map(|k| (4.0 * found[k] - found[k + 1]) / 3.0);
    agreement.near("speed", (16.0 * fine - coarse) / 15.0, capsize, &rule);
    agreement.assert();
}
