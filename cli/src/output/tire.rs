//! Curves of a tire: stiffnesses and friction per load as a table, all points as JSON and CSV.

use super::number::{aligned, number};
use super::palette::styled;
use super::{Axes, Kind, Options, Results, Writer, csv};
use motorcycle::tire::{Characteristic, Fit, Friction};
use serde_json::{Value, json};
use std::io;

/// What a curve runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Longitudinal slip, nothing else.
    LongitudinalSlip,
    /// Slip angle, nothing else.
    SlipAngle,
    /// Camber without slip.
    Camber,
    /// The greatest forces in every direction of the road: the convex hull of all forces at slips within their spans.
    Envelope,
}

impl Along {
    /// Name in JSON and CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::LongitudinalSlip => "longitudinal_slip",
            Self::SlipAngle => "slip_angle",
            Self::Camber => "camber",
            Self::Envelope => "envelope",
        }
    }
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Longitudinal slip.
    pub longitudinal_slip: f64,
    /// Slip angle, rad.
    pub slip_angle: f64,
    /// Camber, rad.
    pub camber: f64,
    /// Forces and moments of the road on the tire.
    pub friction: Friction<f64>,
}

/// A curve at one load.
#[derive(Clone, Debug)]
pub struct TireCurve {
    /// What it runs along.
    pub along: Along,
    /// Load, N.
    pub load: f64,
    /// Camber, rad; of curves along camber 0.
    pub camber: f64,
    /// The points.
    pub samples: Vec<Sample>,
}

/// The curves of a tire.
#[derive(Clone, Debug)]
pub struct TireCurves {
    /// Model or file.
    pub model: String,
    /// The tire of the model; empty for a file.
    pub tire: String,
    /// Kind of the law, or the dialect of its file.
    pub law: String,
    /// Axes of forces and moments.
    pub axes: Axes,
    /// Speed, m/s.
    pub speed: f64,
    /// Within which states it was measured.
    pub fit: Option<Fit>,
    /// Per load.
    pub characteristics: Vec<Characteristic>,
    /// All curves.
    pub curves: Vec<TireCurve>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

impl Results for TireCurves {
    /// Lateral force and the moments about the axle and the normal change their signs; slip angle, camber and overturning moment do not.
    fn in_axes(mut self, axes: Axes) -> Self {
        if axes != self.axes {
            for f in self.curves.iter_mut().flat_map(|c| &mut c.samples).map(|s| &mut s.friction) {
                (f.lateral, f.rolling_moment, f.aligning_moment) = (-f.lateral, -f.rolling_moment, -f.aligning_moment);
            }
            self.axes = axes;
        }
        self
    }
    fn writer(kind: &Kind) -> Writer<Self> {
        kind.write_tire
    }
    fn warnings(&self) -> &[String] {
        &self.warnings
    }
    fn statistics(&self) -> Value {
        json!({ "curves": self.curves.len() })
    }
    fn reached(&self) -> bool {
        true
    }
}

/// The signs of forces and moments in words.
pub fn signs(axes: Axes) -> &'static str {
    match axes {
        Axes::Iso => "ISO: x forward, y left, z up; camber > 0 leaning right; slip angle > 0 sliding right",
        Axes::Sae => "SAE: x forward, y right, z down; camber > 0 leaning right; slip angle > 0 sliding right",
    }
}

/// Column titles and values of the table: per load.
fn columns(curves: &TireCurves, radians: bool) -> Vec<(&'static str, Vec<f64>)> {
    let of = |value: &dyn Fn(&Characteristic) -> f64| curves.characteristics.iter().map(value).collect::<Vec<f64>>();
    let (factor, per) = if radians { (1.0, ["Cα/N 1/rad", "Cγ/N 1/rad"]) } else { (1f64.to_radians(), ["Cα/N 1/deg", "Cγ/N 1/deg"]) };
    vec![
        ("load N", of(&|c| c.load)),
        (per[0], of(&|c| c.cornering_stiffness / c.load * factor)),
        (per[1], of(&|c| c.camber_stiffness / c.load * factor)),
        ("Cκ/N", of(&|c| c.slip_stiffness / c.load)),
        ("μx", of(&|c| c.longitudinal_friction.unwrap_or(f64::NAN))),
        ("μy", of(&|c| c.lateral_friction.unwrap_or(f64::NAN))),
        ("trail mm", of(&|c| 1e3 * c.pneumatic_trail)),
        ("twist/N mm", of(&|c| 1e3 * c.twisting_stiffness / c.load)),
        ("relaxation m", of(&|c| if c.relaxation_length > 0.0 { c.relaxation_length } else { f64::NAN })),
    ]
}

/// `-15° to 15°`.
fn range([low, high]: [f64; 2], factor: f64, unit: &str) -> String {
    format!("{} to {} {unit}", number(low * factor), number(high * factor)).trim_end().to_owned()
}

pub(super) fn write_table(curves: &TireCurves, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    let tire = if curves.tire.is_empty() { String::new() } else { format!(" {}", curves.tire) };
    writeln!(out, "{}", styled(palette.heading, &format!("tire {}{tire}: {}", curves.model, curves.law)))?;
    writeln!(out, "{}", styled(palette.faint, signs(curves.axes)))?;
    if let Some(fit) = &curves.fit {
        let (angle, unit) = if options.angles == super::Angles::Radians { (1.0, "rad") } else { (1f64.to_degrees(), "deg") };
        let load = if fit.load[1] < 1e8 { format!("load {}, ", range(fit.load, 1.0, "N")) } else { String::new() };
        writeln!(
            out,
            "measured for {load}slip angle {}, longitudinal slip {}, camber {}",
            range(fit.slip_angle, angle, unit),
            range(fit.longitudinal_slip, 1.0, ""),
            range(fit.camber, angle, unit)
        )?;
    }
    writeln!(out)?;
    let columns = columns(curves, options.angles == super::Angles::Radians);
    let kept: Vec<_> = columns.into_iter().filter(|(_, values)| values.iter().any(|v| v.is_finite())).collect();
    let cells: Vec<Vec<String>> = kept
        .iter()
        .map(|(title, values)| {
            let texts: Vec<String> = values.iter().map(|v| if v.is_finite() { number(*v) } else { "–".to_owned() }).collect();
            let mut column = vec![(*title).to_owned()];
            column.extend(aligned(&texts));
            let width = column.iter().map(|c| c.chars().count()).max().unwrap_or(0);
            column.iter().map(|c| format!("{c:>width$}")).collect()
        })
        .collect();
    for row in 0..=curves.characteristics.len() {
        let line = cells.iter().map(|column| column[row].as_str()).collect::<Vec<_>>().join("  ");
        writeln!(out, "{}", if row == 0 { styled(palette.heading, &line) } else { line })?;
    }
    Ok(())
}

pub(super) fn write_json(curves: &TireCurves, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let loads: Vec<Value> = curves
        .characteristics
        .iter()
        .map(|c| {
            json!({
                "load": c.load, "cornering_stiffness": c.cornering_stiffness, "camber_stiffness": c.camber_stiffness,
                "slip_stiffness": c.slip_stiffness, "pneumatic_trail": c.pneumatic_trail, "twisting_stiffness": c.twisting_stiffness,
                "longitudinal_friction": c.longitudinal_friction, "lateral_friction": c.lateral_friction,
                "relaxation_length": (c.relaxation_length > 0.0).then_some(c.relaxation_length),
            })
        })
        .collect();
    let lines: Vec<Value> = curves
        .curves
        .iter()
        .map(|curve| {
            let of = |value: &dyn Fn(&Sample) -> f64| curve.samples.iter().map(value).collect::<Vec<f64>>();
            json!({
                "along": curve.along.name(), "load": curve.load, "camber": of(&|s| s.camber), "slip_angle": of(&|s| s.slip_angle),
                "longitudinal_slip": of(&|s| s.longitudinal_slip), "longitudinal_force": of(&|s| s.friction.longitudinal),
                "lateral_force": of(&|s| s.friction.lateral), "overturning_moment": of(&|s| s.friction.overturning_moment),
                "rolling_moment": of(&|s| s.friction.rolling_moment), "aligning_moment": of(&|s| s.friction.aligning_moment),
            })
        })
        .collect();
    let fit = curves
        .fit
        .as_ref()
        .map(|f| json!({ "load": f.load, "slip_angle": f.slip_angle, "longitudinal_slip": f.longitudinal_slip, "camber": f.camber }));
    let object = json!({
        "fastbike": env!("CARGO_PKG_VERSION"), "command": "tire", "model": curves.model, "tire": curves.tire, "law": curves.law,
        "axes": curves.axes.name(), "speed": curves.speed, "fit": fit, "loads": loads, "curves": lines, "warnings": curves.warnings,
    });
    serde_json::to_writer_pretty(&mut *out, &object)?;
    writeln!(out)
}

pub(super) fn write_csv(curves: &TireCurves, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    table.write_record([
        "along",
        "load",
        "longitudinal_slip",
        "slip_angle",
        "camber",
        "longitudinal_force",
        "lateral_force",
        "overturning_moment",
        "rolling_moment",
        "aligning_moment",
    ])?;
    for curve in &curves.curves {
        for s in &curve.samples {
            let f = &s.friction;
            let numbers = [
                curve.load,
                s.longitudinal_slip,
                s.slip_angle,
                s.camber,
                f.longitudinal,
                f.lateral,
                f.overturning_moment,
                f.rolling_moment,
                f.aligning_moment,
            ];
            table.write_record([curve.along.name().to_owned()].into_iter().chain(numbers.map(csv::cell)))?;
        }
    }
    table.flush()
}
