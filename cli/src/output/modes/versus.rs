//! Modes of variants beside those of the base, with their differences.

use super::super::number::{aligned, number};
use super::super::palette::styled;
use super::super::report::Report;
use super::super::{Options, table};
use super::{ModesAlong, NamedMode, PointModes, tagged};
use std::io;

/// What is compared: name, unit, value.
type Quantity = (&'static str, &'static str, fn(&NamedMode) -> f64);

const QUANTITIES: [Quantity; 3] =
    [("re", "1/s", |m| m.value.re), ("damped", "Hz", |m| m.damped_frequency()), ("damping ratio", "", |m| m.damping_ratio)];

/// Name of a mode, the mode of the base, that of the variant.
type Pair<'a> = (&'a str, Option<&'a NamedMode>, Option<&'a NamedMode>);

/// For every variant and point a line per mode: base, variant and difference of each quantity. Sweeps show the oscillations only.
pub(super) fn write(report: &Report, along: &ModesAlong, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    for (name, _, variant) in tagged(report, along).skip(1) {
        writeln!(out, "\n{}", styled(options.palette.heading, &format!("versus {name} (difference = variant - base)")))?;
        for (k, at) in report.points.iter().enumerate() {
            let given = table::prescribed(report, at, options.angles);
            match (along.points.get(k), variant.points.get(k)) {
                (Some(Ok(base)), Some(Ok(other))) => {
                    if report.points.len() > 1 {
                        writeln!(out, "given: {given}")?;
                    }
                    write_point(&pairs(base, other, report.points.len() > 1), options, out)?;
                }
                _ => writeln!(out, "  {given}: no difference to show")?,
            }
        }
    }
    Ok(())
}

/// Modes of one name, in their order, side by side; what only one side has stands alone.
fn pairs<'a>(base: &'a PointModes, other: &'a PointModes, oscillations: bool) -> Vec<Pair<'a>> {
    let mut pairs: Vec<Pair<'_>> = base.modes.iter().map(|mode| (mode.name.as_str(), Some(mode), None)).collect();
    for mode in &other.modes {
        let oscillates = |m: &NamedMode| m.value.im > 0.0;
        let same = |b: &NamedMode| b.name == mode.name && oscillates(b) == oscillates(mode);
        match pairs.iter_mut().find(|(_, b, o)| o.is_none() && b.is_some_and(same)) {
            Some(pair) => pair.2 = Some(mode),
            None => pairs.push((&mode.name, None, Some(mode))),
        }
    }
    pairs.retain(|(_, a, b)| !oscillations || a.or(*b).is_some_and(|m| m.value.im > 0.0));
    pairs
}

fn write_point(pairs: &[Pair<'_>], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let names = pairs.iter().map(|p| p.0.chars().count()).max().unwrap_or(0).max("mode".len());
    let mut columns: Vec<(String, Vec<String>)> = Vec::new();
    for (quantity, unit, of) in QUANTITIES {
        let value = |mode: Option<&NamedMode>| mode.map_or(f64::NAN, of);
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        let column =
            |of: &dyn Fn(f64, f64) -> f64| aligned(&pairs.iter().map(|(_, a, b)| number(of(value(*a), value(*b)))).collect::<Vec<_>>());
        columns.push((format!("{quantity}{unit}"), column(&|a, _| a)));
        columns.push(("variant".to_owned(), column(&|_, b| b)));
        columns.push(("difference".to_owned(), column(&|a, b| b - a)));
    }
    let widths: Vec<usize> =
        columns.iter().map(|(title, cells)| cells.iter().chain([title]).map(|t| t.chars().count()).max().unwrap_or(0)).collect();
    let line =
        |text: &dyn Fn(usize) -> String| widths.iter().enumerate().map(|(c, w)| format!("{:>w$}", text(c))).collect::<Vec<_>>().join("  ");
    writeln!(out, "{}", styled(options.palette.faint, &format!("{:names$}  {}", "mode", line(&|c| columns[c].0.clone()))))?;
    for (row, (name, ..)) in pairs.iter().enumerate() {
        writeln!(out, "{name:names$}  {}", line(&|c| columns[c].1[row].clone()))?;
    }
    Ok(())
}
