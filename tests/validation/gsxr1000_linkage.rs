//! The GSX-R1000 with its rear linkage as a loop: joint reactions of a public code, and the same machine with the geometry in an element.
//!
//! Forces of the source act on the body that its model file names first: the rider, the front upper part (also at the slider), the lower part and
//! the arm at their axles, the arm at its pivot, the rocker, the frame at its springs, the arm at the pull rod.

use fastbike::plan::Turn;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::instant::Instant;
use validation::reference::Table;
use validation::vehicle::{Vehicle, running, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    all_static_reactions_are_met => (
        "`tests/reference/models/gsxr1000_eom`: forces and moments of all joints, springs, the pull rod and the tires in the design pose; the massless rocker in a loop",
        "EoM (B. P. Minaker), `preload.out` of 2019-01-18; `tests/reference/gsxr1000_static.csv`",
        "half of the fifth decimal: the source prints a sixth, which is always 0"
    ),
    rocker_and_shock_follow_the_arm => (
        "`gsxr1000_linkage`: angle of the rocker, length of the shock and its rate over the angle of the arm",
        "four-bar closed numerically, `tests/reference/gsxr1000_rocker.csv`",
        "1e-13: double precision; rates 1e-12 m/rad"
    ),
    the_loop_and_the_element_are_one_machine => (
        "`gsxr1000_linkage` and `gsxr1000`: steady states at rest, straight and in corners",
        "the same linkage as geometry of one element",
        "1e-8 of each signal: both stop at a scaled residual of 1e-10"
    ),
];

#[test]
fn all_static_reactions_are_met() {
    let mut bike = Instant::of("tests/reference/models/gsxr1000_eom/gsxr1000_eom.yaml");
    let table = Table::read("gsxr1000_static.csv");
    let mut agreement = Agreement::on("gsxr1000 as in EoM: static reactions");
    let still = absolute(1e-9).because("preloads to thirteen digits hold the design pose; parts of the accelerations are up to 1e3 m/s²");
    for name in bike.names().iter().filter(|n| ["rate", "speed"].iter().any(|end| n.ends_with(end))) {
        agreement.near(name, bike.rate(name), 0.0, &still);
    }
    let (mut found, mut joint) = (Vec::new(), |item: &'static str, joint: &str, sign: f64| {
        let (f, n) = bike.reaction(joint);
        [(item, "force", f * sign), (item, "moment", n * sign)]
    });
    found.extend(joint("Rear axle", "rear_wheel", -1.0));
    found.extend(joint("Swing arm pivot", "swingarm", 1.0));
    found.extend(joint("Bell crank pivot", "rocker", 1.0));
    found.extend(joint("Seat", "rider_lean", 1.0));
    found.extend(joint("Steering head", "steer", 1.0));
    found.extend(joint("Front axle", "front_wheel", -1.0));
    found.extend(joint("Fork slider", "fork", -1.0));
    let z = |force: f64| mbody::spatial::Vec3::new(0.0, 0.0, force);
    found.push(("Front tire vertical", "force", z(bike.get("front_contact.normal_force"))));
    found.push(("Rear tire vertical", "force", z(bike.get("rear_contact.normal_force"))));
    // springs push the frame along the line between their ends, from the far end to the frame
    let (p4, p6) = ([1.342, 0.426], [1.410, 0.282]);
    for (item, element) in [("Right front spring", "right_front_spring"), ("Left front spring", "left_front_spring")] {
        found.push((item, "force", along(p6, p4) * bike.output(&format!("{element}.force"))));
    }
    found.push(("Rear spring", "force", along([0.4443, 0.1782], [0.487, 0.4888]) * bike.output("rear_spring.force")));
    // the rod is compressed: it pushes the arm away from the rocker
    found.push(("Pull rod (dogbone)", "force", along([0.4946, 0.1522], [0.3722, 0.2748]) * bike.get("pull_rod.force")));

    let printed = absolute(0.5e-5).because("half of the fifth decimal");
    for (item, kind, value) in &found {
        // rows of zeros are not printed
        let row = (0..table.len()).find(|&row| table.cell(row, "item") == *item && table.cell(row, "kind") == *kind);
        let expected = row.map_or([0.0; 3], |row| ["x", "y", "z"].map(|axis| table.number(row, axis)));
        agreement.all_near(&format!("{item} {kind}"), &[value.x, value.y, value.z], &expected, &printed);
    }
    let compared = |row: usize| found.iter().any(|(item, kind, _)| table.cell(row, "item") == *item && table.cell(row, "kind") == *kind);
    agreement.holds("every printed row is compared", (0..table.len()).all(compared));
    agreement.assert();
}

/// Unit vector from a point (x, z) to another.
fn along(from: [f64; 2], to: [f64; 2]) -> mbody::spatial::Vec3<f64> {
    let d = mbody::spatial::Vec3::new(to[0] - from[0], 0.0, to[1] - from[1]);
    d * (1.0 / d.norm())
}

#[test]
fn rocker_and_shock_follow_the_arm() {
    let table = Table::read("gsxr1000_rocker.csv");
    let mut bike = Instant::of("gsxr1000_linkage");
    let mut agreement = Agreement::on("gsxr1000_linkage: rocker and shock");
    let double = absolute(1e-13).because("double precision");
    let rates = absolute(1e-12).because("double precision");
    for row in 0..table.len() {
        let angle = table.number(row, "arm_angle_rad");
        bike.put(&[("swingarm.angle", angle), ("swingarm.rate", 1.0), ("rocker.angle", 3.3 * angle)][..2]);
        agreement.near(&format!("rocker at {angle}"), bike.get("rocker.angle"), table.number(row, "rocker_angle_rad"), &double);
        agreement.near(&format!("shock at {angle}"), bike.output("rear_shock.length"), table.number(row, "shock_length_m"), &double);
        let rate = shock_rate(&mut bike);
        agreement.near(&format!("rate at {angle}"), rate, table.number(row, "shock_length_per_arm_angle_m_per_rad"), &rates);
    }
    agreement.assert();
}

/// Rate of the shock's length, from the velocity of its end on the rocker.
fn shock_rate(bike: &mut Instant) -> f64 {
    let X = bike.pose("rocker_link");
    let chassis = bike.pose("chassis");
    let end = mbody::spatial::Vec3::new(-0.0947, 0.0, -0.0096);
    let d = chassis.R.inverse_times(X.point(end) - chassis.point(mbody::spatial::Vec3::new(0.487, 0.0, 0.4888)));
    let arm = chassis.R.inverse_times(X.R * end);
    let turning = mbody::spatial::Vec3::new(0.0, bike.get("rocker.rate"), 0.0);
    turning.cross(arm).dot(d) / d.norm()
}

#[test]
fn the_loop_and_the_element_are_one_machine() {
    let (with_loop, with_element) = (Vehicle::bundled("gsxr1000_linkage"), Vehicle::bundled("gsxr1000"));
    let lean = |degrees: f64| degrees.to_radians();
    let requests = [Default::default(), running(&[20.0, 60.0]), turning(&[15.0, 35.0], Turn::Lean, &[lean(20.0), lean(-40.0), lean(45.0)])];
    let mut agreement = Agreement::on("gsxr1000: linkage as a loop and as an element");
    let mut compared = 0;
    for request in &requests {
        let pairs = with_loop.steady(request, "kinsol").into_iter().zip(with_element.steady(request, "kinsol"));
        for (a, b) in pairs {
            for signal in b.signals.iter().map(|s| s.name.as_str()).filter(|name| a.signals.iter().any(|s| s.name == *name)) {
                let tolerance = absolute(1e-8).or_relative(1e-8).because("both stop at a scaled residual of 1e-10");
                agreement.near(&format!("{:?}: {signal}", b.point.given), a.get(signal), b.get(signal), &tolerance);
                compared += 1;
            }
        }
    }
    agreement.holds("many signals are in both", compared > 500);
    agreement.assert();
}
