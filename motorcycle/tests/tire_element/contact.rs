//! The road under the tire: lifting, rising, shapes of crowns, limits, rest.

use super::*;

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
