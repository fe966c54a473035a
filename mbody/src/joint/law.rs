//! What a joint is, and how the model stores it.

use super::Columns;
use crate::scalar::{Family, Jet, Make, PerScalar, Real, SystemScalar};
use crate::spatial::{Component, Pose, Turn, Twist, Vec3, Wrench};
use std::fmt;
use std::sync::Arc;

/// How one coordinate or velocity of a joint is called and scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Quantity in the signal name: `angle` gives `<joint>.angle`.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// Nothing but other cyclic coordinates depends on it (x, y, yaw of a vehicle on a homogeneous plane).
    pub cyclic: bool,
}

/// A joint as its author writes it: generic over the scalar, never stored.
///
/// Twists, `H` and bias are those of the outboard frame M in F, written in M.
pub trait JointLaw: fmt::Debug + Send + Sync + 'static {
    /// Names of the coordinates.
    fn coordinates(&self) -> &'static [Coordinate];
    /// Names of the velocities.
    fn velocities(&self) -> &'static [Coordinate];
    /// Coordinates in the reference pose.
    fn reference(&self) -> Vec<f64> {
        vec![0.0; self.coordinates().len()]
    }
    /// Unit axis, fixed in F and in M, about which the joint turns, where it only turns about one.
    fn rotation_axis(&self) -> Option<Vec3<f64>> {
        None
    }
    /// What is known of the rotation of `X_FM`, whatever the coordinates.
    fn turn(&self) -> Turn {
        self.rotation_axis().map_or(Turn::Any, Turn::about)
    }
    /// `X_FM(q)`.
    fn pose<S: Real>(&self, q: &[S]) -> Pose<S>;
    /// `q̇ = N(q) v`; without an override N is the identity.
    fn rates<S: Real>(&self, _q: &[S], v: &[S], rates: &mut [S]) {
        rates.copy_from_slice(v);
    }
    /// Columns of `H(q)`.
    fn subspace<S: Real>(&self, q: &[S], H: &mut [Twist<S>]) {
        for k in 0..H.len() {
            let mut unit = [S::zero(); 6];
            unit[k] = S::one();
            H[k] = from_jet(self, q, &unit[..H.len()]).0;
        }
    }
    /// Whether `H` is the same for all q, so that it need not be written again.
    fn subspace_is_constant(&self) -> bool {
        false
    }
    /// `Ḣ v`.
    fn bias<S: Real>(&self, q: &[S], v: &[S]) -> Twist<S> {
        from_jet(self, q, v).1
    }
    /// `H v` and `Ḣ v`; override where they share work.
    #[inline(always)]
    fn motion_and_bias<S: Real>(&self, q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>) {
        (self.motion(H, v), self.bias(q, v))
    }
    /// `X_PF X_FM(q)` and, where it depends on q, `H(q)`; override where they share work.
    #[inline(always)]
    fn update<S: Real>(&self, X_PF: &Pose<f64>, q: &[S], H: &mut [Twist<S>]) -> Pose<S> {
        if !self.subspace_is_constant() {
            self.subspace(q, H);
        }
        self.placed(X_PF, q)
    }
    /// `H v`; override where most of H is zero.
    #[inline(always)]
    fn motion<S: Real>(&self, H: &[Twist<S>], v: &[S]) -> Twist<S> {
        let mut sum = Twist::zero();
        for (column, &x) in H.iter().zip(v) {
            sum += column.scaled(x);
        }
        sum
    }
    /// `Hᵀ F`; override where most of H is zero.
    #[inline(always)]
    fn effort<S: Real>(&self, H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        for (column, x) in H.iter().zip(tau) {
            *x = column.dot(F);
        }
    }
    /// The F with `Hᵀ F = τ`, of joints that leave all six motions: H is square.
    fn wrench<S: Real>(&self, _H: &[Twist<S>], _tau: &[S]) -> Option<Wrench<S>> {
        None
    }
    /// The v with `H v = V`, of the joints that have a [`JointLaw::wrench`].
    fn velocity<S: Real>(&self, _H: &[Twist<S>], _V: Twist<S>, _v: &mut [S]) {}
    /// `X_PF X_FM(q)`; override where the product is cheaper than its factors.
    #[inline(always)]
    fn placed<S: Real>(&self, X_PF: &Pose<f64>, q: &[S]) -> Pose<S> {
        X_PF.compose(&self.pose(q))
    }
}

/// Twist and acceleration (v̇ = 0) of M in F, written in M, from the pose alone.
///
/// `w = (Rᵀ Ṙ)^∨`, `v = Rᵀ ṗ` and their component-wise rates, by jets along `q̇ = N(q) v`.
pub fn from_jet<S: Real, J: JointLaw + ?Sized>(joint: &J, q: &[S], v: &[S]) -> (Twist<S>, Twist<S>) {
    let (nq, nv) = (q.len(), v.len());
    let mut rates = [S::zero(); 7];
    joint.rates(q, v, &mut rates[..nq]);
    // second rate of q with v held: differentiate N(q) v along q̇
    let mut jets: [Jet<S>; 7] = std::array::from_fn(|i| if i < nq { Jet::new(q[i], rates[i], S::zero()) } else { Jet::default() });
    let speeds: [Jet<S>; 6] = std::array::from_fn(|i| if i < nv { Jet::constant(v[i]) } else { Jet::default() });
    let mut second = [Jet::default(); 7];
    joint.rates(&jets[..nq], &speeds[..nv], &mut second[..nq]);
    for i in 0..nq {
        jets[i].dd = second[i].d;
    }
    let X = joint.pose(&jets[..nq]);
    let part = |pick: fn(&Jet<S>) -> S| {
        let c = |v: &Vec3<Jet<S>>| Vec3::new(pick(&v.x), pick(&v.y), pick(&v.z));
        ([c(&X.R.columns[0]), c(&X.R.columns[1]), c(&X.R.columns[2])], c(&X.p))
    };
    let ((R, _), (Rd, pd), (Rdd, pdd)) = (part(|j| j.x), part(|j| j.d), part(|j| j.dd));
    // (Rᵀ Ṙ)^∨: entry (i, j) of Rᵀ Ṙ is column i of R times column j of Ṙ
    let vee = |A: &[Vec3<S>; 3], B: &[Vec3<S>; 3]| Vec3::new(A[2].dot(B[1]), A[0].dot(B[2]), A[1].dot(B[0]));
    let turn = |A: &[Vec3<S>; 3], p: Vec3<S>| Vec3::new(A[0].dot(p), A[1].dot(p), A[2].dot(p));
    let twist = Twist::new(vee(&R, &Rd), turn(&R, pd));
    let acceleration = Twist::new(vee(&R, &Rdd) + vee(&Rd, &Rd), turn(&R, pdd) + turn(&Rd, pd));
    (twist, acceleration)
}

/// A joint as the model stores it: object-safe for one scalar.
trait JointTwin<S>: Send + Sync {
    fn place(&self, X_PF: &Pose<f64>, q: &[S], H: &mut [Twist<S>]) -> Pose<S>;
    fn update(&self, X_PF: &Pose<f64>, q: &[S], X_PM: &mut Pose<S>, H: &mut [Twist<S>]);
    fn rates(&self, q: &[S], v: &[S], rates: &mut [S]);
    fn bias(&self, q: &[S], v: &[S]) -> Twist<S>;
    fn motion(&self, H: &[Twist<S>], v: &[S]) -> Twist<S>;
    fn motion_and_bias(&self, q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>);
    fn effort(&self, H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]);
    fn wrench(&self, H: &[Twist<S>], tau: &[S]) -> Option<Wrench<S>>;
    fn velocity(&self, H: &[Twist<S>], V: Twist<S>, v: &mut [S]);
}

impl<J: JointLaw, S: SystemScalar> JointTwin<S> for J {
    fn place(&self, X_PF: &Pose<f64>, q: &[S], H: &mut [Twist<S>]) -> Pose<S> {
        self.subspace(q, H);
        self.placed(X_PF, q)
    }
    fn update(&self, X_PF: &Pose<f64>, q: &[S], X_PM: &mut Pose<S>, H: &mut [Twist<S>]) {
        *X_PM = JointLaw::update(self, X_PF, q, H);
    }
    fn rates(&self, q: &[S], v: &[S], rates: &mut [S]) {
        JointLaw::rates(self, q, v, rates);
    }
    fn bias(&self, q: &[S], v: &[S]) -> Twist<S> {
        JointLaw::bias(self, q, v)
    }
    fn motion(&self, H: &[Twist<S>], v: &[S]) -> Twist<S> {
        JointLaw::motion(self, H, v)
    }
    fn motion_and_bias(&self, q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>) {
        JointLaw::motion_and_bias(self, q, H, v)
    }
    fn effort(&self, H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        JointLaw::effort(self, H, F, tau);
    }
    fn wrench(&self, H: &[Twist<S>], tau: &[S]) -> Option<Wrench<S>> {
        JointLaw::wrench(self, H, tau)
    }
    fn velocity(&self, H: &[Twist<S>], V: Twist<S>, v: &mut [S]) {
        JointLaw::velocity(self, H, V, v);
    }
}

struct Twins;

impl Family for Twins {
    type Of<S: SystemScalar> = Arc<dyn JointTwin<S>>;
}

struct Maker<J>(Arc<J>);

impl<J: JointLaw> Make<Twins> for Maker<J> {
    fn make<S: SystemScalar>(&self) -> Arc<dyn JointTwin<S>> {
        self.0.clone()
    }
}

/// Any joint.
pub struct Joint {
    twins: PerScalar<Twins>,
    coordinates: &'static [Coordinate],
    velocities: &'static [Coordinate],
    reference: Vec<f64>,
    rotation_axis: Option<Vec3<f64>>,
    turn: Turn,
    subspace_is_constant: bool,
    /// Which component of a twist each velocity is, where each is one.
    components: Option<Box<[Component]>>,
    /// Whether H is square and the law solves for what it multiplies.
    leaves_all: bool,
    text: String,
}

impl fmt::Debug for Joint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Joint {
    /// Stores a law.
    pub fn new<J: JointLaw>(law: J) -> Self {
        let (coordinates, velocities, reference) = (law.coordinates(), law.velocities(), law.reference());
        let (rotation_axis, turn, text) = (law.rotation_axis(), law.turn(), format!("{law:?}"));
        let subspace_is_constant = law.subspace_is_constant() || velocities.is_empty();
        let mut H = vec![Twist::zero(); velocities.len()];
        law.subspace(&reference, &mut H);
        let components = H.iter().map(Component::of).collect::<Option<_>>().filter(|_| subspace_is_constant);
        let leaves_all = law.wrench(&H, &vec![0.0; velocities.len()]).is_some();
        let twins = PerScalar::new(&Maker(Arc::new(law)));
        Self { twins, coordinates, velocities, reference, rotation_axis, turn, subspace_is_constant, components, leaves_all, text }
    }

    /// The columns of `H`, given where they stand.
    #[inline(always)]
    pub fn columns<'a, S: SystemScalar>(&'a self, H: &'a [Twist<S>]) -> Columns<'a, S> {
        Columns::new(H, self.components.as_deref())
    }

    /// Unit axis, fixed in F and in M, about which the joint turns, where it only turns about one.
    pub fn rotation_axis(&self) -> Option<Vec3<f64>> {
        self.rotation_axis
    }

    /// What is known of the rotation of M in F, whatever the coordinates.
    pub fn turn(&self) -> Turn {
        self.turn
    }

    /// Whether `H` is the same for all q.
    pub fn subspace_is_constant(&self) -> bool {
        self.subspace_is_constant
    }

    /// Number of coordinates.
    pub fn nq(&self) -> usize {
        self.coordinates.len()
    }

    /// Number of velocities.
    pub fn nv(&self) -> usize {
        self.velocities.len()
    }

    /// Names of the coordinates.
    pub fn coordinates(&self) -> &'static [Coordinate] {
        self.coordinates
    }

    /// Names of the velocities.
    pub fn velocities(&self) -> &'static [Coordinate] {
        self.velocities
    }

    /// Coordinates in the reference pose.
    pub fn reference(&self) -> &[f64] {
        &self.reference
    }

    /// Pose `X_PM` in the parent, and the columns of `H` in axes of M.
    #[inline]
    pub fn place<S: SystemScalar>(&self, X_PF: &Pose<f64>, q: &[S], H: &mut [Twist<S>]) -> Pose<S> {
        S::pick(&self.twins).place(X_PF, q, H)
    }

    /// As [`Joint::place`], with the pose written in place and `H` only where it depends on q: for a workspace, whose `H` was
    /// filled when it was made.
    #[inline]
    pub fn update<S: SystemScalar>(&self, X_PF: &Pose<f64>, q: &[S], X_PM: &mut Pose<S>, H: &mut [Twist<S>]) {
        S::pick(&self.twins).update(X_PF, q, X_PM, H);
    }

    /// `q̇ = N(q) v`.
    #[inline]
    pub fn rates<S: SystemScalar>(&self, q: &[S], v: &[S], rates: &mut [S]) {
        S::pick(&self.twins).rates(q, v, rates);
    }

    /// `Ḣ v`.
    #[inline]
    pub fn bias<S: SystemScalar>(&self, q: &[S], v: &[S]) -> Twist<S> {
        S::pick(&self.twins).bias(q, v)
    }

    /// `H v`.
    #[inline]
    pub fn motion<S: SystemScalar>(&self, H: &[Twist<S>], v: &[S]) -> Twist<S> {
        self.moved(Twist::zero(), H, v)
    }

    /// `A + H v`.
    #[inline]
    pub fn moved<S: SystemScalar>(&self, mut A: Twist<S>, H: &[Twist<S>], v: &[S]) -> Twist<S> {
        let Some(components) = &self.components else { return A + S::pick(&self.twins).motion(H, v) };
        components.iter().zip(v).for_each(|(&c, &x)| A.add_along(c, x));
        A
    }

    /// `H v` and `Ḣ v`.
    #[inline]
    pub fn motion_and_bias<S: SystemScalar>(&self, q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>) {
        if self.components.is_some() { (self.motion(H, v), Twist::zero()) } else { S::pick(&self.twins).motion_and_bias(q, H, v) }
    }

    /// Twist of the outboard frame on a body with the twist `V` there, and what accelerates it besides `H v̇`: `Ḣ v + V × H v`.
    #[inline]
    pub fn carried<S: SystemScalar>(&self, mut V: Twist<S>, q: &[S], H: &[Twist<S>], v: &[S]) -> (Twist<S>, Twist<S>) {
        if let Some(&[c]) = self.components.as_deref() {
            V.add_along(c, v[0]);
            return (V, V.cross_along(c, v[0]));
        }
        let (V_J, c_J) = self.motion_and_bias(q, H, v);
        (V + V_J, c_J + V.cross(V_J))
    }

    /// `Hᵀ F`.
    #[inline]
    pub fn effort<S: SystemScalar>(&self, H: &[Twist<S>], F: Wrench<S>, tau: &mut [S]) {
        match &self.components {
            Some(components) => components.iter().zip(tau).for_each(|(&c, x)| *x = F.along(c)),
            None => S::pick(&self.twins).effort(H, F, tau),
        }
    }

    /// Whether the joint leaves all six motions and can be solved for them.
    #[inline]
    pub fn leaves_all(&self) -> bool {
        self.leaves_all
    }

    /// The F with `Hᵀ F = τ`, of joints that leave all six motions.
    #[inline]
    pub fn wrench<S: SystemScalar>(&self, H: &[Twist<S>], tau: &[S]) -> Option<Wrench<S>> {
        if self.leaves_all { S::pick(&self.twins).wrench(H, tau) } else { None }
    }

    /// The v with `H v = V`, of joints that leave all six motions.
    #[inline]
    pub fn velocity<S: SystemScalar>(&self, H: &[Twist<S>], V: Twist<S>, v: &mut [S]) {
        S::pick(&self.twins).velocity(H, V, v);
    }
}
