//! Figures of modes: root locus, frequencies and damping, shapes, sensitivities.

use super::quantity;
use crate::Failure;
use crate::output::modes::{Branch, ModesAlong, NamedMode};
use crate::output::{Angles, Beside, Report};
use crate::plot::{Axis, BarPanel, Bars, Curve, Figure, LinePanel, Lines, Locus, Markers, Phasor, PhasorPanel, Phasors, RootLocus};
use mbody::description::finding::Finding;
use std::f64::consts::TAU;

/// Shares of the largest deviation below this are not drawn.
const SMALL: f64 = 0.03;

fn of_report(report: &Report) -> Result<&ModesAlong, Failure> {
    match &report.beside {
        Beside::Modes(modes) => Ok(modes),
        _ => Err(Finding::error("no_sweep", "there are no modes to draw").into()),
    }
}

/// Modes of the base and of every variant, and the names of these; no names where there is only the base.
fn all(report: &Report) -> Result<(Vec<&ModesAlong>, Vec<String>), Failure> {
    let variants = report.variants.iter().filter_map(|v| match &v.beside {
        Beside::Modes(modes) => Some((modes, v.name.clone())),
        _ => None,
    });
    let (mut modes, mut names) = (vec![of_report(report)?], Vec::new());
    for (variant, name) in variants {
        modes.push(variant);
        names.push(name);
    }
    if !names.is_empty() {
        names.insert(0, report.model.clone());
    }
    Ok((modes, names))
}

/// `Modes of ref11, lean 20 deg`: what does not vary stands in the title.
fn title(report: &Report, modes: &ModesAlong, what: &str) -> String {
    let mut title = format!("{what} of {}", report.model);
    for (k, given) in report.given.iter().enumerate() {
        let first = report.points.first().map_or(f64::NAN, |p| p.given[k]);
        if Some(k) != modes.along && report.points.iter().all(|p| p.given[k] == first) {
            title.push_str(&format!(", {}", quantity(&given.name, &given.unit, first)));
        }
    }
    title
}

/// Eigenvalues in the complex plane.
///
/// # Errors
/// There are no modes.
pub fn locus(report: &Report) -> Result<Figure, Failure> {
    let (all, variants) = all(report)?;
    let branches = all.iter().enumerate().flat_map(|(variant, modes)| loci(modes, variant)).collect();
    let modes = all[0];
    let first = modes.along.and_then(|k| {
        let values = modes.branches.iter().filter(|b| b.begins).filter_map(|b| b.swept.first());
        let value = values.copied().next()?;
        Some(quantity(&report.given[k].name, &report.given[k].unit, value))
    });
    let first = first.unwrap_or_default();
    Ok(Figure::RootLocus(RootLocus { title: title(report, modes, "Modes"), branches, first, variants }))
}

fn loci(modes: &ModesAlong, variant: usize) -> Vec<Locus> {
    let at = |b: &Branch| b.values.iter().map(|z| (z.re, z.im)).collect::<Vec<_>>();
    if !modes.branches.is_empty() {
        return modes.branches.iter().map(|b| Locus { name: b.name.clone(), points: at(b), begins: b.begins, variant }).collect();
    }
    let points = modes.points.iter().flatten().flat_map(|p| &p.modes);
    points.map(|m| Locus { name: m.name.clone(), points: vec![(m.value.re, m.value.im)], begins: false, variant }).collect()
}

/// Whether a piece of a path oscillates beyond the point that it shares with the piece before.
fn oscillates(branch: &Branch) -> bool {
    branch.values.iter().skip(usize::from(!branch.begins && !branch.continues)).any(|z| z.im > 0.0)
}

/// Frequency and damping ratio of everything that oscillates.
///
/// # Errors
/// Nothing was swept.
pub fn frequencies(report: &Report) -> Result<Figure, Failure> {
    let (all, variants) = all(report)?;
    let Some(given) = all[0].along.map(|k| &report.given[k]) else {
        return Err(Finding::error("no_sweep", "all points of the sweep are the same").into());
    };
    let across = Angles::Degrees.show(&given.unit);
    let curves = |of: &dyn Fn(f64, f64) -> f64| {
        let mut curves: Vec<Curve> = Vec::new();
        let branches = all.iter().enumerate().flat_map(|(variant, modes)| modes.branches.iter().map(move |b| (variant, b)));
        for (variant, branch) in branches.filter(|(_, b)| oscillates(b)) {
            let value = |z: &nalgebra::Complex<f64>| if z.im > 0.0 { of(z.re, z.im) } else { f64::NAN };
            // the first point of a later piece is the last one of the piece before
            let shared = usize::from(!branch.begins && !branch.continues);
            let points = branch.swept.iter().zip(&branch.values).skip(shared).map(|(v, z)| (v * across.factor, value(z)));
            match curves.iter_mut().find(|c| c.name == branch.name && c.variant == variant) {
                Some(curve) => {
                    curve.points.push((f64::NAN, f64::NAN));
                    curve.points.extend(points);
                }
                None => curves.push(Curve { name: branch.name.clone(), points: points.collect(), markers: Markers::Never, variant }),
            }
        }
        curves
    };
    let panels = vec![
        LinePanel { y: Axis::new("Damped frequency", "Hz"), curves: curves(&|_, im| im / TAU) },
        LinePanel { y: Axis::new("Damping ratio", "-"), curves: curves(&|re, im| -re / re.hypot(im)) },
    ];
    let x = Axis::new(given.name.replace('_', " "), across.unit);
    Ok(Figure::Lines(Lines { title: title(report, all[0], "Modes"), x, panels, bands: Vec::new(), variants }))
}

/// Modes of the first point that has some, and a title that states the point.
fn first<'a>(report: &'a Report, what: &str) -> Result<(&'a [NamedMode], String), Failure> {
    let modes = of_report(report)?;
    let found = modes.points.iter().enumerate().find_map(|(k, p)| Some((k, p.as_ref().ok()?)));
    let Some((k, point)) = found else { return Err(Finding::error("no_modes", "there are no modes to draw").into()) };
    let given = report.given.iter().zip(&report.points[k].given).map(|(g, v)| format!(", {}", quantity(&g.name, &g.unit, *v)));
    Ok((&point.modes, format!("{what} of {}{}", report.model, given.collect::<String>())))
}

/// `wobble, 7.95 Hz, damping ratio 0.083`; a real mode with its eigenvalue.
fn heading(mode: &NamedMode) -> String {
    match mode.value.im > 0.0 {
        true => format!("{}, {:.2} Hz, damping ratio {:.3}", mode.name, mode.damped_frequency(), mode.damping_ratio),
        false => format!("{}, {:.3} 1/s", mode.name, mode.value.re),
    }
}

/// Displacements in every oscillation at the first point; those of a few percent are left out.
///
/// # Errors
/// Nothing oscillates.
pub fn shapes(report: &Report) -> Result<Figure, Failure> {
    let along = of_report(report)?;
    let (modes, title) = first(report, "Shapes of the modes")?;
    let panel = |mode: &NamedMode| {
        let moving = || (0..mode.shape.len()).filter(|&k| along.displacements[k]);
        let largest = moving().map(|k| mode.shape[k].norm()).fold(0.0, f64::max);
        let drawn = moving().filter(|&k| mode.shape[k].norm() > SMALL * largest);
        let arrow =
            |k: usize| Phasor { name: along.shape_signals[k].name.replace(['.', '_'], " "), value: (mode.shape[k].re, mode.shape[k].im) };
        PhasorPanel { title: heading(mode), arrows: drawn.map(arrow).collect() }
    };
    let panels: Vec<PhasorPanel> = modes.iter().filter(|m| m.value.im > 0.0 && m.confidence > 0.0).map(panel).collect();
    match panels.is_empty() {
        true => Err(Finding::error("no_modes", "nothing oscillates at the first point").into()),
        false => Ok(Figure::Phasors(Phasors { title, panels })),
    }
}

/// What one percent of the parameters does to real and imaginary part.
///
/// # Errors
/// No mode has sensitivities at the first point.
pub fn sensitivities(report: &Report) -> Result<Figure, Failure> {
    let (modes, title) = first(report, "Sensitivity of the modes")?;
    let panel = |mode: &NamedMode| {
        let row = |s: &crate::output::modes::Slope| (s.parameter.name.clone(), vec![0.01 * s.relative().re, 0.01 * s.relative().im]);
        BarPanel { title: heading(mode), rows: mode.sensitivity.iter().map(row).collect() }
    };
    let panels: Vec<BarPanel> = modes.iter().filter(|m| !m.sensitivity.is_empty()).map(panel).collect();
    if panels.is_empty() {
        return Err(Finding::error("no_modes", "no mode of the first point has sensitivities").into());
    }
    let series = ["real part (1/s)", "imaginary part (rad/s)"].map(str::to_owned).to_vec();
    Ok(Figure::Bars(Bars { title, x: Axis::new("Change of the eigenvalue per 1 % of the parameter", "1/s"), series, panels }))
}
