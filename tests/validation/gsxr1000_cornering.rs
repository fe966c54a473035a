//! GSX-R1000: steady corners and braking of an independent program (Python on Pinocchio, written from the equations).

use fastbike::plan::Request;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::reference;
use validation::vehicle::{Vehicle, accelerating, leaning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    corners_and_braking_are_met => (
        "`gsxr1000`: seven steady states (straight, corners of 20, 35, 45 and −35 degrees at 15 to 50 m/s, braking straight and in a corner), 52 signals each",
        "own program in Python on Pinocchio 4.1.0, `reference/gsxr1000_cornering.json`",
        "1e-9 relative: the reference states 1e-12 for itself"
    ),
];

#[test]
fn corners_and_braking_are_met() {
    let vehicle = Vehicle::bundled("gsxr1000");
    let file = reference::json("gsxr1000_cornering.json");
    let mut agreement = Agreement::on("gsxr1000: steady states of an independent program");
    let tolerance = absolute(1e-12).or_relative(1e-9).because("the reference agrees with itself to 1e-12; zeros are compared absolutely");
    for case in file["cases"].as_array().expect("cases") {
        let (name, given) = (case["name"].as_str().expect("a name"), &case["given"]);
        let number = |key: &str| given[key].as_f64();
        let turn = leaning(&[number("speed").expect("a speed")], &[number("lean_deg").expect("a lean").to_radians()]);
        let request = match (number("acceleration"), number("front_brake_share")) {
            (Some(a), Some(share)) => Request { front_brake_share: share, ..accelerating(turn, a) },
            _ => turn,
        };
        let state = vehicle.state(&request);
        for (signal, value) in case["signals"].as_object().expect("signals") {
            let expected = value.as_f64().expect("a number");
            agreement.near(&format!("{name}: {signal}"), state.get(signal), expected, &tolerance);
        }
    }
    agreement.assert();
}
