//! `modes`: modes at a steady state or along a sweep.

use super::{Kind, read};
use crate::animation::{self, Scene};
use crate::arguments::{ModelArguments, OutputArguments};
use crate::family::Vehicles;
use crate::model::Loaded;
use crate::output::modes::ModesAlong;
use crate::output::{Beside, Variant};
use crate::plan::{Request, TrimArguments};
use crate::sensitivities::{self, Wanted};
use crate::small_motions::{FROZEN, Shapes, SmallMotions, accelerates};
use crate::steady::Steady;
use crate::{Context, Exit, Failure, figures, model, results, steady};
use clap::{ArgMatches, Args, Command, ValueEnum};
use mbody::description::finding::{Finding, Severity};
use std::path::PathBuf;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "modes", command, run };

/// What the figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Picture {
    /// Eigenvalues in the complex plane
    Locus,
    /// Frequencies and damping ratios of the oscillations over the swept quantity
    Frequencies,
    /// Shapes of the oscillations at the first point, as phasors
    Shapes,
    /// What one percent of the parameters does to modes at the first point
    Sensitivity,
}

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    #[command(flatten)]
    trim: TrimArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Tell the shapes of the modes: deviations of all unknowns, the largest state being 1 in its typical magnitude
    #[arg(long)]
    shapes: bool,
    /// The same analysis for a variant: another description, or `PATH=VALUE` as in --set (repeatable)
    #[arg(long, value_name = "FILE|PATH=VALUE")]
    versus: Vec<String>,
    /// Tell the ten parameters that move a mode most; modes by name, separated by commas, without a name every oscillation
    #[arg(long, value_name = "MODE", num_args = 0..=1, default_missing_value = "", value_delimiter = ',')]
    sensitivity: Option<Vec<String>>,
    /// Tell how modes move with this parameter, a path as in --set (repeatable)
    #[arg(long, value_name = "PATH")]
    sensitivity_of: Vec<String>,
    /// Animation of all modes at all points to write: one .html file that opens in a browser without a network
    #[arg(long, value_name = "FILE.html")]
    animate: Option<PathBuf>,
    /// What --plot draws; left out: shapes with --shapes, sensitivities with --sensitivity, else the locus
    #[arg(long, value_name = "PICTURE", value_enum)]
    figure: Option<Picture>,
}

impl Arguments {
    fn wants_sensitivities(&self) -> bool {
        self.sensitivity.is_some() || !self.sensitivity_of.is_empty()
    }

    fn draws_shapes(&self) -> bool {
        self.output.plot.is_some() && self.picture() == Picture::Shapes
    }

    fn picture(&self) -> Picture {
        self.figure.unwrap_or(match (self.shapes, self.wants_sensitivities()) {
            (true, _) => Picture::Shapes,
            (_, true) => Picture::Sensitivity,
            _ => Picture::Locus,
        })
    }

    /// Whether the figure that is asked for can have something in it, before anything is computed.
    fn check_figure(&self, request: &Request) -> Result<(), Failure> {
        let finding = match self.output.plot.as_ref().map(|_| self.picture()) {
            Some(Picture::Frequencies) if request.swept() == 0 => {
                let finding = Finding::error("no_sweep", "the figure of a single point would be empty");
                finding.with_hint("sweep something, for example `--speed 10..60:2`")
            }
            Some(Picture::Sensitivity) if !self.wants_sensitivities() => {
                Finding::error("missing_argument", "there are no sensitivities to draw").with_hint("add `--sensitivity`")
            }
            _ => return Ok(()),
        };
        Err(finding.into())
    }
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Modes at a steady state or along a sweep: frequency, damping, names, shapes").after_help(
        "Every mode is told, real ones too. Participation: the share of a signal in the mode, with its rate; all shares add up to 1.\n\
         Along a sweep names are carried from point to point, and changes of stability are searched between the points.\n\
         Sensitivities are derivatives of the eigenvalues by the numbers of the description, the steady state moving along.\n\n\
         Examples:\n  fastbike modes gsxr1000 --speed 30\n  fastbike modes gsxr1000 --speed 5..80:1 --plot locus.svg\n  \
         fastbike modes ref11 --speed 10..60:1 --lateral-acceleration -5 --figure frequencies --plot frequencies.svg\n  \
         fastbike modes gsxr1000 --speed 10..60:2 --versus steering_damper.coefficient=0 --plot damper.svg\n  \
         fastbike modes gsxr1000 --speed 40 --sensitivity wobble\n  fastbike modes gsxr1000 --speed 30 --shapes --plot shapes.svg\n  \
         fastbike modes whipple --speed 1..10:0.25 --format csv\n  fastbike modes gsxr1000 --speed 10..60:10 --animate modes.html",
    )
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let mut arguments: Arguments = read(matches)?;
    arguments.model.set.extend(arguments.trim.gear_override());
    let request = arguments.trim.request()?;
    arguments.output.check()?;
    arguments.check_figure(&request)?;
    arguments.animate.as_deref().map(animation::check).transpose()?;
    let loaded = model::load(&arguments.model, context)?;
    let family = Vehicles::of(&loaded.blueprint, &loaded.source, &context.kinds, arguments.model.reactions);
    let names: Vec<String> = arguments.sensitivity.iter().flatten().filter(|name| !name.is_empty()).cloned().collect();
    let wanted = Wanted::read(&names, &arguments.sensitivity_of, &family)?;
    let (mut steady, mut modes) = analyzed(&arguments, &request, &loaded, "steady states")?;
    if arguments.wants_sensitivities() {
        let small = small_motions(&arguments, &request, &loaded);
        let warnings = sensitivities::add(&small, &steady, &mut modes, &family, &wanted)?;
        steady.warnings.extend(warnings);
    }
    let mut report = results::report("modes", &loaded.name, Vec::new(), steady);
    report.beside = Beside::Modes(modes);
    for variant in &arguments.versus {
        let loaded = model::load(&arguments.model.variant(variant), context)?;
        let (steady, modes) = analyzed(&arguments, &request, &loaded, variant)?;
        let points = results::in_order_of(&report.signals, steady);
        report.variants.push(Variant { name: variant.clone(), points, beside: Beside::Modes(modes) });
    }
    let angles = arguments.output.angles();
    let page = arguments.animate.is_some().then(|| animation::page_of_modes(&Scene::of(&loaded.assembled), &report, angles));
    if let (Beside::Modes(modes), false) = (&mut report.beside, arguments.shapes || arguments.draws_shapes()) {
        modes.leave_out_shapes();
    }
    let exit = results::deliver(context, (&arguments.model, &arguments.output), report, |report| match arguments.picture() {
        Picture::Locus => figures::modes::locus(report),
        Picture::Frequencies => figures::modes::frequencies(report),
        Picture::Shapes => figures::modes::shapes(report),
        Picture::Sensitivity => figures::modes::sensitivities(report),
    });
    if let (Ok(_), Some(path), Some(page)) = (&exit, &arguments.animate, page) {
        animation::write(context, path, &page?)?;
    }
    exit
}

fn small_motions<'a>(arguments: &'a Arguments, request: &'a Request, loaded: &'a Loaded) -> SmallMotions<'a> {
    let (system, backend) = (&loaded.assembled.system, arguments.trim.backend.as_str());
    // trims converge to 1e-10; 1e-6 is what their eigenvalues are told to
    SmallMotions { request, system, backend, residual_tolerance: 1e-6 }
}

/// Steady states of a model and their modes. `what` names the job for the progress bar.
fn analyzed(arguments: &Arguments, request: &Request, loaded: &Loaded, what: &str) -> Result<(Steady, ModesAlong), Failure> {
    let mut steady = steady::run(request, &loaded.assembled.system, &arguments.trim.backend, what)?;
    steady.warnings.extend(loaded.findings.iter().filter(|f| f.severity != Severity::Note).map(ToString::to_string));
    if accelerates(request.acceleration.as_ref()) {
        steady.warnings.push(FROZEN.to_owned());
    }
    let shapes = if arguments.shapes || arguments.draws_shapes() || arguments.animate.is_some() { Shapes::Shown } else { Shapes::LeftOut };
    let modes = small_motions(arguments, request, loaded).along(&steady, shapes)?;
    Ok((steady, modes))
}
