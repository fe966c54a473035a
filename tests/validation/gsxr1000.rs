//! Suzuki GSX-R1000 (Sharp, Evangelou, Limebeer 2004): static forces of a public code, the design pose, cornering over the range.
//!
//! The static forces come from the archived output of EoM (B. P. Minaker), whose fork slides along the line p4–p6 instead of the
//! steering axis, and whose spring forces are unknowns of a given pose. Both choices are made here; the rest is the bundled model.

use problem::Ending;
use std::collections::BTreeMap;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::reference::Table;
use validation::vehicle::{State, Vehicle, free, given, leaning};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    static_forces_are_met => (
        "`gsxr1000`: static tire loads, forces of rear and front springs, forces at the axles, with the data choices of the source",
        "EoM (B. P. Minaker), `preload.out` of 2019-01-18; `tests/reference/gsxr1000_static.csv`",
        "half of the fifth decimal: the source prints a sixth, which is always 0"
    ),
    the_static_pose_is_the_design_pose => (
        "`gsxr1000` as bundled rests in its design pose; its springs carry the preloads of the sources",
        "MotorcycleLib (882.1265 N); statics by hand (2006.1926 N)",
        "1e-6 m, rad; forces 0.05 N, which is what 1e-6 m means for the springs"
    ),
    every_cornering_state_is_reached_or_explained => (
        "`gsxr1000`: cornering from 0 to 50° and 5 to 80 m/s; every point is reached or names a declared limit",
        "the limits of the elements",
        "exact: none of 176 points may end without a cause"
    ),
];

/// Points (x, z) of the source, m.
const P4: [f64; 2] = [1.342, 0.426];
const P6: [f64; 2] = [1.410, 0.282];
const SHOCK_ON_FRAME: [f64; 2] = [0.487, 0.4888];
const SHOCK_ON_ROCKER: [f64; 2] = [0.4443, 0.1782];
/// Caster of the model, rad: the axes of the fork are tilted by it.
const CASTER: f64 = 0.4189;

/// Unit vector from a point to another.
fn direction(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let d = [to[0] - from[0], to[1] - from[1]];
    let length = f64::hypot(d[0], d[1]);
    d.map(|x| x / length)
}

/// The model of the source: slider along p4–p6, springs without preload, two efforts in their place; a chain without tension of
/// its own (0.5 N in both runs would pull the wheel forward).
fn source_model() -> Vehicle {
    let up = direction(P6, P4);
    // chassis axes to the tilted axes of the fork
    let (s, c) = CASTER.sin_cos();
    let axis = [up[0] * c + up[1] * s, -up[0] * s + up[1] * c].map(|x| x.to_string());
    let efforts = "  fork_force: { joint_force: { joint: fork } }\n  arm_torque: { joint_torque: { joint: swingarm } }\n";
    let changes = [
        ("joint.fork.axis.x", axis[0].as_str()),
        ("joint.fork.axis.z", axis[1].as_str()),
        ("fork_strut.spring.preload", "0 N"),
        ("rear_shock.spring.preload", "0 N"),
        ("chain.slack_force", "1e-9 N"),
    ];
    Vehicle::extended("gsxr1000", efforts, &changes)
}

#[test]
fn static_forces_are_met() {
    let vehicle = source_model();
    // the pose is given, the efforts at the places of the springs are found
    let mut request = given(given(Default::default(), "fork.travel", 0.0), "swingarm.angle", 0.0);
    request = free(free(request, "fork_force.force"), "arm_torque.torque");
    let state = vehicle.state(&request);
    let table = Table::read("gsxr1000_static.csv");
    // the source prints six decimals of which the last is always 0
    let printed = |item: &str, axis: &str| {
        let text = table.cell(table.find(&[("item", item), ("kind", "force")]), axis);
        text.strip_suffix('0').expect("a last digit 0").to_owned()
    };
    let mut agreement = Agreement::on("gsxr1000: static forces");

    agreement.printed("front load", state.get("front_tire.normal_force"), &printed("Front tire vertical", "z"));
    agreement.printed("rear load", state.get("rear_tire.normal_force"), &printed("Rear tire vertical", "z"));

    // the shock pushes the frame up along p21–p13; its force is the torque on the arm by the motion ratio
    let shock = state.get("arm_torque.torque") / state.get("rear_shock.motion_ratio");
    let up = direction(SHOCK_ON_ROCKER, SHOCK_ON_FRAME);
    agreement.printed("rear spring x", shock * up[0], &printed("Rear spring", "x"));
    agreement.printed("rear spring z", shock * up[1], &printed("Rear spring", "z"));

    // both legs push the frame along p6–p4, each with half of the force
    let leg = -0.5 * state.get("fork_force.force");
    let up = direction(P6, P4);
    for item in ["Right front spring", "Left front spring"] {
        agreement.printed(&format!("{item} x"), leg * up[0], &printed(item, "x"));
        agreement.printed(&format!("{item} z"), leg * up[1], &printed(item, "z"));
    }

    // what the axles carry: the force that the joint of the wheel transmits
    for (joint, item) in [("front_wheel", "Front axle"), ("rear_wheel", "Rear axle")] {
        agreement.printed(item, -transmitted(&vehicle, &state, joint), &printed(item, "z"));
    }
    agreement.assert();
}

/// Vertical force that a joint exerts on its body, N.
fn transmitted(vehicle: &Vehicle, state: &State, joint: &str) -> f64 {
    let mut plant = vehicle.plant();
    let body = vehicle.system.model().joint(joint).expect("a joint").get();
    state.at(|at| {
        let w = &plant.evaluate_at(at).tree;
        (w.world.X_WB[body].R * w.transmitted[body].f).z
    })
}

#[test]
fn the_static_pose_is_the_design_pose() {
    let state = Vehicle::bundled("gsxr1000").state(&Default::default());
    let mut agreement = Agreement::on("gsxr1000: static pose");
    let design = absolute(1e-6).because("preloads are given to 0.1 mN, tire radii to 1e-11 m; rounding of the loads");
    for signal in ["chassis.heave", "chassis.pitch", "fork.travel", "swingarm.angle"] {
        agreement.near(signal, state.get(signal), 0.0, &design);
    }
    let preload = absolute(0.05).because("a displacement of 1e-6 m at 58 N/mm");
    agreement.near("rear_shock.force", state.get("rear_shock.force"), 2006.1926, &preload);
    agreement.near("fork_strut.force", state.get("fork_strut.force"), 882.1265, &preload);
    agreement.assert();
}

#[test]
fn every_cornering_state_is_reached_or_explained() {
    let vehicle = Vehicle::bundled("gsxr1000");
    let speeds: Vec<f64> = (1..=16).map(|k| 5.0 * f64::from(k)).collect();
    let leans: Vec<f64> = (0..=10).map(|k| f64::from(5 * k).to_radians()).collect();
    let declared: Vec<String> = problem::Limits::limits(&vehicle.plant()).iter().map(|l| l.name.to_string()).collect();
    let mut endings: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for state in vehicle.steady(&leaning(&speeds, &leans), "kinsol") {
        let [speed, lean] = state.point.given[..] else { panic!("two quantities were given") };
        let mut told = format!("{speed} m/s {:.0}°", lean.to_degrees());
        if let Ending::NotConverged { because } = &state.point.ending {
            told += &format!(": {because}");
        }
        endings.entry(state.point.ending.name().to_owned()).or_default().push(told);
    }
    for (ending, points) in &endings {
        println!("gsxr1000: {ending}: {} points, {}", points.len(), points.join("; "));
    }
    let unexplained = endings.iter().filter(|(ending, _)| *ending != "reached" && !declared.contains(ending));
    let unexplained: Vec<_> = unexplained.collect();
    assert!(unexplained.is_empty(), "without a declared cause: {unexplained:#?}");
    assert!(endings["reached"].len() > 100, "most of the range can be ridden: {}", endings["reached"].len());
}
