//! The synthetic sport bike REF-11 against the numbers of an independent program: states of steady motion and eigenvalues.
#![allow(non_snake_case)]

mod rig;

use mbody::contact::Profile;
use mbody::force::{
    Declared, Effort, Energy, Evaluated, Force, ForceLaw, InputDeclared, JointEffort, JointEffortUnit, JointSpring, SpringDamperLaw,
};
use mbody::model::{BodyIndex, Model};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use motorcycle::tire::compact_motorcycle::{
    AligningShape, CompactMotorcycleParameters, LateralShape, LoadDependence::Constant, LongitudinalShape,
};
use motorcycle::tire::rolling_resistance::RollingResistance;
use motorcycle::tire::{AnyTireLaw, Carcass, Deformable, EffectiveRadius, Elastic, RoadContact, Tire, Wheel};
use problem::{Dae, Seeds};
use rig::{Rig, Slot, vehicle};

/// Drag at a point of the main body: `−½ ρ CdA |v| v`.
struct Drag {
    body: BodyIndex,
}

impl ForceLaw for Drag {
    fn declare(&self, _: &str) -> Declared {
        Declared::default()
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let p = at.p_WQ(self.body, Vec3::new(0.70, 0.0, 0.70));
        let v = at.v_WQ(self.body, p);
        out.force(self.body, p, v.scaled(v.norm()) * (-0.5 * 1.204 * 0.35));
    }
    fn energy<S: SystemScalar>(&self, _: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

/// Chain between a sprocket on the main body and the rear wheel, driven by a torque: the runs share the force smoothly.
struct Chain {
    main: BodyIndex,
    wheel: BodyIndex,
}

impl ForceLaw for Chain {
    fn declare(&self, element: &str) -> Declared {
        let input = InputDeclared {
            name: format!("{element}.torque"),
            unit: "N m",
            about: "on the wheel",
            nominal: 100.0,
            rate: None,
            default: 0.0,
        };
        Declared { inputs: vec![input], ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        const R1: f64 = 0.040;
        const R2: f64 = 0.105;
        let (s1, s2) = (at.p_WQ(self.main, Vec3::new(0.640, 0.0, 0.420)), at.X_WB(self.wheel).p);
        let d = s2 - s1;
        let distance = d.norm();
        let u = d.scaled(distance.recip());
        let v = at.X_WB(self.main).R.columns[1].cross(u);
        let c = distance.recip() * (R1 - R2);
        let F = at.input(0) / R2;
        let upper = (F + (F * F + 1.0).sqrt()) * 0.5;
        for (side, tension) in [(1.0, upper), (-1.0, upper - F)] {
            let m = u.scaled(c) + v.scaled((-(c * c) + 1.0).sqrt()) * side;
            let (x1, x2) = (s1 + m * R1, s2 + m * R2);
            let run = x1 - x2;
            let pull = run.scaled(tension / run.norm());
            out.force(self.wheel, x2, pull);
            out.force(self.main, x1, -pull);
        }
    }
    fn energy<S: SystemScalar>(&self, _: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

struct End {
    joint: &'static str,
    radius: f64,
    crown: f64,
    radial: f64,
    lateral: f64,
    cornering: f64,
    camber: f64,
    twisting: f64,
}

const FRONT: End = End {
    joint: "front_wheel",
    radius: 0.300,
    crown: 0.060,
    radial: 150e3,
    lateral: 160e3,
    cornering: 14.0,
    camber: 0.90,
    twisting: 0.015,
};
const REAR: End =
    End { joint: "rear_wheel", radius: 0.320, crown: 0.095, radial: 170e3, lateral: 150e3, cornering: 13.0, camber: 0.95, twisting: 0.020 };

fn tire(model: &Model, end: &End) -> Tire {
    let law = CompactMotorcycleParameters {
        nominal_load: 1300.0,
        longitudinal: LongitudinalShape { stiffness: Constant(20.0), peak: Constant(1.2), shape: 1.5, curvature: 0.0 },
        lateral: LateralShape {
            cornering_stiffness: Constant(end.cornering),
            camber_stiffness: Constant(end.camber),
            peak: Constant(1.25),
            cornering_shape: 1.1,
            camber_shape: 0.7,
            cornering_curvature: 0.0,
            camber_curvature: 0.0,
        },
        aligning: AligningShape {
            pneumatic_trail: 0.025,
            trail_shape: 0.0,
            trail_slope: 0.0,
            twisting_moment: end.twisting,
            twisting_slope: 0.0,
        },
        combined: None,
    };
    let profile = Profile::torus(end.radius, end.crown).expect("a torus");
    Tire {
        wheel: Wheel::new(model, model.joint(end.joint).expect("a wheel"), profile, "road").expect("a wheel joint"),
        carcass: Carcass::Deformable(Deformable {
            radial: Elastic { stiffness: end.radial, damping: 300.0 },
            lateral: Elastic { stiffness: end.lateral, damping: 100.0 },
            longitudinal: None,
        }),
        law: AnyTireLaw::new(law.law().expect("a law")),
        contact: RoadContact::Bonded,
        rolling_resistance: RollingResistance::Constant(0.010),
        effective_radius: EffectiveRadius::Fraction(1.0 / 3.0),
        low_speed: 0.1,
    }
}

fn ref11() -> Rig {
    let model = vehicle(include_str!("../../models/vehicles/ref11/ref11.urdf"));
    let body = |joint: &str| model.joint(joint).expect("a joint");
    let spring = |joint: &str, preload, stiffness, damping| JointSpring {
        joint: body(joint),
        law: SpringDamperLaw::linear(preload, stiffness, damping),
        effort: JointEffortUnit::Torque,
        stop: None,
    };
    let main = model.frame("chassis").expect("the main body").body;
    let forces = vec![
        Force::new("fork_spring", spring("fork", 800.0, 18000.0, 1200.0)),
        Force::new("shock", spring("swingarm", 500.0, 7050.0, 450.0)),
        Force::new("steer_damper", spring("steer", 0.0, 0.0, 1.0)),
        Force::new("steering", JointEffort { joint: body("steer"), unit: JointEffortUnit::Torque, default: 0.0 }),
        Force::new("front_brake", JointEffort { joint: body("front_wheel"), unit: JointEffortUnit::Torque, default: 0.0 }),
        Force::new("chain", Chain { main, wheel: body("rear_wheel") }),
        Force::new("drag", Drag { body: main }),
        Force::new("front_tire", tire(&model, &FRONT)),
        Force::new("rear_tire", tire(&model, &REAR)),
    ];
    Rig::new(model, forces)
}

/// Order of the printed states of steady motion, the total torque apart.
const PRINTED: [&str; 12] = [
    "chassis.heave",
    "chassis.pitch",
    "steer.angle",
    "fork.travel",
    "swingarm.angle",
    "chassis.lateral_speed",
    "front_wheel.spin_rate",
    "rear_wheel.spin_rate",
    "steering.torque",
    "chassis.yaw_rate",
    "front_tire.carcass_lateral",
    "rear_tire.carcass_lateral",
];

struct Printed {
    speed: f64,
    roll: f64,
    acceleration: f64,
    front_share: f64,
    torque: f64,
    states: [f64; 12],
}

const STRAIGHT: Printed = Printed {
    speed: 30.0,
    roll: 0.0,
    acceleration: 0.0,
    front_share: 0.0,
    torque: 67.88178608,
    states: [-0.023580071, -0.00276441, 0.0, 0.012091311, 0.0263603, 0.0, 100.920879233, 95.261498516, 0.0, 0.0, 0.0, 0.0],
};
const LEANING: Printed = Printed {
    speed: 30.0,
    roll: 0.6,
    acceleration: 0.0,
    front_share: 0.0,
    torque: 82.594535197,
    states: [
        -0.01045607,
        0.003712766,
        -0.006576273,
        0.021613691,
        0.039524063,
        0.21456123,
        104.685578071,
        100.727284825,
        -0.813099332,
        -0.184192803,
        0.000961399,
        0.000880007,
    ],
};
const BRAKING: Printed = Printed {
    speed: 30.0,
    roll: 0.4,
    acceleration: -3.0,
    front_share: 0.8,
    torque: -187.188722744,
    states: [
        -0.005253957,
        0.030891996,
        -0.005390532,
        0.046248122,
        0.012042332,
        0.030853191,
        101.266772598,
        96.187367444,
        11.581317263,
        -0.116742154,
        0.000707639,
        0.000393667,
    ],
};

fn at(printed: &Printed) -> Rig {
    let mut rig = ref11();
    rig.set("chassis.forward_speed", printed.speed);
    rig.set("chassis.roll", printed.roll);
    for (name, value) in PRINTED.into_iter().zip(printed.states) {
        rig.set(name, value);
    }
    rig.set("chain.torque", (1.0 - printed.front_share) * printed.torque);
    rig.set("front_brake.torque", printed.front_share * printed.torque);
    let per_second = printed.acceleration / printed.speed;
    for name in ["chassis.forward_speed", "chassis.lateral_speed", "chassis.yaw_rate", "front_wheel.spin_rate", "rear_wheel.spin_rate"] {
        let rate = per_second * rig.get(name);
        rig.set_rate(name, rate);
    }
    rig
}

/// The unknowns of a steady motion of given speed and lean, with one torque.
fn unknowns(torque: &'static str) -> Vec<&'static str> {
    PRINTED.into_iter().chain([torque]).collect()
}

/// Printed states leave no more in any row than half of their last digits can explain.
#[test]
fn the_printed_states_balance_every_row() {
    for printed in [STRAIGHT, LEANING, BRAKING] {
        let mut rig = at(&printed);
        let names = unknowns("chain.torque");
        let mut seeds = Seeds::zeros(rig.y.len(), rig.u.len(), names.len());
        for (k, name) in names.iter().enumerate() {
            match rig.slot(name) {
                Slot::Y(i) => seeds.y[(i, k)] = 0.5e-9,
                // the torque is printed with nine decimals too, but is good to 1e-8
                Slot::U(i) => seeds.u[(i, k)] = if *name == "chain.torque" { 1e-8 } else { 0.5e-9 },
            }
        }
        let (dr, _) = rig.along(&seeds);
        let (r, _) = rig.evaluate();
        for i in rig.steady_rows() {
            let explained: f64 = (0..names.len()).map(|k| dr[(i, k)].abs()).sum();
            let name = &rig.plant.equations()[i].name;
            assert!(r[i].abs() <= explained + 1e-9, "{name}: {} is more than {explained}", r[i]);
        }
    }
}

#[test]
fn forces_and_slips_of_the_leaning_tires_are_met() {
    let mut straight = at(&STRAIGHT);
    assert!((straight.output("front_tire.normal_force") - 1300.056).abs() < 1e-3);
    assert!((straight.output("rear_tire.normal_force") - 1495.794).abs() < 1e-3);
    let mut rig = at(&LEANING);
    for (name, front, rear, half_digit) in [
        ("normal_force", 1321.954, 1473.896, 1e-3),
        ("lateral_force", -722.911, -848.410, 1e-3),
        ("slip_angle", -0.00575, -0.00716, 0.5e-5),
        ("camber", 0.60269, 0.60000, 0.5e-5),
    ] {
        for (tire, expected) in [("front_tire", front), ("rear_tire", rear)] {
            let value = rig.output(&format!("{tire}.{name}"));
            assert!((value - expected).abs() <= half_digit, "{tire}.{name}: {value} is not {expected}");
        }
    }
}

/// Pairs (real part, positive imaginary part) and real eigenvalues; printed with six decimals.
type Modes = ([[f64; 2]; 6], [f64; 7]);

#[test]
fn the_eigenvalues_are_met() {
    let straight: Modes = (
        [
            [-48.185356, 80.844355],
            [-34.513775, 71.030147],
            [-4.160852, 49.932087],
            [-3.580346, 18.128769],
            [-13.512232, 16.204459],
            [-4.775040, 11.887325],
        ],
        [-210.275555, -185.038335, -166.870568, -132.921834, -23.556475, -0.125250, -0.042347],
    );
    let leaning: Modes = (
        [
            [-47.572369, 77.782536],
            [-33.099673, 69.682050],
            [-3.299470, 48.559341],
            [-14.313623, 17.076689],
            [-2.919523, 16.456279],
            [-5.080170, 12.210240],
        ],
        [-224.167360, -209.938420, -160.592617, -116.771600, -23.065283, -0.041254, 0.292409],
    );
    let braking: Modes = (
        [
            [-48.489841, 80.490250],
            [-36.925380, 70.460312],
            [-3.492385, 53.047965],
            [-13.600311, 16.670219],
            [-2.283695, 15.846767],
            [-4.716942, 12.140051],
        ],
        [-253.118487, -181.419566, -174.480153, -96.036037, -23.009448, -0.360755, -0.042342],
    );
    for (printed, torque, (pairs, reals)) in
        [(STRAIGHT, "chain.torque", straight), (LEANING, "chain.torque", leaning), (BRAKING, "front_brake.torque", braking)]
    {
        let mut rig = at(&printed);
        rig.solve(&unknowns(torque), &[]);
        let found = rig.eigenvalues();
        assert_eq!(found.len(), 19);
        let mut worst = 0.0_f64;
        for (value, [re, im]) in found.iter().zip(pairs) {
            worst = worst.max((value.re - re).abs()).max((value.im - im).abs());
        }
        for (value, re) in found[6..].iter().zip(reals) {
            worst = worst.max((value.re - re).abs()).max(value.im.abs());
        }
        // half of the sixth decimal
        assert!(worst < 0.5e-6 + 1e-9, "{worst} in {found:?}");
    }
}

/// Lateral acceleration of 5 m/s² to the right: lean, torque and steering angle over the speed.
#[test]
fn the_turns_of_five_meters_per_second_squared_are_met() {
    let mut rig = at(&STRAIGHT);
    let mut names: Vec<&str> = unknowns("chain.torque").into_iter().filter(|n| *n != "chassis.yaw_rate").collect();
    names.push("chassis.roll");
    for (speed, roll, torque, steer) in [
        (10.0, 0.540835, 2.53754, -0.063847),
        (15.0, 0.547566, 0.92613, -0.027923),
        (20.0, 0.550113, 0.30623, -0.015315),
        (30.0, 0.552207, -0.09947, -0.006259),
        (40.0, 0.553282, -0.15203, -0.003004),
        (50.0, 0.554144, -0.06127, -0.001372),
    ] {
        rig.set("chassis.forward_speed", speed);
        rig.set("chassis.yaw_rate", -5.0 / speed);
        rig.set("chassis.roll", 0.55);
        rig.set("front_wheel.spin_rate", speed / 0.28);
        rig.set("rear_wheel.spin_rate", speed / 0.3);
        rig.solve(&names, &[]);
        for (name, expected, half_digit) in
            [("chassis.roll", roll, 0.5e-6), ("steering.torque", torque, 0.5e-5), ("steer.angle", steer, 0.5e-6)]
        {
            let value = rig.get(name);
            assert!((value - expected).abs() < half_digit + 1e-9, "{name} at {speed} m/s: {value} is not {expected}");
        }
    }
}

/// Torque against lean at 30 m/s, reached in small steps from the printed turn.
#[test]
fn the_torque_changes_its_sign_with_lean() {
    for (roll, torque) in [(0.3, 1.3846), (0.9, -10.5587)] {
        let mut rig = at(&LEANING);
        for step in 1..=10 {
            rig.set("chassis.roll", 0.6 + (roll - 0.6) * f64::from(step) / 10.0);
            rig.solve(&unknowns("chain.torque"), &[]);
        }
        let value = rig.get("steering.torque");
        assert!((value - torque).abs() < 0.5e-4, "at {roll}: {value} is not {torque}");
    }
}
