//! Written form of the tire.

use super::carcass::RoadContact;
use super::carcass_description::{CarcassDescription, carcass};
use super::compact_motorcycle::CompactMotorcycleParameters;
use super::element::Tire;
use super::invalid::InvalidTireData;
use super::law::AnyTireLaw;
use super::linear_normalized::LinearNormalizedParameters;
use super::magic_formula_motorcycle::MagicFormulaMotorcycleParameters;
use super::rolling_resistance::RollingResistance;
use super::sharp_linear::SharpLinearParameters;
use super::wheel::Wheel;
use mbody::assembly::{ElementDescription, Site};
use mbody::contact::Profile;
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::{Angle, Length, Number, Pressure, Speed};
use mbody::description::quantity::{Fraction, NonNegativeQuantity, PositiveQuantity, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Speed below which slips are rounded where nobody says otherwise, m/s.
pub(super) const LOW_SPEED: f64 = 0.1;
/// Share of the compression in the effective rolling radius where nobody says otherwise.
const EFFECTIVE_RADIUS_FRACTION: f64 = 1.0 / 3.0;
/// Relative difference of two statements of the radius that is put down to rounding.
pub(super) const SAME_RADIUS: f64 = 1e-3;

/// A tire on a wheel that rolls on the road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TireDescription {
    /// Name of the wheel joint; its axis points left, and the origin of its child is the center of the wheel.
    wheel: String,
    /// Free radius on the middle plane.
    #[schemars(extend("plausible" = [0.05, 1.0]))]
    radius: PositiveQuantity<Length>,
    /// Shape of the cross-section.
    crown: CrownDescription,
    /// Springs between rim and road, and how side forces build up.
    carcass: CarcassDescription,
    /// Friction at the contact.
    law: LawDescription,
    /// Whether the tire can leave the road; it can where left out.
    #[serde(default)]
    contact: ContactDescription,
    /// Rolling resistance; none where left out.
    rolling_resistance: Option<RollingResistanceDescription>,
    /// Inflation pressure, for the rolling resistance that depends on it.
    #[schemars(extend("plausible" = [3e4, 1e6]))]
    pressure: Option<PositiveQuantity<Pressure>>,
    /// Share of the compression by which the effective rolling radius is smaller than the free one; 1/3 where left out.
    effective_radius_fraction: Option<Quantity<Number, Fraction>>,
    /// Speed below which slips are rounded; 0.1 m/s where left out.
    low_speed: Option<PositiveQuantity<Speed>>,
    /// Name of the road under this wheel: inputs `<road>.height` and `<road>.height_rate`; `road` where left out, which all such wheels share.
    /// A rigid tire has none.
    road: Option<String>,
}

/// Shape of the cross-section.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CrownDescription {
    /// A sharp edge.
    Disc,
    /// A circular arc.
    Torus(TorusDescription),
    /// Part of an ellipse.
    Ellipse(EllipseDescription),
    /// A measured shape.
    Table(CrownTable),
}

/// A circular arc.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorusDescription {
    /// Radius of the arc.
    #[schemars(extend("plausible" = [0.001, 0.3]))]
    radius: PositiveQuantity<Length>,
}

/// Part of an ellipse whose axes lie in the middle plane and across it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EllipseDescription {
    /// Semi-axis in the middle plane.
    radial: PositiveQuantity<Length>,
    /// Semi-axis across it.
    lateral: PositiveQuantity<Length>,
}

/// Distance from the wheel center to the tangent of given inclination, at least four points; mirrored where it starts at 0.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrownTable {
    /// Inclinations of the tangent, increasing, positive where the wheel leans right.
    inclination: Vec<Quantity<Angle>>,
    /// Distances of the tangent from the center.
    support: Vec<PositiveQuantity<Length>>,
}

/// Friction law with its parameters (in SI), or a file that holds one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LawDescription {
    /// The shape of the Magic Formula on a handful of numbers.
    CompactMotorcycle(CompactMotorcycleParameters),
    /// Motorcycle Magic Formula of Sharp, Evangelou and Limebeer.
    MagicFormulaMotorcycle(MagicFormulaMotorcycleParameters),
    /// Linear, stiffnesses per load.
    LinearNormalized(LinearNormalizedParameters),
    /// Linear, stiffnesses as polynomials of the load.
    SharpLinear(SharpLinearParameters),
    /// Name of a file with one of the other entries.
    File(String),
}

/// Whether the tire can leave the road.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactDescription {
    /// The tire lifts where the road would have to pull.
    #[default]
    Lifting,
    /// The road pulls where it has to.
    Bonded,
}

/// Rolling resistance coefficient.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RollingResistanceDescription {
    /// The same at every speed.
    Constant(NonNegativeQuantity<Number>),
    /// Grows with the square of the speed.
    Quadratic(QuadraticResistance),
    /// From the pressure of the tire, after Cossalter.
    Pressure,
}

/// Rolling resistance coefficient that grows with the square of the speed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuadraticResistance {
    /// Coefficient at rest.
    at_rest: NonNegativeQuantity<Number>,
    /// Growth with the square of the speed, in s²/m².
    per_speed_squared: f64,
}

impl ElementDescription for TireDescription {
    const KIND: &'static str = "tire";
    const ABOUT: &'static str = "tire on a wheel: cross-section, carcass, friction law, rolling resistance";
    const EXAMPLE: &'static str = "{ wheel: front_axle, radius: 0.3 m, crown: { torus: { radius: 60 mm } }, \
        carcass: { deformable: { radial: { stiffness: 150 kN/m, damping: 300 N s/m }, lateral: { stiffness: 160 kN/m, damping: 100 N s/m } } }, \
        law: { compact_motorcycle: { nominal_load: 1300, longitudinal: { stiffness: { constant: 20 }, peak: { constant: 1.2 }, shape: 1.5 }, \
        lateral: { cornering_stiffness: { constant: 14 }, camber_stiffness: { constant: 0.9 }, peak: { constant: 1.25 }, \
        cornering_shape: 1.1, camber_shape: 0.7 }, aligning: { pneumatic_trail: 0.025, twisting_moment: 0.015 } } }, \
        rolling_resistance: pressure, pressure: 2.25 bar, road: front_road }";
    type Law = Tire;
    fn assemble(self, site: &mut Site<'_>) -> Option<Tire> {
        let profile = self.profile(site);
        let rolling_resistance = self.rolling_resistance(site);
        let law = friction_law(self.law, site);
        let rigid = matches!(self.carcass, CarcassDescription::Rigid(_));
        if let (true, Some(road)) = (rigid, &self.road) {
            let message = format!("a rigid tire stays on the level road, so the road `{road}` has no height");
            site.find("road", Finding::error("contradictory_entries", message).with_hint("leave the entry out"));
        }
        let mut wheel = profile.and_then(|profile| wheel(site, &self.wheel, profile, self.road));
        if let (true, Some(wheel)) = (rigid, &mut wheel) {
            wheel.road = None;
        }
        let carcass = carcass(self.carcass, wheel.as_ref(), site);
        Some(Tire {
            wheel: wheel?,
            carcass: carcass?,
            law: law?,
            contact: match self.contact {
                ContactDescription::Lifting => RoadContact::Lifting,
                ContactDescription::Bonded => RoadContact::Bonded,
            },
            rolling_resistance: rolling_resistance?,
            effective_radius_fraction: self.effective_radius_fraction.map_or(EFFECTIVE_RADIUS_FRACTION, Quantity::si),
            low_speed: self.low_speed.map_or(LOW_SPEED, Quantity::si),
        })
    }
}

impl TireDescription {
    fn profile(&self, site: &mut Site<'_>) -> Option<Profile> {
        let radius = self.radius.si();
        let profile = match &self.crown {
            CrownDescription::Disc => Profile::disc(radius),
            CrownDescription::Torus(torus) => Profile::torus(radius, torus.radius.si()),
            CrownDescription::Ellipse(e) => Profile::ellipse(radius, e.radial.si(), e.lateral.si()),
            CrownDescription::Table(table) => {
                let inclinations: Vec<f64> = table.inclination.iter().map(|g| g.si()).collect();
                let supports: Vec<f64> = table.support.iter().map(|s| s.si()).collect();
                Profile::table(&inclinations, &supports)
            }
        };
        let profile = profile.map_err(|error| site.refuse("crown", "invalid_crown", error.to_string())).ok()?;
        if (profile.radius() / radius - 1.0).abs() > SAME_RADIUS {
            let found = profile.radius();
            site.refuse(
                "crown",
                "contradictory_entries",
                format!("the table gives {found} m on the middle plane, but `radius` is {radius} m"),
            );
            return None;
        }
        Some(profile)
    }

    fn rolling_resistance(&self, site: &mut Site<'_>) -> Option<RollingResistance> {
        let resistance = match (&self.rolling_resistance, self.pressure) {
            (None, _) => RollingResistance::Constant(0.0),
            (Some(RollingResistanceDescription::Constant(value)), _) => RollingResistance::Constant(value.si()),
            (Some(RollingResistanceDescription::Quadratic(q)), _) => {
                RollingResistance::Quadratic { at_rest: q.at_rest.si(), per_speed_squared: q.per_speed_squared }
            }
            (Some(RollingResistanceDescription::Pressure), Some(pressure)) => RollingResistance::Pressure { pressure: pressure.si() },
            (Some(RollingResistanceDescription::Pressure), None) => {
                site.refuse(
                    "rolling_resistance",
                    "missing_entry",
                    "rolling resistance from the pressure needs the entry `pressure` of the tire",
                );
                return None;
            }
        };
        checked("rolling_resistance", resistance.checked(), site)
    }
}

/// The wheel carried by a joint, refused where the joint does not turn to the left.
pub(super) fn wheel(site: &mut Site<'_>, joint: &str, profile: Profile, road: Option<String>) -> Option<Wheel> {
    let body = site.joint_with("wheel", joint, "rad")?;
    let Some(wheel) = Wheel::new(site.model(), body, profile, road.unwrap_or_else(|| "road".into())) else {
        site.refuse("wheel", "wrong_joint", format!("joint `{joint}` does not turn about a fixed axis, as a wheel does"));
        return None;
    };
    let left = (site.design_pose(wheel.carrier).R * wheel.axis).y;
    // a wheel may be toed in or cambered, but not lie across
    if left > 0.5 {
        return Some(wheel);
    }
    let points = if left < -0.5 { "right" } else { "neither left nor right" };
    site.refuse(
        "wheel",
        "wrong_axis",
        format!("the axis of the wheel joint `{joint}` points {points} in the design pose; it must point left (+y), so that a wheel that rolls forward turns in the positive sense"),
    );
    None
}

/// The law of a description; a file holds the same entry as the description would.
fn friction_law(description: LawDescription, site: &mut Site<'_>) -> Option<AnyTireLaw> {
    let (key, parameters) = match description {
        LawDescription::File(name) => ("law.file", law_file(&name, site)?),
        parameters => ("law", parameters),
    };
    match parameters {
        LawDescription::CompactMotorcycle(p) => checked(key, p.law(), site).map(AnyTireLaw::new),
        LawDescription::MagicFormulaMotorcycle(p) => checked(key, p.law(), site).map(AnyTireLaw::new),
        LawDescription::LinearNormalized(p) => checked(key, p.law(), site).map(AnyTireLaw::new),
        LawDescription::SharpLinear(p) => checked(key, p.law(), site).map(AnyTireLaw::new),
        LawDescription::File(name) => {
            site.refuse(
                key,
                "invalid_tire_file",
                format!("file `{name}` is named by another file; a tire file holds the parameters themselves"),
            );
            None
        }
    }
}

/// The single entry of a tire file.
fn law_file(name: &str, site: &mut Site<'_>) -> Option<LawDescription> {
    let text = site.text("law.file", name)?;
    // through a plain value: in it a choice is a mapping with one key, as in descriptions
    let value = serde_yaml::from_str::<serde_json::Value>(&text).map_err(|error| error.to_string());
    let law = value.and_then(|value| {
        serde_path_to_error::deserialize::<_, LawDescription>(&value).map_err(|error| format!("{} at `{}`", error.inner(), error.path()))
    });
    law.map_err(|error| site.refuse("law.file", "invalid_tire_file", format!("file `{name}`: {error}"))).ok()
}

/// A value that may be refused, with its finding.
pub(super) fn checked<T>(key: &str, result: Result<T, InvalidTireData>, site: &mut Site<'_>) -> Option<T> {
    result.map_err(|error| site.refuse(key, "invalid_tire_data", error.to_string())).ok()
}
