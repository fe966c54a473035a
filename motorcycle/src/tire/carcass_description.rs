//! Written form of the carcass.

use super::carcass::{Elastic, RelaxationLength};
use super::deformable::Deformable;
use super::description::SAME_RADIUS;
use super::element::Carcass;
use super::relaxation::Relaxation;
use super::rigid::Rigid;
use super::tir::PropertyFile;
use super::vertical::Vertical;
use super::wheel::Wheel;
use mbody::assembly::Site;
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::{Damping, Length, Pressure, Stiffness};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Quantity of the force with which a `surface_contact` holds a wheel.
const NORMAL_FORCE: &str = "normal_force";

/// Springs between rim and road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CarcassDescription {
    /// Springs along radius and axle of the rim: side forces build up by the deformation, forces act where the deformed tire touches.
    Deformable(DeformableDescription),
    /// A spring along the normal of the road, with a relaxation of slip or force.
    Vertical(VerticalDescription),
    /// Rigid, with a relaxation of slip or force; a constraint holds the wheel on the road.
    Rigid(RigidDescription),
}

impl CarcassDescription {
    /// Stiffness of the spring that side forces build up over, N/m, where there is one.
    pub(super) fn lateral_stiffness(&self) -> Option<f64> {
        let of = |relaxation: &RelaxationDescription| match relaxation {
            RelaxationDescription::Elastic(spring) => Some(spring.stiffness.si()),
            _ => None,
        };
        match self {
            Self::Deformable(c) => Some(c.lateral.stiffness.si()),
            Self::Vertical(c) => of(&c.relaxation),
            Self::Rigid(c) => of(&c.relaxation),
        }
    }
}

/// Springs along radius and axle of the rim.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeformableDescription {
    /// Along the radius.
    radial: ElasticDescription,
    /// Along the axle; the relaxation length is the cornering stiffness over this stiffness.
    lateral: ElasticDescription,
    /// Along the circumference; rigid where left out.
    longitudinal: Option<ElasticDescription>,
}

/// A spring and a damper.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticDescription {
    /// Stiffness.
    #[schemars(extend("plausible" = [3e3, 5e6]))]
    stiffness: PositiveQuantity<Stiffness>,
    /// Damping; more than nothing, so that a tire in the air comes to rest.
    damping: PositiveQuantity<Damping>,
}

impl ElasticDescription {
    fn elastic(self) -> Elastic {
        Elastic { stiffness: self.stiffness.si(), damping: self.damping.si() }
    }
}

/// A spring along the normal of the road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VerticalDescription {
    /// Stiffness.
    #[schemars(extend("plausible" = [1e4, 5e6]))]
    stiffness: PositiveQuantity<Stiffness>,
    /// Growth of the force with the square of the compression, in N/m²; none where left out.
    stiffness_quadratic: Option<NonNegativeQuantity<Pressure>>,
    /// Damping.
    damping: NonNegativeQuantity<Damping>,
    /// How side forces build up; at once where left out.
    #[serde(default)]
    relaxation: RelaxationDescription,
}

/// A tire that does not give way.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidDescription {
    /// Name of the constraint `surface_contact` that holds this wheel on the road; its force is the load.
    contact: String,
    /// How side forces build up; at once where left out.
    #[serde(default)]
    relaxation: RelaxationDescription,
}

/// How side forces build up.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RelaxationDescription {
    /// At once.
    #[default]
    None,
    /// By a spring along the road.
    Elastic(ElasticDescription),
    /// By a lag of the slip.
    Slip(SlipLagDescription),
    /// By a lag of the side force.
    Force(ForceLagDescription),
    /// By a lag of the side force except what camber alone produces.
    ForceWithoutCamber(ForceLagDescription),
    /// By a lag of both slips over the lengths of the tire property file, where it has them.
    OfFile,
}

/// A lag of the slip.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlipLagDescription {
    /// Length over which lateral slip builds up.
    length: LengthDescription,
    /// Length over which longitudinal slip builds up; at once where left out.
    longitudinal_length: Option<LengthDescription>,
}

/// A lag of the side force.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceLagDescription {
    /// Length over which the force builds up.
    length: LengthDescription,
}

/// A relaxation length.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LengthDescription {
    /// The same at every load and speed.
    Constant(NonNegativeQuantity<Length>),
    /// Coefficients of a polynomial of the load in N that gives m, constant coefficient first.
    LoadPolynomial(Vec<f64>),
    /// c0, c1, c2 of `K (c0 + c1 V + c2 V²)` with the cornering stiffness K, N/rad, and the speed V, m/s.
    CorneringStiffness([f64; 3]),
}

impl LengthDescription {
    fn length(self) -> RelaxationLength {
        match self {
            Self::Constant(length) => RelaxationLength::Constant(length.si()),
            Self::LoadPolynomial(coefficients) => RelaxationLength::LoadPolynomial(coefficients),
            Self::CorneringStiffness(coefficients) => RelaxationLength::CorneringStiffness(coefficients),
        }
    }
}

/// The carcass of a description.
///
/// `file`: the property file that the law comes from.
pub(super) fn carcass(
    description: CarcassDescription,
    wheel: Option<&Wheel>,
    file: Option<&PropertyFile>,
    site: &mut Site<'_>,
) -> Option<Carcass> {
    match description {
        CarcassDescription::Deformable(c) => {
            let longitudinal = c.longitudinal.map(ElasticDescription::elastic);
            let carcass = Deformable { radial: c.radial.elastic(), lateral: c.lateral.elastic(), longitudinal };
            warn_of_snapping(&carcass, site);
            Some(Carcass::Deformable(carcass))
        }
        CarcassDescription::Vertical(c) => Some(Carcass::Vertical(Vertical {
            normal: Elastic { stiffness: c.stiffness.si(), damping: c.damping.si() },
            quadratic: c.stiffness_quadratic.map_or(0.0, Quantity::si),
            relaxation: relaxation("carcass.vertical.relaxation", c.relaxation, file, site)?,
        })),
        CarcassDescription::Rigid(c) => {
            let relaxation = relaxation("carcass.rigid.relaxation", c.relaxation, file, site);
            let load = holding(&c.contact, wheel?, site);
            Some(Carcass::Rigid(Rigid { load: load?, relaxation: relaxation? }))
        }
    }
}

/// A warning where the lateral damper is too weak beside the radial one for friction 1.
fn warn_of_snapping(carcass: &Deformable, site: &mut Site<'_>) {
    let least = Deformable::least_lateral_damping(1.0) * carcass.radial.damping;
    if carcass.lateral.damping < least {
        let message = format!(
            "the lateral damper ({} N s/m) is so weak beside the radial one ({} N s/m) that the patch may snap where a leaning wheel slides",
            carcass.lateral.damping, carcass.radial.damping
        );
        let hint = format!("give {least:.0} N s/m or more; violent rides end `not_converged` otherwise");
        site.find("carcass.deformable.lateral.damping", Finding::warning("weak_lateral_damper", message).with_hint(hint));
    }
}

/// The carcass of a tire property file: a spring along the normal of the road, and a lag of both slips.
///
/// The load of 6.x is `Fz = (q1 ρ/R0 + Q_FZ2 (ρ/R0)²) Fz0 (1 + PFZ1 p)`, `q1² = (Cz R0/Fz0)² − 4 Q_FZ2`; its changes with speed and with the forces in the plane
/// of the road are left out. Source: H. B. Pacejka, *Tire and Vehicle Dynamics*, 3rd ed., equation 4.E68.
pub(super) fn carcass_of_file(file: &PropertyFile, pressure: Option<f64>, site: &mut Site<'_>) -> Option<Carcass> {
    let c = &file.coefficients;
    if c.VERTICAL_STIFFNESS <= 0.0 {
        let message = format!("`{}` has no `VERTICAL_STIFFNESS`, so the springs of the tire must be given", file.name);
        site.find("", Finding::error("missing_key", message).with_hint("add `carcass: { vertical: { stiffness: …, damping: … } }`"));
        return None;
    }
    let inflated = match c.NOMPRES > 0.0 {
        true => 1.0 + c.PFZ1 * (pressure.unwrap_or(if c.INFLPRES > 0.0 { c.INFLPRES } else { c.NOMPRES }) / c.NOMPRES - 1.0),
        false => 1.0,
    };
    let (radius, load) = (c.UNLOADED_RADIUS, c.FNOMIN);
    let square = (c.VERTICAL_STIFFNESS * radius / load).powi(2) - 4.0 * c.Q_FZ2;
    if square <= 0.0 {
        site.refuse(
            "law.tir",
            "out_of_range",
            format!("`Q_FZ2` of `{}` is {}, too large for its `VERTICAL_STIFFNESS`", file.name, c.Q_FZ2),
        );
        return None;
    }
    Some(Carcass::Vertical(Vertical {
        normal: Elastic { stiffness: square.sqrt() * load / radius * inflated, damping: c.VERTICAL_DAMPING },
        quadratic: c.Q_FZ2 * load / (radius * radius) * inflated,
        relaxation: relaxation_of_file(file),
    }))
}

/// Lag of slips over the lengths of the law, where the file has them; at once where it has none.
fn relaxation_of_file(file: &PropertyFile) -> Relaxation {
    let c = &file.coefficients;
    let longitudinal = (c.PTX1 != 0.0 || c.LONGITUDINAL_STIFFNESS > 0.0).then_some(RelaxationLength::LongitudinalOfLaw);
    match c.PTY1 != 0.0 || c.LATERAL_STIFFNESS > 0.0 {
        true => Relaxation::Slip { lateral: RelaxationLength::LateralOfLaw, longitudinal },
        false => Relaxation::None,
    }
}

fn relaxation(key: &str, description: RelaxationDescription, file: Option<&PropertyFile>, site: &mut Site<'_>) -> Option<Relaxation> {
    let relaxation = match description {
        RelaxationDescription::None => Relaxation::None,
        RelaxationDescription::Elastic(spring) => Relaxation::Elastic(spring.elastic()),
        RelaxationDescription::Slip(lag) => {
            Relaxation::Slip { lateral: lag.length.length(), longitudinal: lag.longitudinal_length.map(LengthDescription::length) }
        }
        RelaxationDescription::OfFile => match file {
            Some(file) => relaxation_of_file(file),
            None => {
                let finding = Finding::error("contradictory_entries", "relaxation lengths `of_file` need a law from a tire property file");
                site.find(key, finding.with_hint("give lengths: `relaxation: { slip: { length: { constant: 0.15 m } } }`"));
                return None;
            }
        },
        RelaxationDescription::Force(lag) => Relaxation::Force(lag.length.length()),
        RelaxationDescription::ForceWithoutCamber(lag) => Relaxation::ForceWithoutCamber(lag.length.length()),
    };
    let lengths = match &relaxation {
        Relaxation::None | Relaxation::Elastic(_) => [None, None],
        Relaxation::Slip { lateral, longitudinal } => [Some(lateral), longitudinal.as_ref()],
        Relaxation::Force(length) | Relaxation::ForceWithoutCamber(length) => [Some(length), None],
    };
    if lengths.into_iter().flatten().any(|length| matches!(length, RelaxationLength::LoadPolynomial(c) if c.is_empty())) {
        site.refuse(key, "missing_entry", "a relaxation length as a polynomial of the load needs coefficients");
        return None;
    }
    Some(relaxation)
}

/// The force of the constraint that holds a wheel on the road, refused where it holds something else.
fn holding(contact: &str, wheel: &Wheel, site: &mut Site<'_>) -> Option<String> {
    const KEY: &str = "carcass.rigid.contact";
    let constraint = site.constraint(KEY, contact)?;
    let pushes = constraint.rows().len() == 1 && constraint.rows()[0].multiplier == NORMAL_FORCE;
    if !pushes || constraint.spinning(site.model()) != Some(wheel.body) {
        let held = site.model().body(wheel.body).name.clone();
        let finding = Finding::error("wrong_constraint", format!("constraint `{contact}` does not hold the wheel `{held}` on the road"));
        site.find(KEY, finding.with_hint("it must be a `surface_contact` of the wheel, about the axis of the wheel joint"));
        return None;
    }
    let depth = wheel.depth(&site.design_pose(wheel.body), &site.design_pose(wheel.carrier));
    if depth.abs() > SAME_RADIUS * wheel.profile.radius() {
        let message = format!("constraint `{contact}` holds the wheel so that the tire is {:.4} mm deep in the road", 1e3 * depth);
        site.find(KEY, Finding::error("contradictory_entries", message).with_hint("give both the same radius and crown"));
        return None;
    }
    Some(format!("{contact}.{NORMAL_FORCE}"))
}
