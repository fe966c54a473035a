//! Rotations about one axis that two frames share.
//!
//! Most joints turn about a coordinate axis, and most frames are parallel in the design pose: `R_PB` is then a rotation in a plane, whatever the
//! coordinates, and products with it mix two numbers where a matrix mixes three.
//!
//! ```text
//! about axis k, with i, j, k in cyclic order:   (R v)ᵢ = c vᵢ − s vⱼ,   (R v)ⱼ = s vᵢ + c vⱼ,   (R v)ₖ = vₖ
//! ```
//!
//! Source: Featherstone (2008), sections 2.8 and A.3 (computational cost of axis screw transforms).

use super::inertia::{ArticulatedInertia, Inertia, symmetric_times};
use super::{Pose, Rotation, Twist, Vec3, Wrench};
use crate::scalar::Real;

/// What is known of a rotation, whatever the coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turn {
    /// Nothing.
    #[default]
    Any,
    /// It is none.
    Still,
    /// About x.
    X,
    /// About y.
    Y,
    /// About z.
    Z,
}

impl Turn {
    /// Rotations about a unit axis.
    pub fn about(axis: Vec3<f64>) -> Self {
        match (axis.x == 0.0, axis.y == 0.0, axis.z == 0.0) {
            (false, true, true) => Self::X,
            (true, false, true) => Self::Y,
            (true, true, false) => Self::Z,
            _ => Self::Any,
        }
    }

    /// What a constant rotation is.
    pub fn of(R: &Rotation<f64>) -> Self {
        let [x, y, z] = R.columns;
        let keeps = |column: Vec3<f64>, k: usize| (0..3).all(|i| column[i] == if i == k { 1.0 } else { 0.0 });
        match (keeps(x, 0), keeps(y, 1), keeps(z, 2)) {
            (true, true, true) => Self::Still,
            (true, false, false) => Self::X,
            (false, true, false) => Self::Y,
            (false, false, true) => Self::Z,
            _ => Self::Any,
        }
    }

    /// One rotation after another.
    pub fn then(self, next: Self) -> Self {
        match (self, next) {
            (Self::Still, other) | (other, Self::Still) => other,
            (a, b) if a == b => a,
            _ => Self::Any,
        }
    }
}

/// A pose `X_AB` and what is known of its rotation.
#[derive(Clone, Copy, Debug)]
pub struct Turned<'a, S> {
    X: &'a Pose<S>,
    turn: Turn,
}

/// Runs a product of [`Turning`] for the kind of rotation at hand.
macro_rules! by_turn {
    ($turned:expr, $T:ident => $product:expr) => {
        match $turned.turn {
            Turn::Any => {
                type $T = General;
                $product
            }
            Turn::Still => {
                type $T = Parallel;
                $product
            }
            Turn::X => {
                type $T = About<0>;
                $product
            }
            Turn::Y => {
                type $T = About<1>;
                $product
            }
            Turn::Z => {
                type $T = About<2>;
                $product
            }
        }
    };
}

impl<'a, S: Real> Turned<'a, S> {
    /// A pose whose rotation is of this kind.
    #[inline(always)]
    pub fn new(X: &'a Pose<S>, turn: Turn) -> Self {
        Self { X, turn }
    }

    /// [`Pose::twist_to_child`].
    #[inline(always)]
    pub fn twist_to_child(self, V_A: Twist<S>) -> Twist<S> {
        let at = V_A.v + V_A.w.cross(self.X.p);
        by_turn!(self, T => Twist::new(T::back(&self.X.R, V_A.w), T::back(&self.X.R, at)))
    }

    /// [`Pose::wrench_to_parent`].
    #[inline(always)]
    pub fn wrench_to_parent(self, F_B: Wrench<S>) -> Wrench<S> {
        let (f, n) = by_turn!(self, T => (T::turned(&self.X.R, F_B.f), T::turned(&self.X.R, F_B.n)));
        Wrench::new(n + self.X.p.cross(f), f)
    }

    /// `X_OB = X_OA X_AB`.
    #[inline(always)]
    pub fn seen_from(self, X_OA: &Pose<S>) -> Pose<S> {
        Pose::new(by_turn!(self, T => T::after(&X_OA.R, &self.X.R)), X_OA.point(self.X.p))
    }

    /// The inertia of a composite body, given in B, in A.
    #[inline(always)]
    pub fn inertia_to_parent(self, I_B: &Inertia<S>) -> Inertia<S> {
        by_turn!(self, T => I_B.turned::<T>(&self.X.R)).shifted(self.X.p)
    }

    /// The inertia of an articulated body, given in B, in A.
    #[inline(always)]
    pub fn articulated_to_parent(self, I_B: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        by_turn!(self, T => I_B.turned::<T>(&self.X.R)).shifted(self.X.p)
    }
}

/// Products with rotations of one kind.
pub(super) trait Turning {
    /// `R v`.
    fn turned<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S>;
    /// `Rᵀ v`.
    fn back<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S>;
    /// `R₀ R`.
    fn after<S: Real>(first: &Rotation<S>, R: &Rotation<S>) -> Rotation<S>;
    /// `R I Rᵀ` of a symmetric tensor (xx, yy, zz, xy, xz, yz).
    fn symmetric<S: Real>(R: &Rotation<S>, I: &[S; 6]) -> [S; 6];
    /// `R H Rᵀ`, by columns.
    fn tensor<S: Real>(R: &Rotation<S>, H: &[Vec3<S>; 3]) -> [Vec3<S>; 3];
}

/// Any rotation.
pub(super) enum General {}

impl Turning for General {
    #[inline(always)]
    fn turned<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        R * v
    }
    #[inline(always)]
    fn back<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        R.inverse_times(v)
    }
    #[inline(always)]
    fn after<S: Real>(first: &Rotation<S>, R: &Rotation<S>) -> Rotation<S> {
        *first * *R
    }
    #[inline(always)]
    fn symmetric<S: Real>(R: &Rotation<S>, I: &[S; 6]) -> [S; 6] {
        // the columns of Rᵀ are the rows of R
        let rows = R.inverse().columns;
        let a: [Vec3<S>; 3] = std::array::from_fn(|i| symmetric_times(I, rows[i]));
        [rows[0].dot(a[0]), rows[1].dot(a[1]), rows[2].dot(a[2]), rows[0].dot(a[1]), rows[0].dot(a[2]), rows[1].dot(a[2])]
    }
    #[inline(always)]
    fn tensor<S: Real>(R: &Rotation<S>, H: &[Vec3<S>; 3]) -> [Vec3<S>; 3] {
        let RH = [R * H[0], R * H[1], R * H[2]];
        R.inverse().columns.map(|row| RH[0].scaled(row.x) + RH[1].scaled(row.y) + RH[2].scaled(row.z))
    }
}

/// No rotation.
pub(super) enum Parallel {}

impl Turning for Parallel {
    #[inline(always)]
    fn turned<S: Real>(_: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        v
    }
    #[inline(always)]
    fn back<S: Real>(_: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        v
    }
    #[inline(always)]
    fn after<S: Real>(first: &Rotation<S>, _: &Rotation<S>) -> Rotation<S> {
        *first
    }
    #[inline(always)]
    fn symmetric<S: Real>(_: &Rotation<S>, I: &[S; 6]) -> [S; 6] {
        *I
    }
    #[inline(always)]
    fn tensor<S: Real>(_: &Rotation<S>, H: &[Vec3<S>; 3]) -> [Vec3<S>; 3] {
        *H
    }
}

/// Rotations about axis K: 0 is x, 1 is y, 2 is z.
pub(super) enum About<const K: usize> {}

impl<const K: usize> About<K> {
    const I: usize = (K + 1) % 3;
    const J: usize = (K + 2) % 3;

    /// Cosine and sine.
    #[inline(always)]
    fn angle<S: Real>(R: &Rotation<S>) -> (S, S) {
        let column = R.columns[Self::I];
        (column[Self::I], column[Self::J])
    }

    /// A vector from its entries along i, j and k.
    #[inline(always)]
    fn vector<S: Real>(i: S, j: S, k: S) -> Vec3<S> {
        match K {
            0 => Vec3::new(k, i, j),
            1 => Vec3::new(j, k, i),
            _ => Vec3::new(i, j, k),
        }
    }

    #[inline(always)]
    fn mixed<S: Real>(c: S, s: S, v: Vec3<S>) -> Vec3<S> {
        let (i, j) = (v[Self::I], v[Self::J]);
        Self::vector(c * i - s * j, s * i + c * j, v[K])
    }

    /// Where a symmetric tensor keeps the entry of two axes.
    const fn place(a: usize, b: usize) -> usize {
        if a == b { a } else { a + b + 2 }
    }
}

impl<const K: usize> Turning for About<K> {
    #[inline(always)]
    fn turned<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        let (c, s) = Self::angle(R);
        Self::mixed(c, s, v)
    }
    #[inline(always)]
    fn back<S: Real>(R: &Rotation<S>, v: Vec3<S>) -> Vec3<S> {
        let (c, s) = Self::angle(R);
        Self::mixed(c, -s, v)
    }
    #[inline(always)]
    fn after<S: Real>(first: &Rotation<S>, R: &Rotation<S>) -> Rotation<S> {
        let (c, s) = Self::angle(R);
        let (i, j) = (first.columns[Self::I], first.columns[Self::J]);
        let mut columns = first.columns;
        columns[Self::I] = i.scaled(c) + j.scaled(s);
        columns[Self::J] = j.scaled(c) - i.scaled(s);
        Rotation { columns }
    }
    #[inline(always)]
    fn symmetric<S: Real>(R: &Rotation<S>, I: &[S; 6]) -> [S; 6] {
        let (c, s) = Self::angle(R);
        let (ii, jj, ij) = (I[Self::I], I[Self::J], I[Self::place(Self::I, Self::J)]);
        let (ik, jk) = (I[Self::place(Self::I, K)], I[Self::place(Self::J, K)]);
        let (along_i, along_j) = (c * ii - s * ij, c * ij - s * jj);
        let turned_ii = c * along_i - s * along_j;
        let mut turned = *I;
        turned[Self::I] = turned_ii;
        // the trace stays
        turned[Self::J] = ii + jj - turned_ii;
        turned[Self::place(Self::I, Self::J)] = s * along_i + c * along_j;
        turned[Self::place(Self::I, K)] = c * ik - s * jk;
        turned[Self::place(Self::J, K)] = s * ik + c * jk;
        turned
    }
    #[inline(always)]
    fn tensor<S: Real>(R: &Rotation<S>, H: &[Vec3<S>; 3]) -> [Vec3<S>; 3] {
        let (c, s) = Self::angle(R);
        let mut columns = H.map(|column| Self::mixed(c, s, column));
        let (i, j) = (columns[Self::I], columns[Self::J]);
        columns[Self::I] = i.scaled(c) - j.scaled(s);
        columns[Self::J] = i.scaled(s) + j.scaled(c);
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Products with rotations about one axis are those with any rotation.
    #[test]
    fn rotations_of_every_kind_are_rotations() {
        let v = |a: f64| Vec3::new(a, a * a - 1.0, 2.0 - a);
        let close = |a: Vec3<f64>, b: Vec3<f64>| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-14);
        let (I, H) = ([5.0, 6.0, 7.0, 0.1, -0.2, 0.3], [v(0.7), v(0.8), v(-0.9)]);
        let rotations = [
            Rotation::identity(),
            Rotation::about_x(0.7),
            Rotation::about_y(-1.2),
            Rotation::about_z(2.1),
            Rotation::from_rpy([0.3, 0.2, -0.5]),
        ];
        let kinds = [Turn::Still, Turn::X, Turn::Y, Turn::Z, Turn::Any];
        for (R, turn) in rotations.iter().zip(kinds) {
            assert_eq!(Turn::of(R), turn);
            let at = Turned { X: &Pose::new(*R, v(0.4)), turn };
            by_turn!(at, T => {
                assert!(close(T::turned(R, v(1.1)), R * v(1.1)) && close(T::back(R, v(1.1)), R.inverse_times(v(1.1))));
                let first = Rotation::from_rpy([1.0, -0.4, 0.2]);
                let (a, b) = (T::after(&first, R), first * *R);
                assert!((0..3).all(|k| close(a.columns[k], b.columns[k])));
                let (a, b) = (T::symmetric(R, &I), General::symmetric(R, &I));
                assert!((0..6).all(|k| (a[k] - b[k]).abs() < 1e-14), "{turn:?} {a:?} {b:?}");
                let (a, b) = (T::tensor(R, &H), General::tensor(R, &H));
                assert!((0..3).all(|k| close(a[k], b[k])), "{turn:?} {a:?} {b:?}");
            });
            // of the general products, the pose itself is the measure
            let (V, F) = (Twist::new(v(0.3), v(-1.7)), Wrench::new(v(2.2), v(0.9)));
            let (carried, expected) = (at.twist_to_child(V), at.X.twist_to_child(V));
            assert!(close(carried.w, expected.w) && close(carried.v, expected.v));
            let (moved, expected) = (at.wrench_to_parent(F), at.X.wrench_to_parent(F));
            assert!(close(moved.n, expected.n) && close(moved.f, expected.f));
            // kinetic energy and power do not depend on the frame they are written in
            let rigid = Inertia { m: 3.0, h: v(0.4), I };
            let in_parent = at.inertia_to_parent(&rigid);
            assert!((V.dot(in_parent.times(V)) - carried.dot(rigid.times(carried))).abs() < 1e-12);
            let general = ArticulatedInertia { J: I, H, M: [9.0, 8.0, 7.0, 0.6, 0.5, 0.4] };
            let in_parent = at.articulated_to_parent(&general);
            assert!((V.dot(in_parent.times(V)) - carried.dot(general.times(carried))).abs() < 1e-12);
        }
    }

    #[test]
    fn rotations_about_one_axis_stay_about_it() {
        assert_eq!(Turn::Still.then(Turn::Y), Turn::Y);
        assert_eq!(Turn::Y.then(Turn::Y), Turn::Y);
        assert_eq!(Turn::Y.then(Turn::Z), Turn::Any);
        assert_eq!(Turn::about(Vec3::new(0.0, -1.0, 0.0)), Turn::Y);
        assert_eq!(Turn::about(Vec3::new(0.6, 0.8, 0.0)), Turn::Any);
    }
}
