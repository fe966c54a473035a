//! Makes who repeats a recorded ride: the record from its file, weak gains from the vehicle.

use crate::Failure;
use crate::rider::{Task, reins, ridable};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use mbody::description::quantity::Dimension;
use mbody::description::quantity::Dimensioned;
use mbody::description::quantity::dimension::Time;
use mbody::dynamics::TreePlant;
use mbody::scalar::Pchip;
use motorcycle::maneuver::{ReplayDescription, columns};
use motorcycle::rider::replay::{Record, Replay};
use problem::Dae;

/// Share of the gains, where nobody says otherwise.
const SHARE: f64 = 0.2;

/// Who repeats the ride, and the time at which the record ends, s.
///
/// # Errors
/// There is no such file or column, or nobody could steer the vehicle at this speed (m/s).
pub fn replay(written: &ReplayDescription, library: &dyn Library, speed: f64, task: &Task<'_>) -> Result<(Replay, f64), Failure> {
    let plant = TreePlant::new(task.system.clone());
    let base = ridable(&plant)?;
    let reins = reins(&plant, &base)?;
    let (_, along) = task.along(&[speed], &[0.0])?;
    let refused = |why: String| Failure::from(Finding::error("no_rider", format!("nobody can hold the vehicle at {speed:.1} m/s: {why}")));
    let regulator = along.points.into_iter().next().unwrap_or_else(|| Err(String::new())).map_err(refused)?;
    let measured: Vec<String> = reins.base[..3].iter().chain(&regulator.states).cloned().collect();
    let unit = |name: &str| {
        let unknowns = plant.unknowns().iter().map(|u| &u.signal);
        let mut all = unknowns.chain(plant.inputs().iter().map(|i| &i.signal));
        all.find(|s| s.name == name).and_then(|s| Dimension::of_unit(&s.unit.replace("^2", "²")))
    };
    let read = |names: &[String]| -> Result<(Vec<f64>, Vec<Pchip>), Findings> {
        let time = ("time", Some(Time::DIMENSION));
        let wanted: Vec<_> = std::iter::once(time).chain(names.iter().map(|n| (n.as_str(), unit(n)))).collect();
        let mut read = columns(library, &written.file, &wanted)?.into_iter();
        let times = read.next().unwrap_or_default();
        let curve = |values: Vec<f64>| Pchip::new(&times, &values);
        let curves = read.map(curve).collect::<Result<_, _>>();
        curves
            .map(|curves| (times.clone(), curves))
            .map_err(|e| Finding::error("bad_curve", format!("file `{}`: {e}", written.file)).into())
    };
    let at = |findings: Findings| findings.into_iter().map(|f| f.at_path("replay.file")).collect::<Findings>();
    let (times, then) = read(&measured).map_err(at)?;
    let (_, mut torques) = read(&reins.commands[..1]).map_err(at)?;
    let mut commanded = vec![reins.commands[0].clone()];
    // drive and brakes are repeated where they were recorded
    for name in &reins.commands[1..] {
        if let Ok((_, curve)) = read(std::slice::from_ref(name)) {
            torques.extend(curve);
            commanded.push(name.clone());
        }
    }
    let share = written.gain.map_or(SHARE, |q| q.si());
    let gains = regulator.gains.iter().map(|g| share * g).collect();
    let path_gains = regulator.path_gains.map(|g| share * g);
    let replay = Replay::new(Record { measured, then, commanded, torques, gains, path_gains });
    let broken = || Finding::error("no_rider", "the record does not go together");
    Ok((replay.ok_or_else(broken)?, times.last().copied().unwrap_or_default()))
}
