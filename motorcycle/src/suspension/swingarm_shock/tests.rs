use super::*;
use crate::bench_tree::{Bench, tree};
use crate::suspension::linkage::tests::gsxr1000;
use mbody::force::{Damping, Force, SpringDamper, Stops};

fn law() -> SpringDamperLaw {
    SpringDamperLaw {
        damping: Damping::Bilinear { bump: 8e3, rebound: 13e3, rounding: 0.01 },
        stops: Some(Stops { lower: -0.01, upper: 0.012, stiffness: 1e6, width: 0.004 }),
        ..SpringDamperLaw::linear(2000.0, 58e3, 0.0)
    }
}

fn shock(geometry: ShockGeometry) -> Force {
    let design_length = geometry.length(0.0);
    Force::new("shock", SwingarmShock { joint: tree().1.arm, design_angle: 0.0, design_length, geometry, law: law() })
}

fn direct() -> ShockGeometry {
    // mounts at (0.4, 0, 0.7) on the chassis and (−0.2, 0, −0.02) on the arm, whose pivot is at (0.56, 0, 0.4)
    ShockGeometry::Direct { axis: Vec3::new(0.0, 1.0, 0.0), frame: Vec3::new(-0.16, 0.0, 0.3), arm: Vec3::new(-0.2, 0.0, -0.02) }
}

fn linkage() -> ShockGeometry {
    let shift = |p: Planar<f64>| p + Planar::new(0.011, 0.0392);
    let p = gsxr1000();
    let points = LinkagePoints {
        arm_pivot: shift(p.arm_pivot),
        rocker_pivot: shift(p.rocker_pivot),
        rocker_to_rod: shift(p.rocker_to_rod),
        rocker_to_shock: shift(p.rocker_to_shock),
        rod_on_arm: shift(p.rod_on_arm),
        shock_on_frame: shift(p.shock_on_frame),
    };
    ShockGeometry::Linkage { linkage: Linkage::new(points).unwrap(), sense: 1.0 }
}

#[test]
fn a_direct_shock_is_a_spring_damper_between_the_same_points() {
    let bodies = tree().1;
    let (from, to) = ((bodies.chassis, Vec3::new(0.4, 0.0, 0.7)), (bodies.arm, Vec3::new(-0.2, 0.0, -0.02)));
    let free_length = direct().length(0.0);
    let between = Force::new("shock", SpringDamper { from, to, free_length, law: law(), stop: "spring_stop" });
    let (mut a, mut b) = (Bench::new(vec![shock(direct())]), Bench::new(vec![between]));
    for angle in [-0.05, 0.0, 0.02, 0.09] {
        a.set("swingarm.angle", angle);
        b.set("swingarm.angle", angle);
        for (x, y) in a.efforts().iter().zip(b.efforts()) {
            assert!((x - y).abs() < 1e-8, "{x} against {y}");
        }
        for name in ["shock.force", "shock.length", "shock.compression"] {
            assert!((a.output(name) - b.output(name)).abs() < 1e-9);
        }
    }
}

#[test]
fn a_table_of_the_linkage_follows_the_linkage() {
    let angles: Vec<f64> = (0..29).map(|i| -0.14 + 0.01 * i as f64).collect();
    let lengths: Vec<f64> = angles.iter().map(|&a| linkage().length(a)).collect();
    let table = ShockGeometry::Table(CubicSpline::new(&angles, &lengths, Ends::NotAKnot).unwrap());
    let (mut a, mut b) = (Bench::new(vec![shock(linkage())]), Bench::new(vec![shock(table)]));
    for angle in [-0.043, 0.0, 0.037] {
        a.set("swingarm.angle", angle);
        b.set("swingarm.angle", angle);
        let (x, y) = (a.output("shock.motion_ratio"), b.output("shock.motion_ratio"));
        // the slope of a cubic spline errs by about h³ l⁗/24, here about 1e-6 of l
        assert!((x - y).abs() < 1e-6, "{x} against {y}");
    }
}

#[test]
fn the_shock_pushes_the_arm_down_and_says_where_it_ends() {
    let mut bench = Bench::new(vec![shock(linkage())]);
    bench.rest();
    assert!((bench.output("shock.force") - 2000.0).abs() < 1e-9);
    let moment = bench.output("shock.moment");
    // the motion ratio of the published equilibrium, 609.79 N m per 2006.19 N
    assert!((moment - 2000.0 * 609.79 / 2006.19).abs() < 0.01, "{moment}");
    assert!((bench.effort("swingarm.rate") + moment).abs() < 1e-9);
    bench.set("swingarm.angle", 0.02);
    assert!(bench.output("shock.compression") > 0.0);
    let limits = bench.limits();
    assert_eq!(limits.iter().map(|l| l.1.as_str()).collect::<Vec<_>>(), ["shock.compression", "shock.compression", "shock.linkage_margin"]);
    assert!(limits.iter().all(|l| l.0 == "suspension_stop"));
}

#[test]
fn derivatives_are_exact_and_energy_balances() {
    for geometry in [direct(), linkage()] {
        let mut bench = Bench::new(vec![shock(geometry)]);
        for (angle, rate) in [(-0.05, 0.8), (0.01, -0.3), (0.06, 0.5)] {
            bench.set("swingarm.angle", angle);
            bench.set("swingarm.rate", rate);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
