//! The page of a motion over time.

use super::contact::NUMBERS;
use super::scene::{self, Scene};
use super::{assemble, base64};
use crate::Failure;
use crate::output::{Angles, History, Recording, unreadable};
use mbody::stage::Workspace;
use serde_json::{Value, json};

/// Most frames of a page; longer motions leave samples out evenly.
const MOST: usize = 6000;

/// The page of a motion whose [`History::kept`] holds the coordinates and the signals of the scene.
///
/// `told` is the same motion in the axes of the reader.
///
/// # Errors
/// What was recorded cannot be read again.
pub fn page(scene: &Scene, history: &History, told: &History, angles: Angles) -> Result<String, Failure> {
    let kept = &history.kept;
    let (time, count) = (kept.recording.time(), kept.recording.len());
    let stride = count.div_ceil(MOST).max(1);
    let samples: Vec<usize> = (0..count).filter(|k| k % stride == 0 || k + 1 == count).collect();
    let picked = |recording: &Recording, k: usize| -> Result<Vec<f64>, Failure> {
        let column = recording.column(k).map_err(unreadable)?;
        Ok(samples.iter().map(|&k| column[k]).collect())
    };
    let model = scene.system.model();
    let mut w = Workspace::new(model);
    let nq = model.layout().nq();
    let coordinates = (0..nq).map(|k| picked(&kept.recording, k)).collect::<Result<Vec<_>, _>>()?;
    let frames: Vec<_> = (0..samples.len()).map(|k| scene.poses(&mut w, coordinates.iter().map(|c| c[k]))).collect();
    let mut contacts = Vec::with_capacity(samples.len() * scene.rolling.len() * NUMBERS);
    let named = |name: &String| kept.signals.iter().position(|s| s.name == *name).map(|k| picked(&kept.recording, k)).transpose();
    let columns = scene.rolling.iter().map(|r| r.signals().iter().map(named).collect()).collect::<Result<Vec<Vec<_>>, _>>()?;
    for (k, poses) in frames.iter().enumerate() {
        for (rolling, columns) in scene.rolling.iter().zip(&columns) {
            contacts.extend(rolling.numbers(poses, std::array::from_fn(|c| columns[c].as_ref().map(|c| c[k]))));
        }
    }
    let plot = |&s: &usize| -> Result<Value, Failure> {
        let (signal, shown) = (&told.signals[s], angles.show(&told.signals[s].unit));
        let values = picked(&told.recording, s)?.into_iter().map(|v| v * shown.factor);
        Ok(json!({ "name": signal.name, "unit": shown.unit, "about": signal.about, "values": base64::numbers(values) }))
    };
    let plots = told.shown.iter().map(plot).collect::<Result<Vec<Value>, _>>()?;
    let title = format!("Motion of {}", history.model);
    let data = json!({
        "kind": "run",
        "title": title,
        "about": about(told, angles),
        "scene": scene.json(&frames),
        "count": samples.len(),
        "time": base64::numbers(samples.iter().map(|&k| time[k])),
        "poses": base64::numbers(frames.iter().flat_map(|f| scene::numbers(f))),
        "contacts": base64::numbers(contacts),
        "plots": plots,
    });
    Ok(assemble(&title, &data))
}

/// What was given and how it ended, in a line.
fn about(history: &History, angles: Angles) -> String {
    let given = history.given.iter().map(|(given, value)| {
        let shown = angles.show(&given.unit);
        format!("{} {} {}", given.name, (value * shown.factor * 1e6).round() / 1e6, shown.unit).trim_end().to_owned()
    });
    let given: Vec<String> = given.collect();
    let outcome = &history.outcome;
    let ending = match &outcome.because {
        Some(because) => format!("ended at {:.4} s: {because}", outcome.statistics.time),
        None => format!("{} s", outcome.duration),
    };
    let parts = [given.join(", "), ending, format!("{}, {} form", outcome.backend, outcome.formulation)];
    parts.iter().filter(|p| !p.is_empty()).cloned().collect::<Vec<_>>().join(" · ")
}
