//! What every friction law is held to: exact derivatives, sane limits, left/right symmetry.
//!
//! For the tests of laws, here and in other crates: each function panics where a law breaks its condition.

use super::{AnyTireLaw, Friction, Slip, TireLaw};
use mbody::scalar::{Lanes, Real};

/// Quasi-random slips: load, lateral, longitudinal, camber, speed.
fn slips() -> impl Iterator<Item = [f64; 5]> {
    (1..200).map(|i| {
        let spread = |k: f64| 2.0 * (f64::from(i) * k).fract() - 1.0;
        [
            1500.0 + 1200.0 * spread(2f64.sqrt()),
            0.2 * spread(3f64.sqrt()),
            0.15 * spread(5f64.sqrt()),
            0.9 * spread(7f64.sqrt()),
            30.0 + 20.0 * spread(11f64.sqrt()),
        ]
    })
}

fn slip<S: Real>([load, lateral, longitudinal, camber, speed]: [S; 5]) -> Slip<S> {
    Slip { load, lateral, longitudinal, camber, speed }
}

fn numbers<S>(f: Friction<S>) -> [S; 6] {
    [f.longitudinal, f.lateral, f.overturning_moment, f.aligning_moment, f.utilization, f.rolling_moment]
}

fn evaluate(law: &impl TireLaw, at: [f64; 5]) -> [f64; 6] {
    numbers(law.friction(&slip(at)))
}

/// Exact derivatives of the six answers along the five quantities of a slip.
fn derivatives(law: &impl TireLaw, at: [f64; 5]) -> [[f64; 5]; 6] {
    let mut seeded = at.map(Lanes::<2>::from_f64);
    for (i, s) in seeded.iter_mut().enumerate() {
        s.set_derivative(i, 1.0);
    }
    numbers(law.friction(&slip(seeded))).map(|f| std::array::from_fn(|i| f.derivative(i)))
}

/// Dual numbers against central differences of the fourth order, to 1e-6 of the largest derivative of each answer.
///
/// # Panics
/// The law does not keep it.
pub fn derivatives_are_exact(law: &impl TireLaw) {
    let steps = [0.5, 2e-5, 2e-5, 1e-4, 0.01];
    for at in slips().filter(|at| at[1..4].iter().all(|x| x.abs() > 1e-3)) {
        let exact = derivatives(law, at);
        for (i, h) in steps.into_iter().enumerate() {
            let moved = |k: f64| {
                let mut there = at;
                there[i] += k * h;
                evaluate(law, there)
            };
            let (m2, m1, p1, p2) = (moved(-2.0), moved(-1.0), moved(1.0), moved(2.0));
            for j in 0..6 {
                let difference = (m2[j] - 8.0 * m1[j] + 8.0 * p1[j] - p2[j]) / (12.0 * h);
                // per step of the variable, so that loads in N and slips compare
                let scale = exact[j][i].abs().max((p1[j].abs() + 1e-3) / (at[i].abs() + 1e-3) * 1e-2);
                assert!((exact[j][i] - difference).abs() <= 1e-6 * scale, "answer {j} along {i} at {at:?}: {} {difference}", exact[j][i]);
            }
        }
    }
}

/// The mirror image of a slip gives the mirror image of the forces.
///
/// # Panics
/// The law does not keep it.
pub fn left_is_right_mirrored(law: &impl TireLaw) {
    for at in slips() {
        let [fx, fy, mx, mz, used, my] = evaluate(law, at);
        let mirrored = evaluate(law, [at[0], -at[1], at[2], -at[3], at[4]]);
        for (a, b) in mirrored.into_iter().zip([fx, -fy, -mx, -mz, used, my]) {
            assert!((a - b).abs() < 1e-9, "at {at:?}: {a} {b}");
        }
    }
}

/// Zero load, zero slip and a little negative load stay finite, with their derivatives.
///
/// # Panics
/// The law does not keep it.
pub fn corners_are_finite(law: &impl TireLaw) {
    for load in [-10.0, 0.0, 1e-9, 1000.0] {
        for at in [[load, 0.0, 0.0, 0.0, 20.0], [load, 0.0, 0.0, 0.5, 20.0], [load, 0.1, -1.0, -0.5, 0.1]] {
            assert!(evaluate(law, at).iter().all(|x| x.is_finite()), "at {at:?}");
            assert!(derivatives(law, at).as_flattened().iter().all(|x| x.is_finite()), "at {at:?}");
        }
        assert!(law.cornering_stiffness(load, 0.3).is_finite());
    }
}

/// The cornering stiffness is the slope of the side force of the upright tire.
///
/// # Panics
/// The law does not keep it.
pub fn stiffness_is_the_slope(law: &impl TireLaw) {
    for load in [400.0, 1100.0, 2500.0] {
        let slope = derivatives(law, [load, 0.0, 0.0, 0.0, 20.0])[1][1];
        assert!((law.cornering_stiffness(load, 0.0) / slope - 1.0).abs() < 1e-12, "at {load} N");
        assert!(slope > 0.0);
    }
}

/// Stored behind a pointer the law answers the same, for every scalar.
///
/// # Panics
/// The law does not keep it.
pub fn stored_law_is_the_same(law: impl TireLaw + Clone) {
    let stored = AnyTireLaw::new(law.clone());
    for at in slips().take(10) {
        assert_eq!(evaluate(&stored, at), evaluate(&law, at));
        assert_eq!(derivatives(&stored, at), derivatives(&law, at));
        assert_eq!(stored.cornering_stiffness(at[0], at[3]), law.cornering_stiffness(at[0], at[3]));
    }
}

/// Everything above.
///
/// # Panics
/// The law does not keep it.
pub fn holds(law: &(impl TireLaw + Clone)) {
    derivatives_are_exact(law);
    left_is_right_mirrored(law);
    corners_are_finite(law);
    stiffness_is_the_slope(law);
    stored_law_is_the_same(law.clone());
}
