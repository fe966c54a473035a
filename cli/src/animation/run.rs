//! The page of a motion over time.

use super::contact::NUMBERS;
use super::scene::{self, Scene};
use super::{assemble, base64};
use crate::output::{Angles, History};
use mbody::stage::Workspace;
use serde_json::{Value, json};

/// Most frames of a page; longer motions leave samples out evenly.
const MOST: usize = 6000;

/// The page of a motion whose [`History::kept`] holds the coordinates and the signals of the scene.
///
/// `told` is the same motion in the axes of the reader.
pub fn page(scene: &Scene, history: &History, told: &History, angles: Angles) -> String {
    let kept = &history.kept;
    let stride = kept.time.len().div_ceil(MOST).max(1);
    let samples: Vec<usize> = (0..kept.time.len()).filter(|k| k % stride == 0 || k + 1 == kept.time.len()).collect();
    let model = scene.system.model();
    let mut w = Workspace::new(model);
    let nq = model.layout().nq();
    let frames: Vec<_> = samples.iter().map(|&k| scene.poses(&mut w, kept.columns[..nq].iter().map(|c| c[k]))).collect();
    let mut contacts = Vec::with_capacity(samples.len() * scene.rolling.len() * NUMBERS);
    let columns: Vec<[Option<&[f64]>; 6]> = scene.rolling.iter().map(|r| r.signals().map(|s| kept.column(&s))).collect();
    for (poses, &k) in frames.iter().zip(&samples) {
        for (rolling, columns) in scene.rolling.iter().zip(&columns) {
            contacts.extend(rolling.numbers(poses, columns.map(|c| c.map(|c| c[k]))));
        }
    }
    let plots: Vec<Value> = (told.shown.iter())
        .map(|&s| {
            let (signal, shown) = (&told.signals[s], angles.show(&told.signals[s].unit));
            let values = samples.iter().map(|&k| told.columns[s][k] * shown.factor);
            json!({ "name": signal.name, "unit": shown.unit, "about": signal.about, "values": base64::numbers(values) })
        })
        .collect();
    let title = format!("Motion of {}", history.model);
    let data = json!({
        "kind": "run",
        "title": title,
        "about": about(told, angles),
        "scene": scene.json(&frames),
        "count": samples.len(),
        "time": base64::numbers(samples.iter().map(|&k| kept.time[k])),
        "poses": base64::numbers(frames.iter().flat_map(|f| scene::numbers(f))),
        "contacts": base64::numbers(contacts),
        "plots": plots,
    });
    assemble(&title, &data)
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
