//! Exact derivatives, symmetries, balance of power.

use super::*;

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
