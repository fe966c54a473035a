//! The tire element on a carrier: exact derivatives, symmetries, balance of power, build-up of side forces, lifting.
#![allow(non_snake_case)]

mod rig;

use mbody::contact::Profile;
use mbody::force::Force;
use mbody::spatial::Vec3;
use motorcycle::tire::compact_motorcycle::{
    AligningShape, CombinedWeights, CompactMotorcycleParameters, LateralShape, LoadDependence, LongitudinalShape,
};
use motorcycle::tire::linear_normalized::LinearNormalizedParameters;
use motorcycle::tire::rolling_resistance::RollingResistance;
use motorcycle::tire::{
    AnyTireLaw, Carcass, Deformable, EffectiveRadius, Elastic, Relaxation, RelaxationLength, RoadContact, ThinDiscLinear, Tire, Vertical,
    Wheel,
};
use problem::{At, Dae, Limits, Outputs, Seeds};
use rig::{Rig, vehicle};

const RADIUS: f64 = 0.3;

/// A carrier on a vehicle base, and a wheel on it.
const BENCH: &str = r#"<robot name="bench">
  <link name="carrier">
    <inertial><mass value="100"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="wheel" type="continuous">
    <parent link="carrier"/><child link="rim"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
  </joint>
  <link name="rim">
    <inertial><mass value="10"/><inertia ixx="0.3" iyy="0.5" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
</robot>"#;

const RADIAL: Elastic = Elastic { stiffness: 150e3, damping: 300.0 };
const LATERAL: Elastic = Elastic { stiffness: 160e3, damping: 100.0 };
const LONGITUDINAL: Elastic = Elastic { stiffness: 300e3, damping: 120.0 };

/// A law that uses everything a law may.
fn law() -> AnyTireLaw {
    let linear = |value, slope| LoadDependence::Linear { value, slope };
    let parameters = CompactMotorcycleParameters {
        nominal_load: 1300.0,
        longitudinal: LongitudinalShape { stiffness: linear(20.0, -2.0), peak: linear(1.2, -0.05), shape: 1.5, curvature: 0.2 },
        lateral: LateralShape {
            cornering_stiffness: LoadDependence::Saturating { peak: 17.0, saturation_load: 2.2 },
            camber_stiffness: linear(0.9, 0.05),
            peak: linear(1.25, -0.05),
            cornering_shape: 1.1,
            camber_shape: 0.7,
            cornering_curvature: -1.0,
            camber_curvature: -2.0,
        },
        aligning: AligningShape { pneumatic_trail: 0.025, trail_shape: 1.2, trail_slope: 8.0, twisting_moment: 0.015, twisting_slope: 5.0 },
        combined: Some(CombinedWeights { longitudinal_shape: 1.1, longitudinal_slope: 12.0, lateral_shape: 1.05, lateral_slope: 8.0 }),
    };
    AnyTireLaw::new(parameters.law().expect("a law"))
}

fn deformable(longitudinal: Option<Elastic>) -> Carcass {
    Carcass::Deformable(Deformable { radial: RADIAL, lateral: LATERAL, longitudinal })
}

fn vertical(relaxation: Relaxation) -> Carcass {
    Carcass::Vertical(Vertical { normal: Elastic { stiffness: 150e3, damping: 800.0 }, quadratic: 1e6, relaxation })
}

/// Every carcass, with all its options.
fn carcasses() -> Vec<Carcass> {
    vec![
        deformable(None),
        deformable(Some(LONGITUDINAL)),
        vertical(Relaxation::None),
        vertical(Relaxation::Elastic(LATERAL)),
        vertical(Relaxation::Slip {
            lateral: RelaxationLength::CorneringStiffness([8.6e-6, 3.7e-8, 8.4e-10]),
            longitudinal: Some(RelaxationLength::LoadPolynomial(vec![0.05, 5e-5])),
        }),
        vertical(Relaxation::Force(RelaxationLength::LoadPolynomial(vec![0.1, 1e-4, -3e-8]))),
        vertical(Relaxation::ForceWithoutCamber(RelaxationLength::Constant(0.2))),
    ]
}

/// A bench with a tire of this carcass; `change` adapts the rest.
fn bench(carcass: Carcass, change: impl Fn(&mut Tire)) -> Rig {
    let model = vehicle(BENCH);
    let profile = Profile::torus(RADIUS, 0.06).expect("a torus");
    let wheel = Wheel::new(&model, model.joint("wheel").expect("a wheel"), profile, "road").expect("a wheel joint");
    let mut tire = Tire {
        wheel,
        carcass,
        law: law(),
        contact: RoadContact::Lifting,
        rolling_resistance: RollingResistance::SHARP_1994,
        effective_radius: EffectiveRadius::Fraction(1.0 / 3.0),
        low_speed: 0.1,
    };
    change(&mut tire);
    Rig::new(model, vec![Force::new("tire", tire)])
}

fn disc() -> Rig {
    let model = vehicle(BENCH);
    let profile = Profile::disc(RADIUS).expect("a disc");
    let wheel = Wheel::new(&model, model.joint("wheel").expect("a wheel"), profile, "road").expect("a wheel joint");
    let parameters = LinearNormalizedParameters {
        longitudinal_stiffness: 12.0,
        cornering_stiffness: 12.0,
        camber_stiffness: 1.0,
        aligning_stiffness: 0.0,
        twisting_stiffness: 0.0,
    };
    let normal = Elastic { stiffness: 150e3, damping: 500.0 };
    let disc = ThinDiscLinear { wheel, normal, law: parameters.law().expect("a law"), low_speed: 0.1 };
    Rig::new(model, vec![Force::new("tire", disc)])
}

/// Puts the bench into a general motion, spread by irrational multiples; sinks the tire by some millimeters.
fn general_motion(rig: &mut Rig, i: u32) {
    let spread = |k: f64| 2.0 * (f64::from(i) * k.sqrt()).fract() - 1.0;
    let roll = 0.8 * spread(2.0);
    let sunk = 0.008 + 0.003 * spread(3.0);
    // height of the axle of the undeformed torus, and of the disc within its edge
    let height = 0.24 * roll.cos() + 0.06 - sunk;
    for (name, value) in [
        ("carrier.x", 3.0 * spread(5.0)),
        ("carrier.y", 3.0 * spread(7.0)),
        ("carrier.yaw", 3.0 * spread(11.0)),
        ("carrier.roll", roll),
        ("carrier.pitch", 0.2 * spread(13.0)),
        ("carrier.forward_speed", 20.0 + 8.0 * spread(17.0)),
        ("carrier.lateral_speed", 0.5 * spread(19.0)),
        ("carrier.yaw_rate", 0.5 * spread(23.0)),
        ("carrier.heave_rate", 0.05 * spread(29.0)),
        ("carrier.roll_rate", 0.5 * spread(31.0)),
        ("carrier.pitch_rate", 0.2 * spread(37.0)),
        ("wheel.angle", 2.0 * spread(41.0)),
        ("road.height", 0.02 * spread(43.0)),
        ("road.height_rate", 0.05 * spread(47.0)),
    ] {
        rig.set(name, value);
    }
    let pitch = rig.get("carrier.pitch");
    rig.set("carrier.heave", height + rig.get("road.height") - RADIUS * roll.cos() * pitch.cos());
    let spin = rig.get("carrier.forward_speed") / 0.29 * (1.0 + 0.03 * spread(53.0));
    rig.set("wheel.spin_rate", spin);
    let states: Vec<String> = states(rig);
    for (k, name) in states.iter().enumerate() {
        let (value, rate) = match name.as_str() {
            "tire.lagged_lateral_force" => (600.0, 3000.0),
            "tire.lagged_lateral_slip" | "tire.lagged_longitudinal_slip" => (0.05, 0.3),
            _ => (0.002, 0.02),
        };
        rig.set(name, value * spread(59.0 + f64::from(k as u32)));
        rig.set_rate(name, rate * spread(61.0 + f64::from(k as u32)));
    }
}

/// Names of the states of the tire.
fn states(rig: &Rig) -> Vec<String> {
    rig.plant.unknowns().iter().map(|u| u.signal.name.clone()).filter(|n| n.starts_with("tire.")).collect()
}

/// Solves the rows of the tire for the rates of its states.
fn solve_rates(rig: &mut Rig) {
    let (n, count) = (rig.y.len(), states(rig).len());
    if count == 0 {
        return;
    }
    for _ in 0..20 {
        let (r, _) = rig.evaluate();
        let mut seeds = Seeds::zeros(n, rig.u.len(), count);
        for k in 0..count {
            seeds.yd[(n - count + k, k)] = 1.0;
        }
        let (dr, _) = rig.along(&seeds);
        let rows = r.len() - count;
        let J = nalgebra::DMatrix::from_fn(count, count, |i, k| dr[(rows + i, k)]);
        let step = J.lu().solve(&nalgebra::DVector::from_fn(count, |i, _| r[rows + i])).expect("regular rows");
        for k in 0..count {
            rig.yd[n - count + k] -= step[k];
        }
        if r[rows..].iter().all(|x| x.abs() < 1e-9) {
            return;
        }
    }
    panic!("the rows have no solution");
}

#[test]
fn derivatives_are_exact() {
    let mut rigs: Vec<Rig> = carcasses().into_iter().map(|c| bench(c, |_| ())).collect();
    rigs.extend(carcasses().into_iter().map(|c| bench(c, |t| t.contact = RoadContact::Bonded)));
    rigs.push(disc());
    for rig in &mut rigs {
        for i in 1..12 {
            general_motion(rig, i);
            // one wheel in five hangs in the air, one barely touches
            let heave = rig.get("carrier.heave") + [0.0, 0.0, 0.0, 0.05, 0.0078][(i % 5) as usize];
            rig.set("carrier.heave", heave);
            check_derivatives(rig);
        }
    }
}

/// Every direction of y, ẏ, u against central differences of fourth order.
fn check_derivatives(rig: &mut Rig) {
    let (n, m) = (rig.y.len(), rig.u.len());
    let mut seeds = Seeds::zeros(n, m, 2 * n + m);
    for k in 0..n {
        (seeds.y[(k, k)], seeds.yd[(k, n + k)]) = (1.0, 1.0);
    }
    for k in 0..m {
        seeds.u[(k, 2 * n + k)] = 1.0;
    }
    let (dr, dz) = rig.along(&seeds);
    let names: Vec<String> = rig.plant.unknowns().iter().map(|u| u.signal.name.clone()).collect();
    for k in 0..2 * n + m {
        let name = if k < 2 * n { names[k % n].as_str() } else { "road" };
        // lengths that compress the carcass need small steps, forces large ones
        let h = match name {
            "tire.lagged_lateral_force" => 1.0,
            _ if k < n || k >= 2 * n => 2e-6,
            _ => 1e-3,
        };
        let mut moved = |steps: f64| {
            let (y, yd, u) = (rig.y.clone(), rig.yd.clone(), rig.u.clone());
            match k {
                _ if k < n => rig.y[k] += steps * h,
                _ if k < 2 * n => rig.yd[k - n] += steps * h,
                _ => rig.u[k - 2 * n] += steps * h,
            }
            let (r, z) = rig.evaluate();
            (rig.y, rig.yd, rig.u) = (y, yd, u);
            r.into_iter().chain(z).collect::<Vec<f64>>()
        };
        let (m2, m1, p1, p2) = (moved(-2.0), moved(-1.0), moved(1.0), moved(2.0));
        for j in 0..m1.len() {
            let exact = if j < dr.rows() { dr[(j, k)] } else { dz[(j - dr.rows(), k)] };
            let difference = (m2[j] - 8.0 * m1[j] + 8.0 * p1[j] - p2[j]) / (12.0 * h);
            // rounding of forces of 1e4 N over the step, and the truncation of the load's rounding
            let tolerance = 1e-5 * exact.abs() + 1e-12 * (m1[j].abs() + 1e3) / h;
            assert!((exact - difference).abs() <= tolerance, "answer {j} along {name} ({k}): {exact} {difference}");
        }
    }
}

/// Position, heading and the angle of the wheel change nothing in the yawed frame.
#[test]
fn forces_do_not_depend_on_where_the_wheel_is() {
    for carcass in carcasses() {
        let mut rig = bench(carcass, |_| ());
        for i in 1..10 {
            general_motion(&mut rig, i);
            let (r, z) = rig.evaluate();
            for (name, by) in [("carrier.x", 7.0), ("carrier.y", -4.0), ("carrier.yaw", 1.3), ("wheel.angle", 2.1)] {
                let value = rig.get(name) + by;
                rig.set(name, value);
            }
            let (moved, outputs) = rig.evaluate();
            for row in rig.steady_rows() {
                let name = &rig.plant.equations()[row].name;
                assert!((r[row] - moved[row]).abs() < 1e-8, "{name}: {} {}", r[row], moved[row]);
            }
            let place = rig.output_index("tire.contact_x");
            for (k, (a, b)) in z.iter().zip(&outputs).enumerate().take(place) {
                assert!((a - b).abs() < 1e-8, "{}: {a} {b}", rig.plant.outputs()[k].name);
            }
        }
    }
}

/// The mirror image of a motion has the mirror image of the forces.
#[test]
fn left_is_right_mirrored() {
    let odd_motion = ["roll", "lateral_speed", "yaw_rate", "roll_rate", "carcass_lateral", "lagged_lateral_slip", "lagged_lateral_force"];
    let odd_output = ["lateral_force", "overturning_moment", "aligning_moment", "slip_angle", "camber"];
    for carcass in carcasses() {
        let mut rig = bench(carcass, |_| ());
        for i in 1..10 {
            general_motion(&mut rig, i);
            rig.set("carrier.y", 0.0);
            rig.set("carrier.yaw", 0.0);
            let (_, z) = rig.evaluate();
            let odd = |name: &str, list: &[&str]| list.iter().any(|o| name.ends_with(&format!(".{o}")));
            for k in 0..rig.y.len() {
                if odd(&rig.plant.unknowns()[k].signal.name, &odd_motion) {
                    (rig.y[k], rig.yd[k]) = (-rig.y[k], -rig.yd[k]);
                }
            }
            let (_, mirrored) = rig.evaluate();
            for (k, signal) in rig.plant.outputs().iter().enumerate() {
                let sign = if odd(&signal.name, &odd_output) || signal.name == "tire.contact_y" { -1.0 } else { 1.0 };
                assert!((z[k] - sign * mirrored[k]).abs() < 1e-8, "{}: {} {}", signal.name, z[k], mirrored[k]);
            }
        }
    }
}

/// Delivered power = −d(stored)/dt + supplied − dissipated, with the rate of the stored energy by differences.
#[test]
fn the_power_balances() {
    let contacts = [RoadContact::Bonded, RoadContact::Lifting];
    for (carcass, contact) in carcasses().into_iter().flat_map(|c| contacts.map(|k| (c.clone(), k))) {
        let mut rig = bench(carcass, |t| t.contact = contact);
        let heights: &[f64] = if contact == RoadContact::Lifting { &[0.0, 0.0078, 0.05] } else { &[0.0] };
        for (i, lifted) in (1..20).flat_map(|i| heights.iter().map(move |lifted| (i, lifted))) {
            general_motion(&mut rig, i);
            let heave = rig.get("carrier.heave") + lifted;
            rig.set("carrier.heave", heave);
            solve_rates(&mut rig);
            balance(&mut rig);
        }
    }
    let mut rig = disc();
    for i in 1..20 {
        general_motion(&mut rig, i);
        balance(&mut rig);
    }
}

/// Moves along the motion and compares the account with the power delivered to the bodies.
fn balance(rig: &mut Rig) {
    follow(rig);
    let system = rig.plant.system().clone();
    let at = At { time: 0.0, y: &rig.y, yd: &rig.yd, u: &rig.u };
    let power = rig.plant.evaluate_at(at).delivered_power(&system);
    let account = rig.plant.account_at(at).elements;
    let stored = |rig: &mut Rig, dt: f64| moved(rig, dt, |rig, at| rig.plant.account_at(at).elements.stored);
    let rate = rate_of(rig, stored);
    let rest = power + rate - account.supplied + account.dissipated;
    // differences of some J over 2e-6 s
    assert!(rest.abs() < 1e-6 * power.abs().max(1e4), "{rest} of {power} W");
}

/// Rates of the coordinates from the velocities.
fn follow(rig: &mut Rig) {
    let nq = rig.plant.equations().iter().filter(|e| e.kind == problem::EquationKind::Kinematic).count();
    rig.yd[..nq].fill(0.0);
    let (r, _) = rig.evaluate();
    for k in 0..nq {
        rig.yd[k] = -r[k];
    }
}

/// A quantity after a while of motion with the present rates; the road moves along.
fn moved(rig: &mut Rig, dt: f64, quantity: impl Fn(&mut Rig, At<'_>) -> f64) -> f64 {
    let y: Vec<f64> = rig.y.iter().zip(&rig.yd).map(|(y, yd)| y + dt * yd).collect();
    let (yd, mut u) = (rig.yd.clone(), rig.u.clone());
    if let (rig::Slot::U(height), rig::Slot::U(rate)) = (rig.slot("road.height"), rig.slot("road.height_rate")) {
        u[height] += dt * u[rate];
    }
    quantity(rig, At { time: 0.0, y: &y, yd: &yd, u: &u })
}

fn rate_of(rig: &mut Rig, quantity: impl Fn(&mut Rig, f64) -> f64) -> f64 {
    let h = 1e-6;
    let (m2, m1, p1, p2) = (quantity(rig, -2.0 * h), quantity(rig, -h), quantity(rig, h), quantity(rig, 2.0 * h));
    (m2 - 8.0 * m1 + 8.0 * p1 - p2) / (12.0 * h)
}

/// In a deformable carcass on the road the dissipation is damping, sliding, moments, and the lever of the effective radius.
#[test]
fn the_dissipation_has_its_parts() {
    let mut rig = bench(deformable(None), |t| t.contact = RoadContact::Bonded);
    for i in 1..20 {
        general_motion(&mut rig, i);
        for name in ["carrier.yaw", "carrier.x", "carrier.y"] {
            rig.set(name, 0.0);
        }
        solve_rates(&mut rig);
        follow(&mut rig);
        let outputs: Vec<String> = rig.plant.outputs().iter().map(|o| o.name.clone()).collect();
        let (_, z) = rig.evaluate();
        let z = |name: &str| z[outputs.iter().position(|o| o == &format!("tire.{name}")).expect("an output")];
        // compression rate by differences: independent of the closed form inside
        let index = rig.output_index("tire.deflection");
        let deflection = |rig: &mut Rig, dt: f64| {
            moved(rig, dt, |rig, at| {
                let (mut r, mut z) = (vec![0.0; rig.y.len()], vec![0.0; rig.plant.outputs().len()]);
                rig.plant.evaluate(at, &mut r, &mut z).expect("finite");
                z[index]
            })
        };
        let radial_rate = rate_of(&mut rig, deflection);
        let rig::Slot::Y(state) = rig.slot("tire.carcass_lateral") else { panic!("a state") };
        let lateral_rate = rig.yd[state];

        // velocity of the carrier at the contact point, in the yawed frame
        let (roll, spin) = (rig.get("carrier.roll"), rig.get("wheel.spin_rate"));
        let n = Vec3::new(0.0, roll.cos(), roll.sin());
        let w = Vec3::new(rig.get("carrier.roll_rate"), 0.0, rig.get("carrier.yaw_rate")) + n * rig.get("carrier.pitch_rate");
        let base = Vec3::new(rig.get("carrier.forward_speed"), rig.get("carrier.lateral_speed"), rig.get("carrier.heave_rate"));
        let arm = Vec3::new(z("contact_x"), z("contact_y"), z("contact_z") - rig.get("carrier.heave"));
        let v = base + w.cross(arm);
        let reference = (v.x * v.x + 0.01).sqrt();
        let (slide_x, slide_y) = (-z("longitudinal_slip") * reference, -z("slip_angle").tan() * reference);
        let sliding_of_rim = v.y + lateral_rate * roll.cos() - radial_rate * roll.sin();
        assert!((slide_y - sliding_of_rim).abs() < 1e-6, "{slide_y} {sliding_of_rim}");

        let free = 0.24 + 0.06 * roll.cos();
        let lever = free - z("deflection");
        let expected = RADIAL.damping * radial_rate.powi(2) + LATERAL.damping * lateral_rate.powi(2)
            - z("longitudinal_force") * slide_x
            - z("lateral_force") * slide_y
            - z("longitudinal_force") * spin * (z("effective_radius") - lever)
            - z("rolling_moment") * (w.dot(n) + spin)
            - z("aligning_moment") * (w.z + spin * roll.sin());
        let at = At { time: 0.0, y: &rig.y, yd: &rig.yd, u: &rig.u };
        let dissipated = rig.plant.account_at(at).elements.dissipated;
        // rates by differences of 1e-17 m over 1e-6 s, times forces of 1e3 N
        assert!((dissipated - expected).abs() < 1e-5 * expected.abs().max(100.0), "{dissipated} {expected}");
    }
}

/// A wheel at constant speed whose heading is suddenly off by a small angle: the side force over time.
fn step_slip(rig: &mut Rig, speed: f64, slip: f64, roll: f64, until: f64) -> Vec<(f64, f64)> {
    rig.set("carrier.forward_speed", speed);
    rig.set("carrier.lateral_speed", -slip * speed);
    rig.set("carrier.roll", roll);
    rig.set("carrier.heave", 0.24 * roll.cos() + 0.06 - 0.008 - 0.3 * roll.cos());
    rig.set("wheel.spin_rate", speed / (0.3 - 0.008 / 3.0));
    let first = rig.y.len() - states(rig).len();
    let steps = 2000;
    let dt = until / f64::from(steps);
    let mut history = Vec::new();
    for step in 0..=steps {
        // explicit midpoint rule: second order, 1e-6 of the rise over 2000 steps
        solve_rates(rig);
        history.push((f64::from(step) * dt, rig.output("tire.lateral_force")));
        let start = rig.y.clone();
        for k in first..rig.y.len() {
            rig.y[k] = start[k] + 0.5 * dt * rig.yd[k];
        }
        solve_rates(rig);
        for k in first..rig.y.len() {
            rig.y[k] = start[k] + dt * rig.yd[k];
        }
    }
    history
}

/// Length over which a history reaches 1 − 1/e of its steady value.
fn build_up_length(history: &[(f64, f64)], speed: f64, steady: f64) -> f64 {
    let start = history[0].1;
    let target = start + (1.0 - (-1f64).exp()) * (steady - start);
    let after = history.iter().position(|(_, f)| (f - target) * (start - target) <= 0.0).expect("reached");
    let ((t0, f0), (t1, f1)) = (history[after - 1], history[after]);
    speed * (t0 + (t1 - t0) * (target - f0) / (f1 - f0))
}

fn linear() -> AnyTireLaw {
    let parameters = LinearNormalizedParameters {
        longitudinal_stiffness: 20.0,
        cornering_stiffness: 14.0,
        camber_stiffness: 0.9,
        aligning_stiffness: 0.3,
        twisting_stiffness: 0.015,
    };
    AnyTireLaw::new(parameters.law().expect("a law"))
}

/// The side force after a step of slip builds up over the cornering stiffness over the lateral stiffness, and ends at the law.
#[test]
fn a_step_of_slip_builds_up_over_the_relaxation_length() {
    let (speed, slip) = (15.0, 1e-3);
    // a damper so weak that its share in the length, c V/k, does not show
    let weak = Elastic { stiffness: 160e3, damping: 1e-4 };
    let carcasses = [
        Carcass::Deformable(Deformable { radial: RADIAL, lateral: weak, longitudinal: None }),
        Carcass::Vertical(Vertical { normal: RADIAL, quadratic: 0.0, relaxation: Relaxation::Elastic(weak) }),
    ];
    for carcass in carcasses {
        let mut rig = bench(carcass, |t| t.law = linear());
        let history = step_slip(&mut rig, speed, slip, 0.0, 0.1);
        let load = rig.output("tire.normal_force");
        assert!((load - 150e3 * 0.008).abs() < 1e-2);
        let steady = 14.0 * load * slip;
        assert!((history.last().expect("a history").1 / steady - 1.0).abs() < 1e-4);
        let expected = 14.0 * load / 160e3;
        let length = build_up_length(&history, speed, steady);
        // V0 = 0.1 m/s beside 15 m/s: 2e-5
        assert!((length / expected - 1.0).abs() < 1e-4, "{length} is not {expected}");
    }
}

#[test]
fn the_lags_build_up_over_their_length() {
    let sigma = || RelaxationLength::Constant(0.25);
    for relaxation in
        [Relaxation::Slip { lateral: sigma(), longitudinal: None }, Relaxation::Force(sigma()), Relaxation::ForceWithoutCamber(sigma())]
    {
        let carcass = Carcass::Vertical(Vertical { normal: RADIAL, quadratic: 0.0, relaxation });
        let mut rig = bench(carcass, |t| t.law = linear());
        let history = step_slip(&mut rig, 15.0, 1e-3, 0.0, 0.15);
        let steady = 14.0 * rig.output("tire.normal_force") * 1e-3;
        let length = build_up_length(&history, 15.0, steady);
        assert!((length / 0.25 - 1.0).abs() < 1e-4, "{length}");
    }
}

#[test]
fn only_the_last_lag_lets_camber_act_at_once() {
    let sigma = || RelaxationLength::Constant(0.25);
    for (relaxation, share) in [(Relaxation::Force(sigma()), 0.0), (Relaxation::ForceWithoutCamber(sigma()), 1.0), (Relaxation::None, 1.0)]
    {
        let carcass = Carcass::Vertical(Vertical { normal: RADIAL, quadratic: 0.0, relaxation });
        let mut rig = bench(carcass, |t| t.law = linear());
        let history = step_slip(&mut rig, 15.0, 0.0, 0.2, 1e-3);
        let of_camber = -0.9 * rig.output("tire.normal_force") * 0.2;
        assert!((history[0].1 - share * of_camber).abs() < 1e-6 * of_camber.abs(), "{}", history[0].1);
    }
}

#[test]
fn relaxation_lengths_have_their_forms() {
    let speed = 20.0;
    let expected = |load: f64| [0.3, 0.1 + 1e-4 * load, 14.0 * load * (8e-6 + 4e-8 * speed + 8e-10 * speed * speed)];
    let forms = [
        RelaxationLength::Constant(0.3),
        RelaxationLength::LoadPolynomial(vec![0.1, 1e-4]),
        RelaxationLength::CorneringStiffness([8e-6, 4e-8, 8e-10]),
    ];
    for (k, lateral) in forms.into_iter().enumerate() {
        let relaxation = Relaxation::Slip { lateral, longitudinal: None };
        let carcass = Carcass::Vertical(Vertical { normal: RADIAL, quadratic: 0.0, relaxation });
        let mut rig = bench(carcass, |t| (t.law, t.low_speed) = (linear(), 1e-3));
        let history = step_slip(&mut rig, speed, 1e-3, 0.0, 0.2);
        let load = rig.output("tire.normal_force");
        let length = build_up_length(&history, speed, 14.0 * load * 1e-3);
        assert!((length / expected(load)[k] - 1.0).abs() < 1e-4, "{length} is not {}", expected(load)[k]);
    }
}

/// The steady deflection of the published linear model of a sport-tourer, `λ = N (ka a + (1 − kg) γ)/kl`: the lateral spring carries
/// the part of the load that leans on it, less the camber thrust (R. Lot, M. Massaro; data of the rear tire).
#[test]
fn in_a_lean_the_lateral_spring_carries_what_camber_thrust_leaves() {
    let parameters = LinearNormalizedParameters {
        longitudinal_stiffness: 20.0,
        cornering_stiffness: 14.5,
        camber_stiffness: 0.95,
        aligning_stiffness: 0.20,
        twisting_stiffness: 0.018,
    };
    let law = AnyTireLaw::new(parameters.law().expect("a law"));
    let lateral = Elastic { stiffness: 140e3, damping: 100.0 };
    let carcass = Carcass::Deformable(Deformable { radial: RADIAL, lateral, longitudinal: None });
    let mut rig = bench(carcass, |t| t.law = law.clone());
    for (slip, roll) in [(1e-3, 0.0), (0.0, 1e-3), (2e-4, -1e-3)] {
        step_slip(&mut rig, 20.0, slip, roll, 0.2);
        let load = rig.output("tire.normal_force");
        let expected = load * (14.5 * slip + (1.0 - 0.95) * roll) / 140e3;
        // the rounding of slips at 20 m/s gives 1.2e-5, squares of the angles less
        assert!((rig.get("tire.carcass_lateral") / expected - 1.0).abs() < 2e-5, "{expected}");
    }
}

/// Lifted off the road, the tire exerts nothing and its patch returns; on the way it never pulls, however fast it rebounds.
#[test]
fn a_tire_that_can_lift_never_pulls() {
    for carcass in carcasses() {
        let mut rig = bench(carcass, |_| ());
        for i in 1..20 {
            general_motion(&mut rig, i);
            let on_the_road = rig.get("carrier.heave");
            for (lifted, rate) in [(0.0, 2.0), (0.004, 5.0), (0.0075, -1.0), (0.012, 0.5), (0.3, 0.0), (0.3, -3.0)] {
                rig.set("carrier.heave", on_the_road + lifted);
                rig.set("carrier.heave_rate", rate);
                let load = rig.output("tire.normal_force");
                assert!(load >= 0.0 && (lifted < 0.011 || load == 0.0), "{load} N at {lifted} m");
            }
            if states(&rig).iter().any(|s| s == "tire.carcass_lateral") {
                solve_rates(&mut rig);
                let rig::Slot::Y(k) = rig.slot("tire.carcass_lateral") else { panic!("a state") };
                assert!((rig.yd[k] + 1600.0 * rig.y[k]).abs() < 1e-6, "returns over c/k");
            }
        }
    }
}

#[test]
fn on_the_road_both_contacts_agree() {
    for carcass in carcasses() {
        let mut lifting = bench(carcass.clone(), |_| ());
        let mut bonded = bench(carcass, |t| t.contact = RoadContact::Bonded);
        for i in 1..20 {
            general_motion(&mut lifting, i);
            general_motion(&mut bonded, i);
            let (a, b) = (lifting.output("tire.normal_force"), bonded.output("tire.normal_force"));
            // the rounding of the load, ε²/N with ε = 1 N
            assert!(b > 100.0 && (a - b - 1.0 / b).abs() < 1e-5, "{a} {b}");
        }
    }
}

/// A road that rises is a wheel that sinks.
#[test]
fn the_road_moves_as_the_wheel_would() {
    for carcass in carcasses() {
        let mut rig = bench(carcass, |_| ());
        general_motion(&mut rig, 3);
        let before = rig.evaluate().1;
        for (wheel, road, by) in [("carrier.heave", "road.height", 0.05), ("carrier.heave_rate", "road.height_rate", 0.3)] {
            for name in [wheel, road] {
                let value = rig.get(name) + by;
                rig.set(name, value);
            }
        }
        let after = rig.evaluate().1;
        let height = rig.output_index("tire.contact_z");
        for (k, (a, b)) in before.iter().zip(&after).enumerate().filter(|(k, _)| *k != height) {
            assert!((a - b).abs() < 1e-8, "{}: {a} {b}", rig.plant.outputs()[k].name);
        }
        assert!((after[height] - before[height] - 0.05).abs() < 1e-14);
        let inputs = rig.plant.inputs();
        assert_eq!(inputs[0].rate, Some(1), "the height knows its rate");
    }
}

/// An elliptic crown with equal axes, and a table of a circle, are the torus.
#[test]
fn crowns_of_one_shape_make_one_tire() {
    let torus = Profile::torus(RADIUS, 0.06).expect("a torus");
    let g: Vec<f64> = (0..=60).map(|i| 0.02 * f64::from(i)).collect();
    let s: Vec<f64> = g.iter().map(|g| torus.support(*g)).collect();
    let shapes = [
        (Profile::ellipse(RADIUS, 0.06, 0.06).expect("an ellipse"), 1e-7),
        // the slope of the table errs by 1e-7 m: times a stiffness of 150 kN/m
        (Profile::table(&g, &s).expect("a table"), 0.05),
    ];
    for (shape, tolerance) in shapes {
        for carcass in carcasses() {
            let mut other = bench(carcass.clone(), |t| t.wheel.profile = shape.clone());
            let mut rig = bench(carcass, |_| ());
            for i in 1..10 {
                general_motion(&mut rig, i);
                general_motion(&mut other, i);
                for (k, (a, b)) in rig.evaluate().1.into_iter().zip(other.evaluate().1).enumerate() {
                    assert!((a - b).abs() < tolerance, "{}: {a} {b}", rig.plant.outputs()[k].name);
                }
            }
        }
    }
}

#[test]
fn limits_follow_law_and_crown() {
    let names = |rig: &Rig| rig.plant.limits().iter().map(|l| (l.name.to_string(), l.signal.clone())).collect::<Vec<_>>();
    let saturating = bench(deformable(None), |_| ());
    assert!(names(&saturating).contains(&("tire_saturated".into(), "tire.friction_use".into())));
    let endless = bench(deformable(None), |t| t.law = linear());
    assert!(names(&endless).iter().all(|(name, _)| name != "tire_saturated"));
    assert!(names(&endless).contains(&("wheel_lifted".into(), "tire.normal_force".into())));
    let g = [-0.9, -0.4, 0.0, 0.4, 0.9];
    let s: Vec<f64> = g.iter().map(|g: &f64| 0.24 + 0.06 * g.cos()).collect();
    let narrow = bench(deformable(None), |t| t.wheel.profile = Profile::table(&g, &s).expect("a table"));
    let camber: Vec<f64> = narrow.plant.limits().iter().filter(|l| l.name == "camber_limit").map(|l| l.threshold).collect();
    assert_eq!(camber, [0.9, -0.9]);
}

/// At rest the tire stands: no slip, no moment, no side force, the static load of its spring.
#[test]
fn at_rest_the_tire_only_carries() {
    for carcass in carcasses() {
        let mut rig = bench(carcass, |t| t.contact = RoadContact::Bonded);
        rig.set("carrier.heave", -0.008);
        solve_rates(&mut rig);
        let (r, z) = rig.evaluate();
        assert!(r.iter().chain(&z).all(|x| x.is_finite()));
        let load = rig.output("tire.normal_force");
        // the quadratic part of the vertical carcass adds 1 MN/m² · (8 mm)²
        assert!((load - 1200.0).abs() < 1e-9 || (load - 1264.0).abs() < 1e-9, "{load}");
        for name in ["lateral_force", "longitudinal_force", "rolling_moment", "aligning_moment", "slip_angle", "longitudinal_slip"] {
            assert!(rig.output(&format!("tire.{name}")).abs() < 1e-9, "{name}");
        }
    }
}
