//! What a constraint is: one law on the relative motion of two frames, generic over the scalar.
//!
//! ```text
//! Φ(X_FM) = 0                                     constraint on coordinates
//! s(X_FM, V_FM) = 0, linear in V_FM               constraint on velocities only (rolling without slip)
//! Φ̇, Φ̈: Φ on jets of the pose                      F = Σ λ ∂Φ/∂ξ: wrench of the multipliers on M
//! ```
//!
//! X_FM pose of frame M (fixed in the second body) in frame F (fixed in the first); V_FM twist of M in F, in axes of M about Mo; ξ small
//! rotation and displacement of M in its own axes; λ multipliers, N or N m. The wrench follows from the principle of virtual work,
//! so a constraint does none.
//!
//! Source: A. A. Shabana, *Dynamics of Multibody Systems*, 3rd ed. 2005, chapter 3; rates and forces by automatic differentiation are ours.

use super::prescribed_motion::PrescribedMotion;
use super::relative::relative_motion;
use crate::model::{Attachment, BodyIndex, Model, Outline};
use crate::scalar::{Dual, Family, Jet, Make, PerScalar, Real, SystemScalar};
use crate::spatial::{Pose, Rotation, Twist, Vec3, Wrench};
use crate::stage::Workspace;
use problem::Signal;
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// Largest number of rows of one constraint.
pub const MAX_ROWS: usize = 6;

/// What a row of a constraint holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Level {
    /// Coordinates, and with them velocities and accelerations.
    Position,
    /// Velocities and accelerations only.
    Velocity,
}

/// One row of a constraint and its multiplier.
#[derive(Clone, Debug, PartialEq)]
pub struct RowDeclared {
    /// Quantity of the multiplier in its signal name: `force_x`.
    pub multiplier: Cow<'static, str>,
    /// Unit of the multiplier.
    pub unit: &'static str,
    /// What the multiplier is, and which sense is positive.
    pub about: &'static str,
    /// What is kept at zero: `gap along x`.
    pub error: Cow<'static, str>,
    /// Unit of the error (of its rate, for a row on velocities).
    pub error_unit: &'static str,
    /// Typical magnitude of the error.
    pub nominal: f64,
    /// Which level the row is on.
    pub level: Level,
}

/// A constraint as its author writes it: generic over the scalar, never stored.
pub trait ConstraintLaw: fmt::Debug + Send + Sync + 'static {
    /// The rows: those on coordinates first, in the order of [`Self::error`], then those of [`Self::slip`].
    fn rows(&self) -> Vec<RowDeclared>;
    /// Axis of the second frame about which it may turn without any effect on the constraint (a rolling wheel).
    fn spin_axis(&self) -> Option<Vec3<f64>> {
        None
    }
    /// What drawings show of it, between two frames; nothing without an override.
    fn outline(&self, _from: &Place, _to: &Place) -> Option<Outline> {
        None
    }
    /// Writes the errors of the rows on coordinates.
    fn error<R: Real>(&self, _X_FM: &Pose<R>, _error: &mut [R]) {}
    /// Writes the rows on velocities; linear in the twist.
    fn slip<R: Real>(&self, _X_FM: &Pose<R>, _V_FM: &Twist<R>, _slip: &mut [R]) {}
}

/// Motion of one frame relative to another.
#[derive(Clone, Copy, Debug)]
pub struct RelativeMotion<S> {
    /// Pose of M in F.
    pub X_FM: Pose<S>,
    /// Twist of M in F, in axes of M about Mo.
    pub V_FM: Twist<S>,
    /// Rates of the components of the twist.
    pub A_FM: Twist<S>,
}

impl<S: Real> RelativeMotion<S> {
    /// The pose as a function of time.
    #[inline]
    fn jet(&self) -> Pose<Jet<S>> {
        let (R, w, wd) = (&self.X_FM.R, self.V_FM.w, self.A_FM.w);
        // columns of [w]× and [w]×² + [ẇ]×, turned into F
        let column = |k: usize| {
            let e = Rotation::<S>::identity().columns[k];
            let (d, dd) = (w.cross(e), w.cross(w.cross(e)) + wd.cross(e));
            jets(R.columns[k], *R * d, *R * dd)
        };
        let p_dd = *R * (self.A_FM.v + w.cross(self.V_FM.v));
        Pose::new(Rotation::from_columns(column(0), column(1), column(2)), jets(self.X_FM.p, *R * self.V_FM.v, p_dd))
    }
}

#[inline]
fn jets<S: Real>(x: Vec3<S>, d: Vec3<S>, dd: Vec3<S>) -> Vec3<Jet<S>> {
    Vec3::new(Jet::new(x.x, d.x, dd.x), Jet::new(x.y, d.y, dd.y), Jet::new(x.z, d.z, dd.z))
}

/// The pose with its derivatives along the six small displacements of M.
#[inline]
fn displaced<S: Real>(X: &Pose<S>) -> Pose<Dual<S, 6>> {
    let o = S::zero();
    let [x, y, z] = X.R.columns;
    // δR = R [δθ]×: the derivative of column x along rotation about z is column y, and so on
    let component = |value: S, turn: [S; 3]| Dual { x: value, d: [turn[0], turn[1], turn[2], o, o, o] };
    let column = |c: Vec3<S>, turn: [Vec3<S>; 3]| {
        Vec3::new(component(c.x, turn.map(|t| t.x)), component(c.y, turn.map(|t| t.y)), component(c.z, turn.map(|t| t.z)))
    };
    let zero = Vec3::zero();
    let R = Rotation::from_columns(column(x, [zero, -z, y]), column(y, [z, zero, -x]), column(z, [-y, x, zero]));
    let moved = |value: S, row: [S; 3]| Dual { x: value, d: [o, o, o, row[0], row[1], row[2]] };
    let p = Vec3::new(moved(X.p.x, [x.x, y.x, z.x]), moved(X.p.y, [x.y, y.y, z.y]), moved(X.p.z, [x.z, y.z, z.z]));
    Pose::new(R, p)
}

/// The twist with its derivatives along its own six components.
#[inline]
fn seeded<S: Real>(V: &Twist<S>) -> Twist<Dual<S, 6>> {
    let part = |value: S, k: usize| {
        let mut dual = Dual::constant(value);
        dual.d[k] = S::one();
        dual
    };
    let vector = |v: Vec3<S>, first: usize| Vec3::new(part(v.x, first), part(v.y, first + 1), part(v.z, first + 2));
    Twist::new(vector(V.w, 0), vector(V.v, 3))
}

fn constant<S: Real>(X: &Pose<S>) -> Pose<Dual<S, 6>> {
    let lift = |v: Vec3<S>| Vec3::new(Dual::constant(v.x), Dual::constant(v.y), Dual::constant(v.z));
    let [x, y, z] = X.R.columns;
    Pose::new(Rotation::from_columns(lift(x), lift(y), lift(z)), lift(X.p))
}

#[inline]
fn wrench<S: Real>(d: &[S; 6]) -> Wrench<S> {
    Wrench::new(Vec3::new(d[0], d[1], d[2]), Vec3::new(d[3], d[4], d[5]))
}

/// A row on its three levels.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowValue<S> {
    /// Error; zero for a row on velocities.
    pub error: S,
    /// Rate of the error; the slip for a row on velocities.
    pub rate: S,
    /// Rate of the rate, accelerations included.
    pub acceleration: S,
}

/// A constraint as the system stores it: object-safe for one scalar.
trait ConstraintTwin<S>: Send + Sync {
    fn evaluate(&self, positions: usize, motion: &RelativeMotion<S>, rows: &mut [RowValue<S>]);
    fn directions(&self, positions: usize, X_FM: &Pose<S>, rows: &mut [Wrench<S>]);
}

impl<L: ConstraintLaw, S: SystemScalar> ConstraintTwin<S> for L {
    fn evaluate(&self, positions: usize, motion: &RelativeMotion<S>, rows: &mut [RowValue<S>]) {
        let (holonomic, rolling) = rows.split_at_mut(positions);
        let X = motion.jet();
        let mut values = [Jet::default(); MAX_ROWS];
        self.error(&X, &mut values[..positions]);
        for (row, v) in holonomic.iter_mut().zip(values) {
            *row = RowValue { error: v.x, rate: v.d, acceleration: v.dd };
        }
        if rolling.is_empty() {
            return;
        }
        let o = Vec3::zero();
        let V = Twist::new(jets(motion.V_FM.w, motion.A_FM.w, o), jets(motion.V_FM.v, motion.A_FM.v, o));
        let count = rolling.len();
        self.slip(&X, &V, &mut values[..count]);
        for (row, v) in rolling.iter_mut().zip(values) {
            *row = RowValue { error: S::zero(), rate: v.x, acceleration: v.d };
        }
    }
    fn directions(&self, positions: usize, X_FM: &Pose<S>, rows: &mut [Wrench<S>]) {
        let (holonomic, rolling) = rows.split_at_mut(positions);
        let mut values = [Dual::<S, 6>::default(); MAX_ROWS];
        self.error(&displaced(X_FM), &mut values[..positions]);
        for (row, v) in holonomic.iter_mut().zip(&values) {
            *row = wrench(&v.d);
        }
        if rolling.is_empty() {
            return;
        }
        let count = rolling.len();
        self.slip(&constant(X_FM), &seeded(&Twist::zero()), &mut values[..count]);
        for (row, v) in rolling.iter_mut().zip(&values) {
            *row = wrench(&v.d);
        }
    }
}

struct Twins;

impl Family for Twins {
    type Of<S: SystemScalar> = Arc<dyn ConstraintTwin<S>>;
}

struct Maker<L>(Arc<L>);

impl<L: ConstraintLaw> Make<Twins> for Maker<L> {
    fn make<S: SystemScalar>(&self) -> Arc<dyn ConstraintTwin<S>> {
        self.0.clone()
    }
}

/// A frame fixed in a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The body.
    pub body: BodyIndex,
    /// Pose of the frame in the body.
    pub X_BF: Pose<f64>,
}

impl Place {
    /// The origin of the frame.
    pub fn origin(&self) -> Attachment {
        (self.body, self.X_BF.p)
    }
}

/// What is at work in a constraint.
enum Kind {
    /// A law on the relative motion of the two frames.
    Law { positions: usize, spin_axis: Option<Vec3<f64>>, twins: PerScalar<Twins> },
    /// A prescribed coordinate of the joint between the two.
    Drive(PrescribedMotion),
}

/// When a constraint is evaluated, and with which inputs of its own.
#[derive(Clone, Copy, Debug)]
pub struct Moment<S> {
    /// Time, s.
    pub time: f64,
    /// Inputs, in the order in which the constraint declares them.
    pub inputs: [S; 3],
}

impl<S: Real> Moment<S> {
    /// A time with inputs at zero.
    pub fn at(time: f64) -> Self {
        Self { time, inputs: [S::zero(); 3] }
    }
}

/// Any constraint between two frames.
pub struct Constraint {
    name: String,
    from: Place,
    to: Place,
    rows: Vec<RowDeclared>,
    kind: Kind,
    outline: Option<Outline>,
    text: String,
}

impl fmt::Debug for Constraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.text)
    }
}

impl Constraint {
    /// Stores a law between frame F of the first place and frame M of the second under the name the user gave.
    ///
    /// # Panics
    /// Where the law declares more than [`MAX_ROWS`] rows, or a row on velocities before one on coordinates.
    pub fn new<L: ConstraintLaw>(name: impl Into<String>, from: Place, to: Place, law: L) -> Self {
        let (rows, text) = (law.rows(), format!("{law:?}"));
        let positions = rows.iter().take_while(|r| r.level == Level::Position).count();
        assert!(rows.len() <= MAX_ROWS, "a constraint has at most {MAX_ROWS} rows");
        assert!(rows[positions..].iter().all(|r| r.level == Level::Velocity), "rows on coordinates come first");
        let (spin_axis, outline) = (law.spin_axis(), law.outline(&from, &to));
        let kind = Kind::Law { positions, spin_axis, twins: PerScalar::new(&Maker(Arc::new(law))) };
        Self { name: name.into(), from, to, rows, kind, outline, text }
    }

    /// A prescribed coordinate of the joint that carries a body, under the name the user gave.
    pub fn drive(name: impl Into<String>, model: &Model, drive: PrescribedMotion) -> Self {
        let (body, text) = (model.body(drive.joint), format!("{drive:?}"));
        let from = Place { body: body.parent, X_BF: body.X_PF };
        let to = Place { body: drive.joint, X_BF: Pose::identity() };
        Self { name: name.into(), from, to, rows: vec![drive.row(model)], kind: Kind::Drive(drive), outline: None, text }
    }

    /// Inputs that the constraint reads: name, unit and sentence of each, in the order of [`Moment::inputs`]; each is the rate of the one before.
    pub fn inputs(&self, model: &Model) -> Vec<Signal> {
        match &self.kind {
            Kind::Law { .. } => Vec::new(),
            Kind::Drive(drive) => drive.inputs(&self.name, model),
        }
    }

    /// Name in the description.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// First frame.
    pub fn from(&self) -> &Place {
        &self.from
    }

    /// Second frame; the wrench of the multipliers acts here.
    pub fn to(&self) -> &Place {
        &self.to
    }

    /// What drawings show of it.
    pub fn outline(&self) -> Option<&Outline> {
        self.outline.as_ref()
    }

    /// The rows.
    pub fn rows(&self) -> &[RowDeclared] {
        &self.rows
    }

    /// The body on whose joint angle nothing depends because of this constraint: it turns about the axis of a wheel.
    pub fn spinning(&self, model: &Model) -> Option<BodyIndex> {
        let Kind::Law { spin_axis: Some(axis), .. } = self.kind else { return None };
        let (axis, joint) = (self.to.X_BF.R * axis, model.body(self.to.body).joint.rotation_axis()?);
        // in line with the joint, and the center on its axis
        let in_line = (axis - joint).norm().min((axis + joint).norm()) < 1e-9;
        let aside = self.to.X_BF.p.cross(joint).norm();
        (in_line && aside < 1e-9).then_some(self.to.body)
    }

    /// Evaluates all rows and the wrenches of their unit multipliers at the motion in the stages of `w`, all of which must be filled.
    ///
    /// Returns the pose of the second frame in the first. Wrenches act on the second frame, in its axes about its origin; the first
    /// gets the opposite. Allocates nothing.
    #[inline]
    pub fn observe<S: SystemScalar>(
        &self,
        model: &Model,
        w: &Workspace<S>,
        moment: &Moment<S>,
        rows: &mut [RowValue<S>],
        directions: &mut [Wrench<S>],
    ) -> Pose<S> {
        let motion = relative_motion(model, w, self);
        match &self.kind {
            Kind::Law { positions, twins, .. } => {
                let twin = S::pick(twins);
                twin.evaluate(*positions, &motion, rows);
                twin.directions(*positions, &motion.X_FM, directions);
            }
            Kind::Drive(drive) => (rows[0], directions[0]) = drive.observe(model, w, moment),
        }
        motion.X_FM
    }

    /// Error, rate and acceleration of each row along a motion, and wrenches of unit multipliers, of a law on two frames.
    #[cfg(test)]
    pub(super) fn of_motion(&self, motion: &RelativeMotion<f64>, rows: &mut [RowValue<f64>], directions: &mut [Wrench<f64>]) {
        if let Kind::Law { positions, twins, .. } = &self.kind {
            let twin = f64::pick(twins);
            twin.evaluate(*positions, motion, rows);
            twin.directions(*positions, &motion.X_FM, directions);
        }
    }
}
