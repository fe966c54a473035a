//! Written form of the tire.

use super::carcass::RoadContact;
use super::carcass_description::{CarcassDescription, carcass, carcass_of_file};
use super::effective_radius::EffectiveRadius;
use super::element::Tire;
use super::invalid::InvalidTireData;
use super::law_description::{LawDescription, Mounted, NamedLaw, Place};
use super::rolling_resistance::RollingResistance;
use super::tir::PropertyFile;
use super::wheel::Wheel;
use super::written_law::WrittenLaw;
use mbody::assembly::{ElementDescription, Site};
use mbody::contact::Profile;
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
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
/// Distance from the middle plane beyond which a wheel is on one side of the vehicle, m.
const ASIDE: f64 = 0.01;

/// A tire on a wheel that rolls on the road, with the friction laws of this crate.
pub type TireDescription = TireWith<LawDescription>;

/// A tire on a wheel that rolls on the road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "L: WrittenLaw")]
#[schemars(rename = "TireDescription", bound = "L: WrittenLaw")]
pub struct TireWith<L> {
    /// Name of the wheel joint; its axis points left, and the origin of its child is the center of the wheel.
    wheel: String,
    /// Free radius on the middle plane; that of the property file where left out.
    #[schemars(extend("plausible" = [0.05, 1.0]))]
    radius: Option<PositiveQuantity<Length>>,
    /// Shape of the cross-section. Left out with a property file: a disc, with the overturning moment of the file.
    crown: Option<CrownDescription>,
    /// Springs between rim and road, and how side forces build up; those of the property file where left out.
    carcass: Option<CarcassDescription>,
    /// Friction at the contact.
    #[schemars(with = "L")]
    law: Option<L>,
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
    /// Name of the road under this wheel: inputs `<road>.height`, `<road>.grade`, `<road>.cross_slope`, their rates, and `<road>.friction`; `road` where left out, which all such wheels share.
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

impl<L: WrittenLaw> ElementDescription for TireWith<L> {
    const KIND: &'static str = "tire";
    const ABOUT: &'static str = "tire on a wheel: cross-section, carcass, friction law, rolling resistance";
    const EXAMPLE: &'static str = "{ wheel: front_axle, radius: 0.3 m, crown: { torus: { radius: 60 mm } }, \
        carcass: { deformable: { radial: { stiffness: 150 kN/m, damping: 300 N s/m }, lateral: { stiffness: 160 kN/m, damping: 100 N s/m } } }, \
        law: { compact_motorcycle: { nominal_load: 1300, longitudinal: { stiffness: { constant: 20 }, peak: { constant: 1.2 }, shape: 1.5 }, \
        lateral: { cornering_stiffness: { constant: 14 }, camber_stiffness: { constant: 0.9 }, peak: { constant: 1.25 }, \
        cornering_shape: 1.1, camber_shape: 0.7 }, aligning: { pneumatic_trail: 0.025, twisting_moment: 0.015 } } }, \
        rolling_resistance: pressure, pressure: 2.25 bar, road: front_road }";
    type Law = Tire;
    fn assemble(mut self, site: &mut Site<'_>) -> Option<Tire> {
        let place = self.place(site);
        let named = chosen_law(self.law.take(), &place, site);
        let file = named.as_ref().and_then(|named| named.file.as_ref());
        // a property file that is wrong might have said what is missing here
        let complete = named.is_none() || self.complete(file, site);
        let profile = self.profile(file, site);
        let rolling_resistance = self.rolling_resistance(file, site);
        let rigid = matches!(self.carcass, Some(CarcassDescription::Rigid(_)));
        if let (true, Some(road)) = (rigid, &self.road) {
            let message = format!("a rigid tire stays on the level road, so the road `{road}` has no height");
            site.find("road", Finding::error("contradictory_entries", message).with_hint("leave the entry out"));
        }
        let mut wheel = profile.and_then(|profile| wheel(site, &self.wheel, profile, self.road));
        if let (true, Some(wheel)) = (rigid, &mut wheel) {
            wheel.road = None;
        }
        let carcass = match (self.carcass, file) {
            (Some(written), _) => carcass(written, wheel.as_ref(), file, site),
            (None, Some(file)) => carcass_of_file(file, self.pressure.map(Quantity::si), site),
            (None, None) => None,
        };
        let effective_radius = effective_radius(self.effective_radius_fraction, file);
        Some(Tire {
            wheel: wheel?,
            carcass: carcass?,
            law: named.filter(|_| complete)?.law,
            contact: match self.contact {
                ContactDescription::Lifting => RoadContact::Lifting,
                ContactDescription::Bonded => RoadContact::Bonded,
            },
            rolling_resistance: rolling_resistance?,
            effective_radius,
            low_speed: self.low_speed.map_or(LOW_SPEED, Quantity::si),
        })
    }
}

/// The law of a tire and what its carcass says of it, apart from any vehicle.
#[derive(Debug)]
pub struct StatedTire {
    /// The law.
    pub named: NamedLaw,
    /// Lateral stiffness of the carcass, N/m, over which the cornering stiffness is the relaxation length; none where it gives way otherwise.
    pub lateral_stiffness: Option<f64>,
}

impl TireDescription {
    /// The law of a tire whose written form is `value`; the wheel is taken to be in the middle plane where its law does not say.
    ///
    /// # Errors
    /// `None` where there are errors among the findings.
    pub fn stated(value: &serde_json::Value, library: &dyn Library, findings: &mut Findings) -> Option<StatedTire> {
        let read = serde_path_to_error::deserialize::<_, Self>(value);
        let wrong = |e: serde_path_to_error::Error<serde_json::Error>| {
            Finding::error("wrong_value", e.inner().to_string()).at_path(e.path().to_string())
        };
        let mut description = read.map_err(|error| findings.push(wrong(error))).ok()?;
        let crowned = !matches!(description.crown, None | Some(CrownDescription::Disc));
        let place = Place { mounted: Some(Mounted::Middle), crowned, pressure: description.pressure.map(Quantity::si) };
        let named = description.law.take()?.law(&place, library, findings)?;
        let lateral_stiffness = description.carcass.as_ref().and_then(CarcassDescription::lateral_stiffness);
        Some(StatedTire { named, lateral_stiffness })
    }
}

impl<L> TireWith<L> {
    /// What the place of the tire says about its law.
    fn place(&self, site: &Site<'_>) -> Place {
        let aside = site.model().joint(&self.wheel).map_or(0.0, |body| site.design_pose(body).p.y);
        let mounted = match aside {
            y if y > ASIDE => Mounted::Left,
            y if y < -ASIDE => Mounted::Right,
            _ => Mounted::Middle,
        };
        let crowned = !matches!(self.crown, None | Some(CrownDescription::Disc));
        Place { mounted: Some(mounted), crowned, pressure: self.pressure.map(Quantity::si) }
    }

    /// Whether everything is said that no property file says.
    fn complete(&self, file: Option<&PropertyFile>, site: &mut Site<'_>) -> bool {
        if file.is_some() {
            return true;
        }
        let missing = [
            ("radius", self.radius.is_none(), "the free radius on the middle plane"),
            ("crown", self.crown.is_none(), "the shape of the cross-section"),
            ("carcass", self.carcass.is_none(), "the springs between rim and road"),
        ];
        for (key, missing, about) in missing {
            if missing {
                let finding = Finding::error("missing_key", format!("missing key `{key}`"));
                site.find(
                    "",
                    finding.with_hint(format!("`{key}` is {about}; only a law from a tire property file (`law: {{ tir: … }}`) gives it")),
                );
            }
        }
        missing.iter().all(|(_, missing, _)| !missing)
    }

    fn profile(&self, file: Option<&PropertyFile>, site: &mut Site<'_>) -> Option<Profile> {
        let radius = self.radius.map(Quantity::si).or(file.map(|file| file.coefficients.UNLOADED_RADIUS))?;
        let crown = self.crown.as_ref().or(file.map(|_| &CrownDescription::Disc))?;
        let profile = match crown {
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

    fn rolling_resistance(&self, file: Option<&PropertyFile>, site: &mut Site<'_>) -> Option<RollingResistance> {
        let resistance = match (&self.rolling_resistance, self.pressure) {
            (None, _) if file.is_some() => RollingResistance::Law,
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
    let Some(mut wheel) = Wheel::new(site.model(), body, profile, road.unwrap_or_else(|| "road".into())) else {
        site.refuse("wheel", "wrong_joint", format!("joint `{joint}` does not turn about a fixed axis, as a wheel does"));
        return None;
    };
    let left = (site.design_pose(wheel.carrier).R * wheel.axis).y;
    // a wheel may be toed in or cambered, but not lie across
    if left > 0.5 {
        wheel.road = wheel.road.map(|road| road.below(site, body));
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

/// The law of a description.
fn chosen_law<L: WrittenLaw>(description: Option<L>, place: &Place, site: &mut Site<'_>) -> Option<NamedLaw> {
    let mut findings = Findings::new();
    let named = description?.named(place, &site.library("law"), &mut findings);
    // what has no line is about an entry of the tire
    let (elsewhere, here): (Vec<Finding>, Vec<Finding>) = findings.into_iter().partition(|f| !f.file.is_empty());
    site.pass_on(elsewhere.into_iter().collect());
    for finding in here {
        let key = finding.path.clone();
        site.find(&key, finding);
    }
    named
}

/// The effective radius: a share of the compression, or that of the property file.
fn effective_radius(fraction: Option<Quantity<Number, Fraction>>, file: Option<&PropertyFile>) -> EffectiveRadius {
    let of_file = file.map(|file| &file.coefficients).filter(|c| c.VERTICAL_STIFFNESS > 0.0 && c.BREFF != 0.0);
    match (fraction, of_file) {
        (None, Some(c)) => EffectiveRadius::Fit {
            nominal_load: c.FNOMIN,
            deflection: c.FNOMIN / c.VERTICAL_STIFFNESS,
            slope: c.BREFF,
            peak: c.DREFF,
            linear: c.FREFF,
        },
        (fraction, _) => EffectiveRadius::Fraction(fraction.map_or(EFFECTIVE_RADIUS_FRACTION, Quantity::si)),
    }
}

/// A value that may be refused, with its finding.
pub(super) fn checked<T>(key: &str, result: Result<T, InvalidTireData>, site: &mut Site<'_>) -> Option<T> {
    result.map_err(|error| site.refuse(key, "invalid_tire_data", error.to_string())).ok()
}
