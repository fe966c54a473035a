//! A straight run of a chain between two sprockets.
//!
//! ```text
//! d = S2 − S1     D = |d|     u = d/D     v = u turned up     c = (r1 − r2)/D
//! m = c u + σ √(1 − c²) v     X1 = S1 + r1 m     X2 = S2 + r2 m     t = (X1 − X2)/|X1 − X2|
//! ```
//!
//! S1, S2 centers of the front and the rear sprocket, r1, r2 their pitch radii, m; σ = 1 for the upper, −1 for the lower run;
//! m normal of the run; X1, X2 tangent points; t direction of the run, from rear to front.
//!
//! Source: common tangents of two circles; V. Cossalter, *Motorcycle Dynamics* (2006), chapter 5. Range: sprockets apart, D > |r1 − r2|.

use crate::Planar;
use mbody::scalar::Real;

/// A sprocket in the plane of the chain.
#[derive(Clone, Copy, Debug)]
pub struct Sprocket<S> {
    /// Center.
    pub center: Planar<S>,
    /// Pitch radius, m.
    pub radius: f64,
}

/// Which of the two runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Run {
    /// The run that is tight when the engine drives.
    Upper,
    /// The run that is tight when the engine brakes.
    Lower,
}

/// Tangent points and direction of a run.
#[derive(Clone, Copy, Debug)]
pub struct ChainRun<S> {
    /// Tangent point on the front sprocket.
    pub front: Planar<S>,
    /// Tangent point on the rear sprocket.
    pub rear: Planar<S>,
    /// Unit vector from rear to front.
    pub direction: Planar<S>,
    /// Length, m.
    pub length: S,
}

impl<S: Real> ChainRun<S> {
    /// The run between a front and a rear sprocket.
    #[inline]
    pub fn between(front: Sprocket<S>, rear: Sprocket<S>, run: Run) -> Self {
        let d = rear.center - front.center;
        let inverse = d.norm().recip();
        let u = d.scaled(inverse);
        // normal of u that points up for a rear sprocket behind the front one
        let v = Planar::new(u.z, -u.x);
        let c = inverse * (front.radius - rear.radius);
        let side = (-(c * c) + 1.0).sqrt();
        let m = match run {
            Run::Upper => u.scaled(c) + v.scaled(side),
            Run::Lower => u.scaled(c) - v.scaled(side),
        };
        let tangent = |s: Sprocket<S>| s.center + m.scaled(S::from_f64(s.radius));
        let (x1, x2) = (tangent(front), tangent(rear));
        let span = x1 - x2;
        let length = span.norm();
        Self { front: x1, rear: x2, direction: span.scaled(length.recip()), length }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Sprockets of REF-11, the synthetic data set of this project, whose tangent points an independent prototype printed with six decimals.
    pub fn ref11() -> (Sprocket<f64>, Sprocket<f64>) {
        (Sprocket { center: [0.640, 0.420].into(), radius: 0.040 }, Sprocket { center: [0.0, 0.320].into(), radius: 0.105 })
    }

    fn assert_printed(value: Planar<f64>, x: f64, z: f64) {
        // six decimals are printed
        assert!((value.x - x).abs() < 5.1e-7 && (value.z - z).abs() < 5.1e-7, "{value:?} against {x}, {z}");
    }

    #[test]
    fn both_runs_of_the_worked_example() {
        let (front, rear) = ref11();
        let upper = ChainRun::between(front, rear, Run::Upper);
        assert_printed(upper.front, 0.637822, 0.459941);
        assert_printed(upper.rear, -0.005718, 0.424844);
        assert_printed(upper.direction, 0.998516, 0.054456);
        assert!((upper.length - 0.644496).abs() < 5.1e-7);
        let lower = ChainRun::between(front, rear, Run::Lower);
        // printed as 0.650109; the same formulas in 30-digit arithmetic give 0.65010959
        assert_printed(lower.front, 0.650110, 0.381299);
        assert_printed(lower.rear, 0.026538, 0.218409);
        assert_printed(lower.direction, 0.967534, 0.252740);
        let D2 = 0.64f64 * 0.64 + 0.1 * 0.1;
        assert!((lower.length - (D2 - 0.065f64 * 0.065).sqrt()).abs() < 1e-15);
    }
}
