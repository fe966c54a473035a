//! Figures of a ride: histories, the path from above, accelerations to the front and to the side.

use crate::Failure;
use crate::output::{Angles, History, unreadable};
use crate::plot::{Axis, Curve, Figure, LinePanel, Lines, Markers};
use clap::ValueEnum;
use mbody::description::finding::Finding;

/// What is drawn of a ride.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// Speed, lean, steering torque and offset from the path over time, and the height of the road where it is not flat
    #[default]
    Histories,
    /// The path asked for and the path ridden, from above
    Path,
    /// Acceleration to the front over acceleration to the side
    Gg,
}

/// Panels of the histories: title, curves with their names.
type Panels = [(&'static str, &'static [(&'static str, &'static str)]); 4];

const HISTORIES: Panels = [
    ("speed", &[("ridden", "chassis.forward_speed"), ("asked for", "rider.target_speed")]),
    ("roll", &[("", "chassis.roll")]),
    ("steer torque", &[("", "steer.torque")]),
    ("path error", &[("", "rider.path_error")]),
];

/// The road where the tires touch it: drawn where it is not flat.
const ROAD: (&str, &[(&str, &str)]) = ("road height", &[("front", "front_tire.contact_z"), ("rear", "rear_tire.contact_z")]);
/// Difference of heights that is drawn, m.
const UNEVEN: f64 = 1e-4;

/// Draws a ride.
///
/// # Errors
/// A signal that it needs was not recorded.
pub fn figure(history: &History, picture: Picture) -> Result<Figure, Failure> {
    let time = history.recording.time();
    let column = |name: &str| -> Result<(&str, Vec<f64>), Failure> {
        let at = history.signals.iter().position(|s| s.name == name);
        let at = at.ok_or_else(|| {
            let finding = Finding::error("not_recorded", format!("this figure needs `{name}`, which was not recorded"));
            Failure::from(finding.with_hint("it is a figure of rides; leave out `--record`, and name a maneuver that somebody rides"))
        })?;
        Ok((&history.signals[at].unit, history.recording.column(at).map_err(unreadable)?))
    };
    let curve = |name: &str, x: &[f64], y: &[f64], factor: f64| Curve {
        name: name.to_owned(),
        points: x.iter().zip(y).map(|(x, y)| (*x, y * factor)).collect(),
        markers: Markers::Never,
        variant: 0,
    };
    let (what, x, panels) = match picture {
        Picture::Histories => {
            let mut panels = Vec::new();
            let uneven = column(ROAD.1[1].1).is_ok_and(|(_, z)| z.iter().any(|height| (height - z[0]).abs() > UNEVEN))
                && column(ROAD.1[0].1).is_ok();
            for (title, curves) in HISTORIES.into_iter().chain(uneven.then_some(ROAD)) {
                let unit = column(curves[0].1)?.0;
                let shown = Angles::Degrees.show(unit);
                let one = |(name, signal): &(&str, &str)| Ok(curve(name, time, &column(signal)?.1, shown.factor));
                let curves = curves.iter().map(one).collect::<Result<_, Failure>>()?;
                panels.push(LinePanel { y: Axis::new(title, shown.unit), curves });
            }
            ("Ride", Axis::new("time", "s"), panels)
        }
        Picture::Path => {
            let ridden = curve("ridden", &column("chassis.x")?.1, &column("chassis.y")?.1, 1.0);
            let asked = curve("asked for", &column("rider.path_x")?.1, &column("rider.path_y")?.1, 1.0);
            ("Path", Axis::new("x", "m"), vec![LinePanel { y: Axis::new("y, to the left", "m"), curves: vec![ridden, asked] }])
        }
        Picture::Gg => {
            let [forward, lateral, yaw_rate] = ["forward_speed", "lateral_speed", "yaw_rate"].map(|n| column(&format!("chassis.{n}")));
            let (forward, lateral, yaw_rate) = (forward?.1, lateral?.1, yaw_rate?.1);
            let rates = |v: &[f64]| -> Vec<f64> {
                let last = time.len() - 1;
                let slope = |a: usize, b: usize| (v[b] - v[a]) / (time[b] - time[a]);
                (0..=last).map(|k| slope(k.saturating_sub(1), (k + 1).min(last))).collect()
            };
            // of the base point, along and across its heading
            let along: Vec<f64> = rates(&forward).iter().zip(yaw_rate.iter().zip(&lateral)).map(|(a, (r, v))| a - r * v).collect();
            let across: Vec<f64> = rates(&lateral).iter().zip(yaw_rate.iter().zip(&forward)).map(|(a, (r, v))| a + r * v).collect();
            let axis = Axis::new("acceleration to the front", "m/s^2");
            (
                "Accelerations",
                Axis::new("acceleration to the left", "m/s^2"),
                vec![LinePanel { y: axis, curves: vec![curve("", &across, &along, 1.0)] }],
            )
        }
    };
    Ok(Figure::Lines(Lines { title: format!("{what} of {}", history.model), x, panels, bands: Vec::new(), variants: Vec::new() }))
}
