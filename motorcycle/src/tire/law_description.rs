//! Written form of the friction law: parameters in the description, a file of our own form, or a tire property file.

use super::compact_motorcycle::CompactMotorcycleParameters;
use super::invalid::InvalidTireData;
use super::law::AnyTireLaw;
use super::linear_normalized::LinearNormalizedParameters;
use super::magic_formula::{BeyondFit, Coefficients, FileAxes, KEYS, MagicFormula, Side, TrailCamber, Usage};
use super::magic_formula_motorcycle::{CamberPeak, MagicFormulaMotorcycleParameters};
use super::sharp_linear::SharpLinearParameters;
use super::tir::{self, PropertyFile, TireSide};
use mbody::description::Library;
use mbody::description::document::Document;
use mbody::description::finding::{Finding, Findings, suggestion};
use mbody::description::schema::Schema;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

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
    /// A tire property file (`.tir`): its name, or its name and how it is used.
    Tir(TirDescription),
    /// Name of a file with one of the other entries.
    File(String),
}

/// A tire property file in MF 5.2, PAC_MC, MF 6.1 or MF 6.2.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TirDescription {
    /// Name of the file.
    Name(String),
    /// Name of the file, and how it is used.
    Use(TirUse),
}

/// A tire property file and how it is used.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TirUse {
    /// Name of the file.
    pub file: String,
    /// Side of the vehicle on which the tire runs; where the wheel is, where left out. In the middle, nothing tells left from right.
    pub mounted: Option<Mounted>,
    /// Axes of the file: `iso` (where left out), or `adapted_sae` of the book, with a positive cornering stiffness.
    #[serde(default)]
    pub axes: AxesDescription,
    /// What holds outside the range of the measurement: the forces of its edge (`hold`, where left out), or the formula (`extrapolate`).
    #[serde(default)]
    pub beyond_fit: BeyondFit,
    /// How camber changes the peak of the side force of a PAC_MC tire; `multiply` where left out.
    pub camber_peak: Option<CamberPeak>,
    /// How camber changes the trail of MF 6.x: by its `magnitude` (the book, where left out) or `signed` (as the solver of its authors is reported to do).
    #[serde(default)]
    pub trail_camber: TrailCamber,
    /// Factors on coefficients, for studies: `LMUX: 0.6` for the friction on a wet road.
    #[serde(default)]
    pub factors: BTreeMap<String, f64>,
}

/// Side of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mounted {
    /// Left.
    Left,
    /// Right.
    Right,
    /// In the middle plane.
    Middle,
}

/// Axes of a tire property file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AxesDescription {
    /// x forward, y left, z up.
    #[default]
    Iso,
    /// x forward, y right, z down, slip angle positive for a positive side force.
    AdaptedSae,
}

impl AxesDescription {
    fn file_axes(self) -> FileAxes {
        match self {
            Self::Iso => FileAxes::IsoW,
            Self::AdaptedSae => FileAxes::AdaptedSae,
        }
    }
}

/// What the place of a tire says about its law.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Where the wheel is; none: as the tire was measured.
    pub mounted: Option<Mounted>,
    /// Whether the shape of the cross-section makes the overturning moment.
    pub crowned: bool,
    /// Inflation pressure, Pa, where the description gives it.
    pub pressure: Option<f64>,
}

/// A law, and the property file that it comes from.
#[derive(Debug)]
pub struct NamedLaw {
    /// The law.
    pub law: AnyTireLaw,
    /// Its kind in descriptions, or the dialect of its property file.
    pub kind: &'static str,
    /// The property file.
    pub file: Option<PropertyFile>,
}

/// The JSON Schema (draft 2020-12) of tire law files.
pub fn schema() -> Value {
    let mut root = SchemaSettings::draft2020_12().into_generator().root_schema_for::<LawDescription>().to_value();
    root["title"] = json!("FastBike tire law");
    root
}

/// Reads a law file of our own form against its schema.
///
/// # Errors
/// Everything that is wrong, each at its line.
pub fn read_file(name: &str, text: &str) -> Result<LawDescription, Findings> {
    let document = Document::parse(name, text)?;
    if document.value().is_null() {
        let finding = Finding::error("empty_file", "the tire law is empty").in_file(name);
        return Err(finding.with_hint("one law with its parameters is needed").into());
    }
    let mut findings = Schema::new(&schema())?.check(&document);
    if document.value().get("file").is_some() && !findings.has_errors() {
        let message = "a tire law file holds the parameters themselves, not the name of another file";
        findings.push(document.locate(Finding::error("invalid_tire_file", message).at_path("file")));
    }
    if findings.has_errors() { Err(findings.sorted()) } else { document.read("") }
}

impl LawDescription {
    /// The law. Findings without a file are about `key` of the description.
    ///
    /// # Errors
    /// `None` where there are errors among the findings.
    pub fn law(self, place: &Place, library: &dyn Library, findings: &mut Findings) -> Option<NamedLaw> {
        match self {
            Self::File(name) => {
                let text = text(&name, "law.file", library, findings)?;
                match read_file(&name, &text) {
                    Ok(Self::Tir(tir)) => tir.law(place, library, findings),
                    Ok(law) => law.parameters("law.file", findings),
                    Err(wrong) => {
                        findings.extend(wrong);
                        None
                    }
                }
            }
            Self::Tir(tir) => tir.law(place, library, findings),
            parameters => parameters.parameters("law", findings),
        }
    }

    /// The law of parameters that are here.
    fn parameters(self, key: &str, findings: &mut Findings) -> Option<NamedLaw> {
        fn any<L: super::law::TireLaw>(law: Result<L, InvalidTireData>) -> Result<AnyTireLaw, InvalidTireData> {
            law.map(AnyTireLaw::new)
        }
        let (kind, law) = match self {
            Self::CompactMotorcycle(p) => ("compact_motorcycle", any(p.law())),
            Self::MagicFormulaMotorcycle(p) => ("magic_formula_motorcycle", any(p.law())),
            Self::LinearNormalized(p) => ("linear_normalized", any(p.law())),
            Self::SharpLinear(p) => ("sharp_linear", any(p.law())),
            Self::Tir(_) | Self::File(_) => return None,
        };
        match law {
            Ok(law) => Some(NamedLaw { law, kind, file: None }),
            Err(error) => {
                findings.push(Finding::error("invalid_tire_data", error.to_string()).at_path(key));
                None
            }
        }
    }
}

impl TirDescription {
    fn law(self, place: &Place, library: &dyn Library, findings: &mut Findings) -> Option<NamedLaw> {
        let (used, key) = match self {
            Self::Name(file) => (TirUse::plain(&file), "law.tir"),
            Self::Use(used) => (used, "law.tir.file"),
        };
        let text = text(&used.file, key, library, findings)?;
        let mut file = tir::read(&used.file, &text, used.axes.file_axes(), findings);
        let scaled = file.as_mut().map(|file| used.scale(&mut file.coefficients, findings));
        let file = file.filter(|_| scaled == Some(true))?;
        let usage = used.usage(&file, place, findings);
        let law = AnyTireLaw::new(MagicFormula::new(file.coefficients, file.dialect, usage));
        Some(NamedLaw { law, kind: file.dialect.name, file: Some(file) })
    }
}

impl TirUse {
    /// The file with nothing else said.
    pub fn plain(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            mounted: None,
            axes: AxesDescription::Iso,
            beyond_fit: BeyondFit::Hold,
            camber_peak: None,
            trail_camber: TrailCamber::Magnitude,
            factors: BTreeMap::new(),
        }
    }

    /// Multiplies coefficients; whether all of them exist and stay usable.
    fn scale(&self, coefficients: &mut Coefficients, findings: &mut Findings) -> bool {
        let mut fine = true;
        for (name, factor) in &self.factors {
            match coefficients.get_mut(name) {
                Some(value) if factor.is_finite() && *factor > 0.0 => *value *= factor,
                Some(_) => {
                    fine = false;
                    let message = format!("the factor of `{name}` is {factor}, but must be greater than 0");
                    findings.push(Finding::error("out_of_range", message).at_path(format!("law.tir.factors.{name}")));
                }
                None => {
                    fine = false;
                    let hint = suggestion(name, KEYS.iter().map(|k| k.name));
                    let finding = Finding::error("unknown_key", format!("there is no coefficient `{name}`")).with_hint_from(hint);
                    findings.push(finding.at_path(format!("law.tir.factors.{name}")));
                }
            }
        }
        fine
    }

    /// How the file is used at a place.
    fn usage(&self, file: &PropertyFile, place: &Place, findings: &mut Findings) -> Usage {
        let side = match (file.side, self.mounted.or(place.mounted)) {
            (TireSide::Symmetric, _) | (_, Some(Mounted::Middle)) => Side::Symmetric,
            (_, None) | (TireSide::Left, Some(Mounted::Left)) | (TireSide::Right, Some(Mounted::Right)) => Side::Measured,
            (TireSide::Left, Some(Mounted::Right)) | (TireSide::Right, Some(Mounted::Left)) => Side::Mirrored,
        };
        if side == Side::Symmetric && file.coefficients.symmetric(file.dialect.trail_camber(self.trail_camber)) != file.coefficients {
            let why = if file.side == TireSide::Symmetric { "it says `SYMMETRIC`" } else { "the wheel is in the middle plane" };
            let message = format!("what tells left from right in `{}` (conicity, plysteer) is left out, because {why}", file.name);
            let finding = Finding::note("symmetric_tire", message).at_path("law.tir");
            findings.push(finding.with_hint("`law: { tir: { file: …, mounted: left } }` keeps it"));
        }
        let c = &file.coefficients;
        if let Some(p) = place.pressure.filter(|p| c.NOMPRES > 0.0 && !(c.PRESMIN..=c.PRESMAX).contains(p)) {
            let message = format!("the pressure {p} Pa is outside the measurements of `{}`, {} to {} Pa", file.name, c.PRESMIN, c.PRESMAX);
            findings.push(Finding::warning("outside_fit", message).at_path("pressure"));
        }
        Usage {
            side,
            axes: self.axes.file_axes(),
            beyond: self.beyond_fit,
            pressure: place.pressure,
            camber_peak: self.camber_peak.unwrap_or(CamberPeak::Multiply),
            trail_camber: self.trail_camber,
            crowned: place.crowned,
        }
    }
}

fn text(name: &str, key: &str, library: &dyn Library, findings: &mut Findings) -> Option<String> {
    let found = library.text(name).map(|text| text.into_owned());
    if found.is_none() {
        findings.push(Finding::error("missing_file", format!("file `{name}` was not found")).at_path(key));
    }
    found
}
