//! Variants beside the base: what differs, as a table.

use super::number::{aligned, number};
use super::palette::styled;
use super::report::{Report, Variant};
use super::{Options, table};
use std::io;

/// Relative difference below which two values count as the same.
const SAME: f64 = 1e-9;

/// For one point, the signals that differ; for several, the shown signals with their differences.
pub(super) fn write(report: &Report, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    for variant in &report.variants {
        writeln!(out, "\n{}", styled(options.palette.heading, &format!("versus {} (difference = variant - base)", variant.name)))?;
        match (report.points.as_slice(), variant.points.as_slice()) {
            ([_], [_]) => write_one(report, variant, options, out)?,
            _ => write_several(report, variant, options, out)?,
        }
    }
    Ok(())
}

fn write_one(report: &Report, variant: &Variant, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (base, other) = (&report.points[0], &variant.points[0]);
    if other.values.is_empty() || base.values.is_empty() {
        return writeln!(out, "  no difference to show: base {}, variant {}", base.ending.name(), other.ending.name());
    }
    let differs = |k: &usize| {
        let (a, b) = (base.value(*k), other.value(*k));
        (a - b).abs() > SAME * a.abs().max(b.abs()).max(1e-3)
    };
    let rows: Vec<usize> = (0..report.signals.len()).filter(differs).collect();
    if rows.is_empty() {
        return writeln!(out, "  every signal is the same");
    }
    let column = |of: &dyn Fn(usize) -> f64| {
        let texts: Vec<String> = rows.iter().map(|&k| number(of(k) * options.angles.show(&report.signals[k].unit).factor)).collect();
        aligned(&texts)
    };
    let columns = [column(&|k| base.value(k)), column(&|k| other.value(k)), column(&|k| other.value(k) - base.value(k))];
    let names = rows.iter().map(|&k| report.signals[k].name.chars().count()).max().unwrap_or(0);
    let width = |c: usize, title: &str| columns[c].iter().map(|t| t.chars().count()).max().unwrap_or(0).max(title.len());
    let titles = ["base", "variant", "difference"];
    let widths: Vec<usize> = titles.iter().enumerate().map(|(c, t)| width(c, t)).collect();
    let heads: Vec<String> = titles.iter().zip(&widths).map(|(t, w)| format!("{t:>w$}")).collect();
    writeln!(out, "  {:names$}  {}", "signal", heads.join("  "))?;
    for (row, &k) in rows.iter().enumerate() {
        let cells: Vec<String> = columns.iter().zip(&widths).map(|(c, w)| format!("{:>w$}", c[row])).collect();
        let unit = options.angles.show(&report.signals[k].unit).unit;
        writeln!(out, "  {:names$}  {}  {unit}", report.signals[k].name, cells.join("  "))?;
    }
    Ok(())
}

fn write_several(report: &Report, variant: &Variant, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    for k in table::chosen(report) {
        let signal = &report.signals[k];
        let shown = options.angles.show(&signal.unit);
        writeln!(out, "  {} ({})", signal.name, shown.unit)?;
        let column =
            |of: &dyn Fn(usize) -> f64| aligned(&(0..report.points.len()).map(|p| number(of(p) * shown.factor)).collect::<Vec<_>>());
        let at = |p: usize| variant.points.get(p).map_or(f64::NAN, |point| point.value(k));
        let (base, other, difference) =
            (column(&|p| report.points[p].value(k)), column(&at), column(&|p| at(p) - report.points[p].value(k)));
        for p in 0..report.points.len() {
            let given: Vec<String> = (report.given.iter().zip(&report.points[p].given))
                .map(|(g, v)| {
                    let shown = options.angles.show(&g.unit);
                    format!("{} {} {}", g.name, number(v * shown.factor), shown.unit)
                })
                .collect();
            writeln!(out, "    {}: {}  {}  {}", given.join(", "), base[p], other[p], difference[p])?;
        }
    }
    Ok(())
}
