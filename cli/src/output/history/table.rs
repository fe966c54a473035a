//! A readable number of lines, then how the motion ended and what it took.

use super::{History, Outcome};
use crate::output::number::number;
use crate::output::palette::styled;
use crate::output::table::{Column, quantity};
use crate::output::{Options, units};
use analyses::transient::{Crossing, Worst};
use std::io;

/// Most events of one limit in a line.
const SPANS: usize = 6;
/// Most lines of samples.
const LINES: usize = 25;

pub(in crate::output) fn write(history: &History, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (palette, outcome) = (options.palette, &history.outcome);
    writeln!(out, "{}", styled(palette.heading, &format!("run {}", history.model)))?;
    for line in history.axes.signs() {
        writeln!(out, "{}", styled(palette.faint, line))?;
    }
    let given = history.given.iter().map(|(g, v)| format!("{} {}", g.name, quantity(*v, &g.unit, options.angles)));
    let given = given.collect::<Vec<_>>().join(", ");
    if !given.is_empty() {
        writeln!(out, "given: {given}")?;
    }
    writeln!(out)?;
    let time = history.recording.time();
    let rows = thinned(time.len());
    let mut columns = vec![Column::new("time", "s", rows.iter().map(|&k| time[k]), options.angles)];
    for &s in &history.shown {
        let signal = &history.signals[s];
        let values = history.recording.column(s)?;
        columns.push(Column::new(&signal.name, &signal.unit, rows.iter().map(|&k| values[k]), options.angles));
    }
    let line = |text: &dyn Fn(&Column) -> String| {
        columns.iter().map(|c| format!("{:>width$}", text(c), width = c.width())).collect::<Vec<_>>().join("  ")
    };
    writeln!(out, "{}", styled(palette.heading, &line(&|c| c.name.clone())))?;
    writeln!(out, "{}", styled(palette.faint, line(&|c| c.unit.clone()).trim_end()))?;
    for row in 0..rows.len() {
        writeln!(out, "{}", line(&|c| c.cells[row].clone()).trim_end())?;
    }
    if rows.len() < time.len() {
        let all = format!("{} of {} samples; `--format csv` writes all", rows.len(), time.len());
        writeln!(out, "{}", styled(palette.faint, &all))?;
    }
    writeln!(out)?;
    write_outcome(history, outcome, options, out)
}

/// Indices of the lines shown: evenly spread, the first and the last among them.
fn thinned(count: usize) -> Vec<usize> {
    match count {
        0..=LINES => (0..count).collect(),
        _ => (0..LINES).map(|k| (k * (count - 1) + (LINES - 1) / 2) / (LINES - 1)).collect(),
    }
}

fn write_outcome(history: &History, outcome: &Outcome, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (palette, s) = (options.palette, &outcome.statistics);
    let ending = match &outcome.because {
        None => {
            let met = outcome.condition.as_ref().map(|condition| format!(" {condition}, at")).unwrap_or_default();
            styled(palette.good, &format!("{}{met} {} s", outcome.ending, number(s.time)))
        }
        Some(because) => {
            let text = format!("{} at {} s of {} s: {because}", outcome.ending, number(s.time), number(outcome.duration));
            styled(palette.bad, &text)
        }
    };
    writeln!(out, "ending: {ending}")?;
    for limit in &outcome.limits {
        let unit = history.signals.iter().find(|s| s.name == limit.signal).map_or("", |s| &s.unit);
        let [value, threshold] = [limit.value, limit.threshold].map(|v| quantity(v, unit, options.angles));
        let text = format!("{}: `{}` is {value} at {} s, the limit {threshold}", limit.name, limit.signal, number(limit.time));
        writeln!(out, "limit met: {}", styled(palette.caution, &text))?;
    }
    for line in events(&outcome.crossings) {
        writeln!(out, "events: {}", styled(palette.caution, &line))?;
    }
    let method = match outcome.formulation == outcome.backend {
        true => outcome.backend.to_owned(),
        false => format!("{}, {} form", outcome.backend, outcome.formulation),
    };
    let products = if s.products > 0 { format!(", {} products", s.products) } else { String::new() };
    let rejected = s.rejected + s.convergence_failures;
    let counts = format!("{} steps, {rejected} rejected, {} residuals, {} Jacobians{products}", s.steps, s.residuals, s.jacobians);
    let tolerance = format!("relative tolerance {:e}", outcome.relative_tolerance);
    writeln!(out, "method: {method}, {tolerance}; {counts}, {} ms", number((outcome.wall * 1e4).round() / 10.0))?;
    let drifts = [("coordinates", &outcome.drift.position), ("velocities", &outcome.drift.velocity)];
    for (what, worst) in drifts {
        if let Some(worst) = worst {
            writeln!(out, "constraints on {what}: {}", drift(worst))?;
        }
    }
    Ok(())
}

/// One line per limit and signal: `wheel_lifted, front_tire.normal_force: from 1.203 to 1.871 s, from 2.01 s`.
fn events(crossings: &[Crossing]) -> Vec<String> {
    let mut lines: Vec<(&str, &str, Vec<String>)> = Vec::new();
    for crossing in crossings {
        let same = |line: &(&str, &str, Vec<String>)| line.0 == crossing.name && line.1 == crossing.signal;
        let at = lines.iter().position(same).unwrap_or_else(|| {
            lines.push((&crossing.name, &crossing.signal, Vec::new()));
            lines.len() - 1
        });
        let spans = &mut lines[at].2;
        match (crossing.violated, spans.last_mut()) {
            (false, Some(span)) if !span.contains(" to ") => span.push_str(&format!(" to {:.4}", crossing.time)),
            (false, _) => spans.push(format!("to {:.4}", crossing.time)),
            (true, _) => spans.push(format!("from {:.4}", crossing.time)),
        }
    }
    let told = |spans: &[String]| match spans.len() {
        0..=SPANS => spans.join(", "),
        all => format!("{}, … {all} times", spans[..SPANS].join(", ")),
    };
    lines.iter().map(|(name, signal, spans)| format!("{name} of `{signal}` {} s", told(spans))).collect()
}

/// `at most 1.2e-6 mm (closure along x, at 0.3 s)`.
fn drift(worst: &Worst) -> String {
    let shown = units::small(&worst.off.unit);
    format!("off by at most {:.1e} {} (`{}`, at {} s)", worst.off.by * shown.factor, shown.unit, worst.off.row, number(worst.time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_spread_over_all_samples() {
        assert_eq!(thinned(3), [0, 1, 2]);
        assert_eq!(thinned(25).len(), 25);
        for count in [26, 27, 49, 501, 1000] {
            let lines = thinned(count);
            assert_eq!((lines.len(), lines[0], lines[LINES - 1]), (LINES, 0, count - 1));
            assert!(lines.windows(2).all(|w| w[0] < w[1]), "{lines:?}");
        }
    }
}
