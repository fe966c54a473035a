//! The benchmark motorcycle `moto11`: steady turn and eigenvalues against the values on which several codes agree.
#![allow(non_snake_case)]

mod rig;

use mbody::contact::Profile;
use mbody::force::{
    Declared, Effort, Energy, Evaluated, Force, ForceLaw, JointEffort, JointEffortUnit, JointSpring, PointSensor, SpringDamperLaw,
};
use mbody::model::{BodyIndex, Model};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;
use motorcycle::tire::linear_normalized::LinearNormalizedParameters;
use motorcycle::tire::{Elastic, ThinDiscLinear, Wheel};
use rig::{Rig, vehicle};

/// Mass center of the chassis, where the benchmark has its base.
const CENTER: Vec3<f64> = Vec3 { x: 0.62, y: 0.0, z: 0.62 };

/// `−½ · 1.2 · 0.4 |v| v` at the mass center of the chassis.
struct Drag {
    body: BodyIndex,
}

impl ForceLaw for Drag {
    fn declare(&self, _: &str) -> Declared {
        Declared::default()
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let p = at.p_WQ(self.body, CENTER);
        let v = at.v_WQ(self.body, p);
        out.force(self.body, p, v.scaled(v.norm()) * (-0.5 * 1.2 * 0.4));
    }
    fn energy<S: SystemScalar>(&self, _: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

fn tire(model: &Model, joint: &str, radius: f64) -> ThinDiscLinear {
    let law = LinearNormalizedParameters {
        longitudinal_stiffness: 12.0,
        cornering_stiffness: 12.0,
        camber_stiffness: 1.0,
        aligning_stiffness: 0.0,
        twisting_stiffness: 0.0,
    };
    let profile = Profile::disc(radius).expect("a disc");
    ThinDiscLinear {
        wheel: Wheel::new(model, model.joint(joint).expect("a wheel"), profile, "road").expect("a wheel joint"),
        normal: Elastic { stiffness: 150e3, damping: 500.0 },
        law: law.law().expect("a law"),
        low_speed: 0.1,
    }
}

fn moto11() -> Rig {
    let model = vehicle(include_str!("../../models/vehicles/moto11/moto11.urdf"));
    let body = |joint: &str| model.joint(joint).expect("a joint");
    let spring = |joint: &str, preload, stiffness, damping| JointSpring {
        joint: body(joint),
        law: SpringDamperLaw::linear(preload, stiffness, damping),
        effort: JointEffortUnit::Torque,
        stop: None,
    };
    let main = model.frame("chassis").expect("the chassis").body;
    let forces = vec![
        Force::new("fork_spring", spring("fork", 1000.0, 15e3, 900.0)),
        Force::new("shock", spring("swingarm", 700.0, 20e3, 700.0)),
        Force::new("steer_damper", spring("steer", 0.0, 0.0, 8.0)),
        Force::new("steering", JointEffort { joint: body("steer"), unit: JointEffortUnit::Torque, default: 0.0 }),
        Force::new("drive", JointEffort { joint: body("rear_wheel"), unit: JointEffortUnit::Torque, default: 0.0 }),
        Force::new("drag", Drag { body: main }),
        Force::new("center", PointSensor { body: main, point: CENTER }),
        Force::new("front_tire", tire(&model, "front_wheel", 0.30)),
        Force::new("rear_tire", tire(&model, "rear_wheel", 0.32)),
    ];
    let mut rig = Rig::new(model, forces);
    rig.set("chassis.heave", -0.01);
    rig
}

const UNKNOWNS: [&str; 12] = [
    "chassis.heave",
    "chassis.roll",
    "chassis.pitch",
    "steer.angle",
    "fork.travel",
    "swingarm.angle",
    "chassis.forward_speed",
    "chassis.lateral_speed",
    "front_wheel.spin_rate",
    "rear_wheel.spin_rate",
    "steering.torque",
    "drive.torque",
];

/// Steady turn at a speed of the mass center of the chassis and a yaw rate of `acceleration/speed`, in steps from straight running.
fn turn(speed: f64, acceleration: f64) -> Rig {
    let mut rig = moto11();
    rig.set("chassis.forward_speed", speed);
    rig.set("front_wheel.spin_rate", speed / 0.30);
    rig.set("rear_wheel.spin_rate", speed / 0.32);
    for step in 0..=20 {
        rig.set("chassis.yaw_rate", acceleration / speed * f64::from(step) / 20.0);
        rig.solve(&UNKNOWNS, &[("center.point_speed", speed)]);
    }
    rig
}

#[test]
fn the_turn_on_which_the_peers_agree_is_met() {
    let speed = 10.0 + 50.0 * 10.0 / 19.0;
    let mut rig = turn(speed, 80.0 / 19.0);
    for (name, expected, factor, half_digit) in [
        ("chassis.roll", -23.694738, 1f64.to_degrees(), 0.5e-6),
        ("chassis.pitch", -0.495606, 1f64.to_degrees(), 0.5e-6),
        ("steer.angle", 0.240263, 1f64.to_degrees(), 0.5e-6),
        ("steering.torque", 1.15657, 1.0, 0.5e-5),
        ("drive.torque", 101.6514, 1.0, 0.5e-4),
    ] {
        let value = rig.get(name) * factor;
        assert!((value - expected).abs() < half_digit + 1e-9, "{name}: {value} is not {expected}");
    }
    // a left turn: leaning left, tires pushed to the left, camber of the rear wheel near the roll
    assert!((rig.output("rear_tire.camber") - rig.get("chassis.roll")).abs() < 1e-12);
    assert!(rig.output("rear_tire.lateral_force") > 0.0 && rig.output("front_tire.lateral_force") > 0.0);
}

#[test]
fn the_eigenvalues_on_which_the_peers_agree_are_met() {
    let found = turn(30.0, 0.0).eigenvalues();
    for [re, im] in
        [[-29.5122, 73.2654], [-80.5883, 56.6364], [-15.7023, 48.9841], [-10.9462, 25.3710], [-2.3634, 16.9032], [-5.4951, 13.4513]]
    {
        let nearest = found.iter().map(|l| (l.re - re).abs().max((l.im - im).abs())).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.5e-4 + 1e-9, "{re} ± {im}i misses by {nearest}");
    }
}
