//! Wobble of the GSX-R1000 under brakes and power.
//!
//! Source of the statement: D. J. N. Limebeer, R. S. Sharp, S. Evangelou, “The stability of motorcycles under acceleration and braking”,
//! Proc. Inst. Mech. Eng. C 215 (2001) 1095–1109: braking and descending take damping from the wobble mode, accelerating and climbing
//! add to it. Frozen time, theory manual 8.5.

use fastbike::output::modes::{ModesAlong, NamedMode};
use fastbike::plan::Request;
use fastbike::small_motions::{Shapes, SmallMotions};
use fastbike::steady;
use validation::agreement::Agreement;
use validation::evidence::Row;
use validation::vehicle::{Vehicle, accelerating, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    brakes_take_damping_from_the_wobble_and_power_adds_to_it => (
        "`gsxr1000`, 15 to 60 m/s: wobble is damped less at −5 m/s² and more at +3 m/s² than at constant speed, in real part and in damping ratio",
        "Limebeer, Sharp, Evangelou (2001), the statement",
        "order of the numbers: the source has another machine"
    ),
];

const SPEEDS: [f64; 4] = [15.0, 30.0, 45.0, 60.0];

fn modes(request: &Request) -> ModesAlong {
    let system = Vehicle::bundled("gsxr1000").system;
    let steady = steady::run(request, &system, "kinsol", "modes").unwrap_or_else(|failure| panic!("{failure}"));
    let small = SmallMotions { request, system: &system, backend: "kinsol", residual_tolerance: 1e-6 };
    small.along(&steady, Shapes::LeftOut).unwrap_or_else(|failure| panic!("{failure}"))
}

fn wobble(modes: &ModesAlong, point: usize) -> &NamedMode {
    let point = modes.points[point].as_ref().unwrap_or_else(|because| panic!("{because}"));
    point.modes.iter().find(|m| m.name == "wobble" && m.value.im > 0.0).expect("a wobble")
}

#[test]
fn brakes_take_damping_from_the_wobble_and_power_adds_to_it() {
    let [braking, steady, driving] =
        [-5.0, 0.0, 3.0].map(|a| modes(&Request { front_brake_share: 0.7, ..accelerating(running(&SPEEDS), a) }));
    let mut agreement = Agreement::on("gsxr1000: wobble under brakes and power");
    for (k, speed) in SPEEDS.iter().enumerate() {
        let [b, s, d] = [&braking, &steady, &driving].map(|modes| wobble(modes, k));
        agreement.holds(&format!("{speed} m/s: real parts"), b.value.re > s.value.re && s.value.re > d.value.re);
        agreement.holds(&format!("{speed} m/s: damping ratios"), b.damping_ratio < s.damping_ratio && s.damping_ratio < d.damping_ratio);
    }
    agreement.assert();
}
