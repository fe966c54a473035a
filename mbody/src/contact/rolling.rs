//! Contact of a rolling body with a surface: its frame, its point, its velocities.
//!
//! ```text
//! x = (n × k)/|n × k|     y = k × x     e = x × n     cos γ = |n × k|     sin γ = n·k
//! δ = S(γ) − (C − P0)·k                               P = C − a e − b n + δ k
//! v_P = v_C + w × (P − C)     V_x = v_P·x     V_y = v_P·y     δ̇ = −v_P·k
//! ```
//!
//! C center of the body, n unit axis of its spin (to the left of forward); k unit normal of the surface through P0; x forward
//! and y left in the tangent plane; e upward in the plane of the body; γ camber, rad, positive leaning right; S, a, b support
//! and point of the [`Profile`], m; δ penetration of the undeformed body, m; P contact point, on the surface; v_C, w velocities
//! of the body without its spin. δ̇ is exact: moving along the meridian changes the depth only to second order.
//!
//! Source: V. Cossalter, R. Lot, Vehicle System Dynamics 37 (2002) 423–447 (geometry of a torus on a plane); the support form is ours.
//! Range: |γ| up to 75 degrees or so; everything turns infinite where n is parallel to k. Radii of the surface well above those of the body.

use super::profile::{Meridian, Profile};
use super::surface::{Surface, TangentPlane};
use crate::scalar::Real;
use crate::spatial::Vec3;

/// Directions and angles of a spin axis over a plane.
#[derive(Clone, Copy, Debug)]
pub struct ContactFrame<S> {
    /// Forward: along the intersection of the plane of the body and the tangent plane.
    pub x: Vec3<S>,
    /// Left, in the tangent plane.
    pub y: Vec3<S>,
    /// Normal of the tangent plane.
    pub k: Vec3<S>,
    /// Up, in the plane of the body.
    pub e: Vec3<S>,
    /// Cosine of the camber, positive.
    pub cos_camber: S,
    /// Sine of the camber.
    pub sin_camber: S,
    /// Camber, rad, positive leaning right.
    pub camber: S,
    /// Distance of the center from the plane, m.
    pub center_height: S,
}

impl<S: Real> ContactFrame<S> {
    /// The frame of a body with center C and unit spin axis n over a plane; cost: two roots, one arc tangent.
    #[inline]
    pub fn new(center: Vec3<S>, axis: Vec3<S>, plane: &TangentPlane<S>) -> Self {
        let k = plane.normal;
        let n_cross_k = axis.cross(k);
        let cos_camber = n_cross_k.norm();
        let sin_camber = axis.dot(k);
        let x = n_cross_k.scaled(cos_camber.recip());
        Self {
            x,
            y: k.cross(x),
            k,
            e: x.cross(axis),
            cos_camber,
            sin_camber,
            camber: sin_camber.atan2(cos_camber),
            center_height: (center - plane.point).dot(k),
        }
    }
}

/// Where an undeformed body touches, and how deep it would reach.
#[derive(Clone, Copy, Debug)]
pub struct Contact<S> {
    /// Directions and angles.
    pub frame: ContactFrame<S>,
    /// The touching point on the profile.
    pub meridian: Meridian<S>,
    /// Depth of the undeformed body below the surface, m; negative in the air.
    pub penetration: S,
    /// From the center to the contact point, m.
    pub arm: Vec3<S>,
    /// The contact point, on the tangent plane, m.
    pub point: Vec3<S>,
}

/// Velocities at the contact point, of the body without its spin.
#[derive(Clone, Copy, Debug)]
pub struct ContactVelocity<S> {
    /// Forward, m/s.
    pub forward: S,
    /// To the left, m/s: of the material, not of the geometric contact point, which also rolls along the profile.
    pub lateral: S,
    /// Rate of the penetration over a surface at rest, m/s.
    pub penetration_rate: S,
}

impl<S: Real> Contact<S> {
    /// Contact of a body with center C and unit spin axis n with a plane.
    #[inline]
    pub fn with_plane(profile: &Profile, center: Vec3<S>, axis: Vec3<S>, plane: &TangentPlane<S>) -> Self {
        let frame = ContactFrame::new(center, axis, plane);
        let meridian = profile.meridian_at(&frame);
        let support = meridian.a * frame.cos_camber + meridian.b * frame.sin_camber;
        let penetration = support - frame.center_height;
        let arm = frame.k.scaled(penetration) - frame.e.scaled(meridian.a) - axis.scaled(meridian.b);
        Self { frame, meridian, penetration, arm, point: center + arm }
    }

    /// Contact with a surface that is raised along its normal by a distance, m.
    ///
    /// A fixed number of passes, each against the tangent plane above the contact point of the last one, from the plane above
    /// the center on: differentiable, and its derivatives are those of the value that is computed.
    pub fn with_surface<T: Surface>(profile: &Profile, center: Vec3<S>, axis: Vec3<S>, surface: &T, raised: S) -> Self {
        let above = |x, y| surface.tangent_plane(x, y).raised(raised);
        let mut contact = Self::with_plane(profile, center, axis, &above(center.x, center.y));
        // a plane is its own tangent plane everywhere: nothing to repeat
        for _ in 1..surface.passes() {
            contact = Self::with_plane(profile, center, axis, &above(contact.point.x, contact.point.y));
        }
        contact
    }

    /// Velocities at the contact point from those of the center and the angular velocity without the spin.
    #[inline]
    pub fn velocity(&self, center_velocity: Vec3<S>, angular_velocity: Vec3<S>) -> ContactVelocity<S> {
        let v = center_velocity + angular_velocity.cross(self.arm);
        ContactVelocity { forward: v.dot(self.frame.x), lateral: v.dot(self.frame.y), penetration_rate: -v.dot(self.frame.k) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{HeightField, Plane};
    use crate::scalar::Jet;
    use crate::spatial::Rotation;

    const R: f64 = 0.3;
    const RHO: f64 = 0.07;

    /// A body in motion: center, velocity, spin axis, angular velocity.
    struct Motion {
        c: Vec3<f64>,
        v: Vec3<f64>,
        n: Vec3<f64>,
        w: Vec3<f64>,
    }

    /// Attitudes and motions spread by irrational multiples.
    fn motions() -> impl Iterator<Item = Motion> {
        (1..40).map(|i| {
            let spread = |k: f64| 2.0 * (f64::from(i) * k).fract() - 1.0;
            let vector = |a, b, c| Vec3::new(spread(a), spread(b), spread(c));
            let attitude = Rotation::about_z(3.0 * spread(2.0_f64.sqrt())) * Rotation::about_x(1.2 * spread(3.0_f64.sqrt()));
            Motion {
                c: Vec3::new(spread(0.618), spread(0.755), 0.25 + 0.05 * spread(0.8192)),
                v: vector(0.4142, 0.732, 0.2361) * 10.0,
                n: attitude * Vec3::new(0.0, 1.0, 0.0),
                w: vector(0.6458, 0.3166, 0.1231) * 3.0,
            }
        })
    }

    fn slanted() -> TangentPlane<f64> {
        Plane::new(Vec3::new(0.2, -0.1, 0.05), Vec3::new(0.1, -0.15, 1.0)).unwrap().tangent_plane(0.0, 0.0)
    }

    fn profiles() -> [Profile; 3] {
        [Profile::disc(R).unwrap(), Profile::torus(R, RHO).unwrap(), Profile::ellipse(R, 0.05, 0.09).unwrap()]
    }

    /// Center and axis as functions of time along a rigid motion.
    fn in_time(m: &Motion) -> (Vec3<Jet<f64>>, Vec3<Jet<f64>>) {
        let at = |p: f64, v: f64, a: f64| Jet::new(p, v, a);
        let (nd, ndd) = (m.w.cross(m.n), m.w.cross(m.w.cross(m.n)));
        let center = Vec3::new(at(m.c.x, m.v.x, 0.0), at(m.c.y, m.v.y, 0.0), at(m.c.z, m.v.z, 0.0));
        (center, Vec3::new(at(m.n.x, nd.x, ndd.x), at(m.n.y, nd.y, ndd.y), at(m.n.z, nd.z, ndd.z)))
    }

    fn in_time_plane() -> TangentPlane<Jet<f64>> {
        let plane = slanted();
        TangentPlane { point: Vec3::from_f64(plane.point), normal: Vec3::from_f64(plane.normal) }
    }

    #[test]
    fn the_frame_is_orthonormal_and_its_angles_fit_its_axes() {
        for m in motions() {
            let f = ContactFrame::new(m.c, m.n, &slanted());
            for (a, b, product) in
                [(f.x, f.x, 1.0), (f.x, f.y, 0.0), (f.y, f.k, 0.0), (f.e, f.k, f.cos_camber), (f.e, f.y, -f.sin_camber), (f.e, m.n, 0.0)]
            {
                assert!((a.dot(b) - product).abs() < 1e-14);
            }
            assert!((f.camber.sin() - f.sin_camber).abs() < 1e-14 && (f.camber.cos() - f.cos_camber).abs() < 1e-14);
        }
    }

    #[test]
    fn the_contact_point_lies_on_the_plane_and_aside_of_the_plane_of_the_wheel() {
        let torus = &profiles()[1];
        for m in motions() {
            let plane = slanted();
            let Contact { frame: f, penetration, point, .. } = Contact::with_plane(torus, m.c, m.n, &plane);
            assert!((point - plane.point).dot(plane.normal).abs() < 1e-14);
            assert!((f.center_height - ((R - RHO) * f.cos_camber + RHO - penetration)).abs() < 1e-14);
            let in_wheel_plane = m.c - f.e * (f.center_height / f.cos_camber);
            let aside = -(RHO - penetration) * f.sin_camber / f.cos_camber;
            assert!((point - in_wheel_plane - f.y * aside).norm() < 1e-13);
        }
    }

    #[test]
    fn the_rate_of_penetration_is_minus_the_normal_velocity() {
        for profile in profiles() {
            for m in motions() {
                let (center, axis) = in_time(&m);
                let moving = Contact::with_plane(&profile, center, axis, &in_time_plane());
                let still = Contact::with_plane(&profile, m.c, m.n, &slanted());
                assert!((moving.penetration.d - still.velocity(m.v, m.w).penetration_rate).abs() < 1e-12, "{profile:?}");
            }
        }
    }

    #[test]
    fn material_and_geometric_contact_point_differ_by_the_rolling_over_the_profile() {
        let torus = &profiles()[1];
        for m in motions() {
            let (center, axis) = in_time(&m);
            let moving = Contact::with_plane(torus, center, axis, &in_time_plane());
            let still = Contact::with_plane(torus, m.c, m.n, &slanted());
            let geometric = Vec3::new(moving.point.x.d, moving.point.y.d, moving.point.z.d).dot(still.frame.y);
            let rolling = (RHO - still.penetration) * m.w.dot(still.frame.x);
            assert!((still.velocity(m.v, m.w).lateral - geometric - rolling).abs() < 1e-12);
        }
    }

    #[test]
    fn a_torus_rolling_sideways_on_its_crown_does_not_slide() {
        let torus = &profiles()[1];
        let level = Plane::LEVEL.tangent_plane(0.0, 0.0);
        for camber in [-0.9, 0.0, 0.4, 1.1_f64] {
            let n = Vec3::new(0.0, camber.cos(), camber.sin());
            let center = Vec3::new(0.0, 0.0, torus.support(camber));
            let contact = Contact::with_plane(torus, center, n, &level);
            let rate = Vec3::new(2.0, 0.0, 0.0);
            let rolling_velocity = -rate.cross(contact.arm);
            assert!(contact.penetration.abs() < 1e-15);
            assert!((contact.velocity(rolling_velocity, rate).lateral).abs() < 1e-15);
            assert!((rolling_velocity.y + 2.0 * center.z).abs() < 1e-14);
        }
    }

    #[test]
    fn passes_over_a_height_field_settle_where_its_tangent_plane_touches() {
        let knots: Vec<f64> = (-30..=30).map(|i| 0.2 * f64::from(i)).collect();
        let heights: Vec<f64> = knots.iter().flat_map(|y| knots.iter().map(move |x| 0.05 * (0.6 * x + 0.3 * y).sin())).collect();
        let field = |passes| HeightField::new(&knots, &knots, &heights).unwrap().with_passes(passes);
        for m in motions() {
            let at = |passes| Contact::with_surface(&profiles()[1], m.c, m.n, &field(passes), 0.0);
            let settled = at(12);
            let there = field(12).tangent_plane(settled.point.x, settled.point.y);
            assert!((settled.point - there.point).dot(there.normal).abs() < 1e-12 && (there.normal - settled.frame.k).norm() < 1e-9);
            // each pass gains a factor of the lever (0.3 m) over the radius of the hills (1/(0.05 · 0.67²) = 45 m)
            assert!((at(2).penetration - settled.penetration).abs() < 1e-4);
            assert!((at(3).penetration - settled.penetration).abs() < 1e-6);
        }
    }

    #[test]
    fn a_raised_surface_is_penetrated_deeper() {
        let m = motions().next().unwrap();
        let plane = Plane::new(Vec3::zero(), Vec3::new(0.1, 0.2, 1.0)).unwrap();
        let at = |raised| Contact::with_surface(&profiles()[1], m.c, m.n, &plane, raised).penetration;
        assert!((at(0.01) - at(0.0) - 0.01).abs() < 1e-14);
    }
}
