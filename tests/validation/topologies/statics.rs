//! Scooter, supermoto and bicycle: what their files say, by hand.

use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    bushings_carry_what_is_left => (
        "`scooter`: static forces of both bushings, of the springs and on the tires",
        "three moments by hand from the masses as written",
        "0.01 N: pitch and heave below 1e-7 at rest"
    ),
    the_variator_carries_the_power => (
        "`scooter` at top speed: power of the engine less the belt's loss is that of drag and tires; at 15 m/s the engine stays at its shift speed",
        "balance of power by hand",
        "1 %: slip of the driven tire; 1 % of the shift speed: rounded corners"
    ),
    tables_are_met_at_rest => (
        "`supermoto`: static forces of fork and shock on the published tables, at the compression that is found; the fork carries load less unsprung weight along its axis",
        "tables of MotorcycleDynamics, interpolated linearly by hand",
        "0.5 %: spline against straight lines"
    ),
    frame_and_rider_are_the_published_bicycle => (
        "`bicycle`: rear frame and upper body together have mass, center and inertia of the published rigid rider and frame",
        "J. K. Moore, BicycleParameters, `meijaard2007_browser_jason` (mass, center, Ixx, Iyy, Izz, Ixz)",
        "5e-3: the parts were measured apart"
    ),
];

#[test]
fn bushings_carry_what_is_left() {
    let mut agreement = Agreement::on("scooter at rest");
    let state = Vehicle::bundled("scooter").state(&Default::default());
    const G: f64 = 9.81;
    // masses as written, kg, and how far they are ahead of the rear axle, m
    let bodies = [(148.0, 0.60), (1.5, 0.47), (36.0, 0.25), (10.5, 0.0), (2.5, 1.43), (8.0, 1.37)];
    // the bar: 0.05 m ahead of the head at 0.88 m on an axis of 26.5° through 1.37 + 0.085 m
    let bar = (11.0, 1.37 + 0.085 - 0.88 * 26.5f64.to_radians().tan() + 0.05);
    let [weight, ahead] = bodies.into_iter().chain([bar]).fold([0.0; 2], |[w, x], (m, at)| [w + G * m, x + G * m * at]);
    let front = ahead / 1.37;
    let rear = weight - front;
    // engine unit and wheel about the lower end of the link, 0.47 m ahead; the spring stands at 0.03 m
    let spring = (rear * 0.47 - 36.0 * G * (0.47 - 0.25) - 10.5 * G * 0.47) / (0.47 - 0.03);
    let link = 46.5 * G + spring - rear;
    let each = 0.5 * (link + 1.5 * G);
    let near = absolute(0.01).because("pitch and heave below 1e-7 at rest");
    agreement.near("front load", state.get("front_tire.normal_force"), front, &near);
    agreement.near("rear load", state.get("rear_tire.normal_force"), rear, &near);
    agreement.near("rear spring", state.get("rear_spring.force"), spring, &near);
    for side in ["left", "right"] {
        agreement.near(&format!("{side} bushing, up"), state.get(&format!("{side}_bushing.force_z")), each, &near);
        agreement.near(&format!("{side} bushing, forward"), state.get(&format!("{side}_bushing.force_x")), 0.0, &near);
        agreement.near(&format!("{side} bushing, turning"), state.get(&format!("{side}_bushing.moment_y")), 0.0, &near);
        let sag = state.get(&format!("{side}_bushing.deflection_z"));
        agreement.near(&format!("{side} bushing, sag"), sag, -each / 400e3, &relative(1e-4).because("400 kN/m"));
    }
    agreement.assert();
}

#[test]
fn the_variator_carries_the_power() {
    let mut agreement = Agreement::on("variator");
    let vehicle = Vehicle::bundled("scooter");
    let fastest = fastbike::plan::Request { top_speed: true, ..Default::default() };
    let state = vehicle.state(&fastest);
    let get = |name: &str| state.get(name);
    let speed = get("chassis.forward_speed");
    agreement.holds(&format!("top speed {speed} m/s; 110 to 115 km/h are published"), (0.9 * 30.6..1.1 * 31.9).contains(&speed));
    let engine = 0.85 * get("engine.torque") * get("engine.speed");
    let rolling: f64 =
        ["front_tire", "rear_tire"].iter().map(|t| -get(&format!("{t}.rolling_moment")) / get(&format!("{t}.effective_radius"))).sum();
    agreement.near("power, W", engine, (get("aero.drag") + rolling) * speed, &relative(0.03).because("slip of the driven tire"));
    let city = vehicle.state(&running(&[15.0]));
    let shift = 7500.0 * std::f64::consts::TAU / 60.0;
    agreement.near("engine at 15 m/s", city.get("engine.speed"), shift, &relative(0.01).because("rounded corners"));
    agreement.assert();
}

#[test]
fn tables_are_met_at_rest() {
    let mut agreement = Agreement::on("supermoto at rest");
    let state = Vehicle::bundled("supermoto").state(&Default::default());
    let lines = relative(5e-3).because("a spline against straight lines");
    let between = |x: f64, (x0, f0): (f64, f64), (x1, f1): (f64, f64)| f0 + (f1 - f0) * (x - x0) / (x1 - x0);
    let travel = state.get("fork.travel");
    agreement.holds(&format!("fork {travel} m"), (0.06144..0.07108).contains(&travel));
    agreement.near("fork", state.get("fork_strut.force"), between(travel, (0.06144, 920.8), (0.07108, 1047.4)), &lines);
    let pressed = state.get("rear_shock.compression");
    agreement.holds(&format!("shock {pressed} m"), (0.030..0.040).contains(&pressed));
    agreement.near("shock", state.get("rear_shock.force"), between(pressed, (0.030, 6550.0), (0.040, 8050.0)), &lines);
    // sliders and wheel, 9.67 and 12.14 kg, below a fork tilted by the caster and the pitch
    let tilt = 27.8f64.to_radians() - state.get("chassis.pitch");
    let carried = (state.get("front_tire.normal_force") - (9.67 + 12.14) * 9.81) * tilt.cos();
    agreement.near("fork as a beam", state.get("fork_strut.force"), carried, &relative(1e-6).because("statics"));
    agreement.assert();
}

#[test]
fn frame_and_rider_are_the_published_bicycle() {
    let mut agreement = Agreement::on("bicycle");
    let vehicle = Vehicle::bundled("bicycle");
    let model = vehicle.system.model();
    let body = |link: &str| model.body(model.frame(link).expect("a link").body);
    let upper = body("rider_upper");
    let both = body("chassis").mass.welded_with(&upper.mass.in_parent(&upper.X_PF));
    let [xx, yy, zz, _, xz, _] = both.inertia;
    // Ixz of the source is that of axes with z down
    let published = [
        ("mass", both.mass, 81.86),
        ("center, forward", both.center.x, 0.289099434117),
        ("center, up", both.center.z, 1.04029228321),
        ("Ixx", xx, 11.3557360401),
        ("Iyy", yy, 12.2177848012),
        ("Izz", zz, 3.12354397008),
        ("Ixz", xz, 1.96756380745),
    ];
    for (what, found, printed) in published {
        agreement.near(what, found, printed, &relative(5e-3).because("the parts were measured apart"));
    }
    agreement.assert();
}
