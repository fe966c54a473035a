//! Cross-sections of a round body through its axle: disc, torus, ellipse, table.
//!
//! The meridian is convex and given by its support function S(g): the distance from the center of the body to the tangent
//! whose outward normal makes the angle g with the plane of the body. The point that touches this tangent is
//!
//! ```text
//! a = S cos g − S' sin g        b = S sin g + S' cos g        ρ = S + S'' > 0        S = a cos g + b sin g
//! torus    a = Rc + ρ cos g,        b = ρ sin g,          Rc = R − ρ
//! ellipse  a = Rc + A² cos g / q,   b = B² sin g / q,     Rc = R − A,   q = √(A² cos² g + B² sin² g)
//! ```
//!
//! a distance below the axle, b distance to the right of the mid-plane, ρ radius of curvature of the meridian, R radius on
//! the mid-plane, A and B radial and lateral semi-axis (all m); g rad, positive where the body leans right.
//!
//! Source: support function of a convex curve, e.g. M. do Carmo, *Differential Geometry of Curves and Surfaces*, 1976,
//! section 5.7.
//! Range: |g| < 90 degrees. A table goes on outside its knots as a circular arc of the last radius.

use super::rolling::ContactFrame;
use crate::scalar::spline::{CurveError, Ends};
use crate::scalar::{CubicSpline, Real};

/// Point of the meridian that touches a tangent of given inclination.
#[derive(Clone, Copy, Debug)]
pub struct Meridian<S> {
    /// Distance below the axle, in the plane of the body, m.
    pub a: S,
    /// Distance to the right of the plane of the body, m.
    pub b: S,
}

/// Why data do not make a profile.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// A length that must be positive is not.
    #[error("the {length} of the profile must be positive, but is {value} m")]
    NotPositive {
        /// Which length.
        length: &'static str,
        /// Its value, m.
        value: f64,
    },
    /// The cross-section is larger than the body.
    #[error("the {length} of the profile, {value} m, exceeds the radius, {radius} m")]
    BeyondRadius {
        /// Which length.
        length: &'static str,
        /// Its value, m.
        value: f64,
        /// Radius on the mid-plane, m.
        radius: f64,
    },
    /// A support function that bends outward: no convex body has it.
    #[error("the profile is not convex: its radius of curvature is {curvature_radius} m at an inclination of {inclination} rad")]
    NotConvex {
        /// Inclination, rad.
        inclination: f64,
        /// Radius of curvature there, m.
        curvature_radius: f64,
    },
    /// A table that does not reach both sides of the mid-plane, nor starts on it.
    #[error("the table must start at inclination 0 or hold it inside, but runs from {first} rad to {last} rad")]
    OneSided {
        /// First inclination, rad.
        first: f64,
        /// Last inclination, rad.
        last: f64,
    },
    /// The points of the table.
    #[error("the table of the profile: {0}")]
    Table(#[from] CurveError),
}

/// Cross-section of a round body.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A sharp edge.
    Disc {
        /// Radius, m.
        radius: f64,
    },
    /// A circular arc.
    Torus {
        /// Radius on the mid-plane, m.
        radius: f64,
        /// Radius of the arc, m.
        crown_radius: f64,
    },
    /// Part of an ellipse whose axes lie in the mid-plane and across it.
    Ellipse {
        /// Radius on the mid-plane, m.
        radius: f64,
        /// Semi-axis A in the mid-plane, m.
        radial_semi_axis: f64,
        /// Semi-axis B across it, m.
        lateral_semi_axis: f64,
    },
    /// A measured shape.
    Table(SupportTable),
}

impl Profile {
    /// A disc with a sharp edge.
    ///
    /// # Errors
    /// A radius that is not positive.
    pub fn disc(radius: f64) -> Result<Self, ProfileError> {
        positive("radius", radius)?;
        Ok(Self::Disc { radius })
    }

    /// A torus; a crown radius of 0 gives a disc.
    ///
    /// # Errors
    /// A radius that is not positive, a crown radius that is negative or exceeds the radius.
    pub fn torus(radius: f64, crown_radius: f64) -> Result<Self, ProfileError> {
        positive("radius", radius)?;
        if crown_radius == 0.0 {
            return Ok(Self::Disc { radius });
        }
        within("crown radius", crown_radius, radius)?;
        Ok(Self::Torus { radius, crown_radius })
    }

    /// An elliptic cross-section.
    ///
    /// # Errors
    /// Lengths that are not positive, a radial semi-axis that exceeds the radius.
    pub fn ellipse(radius: f64, radial_semi_axis: f64, lateral_semi_axis: f64) -> Result<Self, ProfileError> {
        positive("radius", radius)?;
        within("radial semi-axis", radial_semi_axis, radius)?;
        positive("lateral semi-axis", lateral_semi_axis)?;
        Ok(Self::Ellipse { radius, radial_semi_axis, lateral_semi_axis })
    }

    /// A table of the support function over the inclination, rad and m. A table that starts at 0 is mirrored.
    ///
    /// # Errors
    /// Fewer than four points, inclinations that do not increase or lie on one side only, a shape that is not convex.
    pub fn table(inclinations: &[f64], supports: &[f64]) -> Result<Self, ProfileError> {
        SupportTable::new(inclinations, supports).map(Self::Table)
    }

    /// Radius on the mid-plane, m.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Disc { radius } | Self::Torus { radius, .. } | Self::Ellipse { radius, .. } => *radius,
            Self::Table(table) => table.at(0.0).0,
        }
    }

    /// First and last inclination that were measured, rad; `None` for shapes that are known everywhere.
    pub fn measured_range(&self) -> Option<(f64, f64)> {
        match self {
            Self::Table(table) => Some(table.spline.range()),
            _ => None,
        }
    }

    /// The point that touches a tangent of inclination g, rad.
    #[inline]
    pub fn meridian<S: Real>(&self, g: S) -> Meridian<S> {
        let (sin, cos) = g.sin_cos();
        self.meridian_of(g, sin, cos)
    }

    /// The point that touches the plane of a contact frame: [`Self::meridian`] without trigonometry.
    #[inline]
    pub fn meridian_at<S: Real>(&self, frame: &ContactFrame<S>) -> Meridian<S> {
        self.meridian_of(frame.camber, frame.sin_camber, frame.cos_camber)
    }

    /// Distance S(g) from the center to the tangent of inclination g, m.
    pub fn support<S: Real>(&self, g: S) -> S {
        let (sin, cos) = g.sin_cos();
        let Meridian { a, b } = self.meridian_of(g, sin, cos);
        a * cos + b * sin
    }

    /// Radius of curvature of the meridian at inclination g, m; 0 for a sharp edge.
    pub fn curvature_radius(&self, g: f64) -> f64 {
        match self {
            Self::Disc { .. } => 0.0,
            Self::Torus { crown_radius, .. } => *crown_radius,
            Self::Ellipse { radial_semi_axis, lateral_semi_axis, .. } => {
                let (s, c) = g.sin_cos();
                let q = f64::hypot(radial_semi_axis * c, lateral_semi_axis * s);
                (radial_semi_axis * lateral_semi_axis).powi(2) / q.powi(3)
            }
            Self::Table(table) => table.curvature_radius(g),
        }
    }

    #[inline]
    fn meridian_of<S: Real>(&self, g: S, sin: S, cos: S) -> Meridian<S> {
        match self {
            Self::Disc { radius } => Meridian { a: S::from_f64(*radius), b: S::zero() },
            Self::Torus { radius, crown_radius } => Meridian { a: cos * *crown_radius + (radius - crown_radius), b: sin * *crown_radius },
            Self::Ellipse { radius, radial_semi_axis, lateral_semi_axis } => {
                let (a2, b2) = (radial_semi_axis.powi(2), lateral_semi_axis.powi(2));
                let per_q = (cos * cos * a2 + sin * sin * b2).sqrt().recip();
                Meridian { a: cos * per_q * a2 + (radius - radial_semi_axis), b: sin * per_q * b2 }
            }
            Self::Table(table) => {
                let (support, slope) = table.at(g);
                Meridian { a: support * cos - slope * sin, b: support * sin + slope * cos }
            }
        }
    }
}

fn positive(length: &'static str, value: f64) -> Result<(), ProfileError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ProfileError::NotPositive { length, value }) }
}

fn within(length: &'static str, value: f64, radius: f64) -> Result<(), ProfileError> {
    positive(length, value)?;
    if value <= radius { Ok(()) } else { Err(ProfileError::BeyondRadius { length, value, radius }) }
}

/// A support function with two continuous derivatives through measured points.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportTable {
    spline: CubicSpline,
}

impl SupportTable {
    fn new(inclinations: &[f64], supports: &[f64]) -> Result<Self, ProfileError> {
        let (g, s) = mirrored(inclinations, supports);
        let spline = CubicSpline::new(&g, &s, Ends::NotAKnot)?;
        let (first, last) = spline.range();
        if first > 0.0 || last < 0.0 {
            return Err(ProfileError::OneSided { first, last });
        }
        let table = Self { spline };
        positive("radius", table.at(0.0).0)?;
        table.check_convex()?;
        Ok(table)
    }

    /// S'' is linear between knots and |S'| is bounded there, so knots and a few places between tell.
    fn check_convex(&self) -> Result<(), ProfileError> {
        for k in self.spline.knots().windows(2) {
            for part in 0..=8 {
                let inclination = k[0] + (k[1] - k[0]) * f64::from(part) / 8.0;
                let curvature_radius = self.curvature_radius(inclination);
                if curvature_radius <= 0.0 {
                    return Err(ProfileError::NotConvex { inclination, curvature_radius });
                }
            }
        }
        Ok(())
    }

    fn curvature_radius(&self, g: f64) -> f64 {
        let (first, last) = self.spline.range();
        let p = self.spline.at(g.clamp(first, last));
        p.value + p.curvature
    }

    /// S and S' at g.
    fn at<S: Real>(&self, g: S) -> (S, S) {
        let (first, last) = self.spline.range();
        if g.value() < first {
            self.arc(first, g)
        } else if g.value() > last {
            self.arc(last, g)
        } else {
            let p = self.spline.at(g);
            (p.value, p.slope)
        }
    }

    /// Beyond a knot: S = ρ + (S₁ − ρ) cos u + S₁' sin u, a circle with the last radius of curvature.
    fn arc<S: Real>(&self, knot: f64, g: S) -> (S, S) {
        let end = self.spline.at(knot);
        let rho = end.value + end.curvature;
        let (sin, cos) = (g - knot).sin_cos();
        (cos * (end.value - rho) + sin * end.slope + rho, cos * end.slope - sin * (end.value - rho))
    }
}

/// A table that starts on the mid-plane holds for both sides.
fn mirrored(g: &[f64], s: &[f64]) -> (Vec<f64>, Vec<f64>) {
    if g.first() != Some(&0.0) || g.len() != s.len() {
        return (g.to_vec(), s.to_vec());
    }
    let left = g.iter().skip(1).rev().map(|g| -g);
    (left.chain(g.iter().copied()).collect(), s.iter().skip(1).rev().chain(s).copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Jet;

    const ANGLES: [f64; 7] = [-1.2, -0.6, -0.05, 0.0, 0.3, 0.8, 1.3];

    fn profiles() -> Vec<Profile> {
        let g: Vec<f64> = (0..=12).map(|i| 0.1 * f64::from(i)).collect();
        let ellipse = Profile::ellipse(0.3, 0.05, 0.08).unwrap();
        let s: Vec<f64> = g.iter().map(|g| ellipse.support(*g)).collect();
        vec![Profile::disc(0.3).unwrap(), Profile::torus(0.3, 0.06).unwrap(), ellipse, Profile::table(&g, &s).unwrap()]
    }

    #[test]
    fn the_point_and_the_slope_follow_from_the_support_function() {
        for profile in profiles() {
            for g in ANGLES {
                let s = profile.support(Jet::new(g, 1.0, 0.0));
                let (m, (sin, cos)) = (profile.meridian(g), g.sin_cos());
                assert!((m.a - (s.x * cos - s.d * sin)).abs() < 1e-14, "{profile:?} at {g}");
                assert!((m.b - (s.x * sin + s.d * cos)).abs() < 1e-14, "{profile:?} at {g}");
                assert!((profile.curvature_radius(g) - (s.x + s.dd)).abs() < 1e-12, "{profile:?} at {g}");
            }
        }
    }

    #[test]
    fn moving_along_the_meridian_is_moving_along_its_tangent() {
        for profile in profiles() {
            for g in ANGLES {
                let m = profile.meridian(Jet::new(g, 1.0, 0.0));
                assert!((m.a.d * g.cos() + m.b.d * g.sin()).abs() < 1e-14, "{profile:?} at {g}");
            }
        }
    }

    #[test]
    fn an_ellipse_with_equal_axes_is_a_torus() {
        let (torus, ellipse) = (Profile::torus(0.3, 0.06).unwrap(), Profile::ellipse(0.3, 0.06, 0.06).unwrap());
        for g in ANGLES {
            let (t, e) = (torus.meridian(Jet::new(g, 1.0, 0.3)), ellipse.meridian(Jet::new(g, 1.0, 0.3)));
            assert!((t.a.x - e.a.x).abs() < 1e-15 && (t.b.x - e.b.x).abs() < 1e-15);
            assert!((t.a.dd - e.a.dd).abs() < 1e-14 && (t.b.dd - e.b.dd).abs() < 1e-14);
        }
    }

    #[test]
    fn a_table_of_the_support_of_a_circle_is_the_circle() {
        let torus = Profile::torus(0.3, 0.06).unwrap();
        let g: Vec<f64> = (0..=25).map(|i| 0.04 * f64::from(i)).collect();
        let s: Vec<f64> = g.iter().map(|g| torus.support(*g)).collect();
        let table = Profile::table(&g, &s).unwrap();
        assert!((table.radius() - 0.3).abs() < 1e-15);
        for g in ANGLES {
            let (t, m) = (torus.meridian(g), table.meridian(g));
            // inside, S' errs by 0.24 h³/24 = 6e-7 m; the last S'' is continued straight over one interval, so the arc outside
            // has a radius wrong by up to 0.24 h² = 4e-4 m, seen over 0.3 rad
            let tolerance = if g.abs() > 1.0 { 0.3 * 4e-4 } else { 1e-6 };
            assert!((t.a - m.a).abs() < tolerance && (t.b - m.b).abs() < tolerance, "at {g}: {t:?} {m:?}");
        }
    }

    #[test]
    fn a_table_stays_twice_differentiable_across_its_end() {
        let table = profiles().pop().unwrap();
        let support = |g: f64| table.support(Jet::new(g, 1.0, 0.0));
        let (inside, outside) = (support(1.2 - 1e-9), support(1.2 + 1e-9));
        assert!((inside.d - outside.d).abs() < 1e-8 && (inside.dd - outside.dd).abs() < 1e-6);
    }

    #[test]
    fn impossible_shapes_are_refused() {
        assert_eq!(Profile::disc(-0.3), Err(ProfileError::NotPositive { length: "radius", value: -0.3 }));
        assert_eq!(Profile::torus(0.3, 0.4), Err(ProfileError::BeyondRadius { length: "crown radius", value: 0.4, radius: 0.3 }));
        let hollow = Profile::table(&[0.0, 0.2, 0.4, 0.6], &[0.3, 0.28, 0.31, 0.2]);
        assert!(matches!(hollow, Err(ProfileError::NotConvex { .. })));
        let one_sided = Profile::table(&[0.1, 0.2, 0.4, 0.6], &[0.3, 0.29, 0.28, 0.27]);
        assert_eq!(one_sided, Err(ProfileError::OneSided { first: 0.1, last: 0.6 }));
    }
}
