//! Inclined roads: uphill is tilted gravity, banks carry side forces, steady states stay, energy is accounted for, slippery roads hold less.

use fastbike::incline::Incline;
use fastbike::motion;
use fastbike::plan::{Request, Turn};
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::rode::{Care, Rode, read};
use validation::vehicle::{State, Vehicle, accelerating, given, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    uphill_is_tilted_gravity => (
        "`ref11` and `gsxr1000`, straight uphill by 8 % and downhill by 5 % at 25 m/s: tires, suspension, drive torque, pitch",
        "the same on level ground in gravity `g cos θ` with the body force `m g sin θ` of an acceleration, wheels turning evenly",
        "1e-9 of the number, and of 1 N, 1 mm, 1 N m: residual of both trims"
    ),
    grades_need_their_force => (
        "`ref11` uphill by 5 % at 20 m/s: longitudinal force of both tires",
        "`m g sin(atan 0.05)` + drag",
        "1e-9: residual of the trim"
    ),
    the_right_bank_needs_no_side_force => (
        "`ref11` with sharp tires at 10 m/s around 60 m, banked by atan(V²/(g R)): sum of the lateral forces, and the lean",
        "zero, of the level turn's m V²/R; lean of the level turn, whose balance about the line of contact is the same",
        "2 % of the level turn's: lean and wheels turn circles of other radii than the base point, by h sin φ = 0.1 m of 60"
    ),
    inclined_states_stay => (
        "`ref11` and `gsxr1000` uphill by 6 %, and around 80 m banked by 8°, and both at once: 3 s hands off",
        "a trim is an equilibrium of the time domain, whose heave rises by g V",
        "1e-5 of the nominal value: tolerance 1e-9, amplified by slow modes"
    ),
    rides_on_inclines_account_for_their_energy => (
        "`gsxr1000` over `hill`, around `banked_circle` and over `slippery_patch`: energy gained is what was supplied less what was dissipated",
        "identity",
        "1e-4 of the energy turned over: quadrature at 200 Hz"
    ),
    slippery_roads_hold_less => (
        "`gsxr1000` braking: greatest use of friction on `slippery_patch`",
        "twice that of the same braking on a dry road, by the similarity method",
        "10 %: loads differ a little where the use is greatest"
    ),
];

fn inclined(request: Request, grade: f64, bank: f64) -> Request {
    Request { incline: Incline { grade, cross_slope: bank.tan() }, ..request }
}

/// Signals that do not know where down is.
const FELT: [&str; 14] = [
    "front_tire.normal_force",
    "rear_tire.normal_force",
    "front_tire.longitudinal_force",
    "rear_tire.longitudinal_force",
    "rear_tire.longitudinal_slip",
    "front_tire.deflection",
    "rear_tire.deflection",
    "front_tire.effective_radius",
    "front_wheel.spin_rate",
    "rear_wheel.spin_rate",
    "fork.travel",
    "swingarm.angle",
    "drive.torque",
    "trail",
];

#[test]
fn uphill_is_tilted_gravity() {
    let (speed, g): (f64, f64) = (25.0, 9.81);
    let mut agreement = Agreement::on("inclines: tilted gravity");
    let residual = absolute(1e-9).or_relative(1e-9).because("residual of both trims");
    for model in ["ref11", "gsxr1000"] {
        for slope in [0.08_f64, -0.05] {
            let angle = slope.atan();
            let hill = Vehicle::with(model, &[("gravity", "9.81 m/s^2")]);
            let hill = hill.state(&inclined(running(&[speed * angle.cos()]), slope, 0.0));
            // the force of an acceleration pulls back on every mass alike; wheels and all that turns with them keep their spin
            let level = Vehicle::with(model, &[("gravity", &format!("{:.17} m/s^2", g * angle.cos()))]);
            let request = accelerating(running(&[speed]), g * angle.sin());
            let request = given(given(request, "rate(front_wheel.spin_rate)", 0.0), "rate(rear_wheel.spin_rate)", 0.0);
            let level = level.state(&Request { front_brake_share: 0.0, ..given(request, "front_brake.torque", 0.0) });
            for name in FELT {
                agreement.near(&format!("{model}, {slope}: {name}"), hill.get(name), level.get(name), &residual);
            }
            let pitch = level.get("chassis.pitch") - angle;
            agreement.near(&format!("{model}, {slope}: pitch"), hill.get("chassis.pitch"), pitch, &residual);
        }
    }
    agreement.assert();
}

#[test]
fn grades_need_their_force() {
    let mut agreement = Agreement::on("inclines: force");
    let vehicle = Vehicle::bundled("ref11");
    let state = vehicle.state(&inclined(running(&[20.0]), 0.05, 0.0));
    let weight = 9.81 * vehicle.system.model().total_mass();
    let force = state.get("front_tire.longitudinal_force") + state.get("rear_tire.longitudinal_force");
    let wanted = weight * 0.05_f64.atan().sin() + state.get("aero.drag");
    agreement.near("force along the slope, N", force, wanted, &relative(1e-9).because("residual of the trim"));
    agreement.holds("rises with the slope", (state.get("chassis.heave_rate") - 1.0).abs() < 1e-12);
    agreement.assert();
}

#[test]
fn the_right_bank_needs_no_side_force() {
    let mut agreement = Agreement::on("inclines: bank");
    let (speed, radius): (f64, f64) = (10.0, 60.0);
    let sharp = [
        ("elements.front_tire.tire.crown", "disc"),
        ("elements.rear_tire.tire.crown", "disc"),
        ("elements.track.single_track.front_wheel.crown_radius", "0 m"),
        ("elements.track.single_track.rear_wheel.crown_radius", "0 m"),
    ];
    let vehicle = Vehicle::with("ref11", &sharp);
    let turn = turning(&[speed], Turn::Radius, &[radius]);
    let right = (speed * speed / (9.81 * radius)).atan();
    // to the left, so the road leans to the left
    let (level, banked) = (vehicle.state(&turn), vehicle.state(&inclined(turn, 0.0, -right)));
    let side = |state: &State| state.get("front_tire.lateral_force") + state.get("rear_tire.lateral_force");
    let share = |of: f64| absolute(0.02 * of.abs()).because("lean and wheels turn circles of other radii than the base point");
    let centripetal = vehicle.system.model().total_mass() * speed * speed / radius;
    agreement.near("level: side forces, N", side(&level), centripetal, &share(centripetal));
    agreement.near("banked: side forces, N", side(&banked), 0.0, &share(centripetal));
    let lean = level.get("chassis.roll");
    agreement.near("lean, rad", banked.get("chassis.roll"), lean, &share(lean));
    agreement.near("camber against the road, rad", banked.get("rear_tire.camber"), lean + right, &share(lean));
    agreement.assert();
}

#[test]
fn inclined_states_stay() {
    let mut agreement = Agreement::on("inclines over time");
    let turn = || turning(&[20.0], Turn::Radius, &[80.0]);
    for model in ["ref11", "gsxr1000"] {
        let vehicle = Vehicle::bundled(model);
        let cases = [
            ("uphill", inclined(running(&[20.0]), 0.06, 0.0)),
            ("banked", inclined(turn(), 0.0, -0.14)),
            ("helix", inclined(turn(), 0.05, -0.14)),
        ];
        for (name, steady) in cases {
            let grade = steady.incline.grade;
            let request = motion::Request {
                times: (0..=30).map(|k| 0.1 * f64::from(k)).collect(),
                relative_tolerance: 1e-9,
                backend: "ida".to_owned(),
                formulation: None,
                derivatives: problem::Derivatives::Exact,
                linear_solver: problem::LinearSolver::Direct,
                fixed_step: motion::USUAL_STEP,
                steady: Some(steady),
                given: Vec::new(),
                signals: None,
                until: Vec::new(),
                interrupt: None,
                record: Vec::new(),
                keep: None,
            };
            let history = motion::run(&request, &vehicle.system, model, None).unwrap_or_else(|failure| panic!("{failure}"));
            let column = |name: &str| {
                let column = history.column(name).unwrap_or_else(|failure| panic!("{failure}"));
                column.unwrap_or_else(|| panic!("no signal `{name}`"))
            };
            agreement.holds(&format!("{model}, {name}: {}", history.outcome.ending), history.outcome.ending == "reached");
            let close = |nominal: f64| absolute(1e-5 * nominal).because("tolerance of the integration, residual of the trim");
            for (signal, nominal) in [
                ("chassis.forward_speed", 10.0),
                ("chassis.lateral_speed", 0.1),
                ("chassis.yaw_rate", 0.1),
                ("chassis.roll", 0.1),
                ("chassis.pitch", 0.1),
                ("fork.travel", 0.01),
                ("rear_tire.normal_force", 1000.0),
                ("trail", 0.1),
            ] {
                let values = column(signal);
                let moved = values.iter().map(|v| (v - values[0]).abs()).fold(0.0, f64::max);
                agreement.near(&format!("{model}, {name}: {signal}"), moved, 0.0, &close(nominal));
            }
            let (heave, [vx, vy]) = (column("chassis.heave"), ["forward", "lateral"].map(|d| column(&format!("chassis.{d}_speed"))[0]));
            agreement.near(&format!("{model}, {name}: rise, m"), heave[30] - heave[0], 3.0 * grade * vx.hypot(vy), &close(0.1));
        }
    }
    agreement.assert();
}

#[test]
fn rides_on_inclines_account_for_their_energy() {
    let mut agreement = Agreement::on("inclines: energy");
    let vehicle = Vehicle::bundled("gsxr1000");
    let record = ["system.energy", "system.power_in", "system.power_dissipated"];
    for name in ["hill", "banked_circle", "slippery_patch"] {
        let care = Care { tolerance: 1e-8, rate: 200.0, ..Care::USUAL };
        let rode = Rode::of(&vehicle, read(name, &[]), care, &record);
        let [energy, supplied, dissipated] = record.map(|name| rode.signal(name));
        let time = rode.time();
        let intervals = (time.len() - 2) / 2 * 2;
        let integral = |power: &dyn Fn(usize) -> f64| {
            let pairs = (0..intervals).step_by(2).map(|k| power(k) + 4.0 * power(k + 1) + power(k + 2));
            pairs.sum::<f64>() / (3.0 * care.rate)
        };
        let turned = integral(&|k| supplied[k].abs() + dissipated[k].abs());
        let quadrature = absolute(1e-4 * turned).because("quadrature at 200 Hz");
        let net = integral(&|k| supplied[k] - dissipated[k]);
        agreement.near(&format!("{name}: energy gained, J, of {turned:.0} J"), energy[intervals] - energy[0], net, &quadrature);
    }
    agreement.assert();
}

#[test]
fn slippery_roads_hold_less() {
    let mut agreement = Agreement::on("inclines: friction");
    let vehicle = Vehicle::bundled("gsxr1000");
    let ridden = |changes: &[String]| {
        Rode::of(&vehicle, read("slippery_patch", changes), Care::USUAL, &["front_tire.friction_use", "rider.path_error"])
    };
    let (wet, dry) = (ridden(&[]), ridden(&["road.friction.points=[[0 m, 1], [1 m, 1]]".to_owned()]));
    let tenth = relative(0.1).because("loads differ a little where the use is greatest");
    agreement.near("greatest use", wet.peak("front_tire.friction_use"), 2.0 * dry.peak("front_tire.friction_use"), &tenth);
    agreement.holds("straight on", wet.peak("rider.path_error") < 0.05);
    agreement.assert();
}
