//! REF-11, a synthetic sport bike: steady states of an independent program (the golden numbers of FastBike's theory manual, B.3).
//!
//! The driving torques of the second and third state are printed with nine decimals, but are good to 1e-8 N m only: a second
//! independent prototype gives 82.594535195 and −187.188722746 N m.

use analyses::eigen;
use fastbike::plan::{Request, Turn};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, accelerating, given, leaning, turning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    three_states_are_met => (
        "`ref11`: straight at 30 m/s, leaning by 0.6 rad, braking with 3 m/s² in a lean of 0.4 rad: pose, speeds, torques, carcass states",
        "independent prototype, theory manual B.3",
        "half of the ninth decimal; the torque of two states 1e-8 N m, as a second prototype differs there"
    ),
    loads_side_forces_and_slips_are_met => (
        "`ref11`: loads, side forces, slip angles and cambers, straight and leaning",
        "independent prototype, theory manual B.3",
        "half a unit of the last printed digit"
    ),
    lateral_acceleration_over_speed_is_met => (
        "`ref11`: lean, steering torque and steering angle at 5 m/s² to the right, 10 to 50 m/s",
        "independent prototype, theory manual B.3",
        "half a unit of the last printed digit"
    ),
    torque_over_lean_is_met => (
        "`ref11`: steering torque at 30 m/s, lean 0.3, 0.6, 0.9 rad; it changes its sign",
        "independent prototype, theory manual B.3",
        "half a unit of the last printed digit"
    ),
    eigenvalues_are_met => (
        "`ref11`: all 19 eigenvalues straight at 30 m/s, leaning by 0.6 rad, and braking with 3 m/s² in a lean of 0.4 rad (frozen)",
        "independent prototype, theory manual B.3",
        "half a unit of the last printed digit"
    ),
];

/// Signals in the order of the printed states; the torque stands between the steering torque and the yaw rate.
const SIGNALS: [&str; 12] = [
    "chassis.heave",
    "chassis.pitch",
    "steer.angle",
    "fork.travel",
    "swingarm.angle",
    "chassis.lateral_speed",
    "front_wheel.spin_rate",
    "rear_wheel.spin_rate",
    "steer.torque",
    "chassis.yaw_rate",
    "front_tire.carcass_lateral",
    "rear_tire.carcass_lateral",
];

/// A printed state: the signals above, and the total torque of engine or brakes.
struct Printed {
    name: &'static str,
    signals: [&'static str; 12],
    torque: &'static str,
}

const STRAIGHT: Printed = Printed {
    name: "straight",
    signals: ["-0.023580071", "-0.00276441", "0", "0.012091311", "0.0263603", "0", "100.920879233", "95.261498516", "0", "0", "0", "0"],
    torque: "67.88178608",
};
const LEANING: Printed = Printed {
    name: "leaning",
    signals: [
        "-0.01045607",
        "0.003712766",
        "-0.006576273",
        "0.021613691",
        "0.039524063",
        "0.21456123",
        "104.685578071",
        "100.727284825",
        "-0.813099332",
        "-0.184192803",
        "0.000961399",
        "0.000880007",
    ],
    torque: "82.594535197",
};
const BRAKING: Printed = Printed {
    name: "braking in a lean",
    signals: [
        "-0.005253957",
        "0.030891996",
        "-0.005390532",
        "0.046248122",
        "0.012042332",
        "0.030853191",
        "101.266772598",
        "96.187367444",
        "11.581317263",
        "-0.116742154",
        "0.000707639",
        "0.000393667",
    ],
    torque: "-187.188722744",
};

/// The manual brakes with four fifths in front, and with the rest through the chain.
fn braking() -> Request {
    let by_brakes = Request { front_brake_share: 1.0, ..accelerating(leaning(&[30.0], &[0.4]), -3.0) };
    given(by_brakes, "drive.torque", "-0.25 * front_brake.torque")
}

/// Nine decimals, trailing zeros not printed.
fn compare(agreement: &mut Agreement, state: &State, printed: &Printed) {
    let half_digit = absolute(0.5e-9).because("nine decimals, trailing zeros not printed");
    for (signal, text) in SIGNALS.into_iter().zip(printed.signals) {
        let expected = text.parse().expect("a number");
        agreement.near(&format!("{}: {signal}", printed.name), state.get(signal), expected, &half_digit);
    }
}

#[test]
fn three_states_are_met() {
    let vehicle = Vehicle::bundled("ref11");
    let mut agreement = Agreement::on("ref11: three printed states");
    let as_second_prototype = absolute(1e-8).because("a second prototype differs by 2e-9 N m");
    for (printed, request) in [(&STRAIGHT, leaning(&[30.0], &[0.0])), (&LEANING, leaning(&[30.0], &[0.6])), (&BRAKING, braking())] {
        let state = vehicle.state(&request);
        compare(&mut agreement, &state, printed);
        let torque = state.get("drive.torque") - state.get("front_brake.torque") - state.get("rear_brake.torque");
        agreement.near(&format!("{}: torque", printed.name), torque, printed.torque.parse().expect("a number"), &as_second_prototype);
    }
    agreement.assert();
}

#[test]
fn loads_side_forces_and_slips_are_met() {
    let vehicle = Vehicle::bundled("ref11");
    let mut agreement = Agreement::on("ref11: tires, straight and leaning");
    let [straight, leaning]: [State; 2] = vehicle.steady(&leaning(&[30.0], &[0.0, 0.6]), "kinsol").try_into().expect("two states");
    agreement.printed("front load, straight", straight.get("front_tire.normal_force"), "1300.056");
    agreement.printed("rear load, straight", straight.get("rear_tire.normal_force"), "1495.794");
    for (quantity, front, rear) in [
        ("normal_force", "1321.954", "1473.896"),
        ("lateral_force", "-722.911", "-848.410"),
        ("slip_angle", "-0.00575", "-0.00716"),
        ("camber", "0.60269", "0.60000"),
    ] {
        for (tire, text) in [("front_tire", front), ("rear_tire", rear)] {
            let signal = format!("{tire}.{quantity}");
            agreement.printed(&signal, leaning.get(&signal), text);
        }
    }
    agreement.assert();
}

#[test]
fn lateral_acceleration_over_speed_is_met() {
    const PRINTED: [(f64, &str, &str, &str); 6] = [
        (10.0, "0.540835", "2.53754", "-0.063847"),
        (15.0, "0.547566", "0.92613", "-0.027923"),
        (20.0, "0.550113", "0.30623", "-0.015315"),
        (30.0, "0.552207", "-0.09947", "-0.006259"),
        (40.0, "0.553282", "-0.15203", "-0.003004"),
        (50.0, "0.554144", "-0.06127", "-0.001372"),
    ];
    let vehicle = Vehicle::bundled("ref11");
    let mut agreement = Agreement::on("ref11: 5 m/s² to the right");
    let speeds = PRINTED.map(|p| p.0);
    let states = vehicle.steady(&turning(&speeds, Turn::LateralAcceleration, &[-5.0]), "kinsol");
    for (state, (speed, lean, torque, angle)) in states.iter().zip(PRINTED) {
        agreement.printed(&format!("lean at {speed} m/s"), state.get("chassis.roll"), lean);
        agreement.printed(&format!("steering torque at {speed} m/s"), state.get("steer.torque"), torque);
        agreement.printed(&format!("steering angle at {speed} m/s"), state.get("steer.angle"), angle);
    }
    agreement.assert();
}

#[test]
fn torque_over_lean_is_met() {
    let vehicle = Vehicle::bundled("ref11");
    let mut agreement = Agreement::on("ref11: steering torque over lean at 30 m/s");
    let states = vehicle.steady(&leaning(&[30.0], &[0.3, 0.6, 0.9]), "kinsol");
    for (state, text) in states.iter().zip(["1.3846", "-0.8131", "-10.5587"]) {
        agreement.printed(&format!("lean {} rad", state.point.given[1]), state.get("steer.torque"), text);
    }
    agreement.assert();
}

/// Six oscillations, real and imaginary part, then seven real eigenvalues, as they are printed.
type Eigenvalues = ([(&'static str, &'static str); 6], [&'static str; 7]);

const STRAIGHT_EIGENVALUES: Eigenvalues = (
    [
        ("-48.185356", "80.844355"),
        ("-34.513775", "71.030147"),
        ("-4.160852", "49.932087"),
        ("-3.580346", "18.128769"),
        ("-13.512232", "16.204459"),
        ("-4.775040", "11.887325"),
    ],
    ["-210.275555", "-185.038335", "-166.870568", "-132.921834", "-23.556475", "-0.125250", "-0.042347"],
);
const LEANING_EIGENVALUES: Eigenvalues = (
    [
        ("-47.572369", "77.782536"),
        ("-33.099673", "69.682050"),
        ("-3.299470", "48.559341"),
        ("-14.313623", "17.076689"),
        ("-2.919523", "16.456279"),
        ("-5.080170", "12.210240"),
    ],
    ["-224.167360", "-209.938420", "-160.592617", "-116.771600", "-23.065283", "-0.041254", "0.292409"],
);
const BRAKING_EIGENVALUES: Eigenvalues = (
    [
        ("-48.489841", "80.490250"),
        ("-36.925380", "70.460312"),
        ("-3.492385", "53.047965"),
        ("-13.600311", "16.670219"),
        ("-2.283695", "15.846767"),
        ("-4.716942", "12.140051"),
    ],
    ["-253.118487", "-181.419566", "-174.480153", "-96.036037", "-23.009448", "-0.360755", "-0.042342"],
);

#[test]
fn eigenvalues_are_met() {
    let vehicle = Vehicle::bundled("ref11");
    let mut agreement = Agreement::on("ref11: eigenvalues");
    for (name, request, (oscillations, reals)) in [
        ("straight", leaning(&[30.0], &[0.0]), STRAIGHT_EIGENVALUES),
        ("leaning", leaning(&[30.0], &[0.6]), LEANING_EIGENVALUES),
        ("braking in a lean", braking(), BRAKING_EIGENVALUES),
    ] {
        let spectrum = eigen(&vehicle.state(&request).linear()).expect("eigenvalues");
        agreement.holds(&format!("{name}: 19 eigenvalues"), spectrum.values.len() == 19);
        let (pairs, rest) = spectrum.values.split_at(12);
        for (pair, (re, im)) in pairs.chunks(2).zip(oscillations) {
            agreement.printed(&format!("{name}: real part of {}", pair[0]), pair[0].re, re);
            agreement.printed(&format!("{name}: imaginary part of {}", pair[0]), pair[0].im, im);
        }
        for (found, re) in rest.iter().zip(reals) {
            agreement.printed(&format!("{name}: real {found}"), found.re, re);
            agreement.holds(&format!("{name}: {found} is real"), found.im == 0.0);
        }
    }
    agreement.assert();
}
