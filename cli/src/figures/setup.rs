//! Figures of a setup: the side view with its lines, and what a suspension does over its travel.

use crate::Failure;
use crate::output::setup::SetupReport;
use crate::plot::{Axis, Curve, Figure, Grid, GridPanel, LinePanel, Markers, Sketch, Stroke};
use mbody::description::finding::Finding;
use motorcycle::setup::{Suspension, TravelPoint};

/// The side view: wheels, steering axis and trail, line of load transfer, chain, arm and squat line.
pub fn side_view(report: &SetupReport) -> Figure {
    let view = &report.setup.side_view;
    let mut sketch = Sketch::new(format!("Setup of {}", report.model));
    let value = |name: &str| {
        let all = report.setup.geometry.iter().chain(&report.setup.mass).chain(&report.setup.pull);
        all.into_iter().find(|q| q.name == name).map_or(f64::NAN, |q| q.value)
    };
    for wheel in &view.wheels {
        sketch.circle(wheel.center, wheel.radius, Stroke::Thick);
        sketch.circle(wheel.center, 0.72 * wheel.radius, Stroke::Thin);
        sketch.point(wheel.center, "");
    }
    let front = view.front_contact[0];
    let height = view.mass_center[1];
    if let Some([foot, head]) = view.steering_axis {
        let along = [head[0] - foot[0], head[1] - foot[1]];
        let top = [foot[0] + 1.15 * along[0], foot[1] + 1.15 * along[1]];
        sketch.line(foot, top, Stroke::Axis, "steering axis");
        sketch.dimension([front, 0.0], [foot[0], 0.0], format!("trail {:.1} mm", 1e3 * value("trail")), 1);
        sketch.note(top, format!("rake {:.2}°", value("rake").to_degrees()));
    }
    sketch.dimension([0.0, 0.0], [front, 0.0], format!("wheelbase {:.0} mm", 1e3 * front), 2);
    sketch.line([0.0, 0.0], [front, height], Stroke::Second, "line of load transfer");
    sketch.point(view.mass_center, "mass center");
    if let Some(squat) = &view.squat {
        if let Some([axle, pivot]) = squat.arm {
            sketch.line(axle, pivot, Stroke::Thick, "");
            sketch.point(pivot, "");
            // below: beside it stands the sprocket
            sketch.note([pivot[0], pivot[1] - 0.08], "pivot".to_owned());
            if let Some(point) = squat.squat_point {
                sketch.line(pivot, point, Stroke::Thin, "");
            }
        }
        if let (Some([rear, fore]), Some(sprockets)) = (squat.chain, squat.sprockets) {
            sprockets.iter().for_each(|(center, radius)| sketch.circle(*center, *radius, Stroke::Thin));
            sketch.line(rear, fore, Stroke::Fourth, "upper run of the chain");
            if let Some(point) = squat.squat_point {
                sketch.line(fore, point, Stroke::Thin, "");
                sketch.point(point, "A");
            }
        }
        let reach = squat.squat_point.map_or(front, |p| p[0].clamp(0.6 * front, 1.5 * front));
        sketch.line([0.0, 0.0], [reach, squat.slope * reach], Stroke::First, "squat line");
    }
    Figure::Sketch(sketch)
}

/// Load, wheel rate and motion ratios over travel, a column for each axle.
///
/// # Errors
/// No axle is sprung.
pub fn curves(report: &SetupReport) -> Result<Figure, Failure> {
    let suspensions = &report.setup.suspensions;
    if suspensions.is_empty() {
        return Err(Finding::error("no_suspension", "there are no curves to draw: no axle of this vehicle is sprung").into());
    }
    type Row = (&'static str, &'static str, fn(&Suspension) -> Vec<Curve>);
    let rows: [Row; 3] = [
        ("load", "N", |s| vec![curve(s, "load", &|p| p.force, s.here.force)]),
        ("wheel rate", "kN/m", |s| vec![curve(s, "wheel rate", &|p| 1e-3 * p.wheel_rate, 1e-3 * s.here.wheel_rate)]),
        ("motion ratio", "", |s| {
            let ratio =
                |k: usize| curve(s, "motion ratio", &move |p: &TravelPoint| p.springs[k].motion_ratio, s.here.springs[k].motion_ratio);
            (0..s.springs.len()).map(ratio).collect()
        }),
    ];
    let mut panels = Vec::new();
    for (label, unit, of) in rows {
        for suspension in suspensions {
            let x = Axis::new(format!("{} travel", suspension.axle), "mm");
            let mut curves = of(suspension);
            let here: Vec<(f64, f64)> = curves.iter_mut().filter_map(|c| c.points.pop()).collect();
            curves.iter_mut().for_each(|c| c.name = String::from("over the travel from full extension"));
            let pose = here.into_iter().map(|p| Curve {
                name: "in the given pose".to_owned(),
                points: vec![p],
                markers: Markers::Always,
                variant: 0,
            });
            curves.extend(pose);
            // stops would hide the slope between them, and rounding is no change
            let values: Vec<f64> = curves.iter().skip(curves.len() / 2).flat_map(|c| &c.points).map(|p| p.1).collect();
            let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
            let y = match label {
                "wheel rate" => Axis::new(label, unit).between(0.0, 2.5 * high),
                "motion ratio" => {
                    let all = curves.iter().flat_map(|c| &c.points).map(|p| p.1);
                    let (least, most) = all.fold((low * 0.95, high * 1.05), |(l, h), v| (l.min(v), h.max(v)));
                    Axis::new(label, unit).between(least.min(most), most.max(least))
                }
                _ => Axis::new(label, unit),
            };
            panels.push(GridPanel { x, lines: LinePanel { y, curves } });
        }
    }
    let title = format!("Suspension of {}", report.model);
    Ok(Figure::Grid(Grid { title, columns: suspensions.len(), panels, variants: Vec::new() }))
}

/// The curve of a value over travel in mm; its last point is that of the given pose.
fn curve(suspension: &Suspension, name: &str, value: &dyn Fn(&TravelPoint) -> f64, here: f64) -> Curve {
    // an end stop would hide everything else
    let shown = suspension.curve.iter().filter(|p| p.force < 3.0 * suspension.here.force);
    let points = shown.map(|p| (1e3 * p.travel, value(p))).chain([(1e3 * suspension.here.travel, here)]);
    Curve { name: name.to_owned(), points: points.collect(), markers: Markers::Never, variant: 0 }
}
