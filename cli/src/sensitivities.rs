//! Which parameters move the modes of a run: derivatives of their eigenvalues by the numbers of the description.

use crate::Failure;
use crate::arguments::unknown_name;
use crate::family::Vehicles;
use crate::output::modes::{ModesAlong, NamedMode, Slope};
use crate::output::{Point, Progress};
use crate::small_motions::SmallMotions;
use crate::steady::{self, Steady};
use analyses::Sensitivity;
use analyses::sensitivity::Derivatives;
use problem::{At, Family, ParameterId};
use rayon::prelude::*;

/// How many parameters are told where nobody chose some.
const TOLD: usize = 10;

/// What is wanted.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Names of modes; none: every oscillation that was recognized.
    pub modes: Vec<String>,
    /// Parameters; none: those that move a mode most.
    pub parameters: Vec<ParameterId>,
}

impl Wanted {
    /// Reads names of modes and paths of parameters.
    ///
    /// # Errors
    /// A path that names no parameter, with the nearest one that does.
    pub fn read(modes: &[String], paths: &[String], family: &Vehicles) -> Result<Self, Failure> {
        let known = || family.parameters().iter().map(|p| p.name.as_str());
        let parameter = |path: &String| {
            family.find(path).ok_or_else(|| Failure::from(unknown_name("sensitivity-of", path, ("parameter", path), known())))
        };
        Ok(Self { modes: modes.to_vec(), parameters: paths.iter().map(parameter).collect::<Result<_, _>>()? })
    }

    fn takes(&self, mode: &NamedMode) -> bool {
        match self.modes.is_empty() {
            // a mode that no rule knows has the name of a signal, and no confidence
            true => mode.value.im > 0.0 && mode.confidence > 0.0,
            false => self.modes.contains(&mode.name),
        }
    }
}

/// Adds the sensitivities to the modes of a run; returns what the reader should know.
///
/// # Errors
/// No point has a mode of a name that was asked for.
pub fn add(
    small: &SmallMotions,
    steady: &Steady,
    modes: &mut ModesAlong,
    family: &Vehicles,
    wanted: &Wanted,
) -> Result<Vec<String>, Failure> {
    let mut known: Vec<&str> = modes.points.iter().flatten().flat_map(|p| &p.modes).map(|m| m.name.as_str()).collect();
    known.dedup();
    if let Some(name) = wanted.modes.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(unknown_name("sensitivity", name, ("mode", name), known).into());
    }
    // a parameter that is zero moves nothing by a share of itself; what follows from others is told with them
    let all = || (0..family.parameters().len()).map(ParameterId).filter(|id| family.is_free(*id) && family.parameters()[id.0].value != 0.0);
    let parameters: Vec<ParameterId> = if wanted.parameters.is_empty() { all().collect() } else { wanted.parameters.clone() };
    let states = small.states(steady);
    let progress = Progress::new("sensitivities", steady.points.len() * parameters.len());
    let mut warnings = Vec::new();
    for (point, modes) in steady.points.iter().zip(&mut modes.points) {
        let Ok(modes) = modes else { continue };
        let sensitivity = match at(small, point, family, &states) {
            Ok(sensitivity) => sensitivity,
            Err(because) => {
                warnings.push(format!("no sensitivities: {because}"));
                continue;
            }
        };
        let found: Vec<(ParameterId, Result<Derivatives, String>)> = (parameters.par_iter())
            .map(|&id| {
                let by = sensitivity.by(id).map_err(|e| e.to_string());
                progress.advance();
                (id, by)
            })
            .collect();
        for mode in modes.modes.iter_mut().filter(|m| wanted.takes(m)) {
            mode.sensitivity = slopes(mode, &sensitivity, &found, family, wanted);
        }
        let failed: Vec<String> = found.iter().filter_map(|(_, by)| by.as_ref().err().cloned()).collect();
        if let Some(first) = failed.first() {
            warnings.push(format!("{} of {} parameters without sensitivities, the first: {first}", failed.len(), found.len()));
        }
    }
    warnings.dedup();
    Ok(warnings)
}

/// A point of the run, ready to be differentiated.
fn at<'f>(small: &SmallMotions, point: &Point, family: &'f Vehicles, states: &[String]) -> Result<Sensitivity<'f>, String> {
    let trim = steady::trim_at(small.request, small.system, point).map_err(|e| e.to_string())?;
    let (y, rest) = point.values.split_at(small.system.unknowns().len());
    let at = At { time: 0.0, y, yd: &point.rates, u: &rest[..small.system.inputs().len()] };
    Sensitivity::at(family, &trim, at, states).map_err(|e| e.to_string())
}

/// Derivatives of one mode: the parameters that were asked for, or those that move it most.
fn slopes(
    mode: &NamedMode,
    sensitivity: &Sensitivity,
    found: &[(ParameterId, Result<Derivatives, String>)],
    family: &Vehicles,
    wanted: &Wanted,
) -> Vec<Slope> {
    let values = &sensitivity.spectrum.values;
    let distance = |k: &usize| (values[*k] - mode.value).norm();
    let Some(slot) = (0..values.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return Vec::new() };
    let slope = |(id, by): &(ParameterId, Result<Derivatives, String>)| {
        let by = by.as_ref().ok()?.eigenvalues[slot]?;
        Some(Slope { parameter: family.parameters()[id.0].clone(), by })
    };
    let mut slopes: Vec<Slope> = found.iter().filter_map(slope).collect();
    if wanted.parameters.is_empty() {
        slopes.sort_by(|a, b| b.relative().norm().total_cmp(&a.relative().norm()));
        slopes.truncate(TOLD);
    }
    slopes
}
