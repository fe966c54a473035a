//! Squat of a chain-driven rear suspension: what the thrust does to the spring.
//!
//! ```text
//! A = (line of the tight run) ∩ (line pivot – axle)     tan σ = (A_z − K_z)/(A_x − K_x)     R = (h/p)/tan σ
//! ```
//!
//! A squat point, m; K rear contact point; σ squat angle; h height of the mass center, p wheelbase, m; R squat ratio: 1 – the spring
//! does not move under thrust, above 1 – it is compressed, below 1 – it is extended.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics* (2006), chapter 6. Without spring moment the arm is a two-force member along
//! pivot – axle, so the force of the road must pass through A. Range: run and arm not parallel, A ahead of K.

use super::ChainRun;
use crate::Planar;
use mbody::scalar::Real;

/// Point A in which the run meets the line from the pivot of the arm to the axle of the wheel, m. Infinite where they are parallel.
#[inline]
pub fn squat_point<S: Real>(run: &ChainRun<S>, pivot: Planar<S>, axle: Planar<S>) -> Planar<S> {
    let arm = pivot - axle;
    let along = (axle - run.rear).cross(arm) / run.direction.cross(arm);
    run.rear + run.direction.scaled(along)
}

/// Tangent of the squat angle, from the rear contact point and the squat point.
#[inline]
pub fn squat_slope<S: Real>(contact: Planar<S>, squat_point: Planar<S>) -> S {
    let line = squat_point - contact;
    line.z / line.x
}

/// Squat ratio from the height of the mass center, the wheelbase and the tangent of the squat angle.
#[inline]
pub fn squat_ratio<S: Real>(height: S, wheelbase: S, squat_slope: S) -> S {
    height / (wheelbase * squat_slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivetrain::{Run, chain_run::tests::ref11};
    use mbody::scalar::Jet;

    #[test]
    fn squat_point_and_angle_of_the_worked_example() {
        let (front, rear) = ref11();
        let run = ChainRun::between(front, rear, Run::Upper);
        let A = squat_point(&run, [0.560, 0.400].into(), rear.center);
        assert!((A.x - 1.190618).abs() < 5.1e-7 && (A.z - 0.490088).abs() < 5.1e-7, "{A:?}");
        let slope = squat_slope([0.0, 0.0].into(), A);
        assert!((slope - 0.411625).abs() < 5.1e-7, "{slope}");
        assert!((squat_ratio(0.411625 * 1.42, 1.42, slope) - 1.0).abs() < 2e-6);
    }

    #[test]
    fn the_quantities_can_be_differentiated() {
        let at = |z: f64| {
            let (front, mut rear) = ref11();
            rear.center.z = z;
            let run = ChainRun::between(front, rear, Run::Upper);
            squat_slope([0.0, 0.0].into(), squat_point(&run, [0.560, 0.400].into(), rear.center))
        };
        let lift = |s: super::super::Sprocket<f64>, rate| super::super::Sprocket {
            center: Planar::new(Jet::constant(s.center.x), Jet::new(s.center.z, rate, 0.0)),
            radius: s.radius,
        };
        let (front, rear) = ref11();
        let (front, rear) = (lift(front, 0.0), lift(rear, 1.0));
        let run = ChainRun::between(front, rear, Run::Upper);
        let pivot = Planar::from_f64([0.560, 0.400].into());
        let slope = squat_slope(Planar::from_f64([0.0, 0.0].into()), squat_point(&run, pivot, rear.center));
        assert!((slope.d - (at(0.32 + 1e-5) - at(0.32 - 1e-5)) / 2e-5).abs() < 1e-6);
    }
}
