//! `tire`: the curves of a tire, whatever its law.

use super::{Kind, read};
use crate::arguments::{ModelArguments, OutputArguments, argument, sweep};
use crate::figures;
use crate::output::tire::TireCurves;
use crate::tire::{self, Span};
use crate::trust::short;
use crate::{Context, Exit, Failure, results};
use clap::{ArgMatches, Args, Command};
use mbody::description::finding::Severity;
use mbody::description::quantity::dimension::{Angle, Force, Number, Speed};
use motorcycle::tire::law_description::AxesDescription;
use motorcycle::tire::{TireLaw, characteristic};

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "tire", command, run };

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    /// A model, the path of a tire property file (.tir), or the name of a bundled tire such as `sel04_120_70`
    #[command(flatten)]
    model: ModelArguments,
    /// Which tire of the model; the first one where left out
    #[arg(long, value_name = "NAME")]
    tire: Option<String>,
    /// Loads; half, one and one and a half of the nominal load of a file, or 1, 2 and 3 kN
    #[arg(long, value_name = "FORCE")]
    load: Option<String>,
    /// Cambers of the curves over slip; 0 and 30 deg, or the end of the range of the measurement
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    camber: Option<String>,
    /// Largest longitudinal slip
    #[arg(long, value_name = "NUMBER", default_value = "0.3")]
    slip: String,
    /// Largest slip angle
    #[arg(long, value_name = "ANGLE", default_value = "12deg")]
    slip_angle: String,
    /// Speed
    #[arg(long, value_name = "SPEED", default_value = "20m/s")]
    speed: String,
    /// Axes of a tire property file: iso, or adapted_sae where its cornering stiffness is positive
    #[arg(long, value_name = "AXES", default_value = "iso", value_parser = file_axes)]
    file_axes: AxesDescription,
    #[command(flatten)]
    output: OutputArguments,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Curves of a tire: forces and moments over slips and camber, stiffnesses, friction").after_help(
        "The table has one line per load: stiffnesses per load, greatest friction, trail, twisting moment per load and camber, and the relaxation length where the tire \
         knows one. JSON and CSV hold all points of all curves; `--plot` draws them.\n\n\
         Examples:\n  fastbike tire gsxr1000 --tire rear_tire --load 1kN,2kN --plot rear.svg\n  fastbike tire front.tir --camber 0deg,40deg\n  \
         fastbike tire sel04_160_70 --axes sae",
    )
}

fn file_axes(text: &str) -> Result<AxesDescription, String> {
    match text {
        "iso" => Ok(AxesDescription::Iso),
        "adapted_sae" => Ok(AxesDescription::AdaptedSae),
        _ => Err("expected `iso` or `adapted_sae`".to_owned()),
    }
}

/// One value greater than 0, up to a bound.
fn single<D: mbody::description::quantity::Dimensioned>(option: &str, text: &str, most: f64) -> Result<f64, Failure> {
    match sweep::<D>(option, text)?[..] {
        [value] if value > 0.0 && value <= most => Ok(value),
        [_] => Err(argument(option, text, "out_of_range", format!("this must be greater than 0 and at most {most}")).into()),
        _ => Err(argument(option, text, "wrong_count", "this takes one value").into()),
    }
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    arguments.output.check()?;
    let slip = single::<Number>("slip", &arguments.slip, 2.0)?;
    let slip_angle = single::<Angle>("slip-angle", &arguments.slip_angle, 1.5)?;
    let speed = single::<Speed>("speed", &arguments.speed, 200.0)?;
    let found = tire::find(&arguments.model, arguments.tire.as_deref(), arguments.file_axes, context)?;
    let named = &found.stated.named;
    let fit = named.law.fit();
    let loads = match &arguments.load {
        Some(text) => {
            let loads = sweep::<Force>("load", text)?;
            if loads.iter().any(|n| *n <= 0.0) {
                return Err(argument("load", text, "out_of_range", "a load must be greater than 0").into());
            }
            loads
        }
        None => match &named.file {
            Some(file) => [0.5, 1.0, 1.5].map(|n| n * file.coefficients.FNOMIN).to_vec(),
            None => vec![1000.0, 2000.0, 3000.0],
        },
    };
    let widest = fit.map_or(50f64.to_radians(), |fit| fit.camber[1].min(60f64.to_radians()));
    let cambers = match &arguments.camber {
        Some(text) => sweep::<Angle>("camber", text)?,
        None => vec![0.0, widest.min(30f64.to_radians())],
    };
    if let (Some(text), Some(_)) = (&arguments.camber, cambers.iter().find(|g| g.abs() > 1.4)) {
        return Err(argument("camber", text, "out_of_range", "a camber must be within 80 deg").into());
    }
    let camber = cambers.iter().fold(widest, |most, g| most.max(g.abs()));
    let mut characteristics: Vec<_> = loads.iter().map(|&load| characteristic(&named.law, load, speed)).collect();
    if let Some(stiffness) = found.stated.lateral_stiffness {
        characteristics.iter_mut().for_each(|c| c.relaxation_length = c.cornering_stiffness / stiffness);
    }
    let span = Span { loads, cambers, slip, slip_angle, camber, speed };
    let mut warnings: Vec<String> = found.findings.iter().filter(|f| f.severity == Severity::Warning).map(|f| f.to_string()).collect();
    if let Some(fit) = fit {
        warnings.extend(beyond("load", &span.loads, fit.load, 1.0, "N"));
        warnings.extend(beyond("camber", &span.cambers, fit.camber, 1f64.to_degrees(), "deg"));
    }
    let curves = TireCurves {
        curves: tire::curves(&named.law, &span),
        model: found.model,
        tire: found.tire,
        law: named.kind.to_owned(),
        axes: Default::default(),
        speed,
        fit,
        characteristics,
        warnings,
    };
    results::deliver(context, (&arguments.model, &arguments.output), curves, |c| Ok(figures::tire::figure(c)))
}

/// What lies outside the range of the measurement.
fn beyond(what: &str, values: &[f64], [low, high]: [f64; 2], factor: f64, unit: &str) -> Option<String> {
    let outside: Vec<String> = values.iter().filter(|v| **v < low || **v > high).map(|v| short(v * factor)).collect();
    let listed = outside.join(", ");
    let range = format!("{} to {} {unit}", short(low * factor), short(high * factor));
    (!outside.is_empty()).then(|| format!("{what} {listed} {unit} is outside the measurements of the tire, {range}"))
}
