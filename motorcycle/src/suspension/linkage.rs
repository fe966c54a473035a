//! Progressive linkage of a rear suspension in closed form: arm, pull rod, rocker, shock.
//!
//! ```text
//! A = P + R(a)(A₀ − P)        d = A − B        D = |d|        cos μ = (b² + D² − r²)/(2 b D)
//! rocker direction e = d/D turned by ±μ        E = B + (turn from e₀ to e)(E₀ − B)        l = |E − T|
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | a | rad | angle of the arm from the design pose, about y: positive in bump |
//! | P, B, T | m | pivot of the arm, pivot of the rocker, upper mount of the shock, on the frame |
//! | A, E | m | end of the rod on the arm, lower mount of the shock on the rocker; index 0: design pose |
//! | r, b | m | length of the rod, distance of its end on the rocker from B |
//! | l | m | length of the shock |
//!
//! Source: planar four-bar by the law of cosines (any book on mechanisms, e.g. J. J. Uicker, G. R. Pennock, J. E. Shigley, *Theory of Machines
//! and Mechanisms*, chapter 2); no mass in rod and rocker. The branch (±) is that of the design pose.
//! Range: the dead centers `cos² μ = 1`, where rod and rocker are in line. Beyond them the rocker stays along d, as if the rod were
//! elastic: finite, but meaningless, and declared as a limit on [`Linkage::margin`].

use crate::Planar;
use mbody::scalar::Real;
use thiserror::Error;

/// Points of the linkage in the design pose: [x, z] in the frame of the body that carries the arm.
#[derive(Clone, Copy, Debug)]
pub struct LinkagePoints {
    /// Pivot of the arm.
    pub arm_pivot: Planar<f64>,
    /// Pivot of the rocker on the frame.
    pub rocker_pivot: Planar<f64>,
    /// End of the rod on the rocker.
    pub rocker_to_rod: Planar<f64>,
    /// Lower mount of the shock, on the rocker.
    pub rocker_to_shock: Planar<f64>,
    /// End of the rod on the arm.
    pub rod_on_arm: Planar<f64>,
    /// Upper mount of the shock, on the frame.
    pub shock_on_frame: Planar<f64>,
}

/// Why points make no linkage.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LinkageError {
    /// Two points that must be apart coincide.
    #[error("`{first}` and `{second}` coincide in the design pose")]
    Coincide {
        /// One point.
        first: &'static str,
        /// The other point.
        second: &'static str,
    },
    /// Rod and rocker are in line, so that the rocker could turn either way.
    #[error("pull rod and rocker are in line in the design pose (within {degrees:.2} degrees): the linkage is at a dead center")]
    DeadCenter {
        /// Angle between the rod-side arm of the rocker and the line of the centers.
        degrees: f64,
    },
}

/// A linkage, ready for evaluation.
#[derive(Clone, Copy, Debug)]
pub struct Linkage {
    points: LinkagePoints,
    rod: f64,
    rocker: f64,
    /// Direction of the rocker in the design pose.
    direction: Planar<f64>,
    /// 1 or −1: on which side of the line of centers the rocker stands.
    branch: f64,
}

impl Linkage {
    /// Smallest sin² of the angle of the rocker against the line of centers that a design pose may have: 1 degree.
    const MARGIN_NEEDED: f64 = 3e-4;
    /// Rounding of sin² at the dead centers; changes lengths inside by less than 1e-14 of themselves.
    const ROUNDING: f64 = 1e-9;

    /// The linkage that fits together in the design pose.
    ///
    /// # Errors
    /// Coinciding points; a design pose at a dead center.
    pub fn new(points: LinkagePoints) -> Result<Self, LinkageError> {
        let LinkagePoints { arm_pivot, rocker_pivot, rocker_to_rod, rocker_to_shock, rod_on_arm, shock_on_frame } = points;
        for (first, p, second, q) in [
            ("the pivot of the arm", arm_pivot, "rod_on_arm", rod_on_arm),
            ("rocker_pivot", rocker_pivot, "rocker_to_rod", rocker_to_rod),
            ("rocker_pivot", rocker_pivot, "rocker_to_shock", rocker_to_shock),
            ("rocker_pivot", rocker_pivot, "rod_on_arm", rod_on_arm),
            ("rocker_to_rod", rocker_to_rod, "rod_on_arm", rod_on_arm),
            ("rocker_to_shock", rocker_to_shock, "shock_on_frame", shock_on_frame),
        ] {
            if (p - q).norm() < 1e-6 {
                return Err(LinkageError::Coincide { first, second });
            }
        }
        let (e, d) = (rocker_to_rod - rocker_pivot, rod_on_arm - rocker_pivot);
        let rocker = e.norm();
        let direction = e.scaled(1.0 / rocker);
        let sine = d.scaled(1.0 / d.norm()).cross(direction);
        if sine * sine < Self::MARGIN_NEEDED {
            return Err(LinkageError::DeadCenter { degrees: sine.abs().asin().to_degrees() });
        }
        Ok(Self { points, rod: (rod_on_arm - rocker_to_rod).norm(), rocker, direction, branch: sine.signum() })
    }

    /// From the rocker pivot to the rod end on the arm: unit vector and cos μ, at the arm angle a from the design pose.
    #[inline]
    fn center_line<S: Real>(&self, a: S) -> (Planar<S>, S) {
        let p = &self.points;
        let (sin, cos) = a.sin_cos();
        let arm = Planar::from_f64(p.rod_on_arm - p.arm_pivot).turned(cos, sin);
        let d = arm + Planar::from_f64(p.arm_pivot - p.rocker_pivot);
        let D = d.norm();
        let cos_mu = (D * D + (self.rocker * self.rocker - self.rod * self.rod)) / (D * (2.0 * self.rocker));
        (d.scaled(D.recip()), cos_mu)
    }

    /// sin² μ: zero at the dead centers, negative where the linkage cannot be assembled.
    #[inline]
    pub fn margin<S: Real>(&self, a: S) -> S {
        let (_, cos_mu) = self.center_line(a);
        -(cos_mu * cos_mu) + 1.0
    }

    /// Length of the shock, m, at the arm angle a from the design pose.
    #[inline]
    pub fn length<S: Real>(&self, a: S) -> S {
        let p = &self.points;
        let (u, cos_mu) = self.center_line(a);
        let sin_mu = positive_part(-(cos_mu * cos_mu) + 1.0, Self::ROUNDING).sqrt() * self.branch;
        let beyond = (cos_mu * cos_mu + sin_mu * sin_mu).sqrt().recip();
        let e = u.turned(cos_mu * beyond, sin_mu * beyond);
        // turn of the rocker since the design pose, without its angle
        let e0 = Planar::from_f64(self.direction);
        let lower = Planar::from_f64(p.rocker_to_shock - p.rocker_pivot).turned(e0.dot(e), e0.cross(e));
        (lower + Planar::from_f64(p.rocker_pivot - p.shock_on_frame)).norm()
    }
}

/// `(x + √(x² + 4e²))/2` without cancellation: its root can be differentiated far below zero.
#[inline]
fn positive_part<S: Real>(x: S, e: f64) -> S {
    let root = (x * x + 4.0 * e * e).sqrt();
    if x.value() >= 0.0 { (x + root) * 0.5 } else { (root - x).recip() * (2.0 * e * e) }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use mbody::scalar::Jet;

    /// Suzuki GSX-R1000: R. S. Sharp, S. Evangelou, D. J. N. Limebeer, Multibody System Dynamics 12 (2004) 251–283,
    /// points p11, p13, p19–p22 as in the public EoM and MotorcycleLib models.
    pub fn gsxr1000() -> LinkagePoints {
        LinkagePoints {
            arm_pivot: [0.549, 0.3608].into(),
            rocker_pivot: [0.539, 0.1878].into(),
            rocker_to_rod: [0.4946, 0.1522].into(),
            rocker_to_shock: [0.4443, 0.1782].into(),
            rod_on_arm: [0.3722, 0.2748].into(),
            shock_on_frame: [0.487, 0.4888].into(),
        }
    }

    /// The four-bar again, as a root search over the angle of the rocker.
    fn length_by_search(p: &LinkagePoints, a: f64) -> f64 {
        let rod = (p.rod_on_arm - p.rocker_to_rod).norm();
        let arm = p.arm_pivot + (p.rod_on_arm - p.arm_pivot).turned(a.cos(), a.sin());
        let turned = |q: Planar<f64>, angle: f64| p.rocker_pivot + (q - p.rocker_pivot).turned(angle.cos(), angle.sin());
        let gap = |angle: f64| (turned(p.rocker_to_rod, angle) - arm).norm() - rod;
        let (mut low, mut high) = (-0.8, 0.8);
        assert!(gap(low) * gap(high) < 0.0, "no change of sign at {a}");
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if gap(low) * gap(middle) <= 0.0 { high = middle } else { low = middle }
        }
        (turned(p.rocker_to_shock, 0.5 * (low + high)) - p.shock_on_frame).norm()
    }

    #[test]
    fn length_agrees_with_a_root_search() {
        let (points, linkage) = (gsxr1000(), Linkage::new(gsxr1000()).unwrap());
        for a in [-0.1, -0.05, 0.0, 0.03, 0.08, 0.13] {
            let (closed, search) = (linkage.length(a), length_by_search(&points, a));
            assert!((closed - search).abs() < 1e-12, "at {a}: {closed} against {search}");
        }
    }

    #[test]
    fn slope_agrees_with_finite_differences() {
        let linkage = Linkage::new(gsxr1000()).unwrap();
        for a in [-0.1, 0.0, 0.1] {
            let jet = linkage.length(Jet::new(a, 1.0, 0.0));
            let h = 1e-4;
            let (minus, here, plus) = (linkage.length(a - h), linkage.length(a), linkage.length(a + h));
            // errors of the differences: h² l‴/6 and rounding over h²
            assert!((jet.d - (plus - minus) / (2.0 * h)).abs() < 1e-7);
            assert!((jet.dd - (plus - 2.0 * here + minus) / (h * h)).abs() < 1e-5);
        }
    }

    #[test]
    fn the_published_static_equilibrium_of_the_arm_follows() {
        // archived output of BPMinaker/eom_pkg 4f19e5c (2019-01-18): rear axle and rear spring forces, N
        let axle = 1161.191350;
        let spring = f64::hypot(273.233130, 1987.499070);
        let rod = (2317.812110, -2321.599390);
        // moments about the pivot p11 of the axle force at p7 and the weight of the arm (8 kg at x = 0.196 m), positive in bump
        let bump = axle * (0.549 - 0.0) - 8.0 * 9.81 * (0.549 - 0.196);
        let slope = Linkage::new(gsxr1000()).unwrap().length(Jet::new(0.0, 1.0, 0.0)).d;
        assert!((-spring * slope - bump).abs() < 2e-4, "{} against {bump} N m", -spring * slope);
        // and the printed rod force gives the same moment at p22
        let from_rod = (0.2748 - 0.3608) * rod.0 - (0.3722 - 0.549) * rod.1;
        assert!((from_rod + bump).abs() < 2e-4);
    }

    #[test]
    fn beyond_the_dead_center_lengths_stay_finite_and_the_margin_turns_negative() {
        let linkage = Linkage::new(gsxr1000()).unwrap();
        let mut dead = false;
        for i in 0..=200 {
            let jet = linkage.length(Jet::new(-1.5 + 0.015 * i as f64, 1.0, 0.0));
            assert!(jet.x.is_finite() && jet.d.is_finite());
            dead |= linkage.margin(-1.5 + 0.015 * i as f64) < 0.0;
        }
        assert!(dead);
        assert!(linkage.margin(0.0) > 0.1);
    }

    #[test]
    fn impossible_design_poses_are_refused() {
        let mut points = gsxr1000();
        let line = points.rod_on_arm - points.rocker_pivot;
        points.rocker_to_rod = points.rocker_pivot + line.scaled(0.4);
        assert!(matches!(Linkage::new(points), Err(LinkageError::DeadCenter { .. })));
        points.rocker_to_rod = points.rocker_pivot;
        let coincide = LinkageError::Coincide { first: "rocker_pivot", second: "rocker_to_rod" };
        assert_eq!(Linkage::new(points).unwrap_err(), coincide);
    }
}
