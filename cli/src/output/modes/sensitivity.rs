//! Sensitivities of a mode as a table: what one percent of a parameter does, and the derivatives.

use super::super::number::{aligned, number};
use super::super::palette::styled;
use super::super::{Options, Shown};
use super::{NamedMode, Slope};
use std::f64::consts::TAU;
use std::io;

/// A column: title, unit, number of a row.
type Column<'a> = (&'static str, &'static str, &'a dyn Fn(&Slope) -> String);

/// The unit in which a parameter is shown.
fn shown<'s>(slope: &'s Slope, options: &Options) -> Shown<'s> {
    options.angles.show(&slope.parameter.unit)
}

/// One line per parameter.
pub(super) fn write(mode: &NamedMode, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    let heading = format!("sensitivity of {}, {} 1/s ± {} rad/s", mode.name, number(mode.value.re), number(mode.value.im));
    writeln!(out, "\n{}", styled(palette.heading, &heading))?;
    // derivatives are by the unit that the value is shown in
    let per = |s: &Slope| s.by.value / shown(s, options).factor;
    let columns: [Column<'_>; 6] = [
        ("value", "", &|s| number(s.parameter.value * shown(s, options).factor)),
        ("re / 1 %", "1/s", &|s| number(0.01 * s.relative().re)),
        ("damped / 1 %", "Hz", &|s| number(0.01 * s.relative().im / TAU)),
        ("d re", "1/s", &|s| number(per(s).re)),
        ("d damped", "Hz", &|s| number(per(s).im / TAU)),
        ("error", "of it", &|s| format!("{:.0e}", s.by.error / s.by.value.norm().max(f64::MIN_POSITIVE))),
    ];
    let cells: Vec<Vec<String>> =
        columns.iter().map(|(_, _, cell)| aligned(&mode.sensitivity.iter().map(cell).collect::<Vec<_>>())).collect();
    let width = |k: usize| {
        let texts = cells[k].iter().map(String::as_str).chain([columns[k].0, columns[k].1]);
        texts.map(|t| t.chars().count()).max().unwrap_or(0)
    };
    let longest = |texts: &dyn Fn(&Slope) -> usize| mode.sensitivity.iter().map(texts).max().unwrap_or(0);
    let names = longest(&|s| s.parameter.name.chars().count()).max("parameter".len());
    let units = longest(&|s| shown(s, options).unit.chars().count()).max("per".len());
    let line = |text: &dyn Fn(usize) -> String| {
        let cells: Vec<String> = (1..columns.len()).map(|k| format!("{:>w$}", text(k), w = width(k))).collect();
        (format!("{:>w$}", text(0), w = width(0)), cells.join("  "))
    };
    let (value, rest) = line(&|k| columns[k].0.to_owned());
    writeln!(out, "{}", styled(palette.faint, &format!("{:names$}  {value}  {:units$}  {rest}", "parameter", "per")))?;
    let (value, rest) = line(&|k| columns[k].1.to_owned());
    writeln!(out, "{}", styled(palette.faint, format!("{:names$}  {value}  {:units$}  {rest}", "", "").trim_end()))?;
    for (row, slope) in mode.sensitivity.iter().enumerate() {
        let (value, rest) = line(&|k| cells[k][row].clone());
        writeln!(out, "{:names$}  {value}  {:units$}  {rest}", slope.parameter.name, shown(slope, options).unit)?;
    }
    Ok(())
}
