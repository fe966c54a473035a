//! Steady states: methods agree, symmetries hold, forces balance, and what is missing or too much is told in signal names.

use analyses::trim::{Trim, TrimError, TrimProblem, Walk};
use fastbike::plan::{Request, Turn};
use mbody::algorithm::energy;
use mbody::spatial::{Twist, Vec3, Wrench};
use problem::{At, Dae, Differentiable, Ending, EquationKind, Matrix, Seeds};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{BUNDLED, State, Vehicle, accelerating, leaning, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    methods_agree => (
        "KINSOL and the native Newton method reach the same steady states of every bundled vehicle: at rest, straight, leaning, turning, accelerating, braking",
        "two independent methods",
        "1e-9 of each signal and in its unit: both stop at a scaled residual of 1e-10"
    ),
    left_and_right_turns_mirror_each_other => (
        "the steady states of left and right turns mirror each other (`gsxr1000` on linear tires: its published ones are not symmetric)",
        "symmetry of the vehicles",
        "1e-8 of each signal: tolerance of the method"
    ),
    forces_and_moments_of_a_steady_turn_balance => (
        "in a steady turn the forces of road, air and weight make the rate of momentum, their moments the rate of angular momentum (six components)",
        "Newton's and Euler's laws for the whole vehicle, from outputs only",
        "1e-6 N, N m: tolerance of the method"
    ),
    the_torque_search_finds_every_lean => (
        "`--steer-torque 0` finds all three leans of `ref11` at 30 m/s: straight running, and one to either side between 0.3 and 0.6 rad",
        "theory manual 7.2 (sign change of the torque)",
        "steering torque 1e-9 N m: the search's own goal"
    ),
    straight_running_falls_into_two_blocks => (
        "in straight running the equations in the plane of symmetry do not see lateral motion, and the other way round",
        "symmetry of the vehicles",
        "1e-9 of the scaled matrix: double precision"
    ),
    what_is_missing_or_too_much_is_told_in_signal_names => (
        "trims with too few or dependent conditions, unknown names and circular ties are refused in signal names",
        "`analyses::trim`",
        "exact"
    ),
    contradictory_conditions_name_the_equation => (
        "a trim that nothing can satisfy names the equation in mechanical words",
        "`analyses::trim`",
        "exact"
    ),
];

/// Steady states of all sorts.
fn requests() -> Vec<(&'static str, Request)> {
    vec![
        ("at rest", Request::default()),
        ("straight", running(&[10.0, 30.0, 50.0])),
        ("leaning", leaning(&[15.0, 40.0], &[-0.5, 0.2, 0.7])),
        ("lateral acceleration", turning(&[25.0], Turn::LateralAcceleration, &[-6.0, 3.0])),
        ("curvature", turning(&[12.0], Turn::Curvature, &[0.02])),
        ("radius", turning(&[20.0], Turn::Radius, &[-80.0])),
        ("yaw rate", turning(&[30.0], Turn::YawRate, &[0.15])),
        ("accelerating", accelerating(leaning(&[25.0], &[0.3]), 1.5)),
        ("braking", accelerating(leaning(&[30.0], &[0.2]), -4.0)),
    ]
}

#[test]
fn methods_agree() {
    let mut agreement = Agreement::on("trim: KINSOL against Newton");
    let tolerance = absolute(1e-9).or_relative(1e-9).because("both stop at a scaled residual of 1e-10");
    for name in BUNDLED {
        let vehicle = Vehicle::bundled(name);
        for (what, request) in requests() {
            let (kinsol, newton) = (vehicle.steady(&request, "kinsol"), vehicle.steady(&request, "newton"));
            for (a, b) in kinsol.iter().zip(&newton) {
                let what = format!("{name} {what} {:?}", a.point.given);
                agreement.holds(&format!("{what}: {:?}", a.point.ending), a.point.ending == Ending::Reached);
                agreement.holds(&format!("{what}: {:?}", b.point.ending), b.point.ending == Ending::Reached);
                for ((signal, x), y) in a.signals.iter().zip(&a.point.values).zip(&b.point.values) {
                    agreement.near(&format!("{what}: {}", signal.name), *y, *x, &tolerance);
                }
            }
        }
    }
    agreement.assert();
}

/// Quantities that change their sign in the mirror, by the last part of their names; all others keep it.
const MIRRORED: [&str; 24] = [
    "y",
    "yaw",
    "roll",
    "lateral_speed",
    "yaw_rate",
    "roll_rate",
    "carcass_lateral",
    "lateral",
    "lateral_force",
    "overturning_moment",
    "aligning_moment",
    "slip_angle",
    "camber",
    "contact_y",
    "velocity_y",
    "acceleration_y",
    "lateral_acceleration",
    "curvature",
    "kinematic_curvature",
    "steer.angle",
    "steer.rate",
    "steer.torque",
    "cross_slope",
    "cross_slope_rate",
];

fn mirrored(signal: &str) -> bool {
    MIRRORED.iter().any(|m| signal == *m || signal.ends_with(&format!(".{m}"))) || signal == "steering_damper.torque"
}

/// A bundled vehicle whose tires do the same to either side. Those of `gsxr1000` do not: rBy3 shifts the slip of the published tires
/// under driving and braking forces.
fn symmetric(name: &str) -> Vehicle {
    let law = "{ linear_normalized: { longitudinal_stiffness: 20, cornering_stiffness: 14, camber_stiffness: 0.9, \
        aligning_stiffness: 0.35, twisting_stiffness: 0.015 } }";
    match name {
        "gsxr1000" => Vehicle::with(name, &[("front_tire.law", law), ("rear_tire.law", law)]),
        _ => Vehicle::bundled(name),
    }
}

#[test]
fn left_and_right_turns_mirror_each_other() {
    let mut agreement = Agreement::on("trim: left against right");
    let tolerance = absolute(1e-8).or_relative(1e-8).because("tolerance of the method");
    for name in BUNDLED {
        let vehicle = symmetric(name);
        for (what, size, request) in [
            ("lean", 0.5, leaning as fn(&[f64], &[f64]) -> Request),
            ("yaw rate", 0.12, |v: &[f64], r: &[f64]| turning(v, Turn::YawRate, r)),
        ] {
            let [left, right] = [-size, size].map(|size| vehicle.state(&request(&[28.0], &[size])));
            for signal in left.signals.iter() {
                let sign = if mirrored(&signal.name) { -1.0 } else { 1.0 };
                let what = format!("{name} {what}: {}", signal.name);
                agreement.near(&what, sign * left.get(&signal.name), right.get(&signal.name), &tolerance);
            }
            for signal in ["chassis.roll", "steer.angle", "steer.torque", "front_tire.lateral_force"] {
                agreement.holds(&format!("{name} {what}: {signal} is there at all"), right.get(signal).abs() > 1e-4);
            }
        }
    }
    agreement.assert();
}

/// Wrench about the world origin of a force at a point and a moment.
fn wrench(point: Vec3<f64>, force: Vec3<f64>, moment: Vec3<f64>) -> Wrench<f64> {
    Wrench::new(moment + point.cross(force), force)
}

/// What road, air and weight do to the vehicle, from outputs, about the world origin (the base point is there, heading along x).
/// The air acts at `point` of the chassis.
fn outside(vehicle: &Vehicle, state: &State, point: Vec3<f64>) -> Wrench<f64> {
    let model = vehicle.system.model();
    let mut plant = vehicle.plant();
    let w = state.at(|at| plant.evaluate_at(at).tree.clone());
    let up = Vec3::new(0.0, 0.0, 1.0);
    let center = energy::mass_center(model, &w.world);
    let mut sum = wrench(center, model.gravity() * model.total_mass(), Vec3::zero());
    for end in ["front", "rear"] {
        let z = |quantity: &str| state.get(&format!("{end}_tire.{quantity}"));
        let axle = w.world.X_WB[model.joint(&format!("{end}_wheel")).expect("a wheel").get()].R.columns[1];
        let forward = axle.cross(up).normalized().expect("a wheel that stands");
        let force = up * z("normal_force") + forward * z("longitudinal_force") + up.cross(forward) * z("lateral_force");
        let moment = up * z("aligning_moment") + axle * z("rolling_moment") + forward * z("overturning_moment");
        sum += wrench(Vec3::new(z("contact_x"), z("contact_y"), z("contact_z")), force, moment);
    }
    let chassis = model.frame("chassis").expect("a chassis").body.get();
    let (X, V): (_, Twist<f64>) = (w.world.X_WB[chassis], w.velocity.V_WB[chassis]);
    let along = (X.R * V.at_point(point)).normalized().expect("a vehicle that moves");
    let force = along * -state.get("aero.drag") + X.R.columns[2] * state.get("aero.lift");
    sum + wrench(X.point(point), force, X.R.columns[1] * -state.get("aero.pitch_moment"))
}

#[test]
fn forces_and_moments_of_a_steady_turn_balance() {
    let mut agreement = Agreement::on("trim: balance of forces and moments");
    let tolerance = absolute(1e-6).because("tolerance of the method");
    // points of the chassis at which the air acts, as the descriptions have them
    for (name, air) in [("ref11", [0.70, 0.0, 0.70]), ("gsxr1000", [0.705, 0.0, 0.0]), ("moto11", [0.62, 0.0, 0.62])] {
        let vehicle = Vehicle::bundled(name);
        for request in [leaning(&[30.0], &[0.6]), leaning(&[14.0], &[-0.4]), running(&[40.0])] {
            let state = vehicle.state(&request);
            let model = vehicle.system.model();
            let mut plant = vehicle.plant();
            let momentum = state.at(|at| {
                let w = &plant.evaluate_at(at).tree;
                energy::momentum(model, &w.world, &w.velocity)
            });
            let (r, velocity) =
                (state.get("chassis.yaw_rate"), Vec3::new(state.get("chassis.forward_speed"), state.get("chassis.lateral_speed"), 0.0));
            // everything turns with the yaw rate, and the base point moves on: dP/dt = r k × P, dL/dt = r k × L + v × P
            let turn = Vec3::new(0.0, 0.0, r);
            let (force, moment) = (turn.cross(momentum.f), turn.cross(momentum.n) + velocity.cross(momentum.f));
            let found = outside(&vehicle, &state, air.into());
            for (axis, pick) in [("x", (|v: Vec3<f64>| v.x) as fn(Vec3<f64>) -> f64), ("y", |v| v.y), ("z", |v| v.z)] {
                let what = format!("{name} {:?} {axis}", state.point.given);
                agreement.near(&format!("force {what}"), pick(found.f), pick(force), &tolerance);
                agreement.near(&format!("moment {what}"), pick(found.n), pick(moment), &tolerance);
            }
        }
    }
    agreement.assert();
}

#[test]
fn the_torque_search_finds_every_lean() {
    let vehicle = Vehicle::bundled("ref11");
    let states = vehicle.steady(&turning(&[30.0], Turn::SteerTorque, &[0.0]), "kinsol");
    let leans: Vec<f64> = states.iter().map(|s| s.get("chassis.roll")).collect();
    let mut agreement = Agreement::on("trim: search by steering torque");
    agreement.holds(&format!("three leans: {leans:?}"), leans.len() == 3);
    for state in &states {
        let goal = absolute(1e-9).because("the search's own goal is 1e-10 N m");
        agreement.near("steering torque", state.get("steer.torque"), 0.0, &goal);
    }
    let mirror = absolute(1e-8).because("1e-10 N m over a slope of some N m/rad");
    agreement.near("straight running", leans[1], 0.0, &mirror);
    agreement.near("left against right", leans[0], -leans[2], &mirror);
    agreement.holds(&format!("between 0.3 and 0.6 rad: {leans:?}"), (0.3..0.6).contains(&leans[2]));
    agreement.assert();
}

/// Whether a signal of a motorcycle belongs to motion out of its plane of symmetry.
fn lateral(signal: &str) -> bool {
    ["lateral", "roll", "yaw", "steer.", ".y", "cross_slope"].iter().any(|part| signal.contains(part)) && !signal.contains("rolling")
}

#[test]
fn straight_running_falls_into_two_blocks() {
    let mut agreement = Agreement::on("trim: blocks of straight running");
    let rounding = absolute(1e-9).because("double precision of entries up to some hundred in units of their scales");
    for name in BUNDLED {
        let vehicle = Vehicle::bundled(name);
        let state = vehicle.state(&running(&[30.0]));
        let mut plant = vehicle.plant();
        let (ny, nu, nr, nz) = (plant.unknowns().len(), plant.inputs().len(), plant.equations().len(), vehicle.system.outputs().len());
        let mut seeds = Seeds::zeros(ny, nu, ny + nu);
        (0..ny).for_each(|i| seeds.y[(i, i)] = 1.0);
        (0..nu).for_each(|i| seeds.u[(i, ny + i)] = 1.0);
        let (mut dr, mut dz) = (Matrix::zeros(nr, ny + nu), Matrix::zeros(nz, ny + nu));
        state.at(|at: At<'_>| plant.along(at, &seeds, (&mut vec![0.0; nr], &mut vec![0.0; nz]), &mut dr, &mut dz).expect("finite"));
        let unknowns = plant.unknowns().iter().map(|u| (u.signal.name.clone(), u.nominal));
        let columns: Vec<(String, f64)> = unknowns.chain(plant.inputs().iter().map(|u| (u.signal.name.clone(), u.nominal))).collect();
        for (i, row) in plant.equations().iter().enumerate().filter(|(_, row)| row.kind != EquationKind::Kinematic) {
            // the row of a carcass state balances lateral forces
            let out_of_plane = lateral(&row.name) || row.kind == EquationKind::Element;
            for (k, (signal, nominal)) in columns.iter().enumerate() {
                if lateral(signal) != out_of_plane {
                    let scaled = dr[(i, k)] * nominal / row.nominal;
                    agreement.near(&format!("{name}: {} by {signal}", row.name), scaled, 0.0, &rounding);
                }
            }
        }
    }
    agreement.assert();
}

/// Why a trim of `ref11` cannot be set up.
fn refusal(change: impl Fn(&mut Trim) -> Result<(), TrimError>) -> TrimError {
    let mut plant = Vehicle::bundled("ref11").plant();
    let mut trim = Trim::steady(&plant);
    trim.give("chassis.forward_speed", 30.0).expect("a signal");
    trim.free("steer.torque", 0.0).expect("an input");
    trim.free("drive.torque", 50.0).expect("an input");
    // near the loaded pose: tires in the air determine nothing
    for (signal, guess) in [("front_wheel.spin_rate", 100.0), ("rear_wheel.spin_rate", 94.0), ("chassis.heave", -0.02)] {
        trim.guess(signal, guess);
    }
    let refused = change(&mut trim).err().or_else(|| match TrimProblem::new(&mut plant, &trim) {
        Err(error) => Some(error),
        Ok(mut problem) => {
            let (walk, goals) = (Walk::default(), problem.goals().into_iter().map(|(_, value)| value).collect::<Vec<_>>());
            let mut x = problem.guess().to_vec();
            walk.solve(&mut problem, &mut native::Newton::new(), &goals, &mut x);
            walk.reach(&mut problem, &mut native::Newton::new(), (&goals, &x), &goals).err()
        }
    });
    refused.expect("a refusal")
}

#[test]
fn what_is_missing_or_too_much_is_told_in_signal_names() {
    // lean or turn is not given
    let missing = refusal(|_| Ok(()));
    let told = missing.to_string();
    assert!(matches!(missing, TrimError::Count { unknowns: 14, equations: 13, .. }), "{told}");
    assert!(told.contains("`chassis.roll`") || told.contains("`chassis.yaw_rate`"), "{told}");

    // a brake does nothing at rest
    let open = refusal(|trim| {
        trim.give("chassis.forward_speed", 0.0)?;
        for signal in ["chassis.roll", "chassis.lateral_speed", "chassis.yaw_rate", "front_wheel.spin_rate", "rear_wheel.spin_rate"] {
            trim.give(signal, 0.0)?;
        }
        trim.free("front_brake.torque", 50.0)
    });
    let told = open.to_string();
    assert!(matches!(open, TrimError::Undetermined { .. }), "{told}");
    assert!(told.contains("`front_brake.torque`"), "{told}");

    let unknown = refusal(|trim| trim.give("chassis.rol", 0.1).map(|_| ()));
    assert_eq!(unknown, TrimError::UnknownSignal { name: "chassis.rol".to_owned() });
    let freed = refusal(|trim| trim.free("front_tire.camber", 0.0));
    assert_eq!(freed, TrimError::OutputRole { name: "front_tire.camber".to_owned() });
    let circle = refusal(|trim| {
        trim.tie("steer.torque", "drive.torque")?;
        trim.tie("drive.torque", "steer.torque")
    });
    assert!(matches!(&circle, TrimError::Tie { name, .. } if name.ends_with(".torque")), "{circle}");
    let by_output = refusal(|trim| trim.tie("steer.torque", "2 * front_tire.lateral_force"));
    assert!(by_output.to_string().contains("`front_tire.lateral_force`"), "{by_output}");
}

#[test]
fn contradictory_conditions_name_the_equation() {
    // straight running at 30 m/s without any torque: nothing overcomes the drag
    let refused = refusal(|trim| {
        trim.give("chassis.roll", 0.0)?;
        trim.give("drive.torque", 0.0).map(|_| ())
    });
    let told = refused.to_string();
    assert!(matches!(refused, TrimError::Contradictory { .. } | TrimError::Conflict { .. }), "{told}");
    assert!(told.contains("forward_speed") || told.contains("spin_rate"), "{told}");
}
