//! One of the six components of a twist or a wrench.
//!
//! Most joints move along axes of their frames: columns of `H` are unit vectors e, and products with them pick or place numbers.
//! Source: Featherstone (2008), section 2.15 and table 4.1 (subspaces of standard joints).

use super::{ArticulatedInertia, Inertia, Twist, Vec3, Wrench};
use crate::scalar::Real;

/// A component of a twist (w; v), or the one of a wrench (n; f) that does work along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// About x.
    AngularX,
    /// About y.
    AngularY,
    /// About z.
    AngularZ,
    /// Along x.
    LinearX,
    /// Along y.
    LinearY,
    /// Along z.
    LinearZ,
}

impl Component {
    /// All six, in the order (w; v).
    pub const ALL: [Self; 6] = [Self::AngularX, Self::AngularY, Self::AngularZ, Self::LinearX, Self::LinearY, Self::LinearZ];

    /// The component of which a column is the unit vector, where it is one.
    pub fn of(column: &Twist<f64>) -> Option<Self> {
        Self::ALL.into_iter().find(|&c| *column == Twist::along(c, 1.0))
    }
}

impl<S: Real> Twist<S> {
    /// A twist of one component.
    #[inline(always)]
    pub fn along(c: Component, x: S) -> Self {
        let mut V = Self::zero();
        V.add_along(c, x);
        V
    }

    /// Adds to one component.
    #[inline(always)]
    pub fn add_along(&mut self, c: Component, x: S) {
        match c {
            Component::AngularX => self.w.x += x,
            Component::AngularY => self.w.y += x,
            Component::AngularZ => self.w.z += x,
            Component::LinearX => self.v.x += x,
            Component::LinearY => self.v.y += x,
            Component::LinearZ => self.v.z += x,
        }
    }

    /// `self × e x`: the rate of a motion along one component that is fixed in a body moving with this twist.
    #[inline(always)]
    pub fn cross_along(self, c: Component, x: S) -> Self {
        let o = S::zero();
        let about_x = |a: Vec3<S>| Vec3::new(o, a.z * x, -(a.y * x));
        let about_y = |a: Vec3<S>| Vec3::new(-(a.z * x), o, a.x * x);
        let about_z = |a: Vec3<S>| Vec3::new(a.y * x, -(a.x * x), o);
        match c {
            Component::AngularX => Self::new(about_x(self.w), about_x(self.v)),
            Component::AngularY => Self::new(about_y(self.w), about_y(self.v)),
            Component::AngularZ => Self::new(about_z(self.w), about_z(self.v)),
            Component::LinearX => Self::new(Vec3::zero(), about_x(self.w)),
            Component::LinearY => Self::new(Vec3::zero(), about_y(self.w)),
            Component::LinearZ => Self::new(Vec3::zero(), about_z(self.w)),
        }
    }
}

impl<S: Real> Wrench<S> {
    /// One component: the power along a unit twist.
    #[inline(always)]
    pub fn along(&self, c: Component) -> S {
        match c {
            Component::AngularX => self.n.x,
            Component::AngularY => self.n.y,
            Component::AngularZ => self.n.z,
            Component::LinearX => self.f.x,
            Component::LinearY => self.f.y,
            Component::LinearZ => self.f.z,
        }
    }
}

impl<S: Real> Inertia<S> {
    /// Inertia times a unit twist.
    #[inline(always)]
    pub fn column(&self, c: Component) -> Wrench<S> {
        let (o, m, h, I) = (S::zero(), self.m, self.h, &self.I);
        match c {
            Component::AngularX => Wrench::new(Vec3::new(I[0], I[3], I[4]), Vec3::new(o, -h.z, h.y)),
            Component::AngularY => Wrench::new(Vec3::new(I[3], I[1], I[5]), Vec3::new(h.z, o, -h.x)),
            Component::AngularZ => Wrench::new(Vec3::new(I[4], I[5], I[2]), Vec3::new(-h.y, h.x, o)),
            Component::LinearX => Wrench::new(Vec3::new(o, h.z, -h.y), Vec3::new(m, o, o)),
            Component::LinearY => Wrench::new(Vec3::new(-h.z, o, h.x), Vec3::new(o, m, o)),
            Component::LinearZ => Wrench::new(Vec3::new(h.y, -h.x, o), Vec3::new(o, o, m)),
        }
    }
}

impl<S: Real> ArticulatedInertia<S> {
    /// Inertia times a unit twist.
    #[inline(always)]
    pub fn column(&self, c: Component) -> Wrench<S> {
        let (J, M, [x, y, z]) = (&self.J, &self.M, self.H);
        match c {
            Component::AngularX => Wrench::new(Vec3::new(J[0], J[3], J[4]), Vec3::new(x.x, y.x, z.x)),
            Component::AngularY => Wrench::new(Vec3::new(J[3], J[1], J[5]), Vec3::new(x.y, y.y, z.y)),
            Component::AngularZ => Wrench::new(Vec3::new(J[4], J[5], J[2]), Vec3::new(x.z, y.z, z.z)),
            Component::LinearX => Wrench::new(x, Vec3::new(M[0], M[3], M[4])),
            Component::LinearY => Wrench::new(y, Vec3::new(M[3], M[1], M[5])),
            Component::LinearZ => Wrench::new(z, Vec3::new(M[4], M[5], M[2])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is picked is what the product with a unit twist gives.
    #[test]
    fn components_are_products_with_unit_twists() {
        let v = |a: f64| Vec3::new(a, a * a - 1.0, 2.0 - a);
        let (V, F) = (Twist::new(v(0.3), v(-1.7)), Wrench::new(v(2.2), v(0.9)));
        let rigid = Inertia { m: 3.0, h: v(0.4), I: [5.0, 6.0, 7.0, 0.1, -0.2, 0.3] };
        let general =
            ArticulatedInertia { J: [1.0, 2.0, 3.0, 0.4, 0.5, 0.6], H: [v(0.7), v(0.8), v(-0.9)], M: [9.0, 8.0, 7.0, 0.6, 0.5, 0.4] };
        for c in Component::ALL {
            let e = Twist::along(c, 1.0);
            assert_eq!(Component::of(&e), Some(c));
            assert_eq!(F.along(c), e.dot(F));
            assert_eq!(rigid.column(c), rigid.times(e));
            assert_eq!(general.column(c), general.times(e));
            assert_eq!(V.cross_along(c, 1.3), V.cross(Twist::along(c, 1.3)));
        }
        assert_eq!(Component::of(&Twist::new(v(0.0), v(1.0))), None);
    }
}
