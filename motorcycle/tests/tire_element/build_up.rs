//! Side forces that build up over time.

use super::*;

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
