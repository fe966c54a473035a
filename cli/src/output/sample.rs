//! Reports for the tests of the writers.

use super::report::{Given, Point, Report};
use problem::{Effort, Ending, Signal};

/// A number that needs all its digits.
pub(super) const YAW_RATE: f64 = -0.223_144_567_891_234_5;

fn effort(iterations: usize) -> Effort {
    Effort { iterations, ..Effort::default() }
}

fn given() -> Vec<Given> {
    vec![Given::new("speed", "m/s"), Given::new("lean", "rad")]
}

/// One point that was reached.
pub(super) fn corner() -> Report {
    let signals = vec![
        Signal::new("chassis.roll", "rad", "roll angle, positive to the right"),
        Signal::new("chassis.yaw_rate", "rad/s", "yaw rate, positive to the left"),
        Signal::new("steer.torque", "N m", "torque on the handlebar, positive to the left"),
        Signal::new("rear_tire.normal_force", "N", "load, positive up"),
        Signal::new("rear_tire.slip_angle", "rad", "slip angle, positive when it pushes to the left"),
        Signal::new("rear_tire.friction_use", "-", "share of the available friction"),
        Signal::new("curvature", "1/m", "curvature of the path, positive to the left"),
    ];
    let values = vec![0.6, YAW_RATE, -7.125, 1623.4567, 3e-17, 0.71, -0.011_157];
    let point = Point { given: vec![20.0, 0.6], ending: Ending::Reached, effort: effort(4), residual: 1e-12, values, rates: vec![] };
    Report { points: vec![point], ..Report::new("trim", "ref11", given(), signals) }
}

/// Three points with three endings.
pub(super) fn sweep() -> Report {
    let signals = vec![
        Signal::new("chassis.roll", "rad", "roll angle, positive to the right"),
        Signal::new("steer.torque", "N m", "torque on the handlebar, positive to the left"),
        Signal::new("rear_tire.normal_force", "N", "load, positive up"),
    ];
    let limit = Ending::Limit { name: "tire_saturated".into(), signal: "rear_tire.friction_use".into(), value: 1.02, threshold: 1.0 };
    let lost = Ending::NotConverged { because: "`steer.angle` and `chassis.roll` move together".into() };
    let point = |speed, ending, iterations, residual, values| Point {
        given: vec![speed, 0.6],
        ending,
        effort: effort(iterations),
        residual,
        values,
        rates: vec![],
    };
    let points = vec![
        point(20.0, Ending::Reached, 4, 1e-12, vec![0.6, -7.125, 1623.4567]),
        point(30.0, limit, 17, 0.003, vec![0.55, 12.0, f64::NAN]),
        point(40.0, lost, 60, f64::NAN, vec![]),
    ];
    Report { points, warnings: vec!["front tire outside its fit".into()], ..Report::new("trim", "ref11", given(), signals) }
}

/// No point at all.
pub(super) fn nothing() -> Report {
    Report::new("map", "ref11", given(), Vec::new())
}
