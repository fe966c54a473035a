//! Maneuvers by name or path, and who rides them.

use crate::Failure;
use crate::arguments::argument;
use crate::library;
use crate::replay::replay;
use crate::rider::{FRONT_BRAKE_SHARE, Task};
use crate::road;
use mbody::description::finding::{Finding, Findings};
use mbody::dynamics::System;
use motorcycle::maneuver::{Control, Maneuver, Moving};
use problem::{Controller, Limit, Side};
use std::sync::Arc;

/// Name of the ending at the end of the path.
pub const GOAL: &str = "end_of_path";

/// Name of the ending far from the path, and how far that is, m: what was planned there has nothing to do with where the vehicle is.
pub const LOST: &str = "off_the_path";
const FAR_OFF: f64 = 20.0;

/// Steps that an integration takes at least over the shortest bump of a road.
const STEPS_PER_BUMP: f64 = 2.0;

/// A maneuver that is about to be ridden.
pub struct Ride {
    /// Who rides, and what passes under the wheels.
    pub controllers: Vec<Box<dyn Controller>>,
    /// Inputs over time.
    pub inputs: Vec<Moving>,
    /// Longest step with which nothing on the road is passed over, s.
    pub longest_step: f64,
    /// When it ends at the latest, s.
    pub end: f64,
    /// What is the end of it, good or bad, where there is a rider to tell.
    pub ends: Vec<Limit>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

impl Default for Ride {
    fn default() -> Self {
        Self {
            controllers: Vec::new(),
            inputs: Vec::new(),
            longest_step: f64::INFINITY,
            end: f64::INFINITY,
            ends: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

/// Reads a maneuver with `PATH=VALUE` overrides.
///
/// # Errors
/// There is none of that name, or everything that is wrong in it.
pub fn read(name: &str, changes: &[String]) -> Result<Maneuver, Failure> {
    let source = library::maneuver(name)?;
    let overrides = changes.iter().map(|change| match change.split_once('=') {
        Some((path, value)) if !path.is_empty() && !value.is_empty() => Ok((path.trim().to_owned(), value.trim().to_owned())),
        _ => Err(Failure::from(
            argument("change", change, "bad_override", "this is not of the form PATH=VALUE")
                .with_hint("for example `--change speed=20m/s`"),
        )),
    });
    let overrides = overrides.collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings::new();
    let maneuver = motorcycle::maneuver::read(&source.file, &source, &overrides, &mut findings);
    match maneuver {
        Some(maneuver) => Ok(maneuver),
        None => Err(Failure::Findings(findings.sorted())),
    }
}

/// Makes the rider and the road of the maneuver of this name.
///
/// # Errors
/// The vehicle cannot be ridden, or cannot feel the road.
pub fn ride(name: &str, maneuver: Maneuver, system: &Arc<System>) -> Result<Ride, Failure> {
    let course = &maneuver.course;
    let road = (!maneuver.road.is_empty()).then(|| road::under_wheels(&maneuver.road, &course.path, system)).transpose()?;
    let fastest = course.speed.range().1.max(1.0);
    let shortest = maneuver.road.iter().map(|relief| relief.shortest()).fold(f64::INFINITY, f64::min);
    let longest_step = shortest / (STEPS_PER_BUMP * fastest);
    let mut controllers: Vec<Box<dyn Controller>> = road.into_iter().map(|road| Box::new(road) as Box<dyn Controller>).collect();
    if !course.torque_pulses.is_empty() && (maneuver.control == Control::None || maneuver.replay.is_some()) {
        let finding = Finding::error("no_rider", "`torque_pulses` are torques of a rider, and `control: none` and `replay` have none");
        return Err(finding.with_hint("`--signals FILE.csv` gives inputs over time").into());
    }
    if maneuver.control == Control::None {
        return Ok(Ride { controllers, inputs: maneuver.inputs, longest_step, ..Ride::default() });
    }
    let task = Task { system, backend: "kinsol", wishes: &maneuver.rider, front_brake_share: FRONT_BRAKE_SHARE };
    if let Some(written) = &maneuver.replay {
        let (replay, end) = replay(written, &library::maneuver(name)?, course.speed.first(), &task)?;
        controllers.push(Box::new(replay));
        return Ok(Ride { controllers, inputs: maneuver.inputs, longest_step, end, ..Ride::default() });
    }
    let end = course.path.length();
    let designed = task.design(maneuver.course)?;
    let limit = |name: &'static str, signal: &str, side, threshold, about: &'static str| Limit {
        name: name.into(),
        signal: signal.to_owned(),
        threshold,
        side,
        nominal: 1.0,
        about: about.into(),
    };
    let lost = |side, threshold| limit(LOST, "rider.path_error", side, threshold, "the rider has lost the path");
    let ends =
        vec![limit(GOAL, "rider.station", Side::Above, end, "the path ends"), lost(Side::Above, FAR_OFF), lost(Side::Below, -FAR_OFF)];
    controllers.push(Box::new(designed.rider));
    Ok(Ride { controllers, inputs: maneuver.inputs, longest_step, ends, warnings: designed.warnings, ..Ride::default() })
}
