//! What a force element is: one law, generic over the scalar.

use crate::model::{BodyIndex, Model, Outline};
use crate::scalar::{Family, Make, PerScalar, SystemScalar};
use crate::spatial::{Pose, Twist, Vec3, Wrench};
use crate::stage::{Acceleration, Position, Velocity, World};
use problem::Side;
use std::any::Any;
use std::cell::Cell;
use std::sync::Arc;

/// A state that an element owns: deflection, lag, integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct StateDeclared {
    /// Quantity in the signal name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// Absolute tolerance for time integration.
    pub absolute_tolerance: f64,
    /// Whether the rate of the state appears in its row.
    pub differential: bool,
    /// What the row of this state balances, and its unit and typical magnitude.
    pub row: (&'static str, &'static str, f64),
}

/// An input that an element reads. Inputs of one full name are one input, whoever reads them.
#[derive(Clone, Debug, PartialEq)]
pub struct InputDeclared {
    /// Full signal name, for example `front_road.height`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// Full name of the input that is the rate of this one, where the element reads both.
    pub rate: Option<String>,
    /// Value where nobody says otherwise.
    pub default: f64,
}

/// An output that an element computes.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputDeclared {
    /// Full signal name.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// One sentence.
    pub about: &'static str,
}

/// A physical limit on an output or unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitDeclared {
    /// Stable name of the limit.
    pub name: &'static str,
    /// Full name of the signal.
    pub signal: String,
    /// Threshold.
    pub threshold: f64,
    /// Violated above or below.
    pub side: Side,
    /// Typical magnitude of the signal.
    pub nominal: f64,
    /// What happens there.
    pub about: &'static str,
}

/// Within which values of a signal an element is what it says: no limit of the motion, but of the trust in it.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeDeclared {
    /// Full name of the signal.
    pub signal: String,
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// Whose range it is, as in "outside the range of …".
    pub about: &'static str,
}

/// Everything an element announces when it is assembled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Declared {
    /// States, in the order in which [`Evaluated::state`] counts them.
    pub states: Vec<StateDeclared>,
    /// Inputs, in the order of [`Evaluated::input`].
    pub inputs: Vec<InputDeclared>,
    /// Outputs, in the order of [`Effort::output`].
    pub outputs: Vec<OutputDeclared>,
    /// Physical limits.
    pub limits: Vec<LimitDeclared>,
    /// Ranges in which the element can be trusted.
    pub ranges: Vec<RangeDeclared>,
    /// Bodies whose joint angle nothing depends on because of this element (rolling wheels).
    pub spinning: Vec<BodyIndex>,
    /// Full signal names of the multipliers of constraints that the element reads, in the order of [`Evaluated::multiplier`].
    pub multipliers: Vec<String>,
    /// Whether the element only tells: it exerts nothing, stores nothing and has no rows. Where outputs are not asked for, neither is it.
    pub tells_only: bool,
}

/// Energy account of an element. With P the power that its wrenches and joint efforts deliver,
/// `P = −d(stored)/dt + supplied − dissipated`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Energy<S> {
    /// Stored energy, J.
    pub stored: S,
    /// Power that comes in from outside (inputs, a moving road, a prescribed wind), W.
    pub supplied: S,
    /// Power turned into heat, W.
    pub dissipated: S,
}

/// The evaluated system, as an element sees it.
#[derive(Debug)]
pub struct Evaluated<'a, S> {
    /// The tree.
    pub model: &'a Model,
    /// Time, s.
    pub time: f64,
    pub(crate) position: &'a Position<S>,
    pub(crate) world: &'a World<S>,
    pub(crate) velocity: &'a Velocity<S>,
    pub(crate) acceleration: &'a Acceleration<S>,
    pub(crate) states: &'a [S],
    pub(crate) state_rates: &'a [S],
    pub(crate) inputs: &'a [S],
    pub(crate) input_map: &'a [usize],
    pub(crate) multipliers: &'a [S],
    pub(crate) multiplier_map: &'a [usize],
    /// Set where an acceleration or the rate of a state is read.
    pub(crate) reads_rates: &'a Cell<bool>,
}

impl<S: SystemScalar> Evaluated<'_, S> {
    /// Pose of a body in the world.
    #[inline]
    pub fn X_WB(&self, body: BodyIndex) -> &Pose<S> {
        &self.world.X_WB[body.0]
    }

    /// Twist of a body, in body axes about the body origin.
    #[inline]
    pub fn V_WB(&self, body: BodyIndex) -> &Twist<S> {
        &self.velocity.V_WB[body.0]
    }

    /// Angular velocity of a body, in world axes.
    #[inline]
    pub fn w_WB(&self, body: BodyIndex) -> Vec3<S> {
        self.X_WB(body).R * self.V_WB(body).w
    }

    /// Velocity, in world axes, of the point of a body that is at `p_WQ`.
    #[inline]
    pub fn v_WQ(&self, body: BodyIndex, p_WQ: Vec3<S>) -> Vec3<S> {
        self.motion_at(body, p_WQ).1
    }

    /// Angular velocity of a body, and velocity of its point that is at `p_WQ`, in world axes.
    #[inline(always)]
    pub fn motion_at(&self, body: BodyIndex, p_WQ: Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let (X, V) = (self.X_WB(body), self.V_WB(body));
        let w = X.R * V.w;
        (w, X.R * V.v + w.cross(p_WQ - X.p))
    }

    /// Position in the world of a point fixed in a body.
    #[inline]
    pub fn p_WQ(&self, body: BodyIndex, p_BQ: Vec3<f64>) -> Vec3<S> {
        self.X_WB(body).point_const(p_BQ)
    }

    /// Acceleration, in world axes, of a point fixed in a body.
    #[inline]
    pub fn a_WQ(&self, body: BodyIndex, p_BQ: Vec3<f64>) -> Vec3<S> {
        self.reads_rates.set(true);
        let (X, V, A) = (self.X_WB(body), self.V_WB(body), &self.acceleration.A_WB[body.0]);
        let p = Vec3::from_f64(p_BQ);
        let in_body = A.v + A.w.cross(p) + V.w.cross(V.v + V.w.cross(p));
        X.R * in_body + Vec3::from_f64(self.model.gravity())
    }

    /// First coordinate of the joint that carries a body.
    #[inline]
    pub fn coordinate(&self, body: BodyIndex) -> S {
        self.position.q[self.model.body(body).q.start]
    }

    /// First velocity of the joint that carries a body.
    #[inline]
    pub fn speed(&self, body: BodyIndex) -> S {
        self.velocity.v[self.model.body(body).v.start]
    }

    /// All velocities of the joint that carries a body.
    #[inline]
    pub fn speeds(&self, body: BodyIndex) -> &[S] {
        &self.velocity.v[self.model.body(body).v.clone()]
    }

    /// First acceleration of the joint that carries a body.
    #[inline]
    pub fn acceleration(&self, body: BodyIndex) -> S {
        self.reads_rates.set(true);
        self.acceleration.vd[self.model.body(body).v.start]
    }

    /// Angular acceleration of a body, in world axes.
    #[inline]
    pub fn alpha_WB(&self, body: BodyIndex) -> Vec3<S> {
        self.reads_rates.set(true);
        self.X_WB(body).R * self.acceleration.A_WB[body.0].w
    }

    /// An own state.
    #[inline]
    pub fn state(&self, i: usize) -> S {
        self.states[i]
    }

    /// The rate of an own state.
    #[inline]
    pub fn state_rate(&self, i: usize) -> S {
        self.reads_rates.set(true);
        self.state_rates[i]
    }

    /// A declared input.
    #[inline]
    pub fn input(&self, i: usize) -> S {
        self.inputs[self.input_map[i]]
    }

    /// A declared multiplier of a constraint: the force or moment with which the constraint holds.
    #[inline]
    pub fn multiplier(&self, i: usize) -> S {
        self.multipliers[self.multiplier_map[i]]
    }
}

/// What an element adds to the system.
#[derive(Debug)]
pub struct Effort<'a, S> {
    pub(crate) model: &'a Model,
    pub(crate) world: &'a World<S>,
    pub(crate) applied: &'a mut [Wrench<S>],
    pub(crate) tau: &'a mut [S],
    pub(crate) rows: &'a mut [S],
    pub(crate) outputs: &'a mut [S],
}

impl<S: SystemScalar> Effort<'_, S> {
    /// Force `f_W` on a body at the point `p_WQ`, both in the world.
    #[inline]
    pub fn force(&mut self, body: BodyIndex, p_WQ: Vec3<S>, f_W: Vec3<S>) {
        self.force_and_moment(body, p_WQ, f_W, Vec3::zero());
    }

    /// Force at a point and a free moment on a body, in the world.
    #[inline(always)]
    pub fn force_and_moment(&mut self, body: BodyIndex, p_WQ: Vec3<S>, f_W: Vec3<S>, n_W: Vec3<S>) {
        if body == BodyIndex::WORLD {
            return;
        }
        let X = &self.world.X_WB[body.0];
        let n = n_W + (p_WQ - X.p).cross(f_W);
        self.applied[body.0] += Wrench::new(X.R.inverse_times(n), X.R.inverse_times(f_W));
    }

    /// Free moment on a body, in the world.
    #[inline]
    pub fn moment(&mut self, body: BodyIndex, n_W: Vec3<S>) {
        if body == BodyIndex::WORLD {
            return;
        }
        let R = &self.world.X_WB[body.0].R;
        self.applied[body.0] += Wrench::new(R.inverse_times(n_W), Vec3::zero());
    }

    /// Effort on the first coordinate of the joint that carries a body (the reaction on the parent is implied).
    #[inline]
    pub fn joint(&mut self, body: BodyIndex, effort: S) {
        self.tau[self.model.body(body).v.start] += effort;
    }

    /// Residual of the row of an own state.
    #[inline]
    pub fn row(&mut self, i: usize, residual: S) {
        self.rows[i] = residual;
    }

    /// Value of a declared output.
    #[inline]
    pub fn output(&mut self, i: usize, value: S) {
        self.outputs[i] = value;
    }
}

/// A force element as its author writes it: generic over the scalar, never stored.
pub trait ForceLaw: Send + Sync + 'static {
    /// States, inputs, outputs and limits; `element` is the name the user gave, for full signal names.
    fn declare(&self, element: &str) -> Declared;
    /// Adds forces, writes rows and outputs.
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>);
    /// Energy account.
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S>;
    /// What drawings show of it; nothing without an override.
    fn outlines(&self, _model: &Model) -> Vec<Outline> {
        Vec::new()
    }
}

/// A force element as the system stores it: object-safe for one scalar.
trait ForceTwin<S>: Send + Sync {
    fn apply(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>);
    fn energy(&self, at: &Evaluated<'_, S>) -> Energy<S>;
    fn outlines(&self, model: &Model) -> Vec<Outline>;
}

impl<L: ForceLaw, S: SystemScalar> ForceTwin<S> for L {
    fn apply(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        ForceLaw::apply(self, at, out);
    }
    fn energy(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        ForceLaw::energy(self, at)
    }
    fn outlines(&self, model: &Model) -> Vec<Outline> {
        ForceLaw::outlines(self, model)
    }
}

struct Twins;

impl Family for Twins {
    type Of<S: SystemScalar> = Arc<dyn ForceTwin<S>>;
}

struct Maker<L>(Arc<L>);

impl<L: ForceLaw> Make<Twins> for Maker<L> {
    fn make<S: SystemScalar>(&self) -> Arc<dyn ForceTwin<S>> {
        self.0.clone()
    }
}

/// Any force element, with its name and what it declared.
pub struct Force {
    name: String,
    declared: Declared,
    law: Arc<dyn Any + Send + Sync>,
    twins: PerScalar<Twins>,
}

impl std::fmt::Debug for Force {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Force").field("name", &self.name).field("declared", &self.declared).finish_non_exhaustive()
    }
}

impl Force {
    /// Stores a law under the name the user gave.
    pub fn new<L: ForceLaw>(name: impl Into<String>, law: L) -> Self {
        let name = name.into();
        let declared = law.declare(&name);
        let law = Arc::new(law);
        Self { name, declared, law: law.clone(), twins: PerScalar::new(&Maker(law)) }
    }

    /// The law as its author wrote it, where it is an `L`: for services that read its parameters.
    pub fn law<L: ForceLaw>(&self) -> Option<&L> {
        self.law.downcast_ref()
    }

    /// Name in the description.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// States, inputs, outputs and limits.
    pub fn declared(&self) -> &Declared {
        &self.declared
    }

    /// Adds forces, writes rows and outputs.
    #[inline]
    pub fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        S::pick(&self.twins).apply(at, out);
    }

    /// Energy account.
    #[inline]
    pub fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        S::pick(&self.twins).energy(at)
    }

    /// What drawings show of it.
    pub fn outlines(&self, model: &Model) -> Vec<Outline> {
        f64::pick(&self.twins).outlines(model)
    }
}
