//! Curves of a tire: forces over slips and camber, moments, and the forces that are possible at once.

use crate::output::Axes;
use crate::output::tire::{Along, Sample, TireCurve, TireCurves};
use crate::plot::{Axis, Curve, Figure, Grid, GridPanel, LinePanel, Markers};

/// A panel: what its curves run along, and the two quantities.
struct Drawn {
    along: Along,
    x: (&'static str, &'static str),
    y: (&'static str, &'static str),
    point: fn(&Sample, f64) -> (f64, f64),
}

const PANELS: [Drawn; 6] = [
    Drawn {
        along: Along::LongitudinalSlip,
        x: ("longitudinal slip", ""),
        y: ("Fx", "N"),
        point: |s, _| (s.longitudinal_slip, s.friction.longitudinal),
    },
    Drawn {
        along: Along::SlipAngle,
        x: ("slip angle", "deg"),
        y: ("Fy", "N"),
        point: |s, _| (s.slip_angle.to_degrees(), s.friction.lateral),
    },
    Drawn {
        along: Along::Camber,
        x: ("camber", "deg"),
        y: ("Fy of camber", "N"),
        point: |s, _| (s.camber.to_degrees(), s.friction.lateral),
    },
    Drawn {
        along: Along::SlipAngle,
        x: ("slip angle", "deg"),
        y: ("Mz", "N m"),
        point: |s, _| (s.slip_angle.to_degrees(), s.friction.aligning_moment),
    },
    Drawn {
        along: Along::Camber,
        x: ("camber", "deg"),
        y: ("Mz of camber", "N m"),
        point: |s, _| (s.camber.to_degrees(), s.friction.aligning_moment),
    },
    Drawn {
        along: Along::Envelope,
        x: ("greatest Fx/N", ""),
        y: ("greatest Fy/N", ""),
        point: |s, load| (s.friction.longitudinal / load, s.friction.lateral / load),
    },
];

/// Draws the curves.
pub fn figure(curves: &TireCurves) -> Figure {
    let mut cambers: Vec<f64> = Vec::new();
    for curve in curves.curves.iter().filter(|c| c.along == Along::SlipAngle) {
        if !cambers.contains(&curve.camber) {
            cambers.push(curve.camber);
        }
    }
    let variant = |camber: f64| cambers.iter().position(|c| *c == camber).unwrap_or(0);
    let mut panels: Vec<GridPanel> = Vec::new();
    for drawn in &PANELS {
        let curve = |c: &TireCurve| Curve {
            name: format!("{:.0} N", c.load),
            points: c.samples.iter().map(|s| (drawn.point)(s, c.load)).collect(),
            markers: Markers::Never,
            variant: variant(c.camber),
        };
        let of: Vec<Curve> = curves.curves.iter().filter(|c| c.along == drawn.along).map(curve).collect();
        panels.push(GridPanel { x: Axis::new(drawn.x.0, drawn.x.1), lines: LinePanel { y: Axis::new(drawn.y.0, drawn.y.1), curves: of } });
    }
    // moments about x belong to a figure only where a law has them
    let rolls = |s: &Sample| s.friction.overturning_moment != 0.0;
    if curves.curves.iter().flat_map(|c| &c.samples).any(rolls) {
        let along = |along: Along, x: &'static str, point: fn(&Sample) -> f64| {
            let of = curves.curves.iter().filter(|c| c.along == along).map(|c| Curve {
                name: format!("{:.0} N", c.load),
                points: c.samples.iter().map(|s| (point(s), s.friction.overturning_moment)).collect(),
                markers: Markers::Never,
                variant: variant(c.camber),
            });
            GridPanel { x: Axis::new(x, "deg"), lines: LinePanel { y: Axis::new("Mx", "N m"), curves: of.collect() } }
        };
        panels.push(along(Along::SlipAngle, "slip angle", |s| s.slip_angle.to_degrees()));
        panels.push(along(Along::Camber, "camber", |s| s.camber.to_degrees()));
    }
    let axes = match curves.axes {
        Axes::Iso => "y left, z up",
        Axes::Sae => "y right, z down",
    };
    let name = if curves.tire.is_empty() { curves.model.clone() } else { format!("{} of {}", curves.tire, curves.model) };
    let variants = cambers.iter().map(|c| format!("camber {:.0}°", c.to_degrees())).collect();
    Figure::Grid(Grid { title: format!("{name}, {} ({axes})", curves.law), columns: 3, panels, variants })
}
