//! Chain drive: the golden example, and what the thrust does to the suspension against the squat ratio.
//!
//! The squat ratio is a statement about a rear suspension that alone can move and carries no mass: so it is held on `ref11` with
//! a locked fork, hard tires, light rear parts and without drag, where it is exact; on the machines as they are it must give the
//! sense of the motion.

use mbody::algorithm::energy;
use motorcycle::Planar;
use motorcycle::drivetrain::squat::{squat_point, squat_ratio, squat_slope};
use motorcycle::drivetrain::{ChainRun, Run, Sprocket};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, accelerating, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_golden_example_is_met => (
        "tangent points, direction and length of both chain runs, squat point and squat angle",
        "worked example of the theory manual, 5.5",
        "half a unit of the last printed digit; one number is cut off instead of rounded in print"
    ),
    thrust_moves_the_suspension_as_the_squat_ratio_says => (
        "the arm of an idealized `ref11` rises under thrust for a squat ratio above 1, falls below 1, and stays at 1",
        "two-force member argument (V. Cossalter, *Motorcycle Dynamics*, chapter 6)",
        "1e-8 rad per m/s² at ratio 1, where tires of 1e9 N/m still give way by 1e-7 m (at ratio 1.05: 5e-4); signs elsewhere"
    ),
    machines_squat_as_their_ratio_says => (
        "`ref11` and `gsxr1000` as they are: the sense in which thrust moves the rear suspension is that of the squat ratio",
        "squat ratio from geometry against simulated steady states",
        "sign, where the ratio is more than 0.1 from 1"
    ),
];

/// The sprockets of the example and of `ref11`.
const PIVOT: [f64; 2] = [0.560, 0.400];

fn run(front: [f64; 2], run: Run) -> ChainRun<f64> {
    let (front, rear) = (Sprocket { center: front.into(), radius: 0.040 }, Sprocket { center: [0.0, 0.320].into(), radius: 0.105 });
    ChainRun::between(front, rear, run)
}

#[test]
fn the_golden_example_is_met() {
    let mut agreement = Agreement::on("chain: golden example");
    let (upper, lower) = (run([0.640, 0.420], Run::Upper), run([0.640, 0.420], Run::Lower));
    let point = squat_point(&upper, PIVOT.into(), [0.0, 0.320].into());
    let mut pair = |what: &str, p: Planar<f64>, [x, z]: [&str; 2]| {
        agreement.printed(&format!("{what} x"), p.x, x);
        agreement.printed(&format!("{what} z"), p.z, z);
    };
    pair("upper run, front", upper.front, ["0.637822", "0.459941"]);
    pair("upper run, rear", upper.rear, ["-0.005718", "0.424844"]);
    pair("upper run, direction", upper.direction, ["0.998516", "0.054456"]);
    pair("squat point", point, ["1.190618", "0.490088"]);
    // printed as 0.650109; the same formulas in 30-digit arithmetic give 0.65010959
    pair("lower run, front", lower.front, ["0.650110", "0.381299"]);
    pair("lower run, rear", lower.rear, ["0.026538", "0.218409"]);
    pair("lower run, direction", lower.direction, ["0.967534", "0.252740"]);
    agreement.printed("length", upper.length, "0.644496");
    agreement.printed("tan sigma", squat_slope([0.0, 0.0].into(), point), "0.411625");
    agreement.assert();
}

/// Height of the front sprocket of the idealized machine, m.
fn idealized(sprocket_height: f64) -> Vehicle {
    let height = format!("[0.640, 0, {sprocket_height}]");
    let hard = "1e9 N/m";
    let mut changes = vec![
        ("chain.front_sprocket.at", height.as_str()),
        ("chain.slack_force", "1e-9 N"),
        ("aero.drag_area", "0 m^2"),
        ("front_tire.rolling_resistance.constant", "0"),
        ("rear_tire.rolling_resistance.constant", "0"),
        ("front_tire.carcass.deformable.radial.stiffness", hard),
        ("rear_tire.carcass.deformable.radial.stiffness", hard),
        ("joint.fork.locked", "true"),
    ];
    // light rear parts; wheels that turn without effort
    for (path, value) in [
        ("link.swingarm_arm.mass", "1e-9 kg"),
        ("link.rear_wheel_rim.mass", "1e-9 kg"),
        ("link.swingarm_arm.inertia.ixx", "1e-12"),
        ("link.swingarm_arm.inertia.iyy", "1e-12"),
        ("link.swingarm_arm.inertia.izz", "1e-12"),
        ("link.rear_wheel_rim.inertia.ixx", "1e-12"),
        ("link.rear_wheel_rim.inertia.iyy", "1e-12"),
        ("link.rear_wheel_rim.inertia.izz", "1e-12"),
        ("link.front_wheel_rim.inertia.ixx", "1e-12"),
        ("link.front_wheel_rim.inertia.iyy", "1e-12"),
        ("link.front_wheel_rim.inertia.izz", "1e-12"),
    ] {
        changes.push((path, value));
    }
    Vehicle::with("ref11", &changes)
}

/// Height of the mass center over the road, in a state.
fn mass_center_height(vehicle: &Vehicle, state: &State) -> f64 {
    let model = vehicle.system.model();
    state.at(|at| energy::mass_center(model, &vehicle.plant().evaluate_at(at).tree.world).z)
}

/// Squat ratio in a state, from places in the world.
fn ratio(vehicle: &Vehicle, state: &State, sprockets: ([f64; 2], [f64; 2])) -> f64 {
    let (front, [front_radius, rear_radius]) = sprockets;
    let model = vehicle.system.model();
    let mut plant = vehicle.plant();
    let world = state.at(|at| plant.evaluate_at(at).tree.world.clone());
    let body = |joint: &str| world.X_WB[model.joint(joint).expect("a joint").get()];
    let chassis = world.X_WB[model.frame("chassis").expect("a chassis").body.get()];
    let place = |p: mbody::spatial::Vec3<f64>| Planar::new(p.x, p.z);
    let (front, axle) = (place(chassis.point([front[0], 0.0, front[1]].into())), place(body("rear_wheel").p));
    let run =
        ChainRun::between(Sprocket { center: front, radius: front_radius }, Sprocket { center: axle, radius: rear_radius }, Run::Upper);
    let contact = Planar::new(state.get("rear_tire.contact_x"), 0.0);
    let slope = squat_slope(contact, squat_point(&run, place(body("swingarm").p), axle));
    let wheelbase = state.get("front_tire.contact_x") - contact.x;
    squat_ratio(mass_center_height(vehicle, state), wheelbase, slope)
}

/// Angle of the arm by acceleration, rad per m/s², positive in bump: central difference of steady states.
fn rise(vehicle: &Vehicle, speed: f64, step: f64) -> f64 {
    let at = |acceleration: f64| vehicle.state(&accelerating(running(&[speed]), acceleration)).get("swingarm.angle");
    (at(2.0 * step) - at(step)) / step
}

#[test]
fn thrust_moves_the_suspension_as_the_squat_ratio_says() {
    let mut agreement = Agreement::on("chain: squat ratio of an idealized machine");
    let ratio_at = |height: f64| {
        let vehicle = idealized(height);
        let state = vehicle.state(&running(&[20.0]));
        ratio(&vehicle, &state, ([0.640, height], [0.040, 0.105]))
    };
    // the height at which thrust does nothing: bisection on the ratio, which falls with the height of the sprocket
    let (mut low, mut high) = (0.38, 0.50);
    println!("squat ratio of the idealized machine: {:.4} at {low} m, {:.4} at {high} m", ratio_at(low), ratio_at(high));
    let falls = ratio_at(low) > ratio_at(high);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (ratio_at(middle) > 1.0) == falls { low = middle } else { high = middle }
    }
    let neutral = 0.5 * (low + high);
    let still = absolute(1e-8).because("a load transfer of 120 N tilts a machine on 1e9 N/m by 2e-7 rad, and its weight pulls along");
    agreement.near("ratio 1", rise(&idealized(neutral), 20.0, 0.5), 0.0, &still);
    for height in [neutral - 0.02, neutral - 0.005, neutral + 0.005, neutral + 0.02] {
        let (ratio, rise) = (ratio_at(height), rise(&idealized(height), 20.0, 0.5));
        println!("sprocket at {height:.4} m: squat ratio {ratio:.4}, arm {rise:.3e} rad per m/s²");
        agreement.holds(&format!("ratio {ratio}: arm moves by {rise} rad per m/s²"), (ratio > 1.0) == (rise > 0.0) && rise.abs() > 1e-6);
    }
    agreement.assert();
}

#[test]
fn machines_squat_as_their_ratio_says() {
    let mut agreement = Agreement::on("chain: squat of the machines");
    for (name, [x, z], radii) in [("ref11", [0.640, 0.420], [0.040, 0.105]), ("gsxr1000", [0.634, 0.372], [0.04320, 0.10622])] {
        for offset in [-0.04, -0.02, 0.0, 0.02, 0.04] {
            let height = z + offset;
            let vehicle = Vehicle::with(name, &[("chain.front_sprocket.at", &format!("[{x}, 0, {height}]"))]);
            let state = vehicle.state(&running(&[20.0]));
            let (ratio, rise) = (ratio(&vehicle, &state, ([x, height], radii)), rise(&vehicle, 20.0, 0.25));
            println!("{name}, sprocket at {height:.3} m: squat ratio {ratio:.4}, arm {rise:.3e} rad per m/s²");
            // unsprung masses, wheel inertia and the pitch of the whole are beyond the ratio: near 1 the sense is open
            if (ratio - 1.0).abs() > 0.1 {
                agreement.holds(&format!("{name}: ratio {ratio}, arm {rise} rad per m/s²"), (ratio > 1.0) == (rise > 0.0));
            }
        }
    }
    agreement.assert();
}
