//! What a friction law is, and how one of any kind is stored.
//!
//! A law is written once, generic over the scalar; [`AnyTireLaw`] keeps it behind a pointer for every scalar of the
//! assembled system, so that derivatives come out exact.

use mbody::scalar::{Family, Make, PerScalar, SystemScalar};
use std::sync::Arc;

/// What a law is asked: load, slips, camber and speed at the contact point.
#[derive(Clone, Copy, Debug)]
pub struct Slip<S> {
    /// Normal load N, N.
    pub load: S,
    /// Lateral slip `a = −V_sy/V*`, the tangent of the slip angle, positive when the tire slides to the right.
    pub lateral: S,
    /// Longitudinal slip `κ = −V_sx/V*`; driving positive, locked wheel −1.
    pub longitudinal: S,
    /// Camber γ, rad, positive leaning right.
    pub camber: S,
    /// Reference speed V*, m/s, positive.
    pub speed: S,
}

/// What a law answers: forces and moments of the road on the tire at the contact point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Friction<S> {
    /// Force forward, N.
    pub longitudinal: S,
    /// Force to the left, N.
    pub lateral: S,
    /// Moment about the forward axis, N m, beyond what the shape of the cross-section produces by itself.
    pub overturning_moment: S,
    /// Moment of rolling resistance about the axle, N m, negative where it brakes a wheel that rolls forward; 0 for laws that know nothing of it.
    pub rolling_moment: S,
    /// Moment about the normal of the road, upward, N m.
    pub aligning_moment: S,
    /// Share of the available friction in use: 0 free, about 1 at the peak of the force; 0 for laws without a limit.
    pub utilization: S,
}

/// Within which states a tire was measured: lower and upper bound, in our axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Load, N.
    pub load: [f64; 2],
    /// Slip angle, rad.
    pub slip_angle: [f64; 2],
    /// Longitudinal slip.
    pub longitudinal_slip: [f64; 2],
    /// Camber, rad.
    pub camber: [f64; 2],
}

/// About which point a law gives its moments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MomentPoint {
    /// The point of contact, where the forces act.
    #[default]
    Contact,
    /// The point where the plane of the wheel meets the road, with all that camber does.
    WheelPlane,
    /// The same point for the aligning moment; the shape of the cross-section makes the overturning moment.
    WheelPlaneOfCrown,
}

/// A friction law: steady forces of a rolling tire.
///
/// Conditions every law keeps, checked by the tests of each: finite at zero load, smooth at zero slip, and with derivatives
/// that agree with differences of its values.
pub trait TireLaw: Send + Sync + 'static {
    /// Forces and moments at a slip, in ISO axes.
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S>;

    /// Cornering stiffness at a load and a camber, N per unit of lateral slip: what relaxation lengths are built from.
    ///
    /// It is the slope dFy/da at zero slip of the upright tire, with the parameters of that camber. In laws whose side force
    /// saturates with slip and camber together, the slope of the leaning tire itself is smaller.
    fn cornering_stiffness<S: SystemScalar>(&self, load: S, camber: S) -> S;

    /// Whether the forces have a peak, so that the utilization means something.
    fn saturates(&self) -> bool;

    /// Within which states the tire was measured, where the law knows.
    fn fit(&self) -> Option<Fit> {
        None
    }

    /// About which point the moments are.
    fn moment_point(&self) -> MomentPoint {
        MomentPoint::Contact
    }

    /// Lateral and longitudinal relaxation length at a load and a camber, m; 0 where the law knows none.
    fn relaxation_lengths<S: SystemScalar>(&self, _load: S, _camber: S) -> [S; 2] {
        [S::zero(), S::zero()]
    }

    /// Whether the law knows the rolling resistance.
    fn rolls(&self) -> bool {
        false
    }
}

/// A law for one scalar: object-safe, implemented for every [`TireLaw`].
trait LawFor<S>: Send + Sync {
    fn friction_at(&self, slip: &Slip<S>) -> Friction<S>;
    fn cornering_stiffness_at(&self, load: S, camber: S) -> S;
    fn relaxation_lengths_at(&self, load: S, camber: S) -> [S; 2];
}

impl<S: SystemScalar, L: TireLaw> LawFor<S> for L {
    fn friction_at(&self, slip: &Slip<S>) -> Friction<S> {
        self.friction(slip)
    }

    fn cornering_stiffness_at(&self, load: S, camber: S) -> S {
        self.cornering_stiffness(load, camber)
    }

    fn relaxation_lengths_at(&self, load: S, camber: S) -> [S; 2] {
        self.relaxation_lengths(load, camber)
    }
}

/// The pointers to a law, scalar by scalar.
enum LawFamily {}

impl Family for LawFamily {
    type Of<S: SystemScalar> = Arc<dyn LawFor<S>>;
}

/// Hands the same law to every scalar.
struct Shared<L>(Arc<L>);

impl<L: TireLaw> Make<LawFamily> for Shared<L> {
    fn make<S: SystemScalar>(&self) -> Arc<dyn LawFor<S>> {
        self.0.clone()
    }
}

/// A law of any kind; cheap to clone.
#[derive(Clone)]
pub struct AnyTireLaw {
    laws: Arc<PerScalar<LawFamily>>,
    saturates: bool,
    fit: Option<Fit>,
    moment_point: MomentPoint,
    rolls: bool,
}

impl AnyTireLaw {
    /// Stores a law.
    pub fn new(law: impl TireLaw) -> Self {
        let (saturates, fit, moment_point, rolls) = (law.saturates(), law.fit(), law.moment_point(), law.rolls());
        Self { laws: Arc::new(PerScalar::new(&Shared(Arc::new(law)))), saturates, fit, moment_point, rolls }
    }
}

impl std::fmt::Debug for AnyTireLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("AnyTireLaw")
    }
}

impl TireLaw for AnyTireLaw {
    #[inline]
    fn friction<S: SystemScalar>(&self, slip: &Slip<S>) -> Friction<S> {
        S::pick(&self.laws).friction_at(slip)
    }

    #[inline]
    fn cornering_stiffness<S: SystemScalar>(&self, load: S, camber: S) -> S {
        S::pick(&self.laws).cornering_stiffness_at(load, camber)
    }

    fn saturates(&self) -> bool {
        self.saturates
    }

    fn fit(&self) -> Option<Fit> {
        self.fit
    }

    fn moment_point(&self) -> MomentPoint {
        self.moment_point
    }

    #[inline]
    fn relaxation_lengths<S: SystemScalar>(&self, load: S, camber: S) -> [S; 2] {
        S::pick(&self.laws).relaxation_lengths_at(load, camber)
    }

    fn rolls(&self) -> bool {
        self.rolls
    }
}
