//! Arguments that several commands share, and how their values are read.

use crate::Failure;
use crate::output::{self, Angles, Axes};
use crate::plot::FileFormat;
use clap::{Args, ValueEnum};
use mbody::description::finding::{Finding, suggestion};
use mbody::description::quantity::{Dimensioned, parse_quantity};
use problem::{Derivatives, LinearSolver};
use std::path::PathBuf;

/// Which model, and what is changed in it.
#[derive(Clone, Debug, Args)]
pub struct ModelArguments {
    /// Bundled name (see `fastbike info`), or the path of a .yaml description or a plain .urdf
    pub model: String,
    /// Override an entry of the description: `element.parameter=value`, `joint.NAME.locked=true`, `link.NAME.mass=9kg` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Add the reactions of all joints to the signals: `swingarm.force_x` … `swingarm.moment_z`, what the parent exerts on the child
    #[arg(long)]
    pub reactions: bool,
}

impl ModelArguments {
    /// The model of a variant: another one, or the same with one more entry overridden (`PATH=VALUE`).
    pub fn variant(&self, variant: &str) -> Self {
        let mut model = self.clone();
        match variant.contains('=') {
            true => model.set.push(variant.to_owned()),
            false => model.model = variant.to_owned(),
        }
        model
    }
}

/// How results are shown and kept.
#[derive(Clone, Debug, Args)]
pub struct OutputArguments {
    /// Format on standard output: table, json or csv
    #[arg(long, default_value = "table", value_parser = format)]
    pub format: &'static output::Kind,
    /// Axes of everything printed: iso (x forward, y left, z up) or sae (x forward, y right, z down)
    #[arg(long, default_value = "iso", value_parser = axes)]
    pub axes: Axes,
    /// Show angles of tables in radians instead of degrees
    #[arg(long)]
    pub radians: bool,
    /// Figure to write, .svg or .png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Folder to keep the run in: inputs, version, statistics, results and figures
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl OutputArguments {
    /// Whether the figure has a format that is drawn, before anything is computed.
    pub fn check(&self) -> Result<(), Failure> {
        match &self.plot {
            Some(path) if FileFormat::of(path).is_err() => {
                let finding = argument("plot", &path.display().to_string(), "unknown_value", "there is no figure of this format");
                Err(finding.with_hint("the name of the file ends in `.svg` or `.png`").into())
            }
            _ => Ok(()),
        }
    }

    /// Unit of angles in tables.
    pub fn angles(&self) -> Angles {
        if self.radians { Angles::Radians } else { Angles::Degrees }
    }
}

fn format(text: &str) -> Result<&'static output::Kind, String> {
    let known: Vec<&str> = output::KINDS.iter().map(|k| k.name).collect();
    output::kind(text).ok_or_else(|| format!("expected one of `{}`", known.join("`, `")))
}

fn axes(text: &str) -> Result<Axes, String> {
    Axes::from_name(text).ok_or_else(|| "expected `iso` or `sae`".to_owned())
}

/// An error about an option of the command line and the text behind it.
pub fn argument(option: &str, text: &str, code: &'static str, message: impl Into<String>) -> Finding {
    Finding::error(code, message).in_file(format!("--{option} {text}"))
}

/// An unknown name behind an option, with the nearest of the known ones.
pub fn unknown_name<'a>(option: &str, text: &str, (noun, name): (&str, &str), known: impl IntoIterator<Item = &'a str>) -> Finding {
    let code = if noun == "signal" { "unknown_signal" } else { "unknown_value" };
    argument(option, text, code, format!("there is no {noun} `{name}`")).with_hint_from(suggestion(name, known))
}

/// One value or several: `30`, `108km/h`, `10..60:2` (start..end:step), `0.1..30:log200` (so many values, in equal ratios), `10,20,30`.
/// Values are SI.
///
/// # Errors
/// Names the part that cannot be read, the unit that does not fit, or a step that leads nowhere.
pub fn sweep<D: Dimensioned>(option: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let wrong = |why: &str| argument(option, text, "bad_range", why);
    let one = |part: &str| {
        let value = parse_quantity(part.trim(), D::DIMENSION);
        value.map_err(|e| Failure::from(argument(option, text, e.code(), e.to_string()).with_hint_from(e.hint())))
    };
    if text.contains(',') {
        return text.split(',').map(one).collect();
    }
    let Some((start, rest)) = text.split_once("..") else {
        return Ok(vec![one(text)?]);
    };
    let Some((end, step)) = rest.split_once(':') else {
        return Err(wrong("the range has no step").with_hint("a range is written start..end:step, for example 10..60:2").into());
    };
    let (start, end) = (one(start)?, one(end)?);
    if let Some(count) = step.trim().strip_prefix("log") {
        return logarithmic((start, end), count).map_err(|why| wrong(&why).with_hint("for example 0.1..30:log200").into());
    }
    let step = one(step)?;
    if step == 0.0 || (end - start) * step < 0.0 {
        return Err(wrong("the step does not lead from the start to the end").into());
    }
    // the end belongs to the range where a whole number of steps meets it
    let count = ((end - start) / step + 1e-9).floor();
    if count > 1e6 {
        return Err(wrong(&format!("that is {count:.0} points; at most 1000000 are accepted")).into());
    }
    Ok((0..=count as usize).map(|i| start + i as f64 * step).collect())
}

/// Values in equal ratios, both ends included.
fn logarithmic((start, end): (f64, f64), count: &str) -> Result<Vec<f64>, String> {
    let Some(count) = count.trim().parse::<u32>().ok().filter(|n| (2..=1_000_000).contains(n)) else {
        return Err(format!("`{count}` is no number of values from 2 to 1000000"));
    };
    if start <= 0.0 || end <= 0.0 || start == end {
        return Err("a range in equal ratios has two different ends above zero".to_owned());
    }
    let last = count - 1;
    // the ends are met to the last digit
    Ok((0..count).map(|k| if k == last { end } else { start * (end / start).powf(f64::from(k) / f64::from(last)) }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::description::quantity::dimension::{Angle, Frequency, Speed};

    #[test]
    fn values_lists_and_ranges_are_read_with_units() {
        assert_eq!(sweep::<Speed>("speed", "108km/h").unwrap(), [30.0]);
        assert_eq!(sweep::<Speed>("speed", "10,20").unwrap(), [10.0, 20.0]);
        assert_eq!(sweep::<Speed>("speed", "10..60:25").unwrap(), [10.0, 35.0, 60.0]);
        assert_eq!(sweep::<Speed>("speed", "0..1:0.1").unwrap().len(), 11);
        assert_eq!(sweep::<Speed>("speed", "-1..-3:-1").unwrap(), [-1.0, -2.0, -3.0]);
        assert_eq!(sweep::<Frequency>("frequency", "0.1..10 Hz:log3").unwrap(), [0.1, 1.0, 10.0]);
        assert!((sweep::<Angle>("lean", "0deg..50deg:5deg").unwrap()[10] - 50f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn wrong_values_say_what_was_expected() {
        let message = |text| sweep::<Speed>("speed", text).unwrap_err().to_string();
        assert!(message("30kg").contains("a speed"), "{}", message("30kg"));
        assert!(message("10..60").contains("start..end:step"));
        assert!(message("10..60:-1").contains("does not lead"));
        assert!(message("0..60:log10").contains("above zero"));
        assert!(message("1..60:log1").contains("no number of values"));
        assert!(message("fast").contains("--speed fast"));
    }
}

/// Where matrices come from, as an option says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Jacobian {
    /// Exact derivatives of the engine
    Exact,
    /// Difference quotients, one evaluation per column
    Differences,
}

impl From<Jacobian> for Derivatives {
    fn from(jacobian: Jacobian) -> Self {
        match jacobian {
            Jacobian::Exact => Self::Exact,
            Jacobian::Differences => Self::Differences,
        }
    }
}

/// What solves linear equations, as an option says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Linear {
    /// LU factors of the dense matrix
    Direct,
    /// GMRES: products with directional derivatives instead of a matrix; ida preconditions it by the factors of an earlier one
    Gmres,
}

impl From<Linear> for LinearSolver {
    fn from(linear: Linear) -> Self {
        match linear {
            Linear::Direct => Self::Direct,
            Linear::Gmres => Self::Gmres,
        }
    }
}
