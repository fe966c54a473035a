//! Written form of one-dimensional force laws, for joints that slide and joints that turn alike.

use super::Site;
use crate::description::quantity::dimension::{
    Angle, AngularDamping, AngularSpeed, AngularStiffness, Damping as DampingUnit, Force, Length, Number, Speed, Stiffness, Torque,
};
use crate::description::quantity::{Dimensioned, NonNegativeQuantity, PositiveQuantity, Quantity};
use crate::force::{Air, Damping, Friction, Spring, SpringDamperLaw, Stops};
use crate::scalar::{CubicSpline, Pchip, spline::CurveError, spline::Ends};
use schemars::JsonSchema;
use serde::Deserialize;

/// The dimensions of a sliding or of a turning deflection.
pub trait Motion: Clone + std::fmt::Debug + 'static {
    /// Deflection.
    type Deflection: Dimensioned + Clone + std::fmt::Debug + 'static;
    /// Rate of the deflection.
    type Rate: Dimensioned + Clone + std::fmt::Debug + 'static;
    /// Force or torque.
    type Effort: Dimensioned + Clone + std::fmt::Debug + 'static;
    /// Effort per deflection.
    type Stiffness: Dimensioned + Clone + std::fmt::Debug + 'static;
    /// Effort per rate.
    type Damping: Dimensioned + Clone + std::fmt::Debug + 'static;
}

/// Deflections in m, forces in N.
#[derive(Clone, Debug, JsonSchema)]
pub struct Sliding;

/// Deflections in rad, torques in N m.
#[derive(Clone, Debug, JsonSchema)]
pub struct Turning;

impl Motion for Sliding {
    type Deflection = Length;
    type Rate = Speed;
    type Effort = Force;
    type Stiffness = Stiffness;
    type Damping = DampingUnit;
}

impl Motion for Turning {
    type Deflection = Angle;
    type Rate = AngularSpeed;
    type Effort = Torque;
    type Stiffness = AngularStiffness;
    type Damping = AngularDamping;
}

/// Elastic part: a linear spring, or a table.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct SpringDescription<M: Motion> {
    /// Stiffness of the linear spring.
    pub stiffness: Option<NonNegativeQuantity<M::Stiffness>>,
    /// Force of the linear spring where the deflection equals `reference`.
    pub preload: Option<Quantity<M::Effort>>,
    /// Deflection at which the linear spring exerts its preload; zero where left out.
    pub reference: Option<Quantity<M::Deflection>>,
    /// Force against deflection, instead of stiffness and preload.
    pub table: Option<SpringTable<M>>,
}

/// Force against deflection, at least two points, deflections increasing.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct SpringTable<M: Motion> {
    /// Deflections, increasing.
    pub deflection: Vec<Quantity<M::Deflection>>,
    /// Forces at the deflections.
    pub force: Vec<Quantity<M::Effort>>,
}

/// Viscous part: linear, bilinear, or a table.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct DamperDescription<M: Motion> {
    /// Coefficient of a linear damper.
    pub coefficient: Option<NonNegativeQuantity<M::Damping>>,
    /// Coefficient in bump (rising deflection); goes with `rebound`.
    pub bump: Option<NonNegativeQuantity<M::Damping>>,
    /// Coefficient in rebound (falling deflection); goes with `bump`.
    pub rebound: Option<NonNegativeQuantity<M::Damping>>,
    /// Rate over which bump and rebound blend; 10 mm/s or 10 mrad/s where left out.
    pub rounding: Option<PositiveQuantity<M::Rate>>,
    /// Force against rate, instead of coefficients.
    pub table: Option<DamperTable<M>>,
}

/// Force against rate, at least two points, rates increasing.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct DamperTable<M: Motion> {
    /// Rates, increasing; positive in bump.
    pub rate: Vec<Quantity<M::Rate>>,
    /// Forces at the rates.
    pub force: Vec<Quantity<M::Effort>>,
}

/// Air column: `force·[(length/(length − x))^exponent − 1]`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AirDescription {
    /// Initial pressure times area.
    pub force: NonNegativeQuantity<Force>,
    /// Length of the column at zero deflection.
    pub length: PositiveQuantity<Length>,
    /// Polytropic exponent, 1 (slow) to 1.4 (fast).
    pub exponent: PositiveQuantity<Number>,
}

/// End stops: stiff one-sided springs that build up over a width.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct StopsDescription<M: Motion> {
    /// Deflection at which the lower stop begins (full rebound).
    pub lower: Quantity<M::Deflection>,
    /// Deflection at which the upper stop begins (full bump).
    pub upper: Quantity<M::Deflection>,
    /// Stiffness of the stops.
    pub stiffness: PositiveQuantity<M::Stiffness>,
    /// Deflection over which that stiffness builds up.
    pub width: PositiveQuantity<M::Deflection>,
}

/// Dry friction, rounded: `effort·tanh(rate/speed)`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
#[schemars(bound = "M: Motion + JsonSchema")]
pub struct FrictionDescription<M: Motion> {
    /// Friction at large rate.
    pub effort: NonNegativeQuantity<M::Effort>,
    /// Rate over which the friction changes its sign.
    pub rounding: PositiveQuantity<M::Rate>,
}

/// The parts of a one-dimensional law as written; each kind of element has them as its own keys.
#[derive(Clone, Debug)]
pub struct LawDescription<M: Motion> {
    /// Key `spring`.
    pub spring: Option<SpringDescription<M>>,
    /// Key `damper`.
    pub damper: Option<DamperDescription<M>>,
    /// Key `air`.
    pub air: Option<AirDescription>,
    /// Key `stops`.
    pub stops: Option<StopsDescription<M>>,
    /// Key `friction`.
    pub friction: Option<FrictionDescription<M>>,
}

impl<M: Motion> LawDescription<M> {
    /// The law, or findings at the keys `spring`, `damper`, `air`, `stops`, `friction`.
    pub fn law(self, site: &mut Site<'_>) -> Option<SpringDamperLaw> {
        let spring = self.spring.map_or(Some(Spring::Linear { preload: 0.0, stiffness: 0.0, reference: 0.0 }), |s| spring(s, site));
        let damping = self.damper.map_or(Some(Damping::Linear(0.0)), |d| damping(d, site));
        let air = self.air.map(|a| Air { force: a.force.si(), length: a.length.si(), exponent: a.exponent.si() });
        let stops = match self.stops {
            Some(s) if s.lower.si() >= s.upper.si() => {
                let (lower, upper) = (s.lower, s.upper);
                site.refuse("stops", "stops_crossed", format!("the lower stop at {lower} is not below the upper stop at {upper}"));
                return None;
            }
            stops => stops.map(|s| Stops { lower: s.lower.si(), upper: s.upper.si(), stiffness: s.stiffness.si(), width: s.width.si() }),
        };
        let friction = self.friction.map(|f| Friction { force: f.effort.si(), speed: f.rounding.si() });
        Some(SpringDamperLaw { spring: spring?, damping: damping?, air, stops, friction })
    }
}

fn spring<M: Motion>(s: SpringDescription<M>, site: &mut Site<'_>) -> Option<Spring> {
    let linear = s.stiffness.is_some() || s.preload.is_some() || s.reference.is_some();
    let Some(table) = s.table else {
        let si = |q: Option<Quantity<M::Effort>>| q.map_or(0.0, Quantity::si);
        let reference = s.reference.map_or(0.0, Quantity::si);
        return Some(Spring::Linear { preload: si(s.preload), stiffness: s.stiffness.map_or(0.0, Quantity::si), reference });
    };
    if linear {
        site.refuse("spring", "contradictory_entries", "a spring has either stiffness and preload or a table, not both");
        return None;
    }
    let (x, y): (Vec<f64>, Vec<f64>) =
        (table.deflection.into_iter().map(Quantity::si).collect(), table.force.into_iter().map(Quantity::si).collect());
    match CubicSpline::new(&x, &y, Ends::Natural) {
        Ok(spline) => Some(Spring::Table(spline)),
        Err(error) => {
            refuse_table(site, "spring.table", &error, ("deflection", "force"), M::Deflection::DIMENSION.unit);
            None
        }
    }
}

/// Why two lists make no table, at the entry that is to be changed.
fn refuse_table(site: &mut Site<'_>, key: &str, error: &CurveError, (x, y): (&str, &str), unit: &str) {
    let (entry, message) = match *error {
        CurveError::TooFewPoints { found, needed } => (x.to_owned(), format!("the table has {found} rows, expected at least {needed}")),
        CurveError::Unpaired { abscissas, ordinates } => (y.to_owned(), format!("`{x}` has {abscissas} values, but `{y}` has {ordinates}")),
        CurveError::NotIncreasing { point, at } => {
            (format!("{x}.{point}"), format!("`{x}` must increase, but {at} {unit} is not beyond the value before it"))
        }
        CurveError::NotFinite { point } => (format!("{y}.{point}"), "a value of the table is not finite".to_owned()),
    };
    site.refuse(&format!("{key}.{entry}"), "invalid_table", message);
}

fn damping<M: Motion>(d: DamperDescription<M>, site: &mut Site<'_>) -> Option<Damping> {
    match (d.coefficient, d.bump, d.rebound, d.table) {
        (None, None, None, None) => Some(Damping::Linear(0.0)),
        (Some(c), None, None, None) => Some(Damping::Linear(c.si())),
        (None, Some(bump), Some(rebound), None) => {
            Some(Damping::Bilinear { bump: bump.si(), rebound: rebound.si(), rounding: d.rounding.map_or(0.01, Quantity::si) })
        }
        (None, None, None, Some(table)) => {
            let (x, y): (Vec<f64>, Vec<f64>) =
                (table.rate.into_iter().map(Quantity::si).collect(), table.force.into_iter().map(Quantity::si).collect());
            match Pchip::new(&x, &y) {
                Ok(curve) => Some(Damping::Table(curve)),
                Err(error) => {
                    refuse_table(site, "damper.table", &error, ("rate", "force"), M::Rate::DIMENSION.unit);
                    None
                }
            }
        }
        _ => {
            site.refuse(
                "damper",
                "contradictory_entries",
                "a damper has either `coefficient`, or `bump` and `rebound` together, or a table: exactly one of the three",
            );
            None
        }
    }
}
