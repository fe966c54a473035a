//! Shafts and arms: how springs answer to thrust and to braking.

use fastbike::plan::Request;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{Vehicle, accelerating, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    a_duolever_takes_out_half_of_the_dive => (
        "`duolever` braking in front with 4 m/s²: change of the force of the strut at the wheel",
        "two-force members by hand: force at the contact against the intersection of both arms",
        "10 % of the change of load: levers change over the travel"
    ),
    a_shaft_lifts_a_short_arm_and_a_torque_rod_tames_it => (
        "`duolever` (housing on the arm) and `telelever` (torque rod): change of the rear spring force while accelerating with 2 m/s²",
        "moments by hand: forces at the contact about the pivot of the arm, about the intersection of arm and rod",
        "4 N m of 160 N m and 6 % of the change of load: inertia of arm and wheel"
    ),
];

/// Intersection of two lines through points (x, z).
fn meet((p, q): ([f64; 2], [f64; 2]), (r, s): ([f64; 2], [f64; 2])) -> [f64; 2] {
    let (d, e) = ([q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]);
    let t = ((r[0] - p[0]) * e[1] - (r[1] - p[1]) * e[0]) / (d[0] * e[1] - d[1] * e[0]);
    [p[0] + t * d[0], p[1] + t * d[1]]
}

/// Virtual work of a wheel that swings about a point (x, z) from a contact at (x, 0): moment of (force forward, load) per moment of the load.
fn about(center: [f64; 2], contact: f64, force: f64, load: f64) -> f64 {
    load - force * center[1] / (center[0] - contact)
}

/// Distance of the line of a strut from a pivot, m; the bottom turns about the pivot by an angle, positive where a wheel behind it moves up.
fn lever(pivot: [f64; 2], bottom: [f64; 2], top: [f64; 2], angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let r = [bottom[0] - pivot[0], bottom[1] - pivot[1]];
    let r = [r[0] * cos + r[1] * sin, r[1] * cos - r[0] * sin];
    let d = [pivot[0] + r[0] - top[0], pivot[1] + r[1] - top[1]];
    (r[0] * d[1] - r[1] * d[0]).abs() / f64::hypot(d[0], d[1])
}

#[test]
fn a_shaft_lifts_a_short_arm_and_a_torque_rod_tames_it() {
    let mut agreement = Agreement::on("shafts");
    let states = |name: &str| {
        let vehicle = Vehicle::bundled(name);
        [0.0, 2.0].map(|a| vehicle.state(&accelerating(running(&[10.0]), a)))
    };
    // housing on the arm: moments of arm and wheel about the pivot, where the arm stands
    let (pivot, bottom, top) = ([0.45, 0.40], [0.10, 0.40], [0.20, 0.74]);
    let moments = states("duolever").map(|state| {
        let get = |name: &str| state.get(name);
        let (heave, pitch) = (get("chassis.heave"), get("chassis.pitch"));
        let place = [pivot[0] * pitch.cos() + pivot[1] * pitch.sin(), heave + pivot[1] * pitch.cos() - pivot[0] * pitch.sin()];
        let spring = get("rear_strut.force") * lever(pivot, bottom, top, get("swingarm.angle"));
        let arm = place[0] - get("rear_tire.contact_x");
        (spring, arm * get("rear_tire.normal_force") - place[1] * get("rear_tire.longitudinal_force"), get("rear_tire.normal_force"))
    });
    let lifted = (moments[1].0 - moments[0].0, moments[1].1 - moments[0].1);
    println!("duolever: moment of the spring {:.2} N m, by hand {:.2} N m", lifted.0, lifted.1);
    let inertia =
        absolute(4.0).because("inertia of arm and wheel, 14 kg and 17 kg within a decimeter of the height of the pivot, and of the spin");
    agreement.near("duolever: moment of the spring, N m", lifted.0, lifted.1, &inertia);
    agreement.holds("duolever: the rear rises", lifted.0 < 0.0);
    // torque rod: arm and rod meet near the line from the contact that the load transfer asks for, so the spring hardly moves
    let center = meet(([0.44, 0.40], [0.045, 0.325]), ([0.40, 0.305], [0.03, 0.205]));
    agreement.holds(&format!("telelever: the effective arm {center:?} is three times as long"), center[0] > 3.0 * 0.44);
    let [level, pushed] = states("telelever");
    let change = |signal: &str| pushed.get(signal) - level.get(signal);
    let expected = about(center, 0.0, change("rear_tire.longitudinal_force"), change("rear_tire.normal_force"));
    let rest = Vehicle::bundled("telelever").state(&Default::default());
    let ratio = rest.get("rear_strut.force") / (rest.get("rear_tire.normal_force") - 9.81 * (14.0 + 9.0 + 8.0 * 0.22 / 0.44));
    let found = change("rear_strut.force") / ratio;
    println!("telelever: spring {found:.1} N at the wheel of {:.1} N more load, by hand {expected:.1} N", change("rear_tire.normal_force"));
    let load = absolute(0.06 * change("rear_tire.normal_force")).because("inertia of the wheel and of its spin is left out");
    agreement.near("telelever: spring at the wheel, N", found, expected, &load);
    agreement.assert();
}

#[test]
fn a_duolever_takes_out_half_of_the_dive() {
    let mut agreement = Agreement::on("duolever: brakes");
    let vehicle = Vehicle::bundled("duolever");
    let center = meet(([1.02, 0.665], upper_ball(0.66)), ([0.97, 0.50], upper_ball(0.47)));
    agreement.holds(&format!("the arms converge behind, above the road: {center:?}"), center[0] < 0.0 && center[1] > 0.3);
    let braking = Request { front_brake_share: 1.0, ..accelerating(running(&[20.0]), -4.0) };
    let [level, braked] = [vehicle.state(&running(&[20.0])), vehicle.state(&braking)];
    let change = |signal: &str| braked.get(signal) - level.get(signal);
    let load = change("front_tire.normal_force");
    let expected = about(center, 1.585, change("front_tire.longitudinal_force"), load);
    let rest = vehicle.state(&Default::default());
    let ratio = rest.get("front_strut.force") / (rest.get("front_tire.normal_force") - 9.81 * (8.5 + 13.0 + 0.5 * (1.8 + 2.4)));
    let found = change("front_strut.force") / ratio;
    println!("duolever: front strut {found:.1} N at the wheel of {load:.1} N more load, by hand {expected:.1} N");
    let levers = absolute(0.1 * load).because("levers change over the travel, and arms weigh and hold back");
    agreement.near("spring at the wheel, N", found, expected, &levers);
    agreement.holds("half of the dive is left", (0.3..0.7).contains(&(found / load)));
    agreement.assert();
}

/// Point of the Duolever's steering axis at a height: 29.6° through 1.585 + 0.104 m on the road.
fn upper_ball(height: f64) -> [f64; 2] {
    [1.585 + 0.104 - height * 29.6f64.to_radians().tan(), height]
}
