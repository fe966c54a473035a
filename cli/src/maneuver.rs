//! Maneuvers by name or path, and who rides them.

use crate::Failure;
use crate::arguments::argument;
use crate::library;
use crate::rider::Task;
use mbody::description::finding::{Finding, Findings};
use mbody::dynamics::System;
use motorcycle::maneuver::{Control, Maneuver};
use motorcycle::rider::Rider;
use problem::{Limit, Side};
use std::sync::Arc;

/// Name of the ending at the end of the path.
pub const GOAL: &str = "end_of_path";

/// Share of the front brake where the loads do not say it.
const FRONT_BRAKE_SHARE: f64 = 0.7;

/// A maneuver that is about to be ridden.
pub struct Ride {
    /// Who rides; nobody where the inputs stay as they are.
    pub rider: Option<Rider>,
    /// What is the end of it, where there is a rider to tell.
    pub goal: Option<Limit>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

/// Reads a maneuver with `PATH=VALUE` overrides.
///
/// # Errors
/// There is none of that name, or everything that is wrong in it.
pub fn read(name: &str, changes: &[String]) -> Result<Maneuver, Failure> {
    let (file, text) = library::maneuver(name)?;
    let overrides = changes.iter().map(|change| match change.split_once('=') {
        Some((path, value)) if !path.is_empty() && !value.is_empty() => Ok((path.trim().to_owned(), value.trim().to_owned())),
        _ => Err(Failure::from(
            argument("change", change, "bad_override", "this is not of the form PATH=VALUE")
                .with_hint("for example `--change speed=20m/s`"),
        )),
    });
    let overrides = overrides.collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings::new();
    let maneuver = motorcycle::maneuver::read(&file, &text, &overrides, &mut findings);
    match maneuver {
        Some(maneuver) => Ok(maneuver),
        None => Err(Failure::Findings(findings.sorted())),
    }
}

/// Makes the rider of a maneuver.
///
/// # Errors
/// The vehicle cannot be ridden.
pub fn ride(maneuver: Maneuver, system: &Arc<System>) -> Result<Ride, Failure> {
    if maneuver.control == Control::None {
        if !maneuver.course.torque_pulses.is_empty() {
            let finding = Finding::error("no_rider", "`torque_pulses` are torques of a rider, and `control: none` has none");
            return Err(finding.with_hint("`--signals FILE.csv` gives inputs over time").into());
        }
        return Ok(Ride { rider: None, goal: None, warnings: Vec::new() });
    }
    let task = Task { system, backend: "kinsol", wishes: &maneuver.rider, front_brake_share: FRONT_BRAKE_SHARE };
    let end = maneuver.course.path.length();
    let designed = task.design(maneuver.course)?;
    let goal = Limit {
        name: GOAL.into(),
        signal: "rider.station".to_owned(),
        threshold: end,
        side: Side::Above,
        nominal: 1.0,
        about: "the path ends".into(),
    };
    Ok(Ride { rider: Some(designed.rider), goal: Some(goal), warnings: designed.warnings })
}
