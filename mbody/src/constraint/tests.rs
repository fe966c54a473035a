//! Every law against difference quotients along a motion, and its wrenches against its rates.

use super::*;
use crate::contact::Profile;
use crate::joint::{JointLaw, VehicleBase, from_jet};
use crate::model::BodyIndex;
use crate::spatial::{Pose, Rotation, Vec3, Wrench};

/// One of each kind and variant.
fn every() -> Vec<Constraint> {
    let place = Place { body: BodyIndex::WORLD, X_BF: Pose::identity() };
    let slanted = Vec3::new(0.36, 0.48, 0.8);
    let y = Vec3::new(0.0, 1.0, 0.0);
    let torus = || Profile::torus(0.3, 0.06).expect("a torus");
    let mut all = Vec::new();
    let kinds = [CutKind::Fixed, CutKind::Revolute, CutKind::Prismatic, CutKind::Screw(0.02), CutKind::Universal, CutKind::Spherical];
    for kind in kinds.into_iter().chain([CutKind::Planar]) {
        for axis in [y, slanted] {
            all.push(Constraint::new(format!("{kind:?}"), place, place, CutJoint::new(kind, axis)));
        }
    }
    all.push(Constraint::new("distance", place, place, Distance { length: 0.4 }));
    for point in [HeldPoint::at_point(), HeldPoint::on_line(slanted), HeldPoint::on_plane(y)] {
        all.push(Constraint::new("point", place, place, point));
    }
    all.push(Constraint::new("touching", place, place, SurfaceContact::new(torus(), y)));
    all.push(Constraint::new("torus", place, place, Rolling::new(torus(), y)));
    all.push(Constraint::new("knife edge", place, place, Rolling::new(Profile::disc(0.3).expect("a disc"), y)));
    all
}

/// Motion of the second frame in the first: coordinates of a vehicle base with constant velocities.
struct Path {
    q: Vec<f64>,
    v: Vec<f64>,
}

impl Path {
    /// Coordinates after a short time, by one step of the classical Runge–Kutta method.
    fn at(&self, h: f64) -> Vec<f64> {
        let rate = |q: &[f64]| {
            let mut rate = vec![0.0; 6];
            VehicleBase.rates(q, &self.v, &mut rate);
            rate
        };
        let step = |k: &[f64], h: f64| self.q.iter().zip(k).map(|(q, k)| q + h * k).collect::<Vec<f64>>();
        let k1 = rate(&self.q);
        let k2 = rate(&step(&k1, h / 2.0));
        let k3 = rate(&step(&k2, h / 2.0));
        let k4 = rate(&step(&k3, h));
        (0..6).map(|i| self.q[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect()
    }

    fn motion(&self, h: f64) -> RelativeMotion<f64> {
        let q = self.at(h);
        let (V_FM, A_FM) = from_jet(&VehicleBase, &q, &self.v);
        RelativeMotion { X_FM: VehicleBase.pose(&q), V_FM, A_FM }
    }
}

fn paths() -> impl Iterator<Item = Path> {
    (1..12).map(|i| {
        let spread = |k: f64| 2.0 * (f64::from(i) * k).fract() - 1.0;
        let q = [0.618, 0.755, 0.8192, 0.1231, 0.4142, 0.732].map(spread).to_vec();
        let v = [0.6458, 0.3166, 0.2361, 0.5321, 0.8794, 0.3473].map(|k| 2.0 * spread(k)).to_vec();
        Path { q: q.iter().zip([0.1, 0.1, 2.0, 0.3, 0.8, 0.9]).map(|(q, s)| q * s).collect(), v }
    })
}

fn values(c: &Constraint, motion: &RelativeMotion<f64>) -> Vec<RowValue<f64>> {
    let mut rows = vec![RowValue::default(); c.rows().len()];
    c.of_motion(motion, &mut rows, &mut vec![Wrench::zero(); c.rows().len()]);
    rows
}

#[test]
fn rates_and_accelerations_are_those_of_the_error() {
    const H: f64 = 1e-4;
    for c in every() {
        for path in paths() {
            let [before, now, after] = [-H, 0.0, H].map(|h| values(&c, &path.motion(h)));
            for (k, row) in c.rows().iter().enumerate() {
                let slope = |f: fn(&RowValue<f64>) -> f64| (f(&after[k]) - f(&before[k])) / (2.0 * H);
                if row.level == Level::Position {
                    let quotient = slope(|r| r.error);
                    // third derivatives of up to some 1e3 per s³ (the screw turns 50 times faster) times H²/6
                    assert!((now[k].rate - quotient).abs() < 1e-5 * (1.0 + quotient.abs()) * 10.0, "{c:?} {row:?}");
                }
                let quotient = slope(|r| r.rate);
                assert!((now[k].acceleration - quotient).abs() < 1e-3 * (1.0 + quotient.abs()), "{c:?} {row:?}");
            }
        }
    }
}

#[test]
fn the_power_of_a_unit_multiplier_is_the_rate_of_its_row() {
    for c in every() {
        for path in paths() {
            let motion = path.motion(0.0);
            let rows = values(&c, &motion);
            let mut wrenches = vec![Wrench::zero(); rows.len()];
            c.of_motion(&motion, &mut rows.clone(), &mut wrenches);
            for (row, F) in rows.iter().zip(&wrenches) {
                let power = motion.V_FM.dot(*F);
                assert!((power - row.rate).abs() < 1e-12 * (1.0 + power.abs()), "{c:?}");
            }
        }
    }
}

#[test]
fn a_closed_joint_has_no_error_and_its_own_motion_has_no_rate() {
    let slanted = Vec3::new(0.36, 0.48, 0.8);
    let place = Place { body: BodyIndex::WORLD, X_BF: Pose::identity() };
    let turned = Rotation::about_axis(slanted, 2.5);
    let slid = |p: f64| slanted * p;
    let cases = [
        (CutKind::Revolute, Pose::new(turned, Vec3::zero())),
        (CutKind::Prismatic, Pose::new(Rotation::identity(), slid(0.7))),
        (CutKind::Screw(0.02), Pose::new(turned, slid(0.05))),
        (CutKind::Spherical, Pose::new(turned, Vec3::zero())),
    ];
    for (kind, X_FM) in cases {
        let c = Constraint::new("loop", place, place, CutJoint::new(kind, slanted));
        let still = RelativeMotion { X_FM, V_FM: Default::default(), A_FM: Default::default() };
        assert!(values(&c, &still).iter().all(|r| r.error.abs() < 1e-15), "{kind:?} {:?}", values(&c, &still));
    }
}

#[test]
fn a_wheel_that_rolls_straight_does_not_slip() {
    let place = Place { body: BodyIndex::WORLD, X_BF: Pose::identity() };
    let c = Constraint::new("wheel", place, place, Rolling::new(Profile::disc(0.3).expect("a disc"), Vec3::new(0.0, 1.0, 0.0)));
    let X_FM = Pose::new(Rotation::about_y(1.1), Vec3::new(5.0, 2.0, 0.3));
    let spin = Vec3::new(0.0, 10.0, 0.0);
    let v = X_FM.R.inverse_times(Vec3::new(3.0, 0.0, 0.0));
    let motion = RelativeMotion { X_FM, V_FM: crate::spatial::Twist::new(spin, v), A_FM: Default::default() };
    let rows = values(&c, &motion);
    assert!(rows.iter().all(|r| r.error.abs() < 1e-15 && r.rate.abs() < 1e-14));
    let mut wrenches = [Wrench::zero(); 3];
    c.of_motion(&motion, &mut rows.clone(), &mut wrenches);
    // the normal force points up, through the center
    assert!((X_FM.R * wrenches[0].f - Vec3::new(0.0, 0.0, 1.0)).norm() < 1e-15 && wrenches[0].n.norm() < 1e-15);
    // the longitudinal force points forward and brakes the spin
    assert!((X_FM.R * wrenches[1].f - Vec3::new(1.0, 0.0, 0.0)).norm() < 1e-15 && (wrenches[1].n.y + 0.3).abs() < 1e-15);
}
