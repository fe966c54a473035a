//! The sidecar: why it steers straight on, and its mirror image.

use fastbike::plan::Turn;
use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_sidecar_pulls_to_its_side => (
        "`sidecar`, straight on at 20 m/s: drags and tire forces balance about the vertical axis, steering angle and torque are to the left (the sidecar is on the right), growing with \
         speed; without the drag of the sidecar the torque all but vanishes; the torque is the moment of the front tire about the steering axis",
        "moments by hand from forces and points; signs: every rider's experience (hackpilot.com: the sidecar pulls to its side)",
        "0.1 N m of 150 N m: what roll adds to the heading of the front wheel; 2 % of the torque: weight of the front assembly; static loads 1e-3 N: digits of the hand calculation"
    ),
    a_sidecar_on_the_other_side_is_its_mirror_image => (
        "`sidecar` with all its files mirrored: straight on, in corners and at rest all signals mirrored",
        "symmetry of space",
        "1e-8 of each signal: both stop at a scaled residual of 1e-10"
    ),
];

/// Moment about the vertical axis through the base point of a force (x, y) at a point (x, y).
fn yaw((x, y): (f64, f64), (fx, fy): (f64, f64)) -> f64 {
    x * fy - y * fx
}

#[test]
fn the_sidecar_pulls_to_its_side() {
    let mut agreement = Agreement::on("sidecar");
    let vehicle = Vehicle::bundled("sidecar");
    let rest = vehicle.state(&Default::default());
    // masses as written, kg, and their places ahead and to the left of the base point, m
    let parts = [(232.0, 0.62, 0.0), (189.0, 0.48, -0.80), (16.0, 1.215, 0.0), (6.0, 1.32, 0.0), (14.0, 1.5, 0.0)];
    let parts = parts.into_iter().chain([(12.0, 0.16, 0.0), (15.0, 0.0, 0.0), (7.0, 0.45, -1.06), (14.0, 0.28, -1.14)]);
    let [weight, ahead, aside] = parts.fold([0.0; 3], |[w, x, y], (m, px, py)| [w + 9.81 * m, x + 9.81 * m * px, y + 9.81 * m * py]);
    let side = -aside / 1.14;
    let front = (ahead - 0.28 * side) / 1.5;
    let digits = absolute(1e-3).because("roll and pitch below 1e-7 at rest");
    for (tire, load) in [("front_tire", front), ("side_tire", side), ("rear_tire", weight - front - side)] {
        agreement.near(&format!("static load of {tire}"), rest.get(&format!("{tire}.normal_force")), load, &digits);
    }

    let state = vehicle.state(&running(&[20.0]));
    let get = |name: &str| state.get(name);
    // horizontal forces on the vehicle: three tires, and air along the relative wind at two points
    let mut moment = 0.0;
    // forces are along and across the headings of the wheels: steered (Cossalter: tan Δ = tan δ cos ε), straight, toed in by 19 mm over the wheelbase
    let steered = (get("steer.angle").tan() * (27f64.to_radians() - get("chassis.pitch")).cos()).atan();
    for (tire, heading) in [("front_tire", steered), ("rear_tire", 0.0), ("side_tire", 0.019 / 1.5)] {
        let of = |quantity: &str| get(&format!("{tire}.{quantity}"));
        let (sin, cos) = f64::sin_cos(heading);
        let (along, across) = (of("longitudinal_force"), of("lateral_force"));
        let force = (along * cos - across * sin, along * sin + across * cos);
        moment += yaw((of("contact_x"), of("contact_y")), force) + of("aligning_moment");
    }
    let (forward, lateral, roll) = (20.0, get("chassis.lateral_speed"), get("chassis.roll"));
    for (element, at) in [("aero", [0.65, 0.0, 0.75]), ("sidecar_aero", [0.70, -0.95, 0.55])] {
        let drag = get(&format!("{element}.drag")) / f64::hypot(forward, lateral);
        moment += yaw((at[0], at[1] - roll * at[2]), (-drag * forward, -drag * lateral));
    }
    agreement.near(
        "moments about the vertical axis, N m",
        moment,
        0.0,
        &absolute(0.1).because("what roll adds to the heading of the front wheel"),
    );
    let pull = yaw((0.0, -1.14), (get("side_tire.longitudinal_force"), 0.0)) + yaw((0.0, -0.95), (-get("sidecar_aero.drag"), 0.0));
    agreement.holds(&format!("drag of the sidecar turns to the right: {pull} N m"), pull < -100.0);
    agreement.holds("the front tire pushes to the left", get("front_tire.lateral_force") > 50.0);

    // moment of the front tire about the steering axis, from its point on the road
    let (caster, trail) = (27f64.to_radians() - get("chassis.pitch"), get("trail"));
    let axis = [-caster.sin(), -caster.cos() * roll, caster.cos()];
    let force = ["longitudinal_force", "lateral_force", "normal_force"].map(|f| get(&format!("front_tire.{f}")));
    let offset = get("front_tire.contact_y");
    // arm (−trail, offset, 0) from the axis to the contact
    let arm = [offset * force[2], trail * force[2], -trail * force[1] - offset * force[0]];
    let turned: f64 = arm.iter().zip(axis).map(|(m, s)| m * s).sum::<f64>() + get("front_tire.aligning_moment") * axis[2];
    agreement.near("steering torque", get("steer.torque"), -turned, &relative(0.02).because("weight of the front assembly is left out"));

    let along: Vec<State> = vehicle.steady(&running(&[5.0, 10.0, 15.0, 20.0, 25.0]), "kinsol");
    for signal in ["steer.angle", "steer.torque"] {
        let values: Vec<f64> = along.iter().map(|state| state.get(signal)).collect();
        agreement.holds(&format!("{signal} to the left, growing: {values:?}"), values[0] > 0.0 && values.windows(2).all(|v| v[1] > v[0]));
    }
    let clean = Vehicle::with("sidecar", &[("sidecar_aero.drag_area", "0")]).state(&running(&[20.0]));
    let (with, without) = (get("steer.torque"), clean.get("steer.torque"));
    agreement.holds(&format!("without drag of the sidecar {without} N m, with it {with} N m"), without.abs() < 0.1 * with);
    agreement.assert();
}

/// The text with left and right exchanged: second entries of positions, first and third of angles. Joint axes are of rotations, whose y components stay.
fn mirrored(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let line = match (line.contains("<origin"), line.contains("at: [")) {
            (true, _) => numbers(&numbers(line, "xyz=\"", "\"", [1.0, -1.0, 1.0]), "rpy=\"", "\"", [-1.0, 1.0, -1.0]),
            (_, true) => numbers(line, "at: [", "]", [1.0, -1.0, 1.0]),
            _ => line.to_owned(),
        };
        out.push_str(&line);
        out.push('\n');
    }
    out
}

/// A line whose three numbers between two marks are multiplied.
fn numbers(line: &str, from: &str, to: &str, by: [f64; 3]) -> String {
    let Some((before, rest)) = line.split_once(from) else { return line.to_owned() };
    let Some((inside, after)) = rest.split_once(to) else { return line.to_owned() };
    let separator = if inside.contains(',') { ", " } else { " " };
    let entries: Vec<&str> = inside.split([',', ' ']).filter(|e| !e.is_empty()).collect();
    let changed = entries.iter().zip(by).map(|(entry, by)| match (by < 0.0, entry.strip_prefix('-')) {
        (false, _) => (*entry).to_owned(),
        (true, Some(positive)) => positive.to_owned(),
        (true, None) => format!("-{entry}"),
    });
    let changed: Vec<String> = changed.collect();
    format!("{before}{from}{}{to}{}", changed.join(separator), numbers(after, from, to, by))
}

/// Whether a signal changes its sign in a mirror.
fn flips(name: &str) -> bool {
    const OWNERS: [&str; 2] = ["steer.angle", "steer.torque"];
    const PARTS: [&str; 16] = [
        "roll",
        "lateral",
        "yaw",
        "slip_angle",
        "camber",
        "aligning_moment",
        "overturning_moment",
        "contact_y",
        "curvature",
        "velocity_y",
        "acceleration_y",
        "chassis.y",
        "steer.rate",
        "steering_damper",
        "steering_stop",
        "force_y",
    ];
    const SAME: [&str; 1] = ["rolling_moment"];
    OWNERS.contains(&name) || (PARTS.iter().any(|part| name.contains(part)) && !SAME.iter().any(|part| name.contains(part)))
}

#[test]
fn a_sidecar_on_the_other_side_is_its_mirror_image() {
    let (right, left) = (Vehicle::bundled("sidecar"), Vehicle::rewritten("sidecar", mirrored));
    let mut agreement = Agreement::on("mirrored sidecar");
    let both = absolute(1e-8).or_relative(1e-8).because("both stop at a scaled residual of 1e-10");
    let side = |sign: f64| [Default::default(), running(&[20.0]), turning(&[15.0], Turn::LateralAcceleration, &[2.0 * sign])];
    for (a, b) in side(1.0).iter().zip(&side(-1.0)) {
        let (a, b) = (right.state(a), left.state(b));
        for signal in a.signals.iter().map(|s| s.name.as_str()) {
            let sign = if flips(signal) { -1.0 } else { 1.0 };
            agreement.near(&format!("{:?}: {signal}", a.point.given), b.get(signal), sign * a.get(signal), &both);
        }
    }
    agreement.assert();
}
