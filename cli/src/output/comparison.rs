//! Several methods on one problem: a line each, JSON, CSV.

use super::axes::Axes;
use super::number::number;
use super::palette::styled;
use super::{Kind, Options, Results, Writer, csv};
use serde_json::json;
use std::io;

/// A cell without entry.
pub const NONE: &str = "–";

/// One method at one tolerance.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the backend.
    pub backend: String,
    /// Form of the problem that it took.
    pub form: String,
    /// Where its matrices came from; [`NONE`] where there is nothing to choose.
    pub jacobian: &'static str,
    /// What solved its linear equations; [`NONE`] where there are none.
    pub linear_solver: &'static str,
    /// Relative tolerance; NaN where the method has none to choose.
    pub relative_tolerance: f64,
    /// Length of all steps, s; NaN where the method chooses it.
    pub step: f64,
    /// Name of the ending.
    pub ending: String,
    /// Why it did not reach its goal.
    pub because: Option<String>,
    /// Least wall time of the repeats, s.
    pub wall: f64,
    /// How much longer the slowest repeat took, as a share.
    pub spread: f64,
    /// Simulated time over wall time; NaN where nothing is simulated.
    pub real_time_factor: f64,
    /// Steps, or points of a sweep.
    pub steps: usize,
    /// Steps rejected, or points not reached.
    pub rejected: usize,
    /// Evaluations of the residual or of the rates.
    pub residuals: usize,
    /// Jacobian evaluations.
    pub jacobians: usize,
    /// Products of Jacobians with vectors, where no matrix was formed.
    pub products: usize,
    /// Linear solves.
    pub solves: usize,
    /// Largest difference to the reference, in units of nominal values; NaN where there is none to compare with.
    pub error: f64,
    /// Largest change of the energy as a share, where nothing supplies or dissipates any; NaN elsewhere.
    pub energy_drift: f64,
    /// Largest error of a constraint on coordinates, SI; NaN without constraints.
    pub constraint_drift: f64,
}

/// A comparison.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Name of the model.
    pub model: String,
    /// What was computed, in words.
    pub problem: String,
    /// What the errors refer to, in words.
    pub reference: String,
    /// Whether steps are time steps, not points of a sweep.
    pub in_time: bool,
    /// The rows.
    pub rows: Vec<Row>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

impl Results for Comparison {
    /// Nothing in it has a direction.
    fn in_axes(self, _: Axes) -> Self {
        self
    }
    fn writer(kind: &Kind) -> Writer<Self> {
        kind.write_comparison
    }
    fn warnings(&self) -> &[String] {
        &self.warnings
    }
    fn statistics(&self) -> serde_json::Value {
        json!({ "rows": self.rows.len() })
    }
    fn reached(&self) -> bool {
        self.rows.iter().any(|r| r.because.is_none())
    }
}

/// A cell of a number that may not be there.
fn cell(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$e}") } else { NONE.to_owned() }
}

/// One line per row, causes of failures below.
pub(super) fn write_table(comparison: &Comparison, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    writeln!(out, "{}", styled(palette.heading, &format!("compare {}: {}", comparison.model, comparison.problem)))?;
    writeln!(out, "{}", styled(palette.faint, &format!("error: largest difference to {}, in nominal values", comparison.reference)))?;
    let (steps, rejected) = if comparison.in_time { ("steps", "rejected") } else { ("points", "missed") };
    let titles = [
        "backend",
        "form",
        "Jacobian",
        "linear solver",
        "rtol",
        "step ms",
        "wall ms",
        "spread",
        "× real",
        steps,
        rejected,
        "residuals",
        "Jacobians",
        "products",
        "solves",
        "error",
        "energy",
        "constraints",
    ];
    let rows: Vec<[String; 18]> = comparison
        .rows
        .iter()
        .map(|r| {
            [
                r.backend.clone(),
                r.form.clone(),
                r.jacobian.to_owned(),
                r.linear_solver.to_owned(),
                cell(r.relative_tolerance, 0),
                if r.step.is_finite() { number(1e3 * r.step) } else { NONE.to_owned() },
                number(1e3 * r.wall),
                format!("{:.0} %", 100.0 * r.spread),
                if r.real_time_factor.is_finite() { format!("{:.0}", r.real_time_factor) } else { NONE.to_owned() },
                r.steps.to_string(),
                r.rejected.to_string(),
                r.residuals.to_string(),
                r.jacobians.to_string(),
                if r.products > 0 { r.products.to_string() } else { NONE.to_owned() },
                r.solves.to_string(),
                cell(r.error, 1),
                cell(r.energy_drift, 1),
                cell(r.constraint_drift, 1),
            ]
        })
        .collect();
    // columns without any entry are left out
    let kept: Vec<usize> = (0..titles.len()).filter(|&c| c < 2 || rows.iter().any(|r| r[c] != NONE)).collect();
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).chain([titles[c].chars().count()]).max().unwrap_or(0);
    let line = |cells: &dyn Fn(usize) -> String| {
        let texts = kept.iter().map(|&c| match c {
            0..=3 => format!("{:<width$}", cells(c), width = width(c)),
            _ => format!("{:>width$}", cells(c), width = width(c)),
        });
        texts.collect::<Vec<_>>().join("  ")
    };
    writeln!(out, "\n{}", styled(palette.heading, &line(&|c| titles[c].to_owned())))?;
    for (row, cells) in comparison.rows.iter().zip(&rows) {
        let text = line(&|c| cells[c].clone());
        match &row.because {
            None => writeln!(out, "{text}")?,
            Some(because) => writeln!(out, "{text}\n  {}", styled(palette.bad, &format!("{}: {because}", row.ending)))?,
        }
    }
    Ok(())
}

/// One object, see the command line contract.
pub(super) fn write_json(comparison: &Comparison, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let rows: Vec<serde_json::Value> = comparison
        .rows
        .iter()
        .map(|r| {
            json!({
                "backend": r.backend, "form": r.form, "jacobian": r.jacobian, "linear_solver": r.linear_solver, "rtol": r.relative_tolerance, "step_s": r.step, "ending": r.ending, "because": r.because,
                "wall_s": r.wall, "spread": r.spread, "real_time_factor": r.real_time_factor, "steps": r.steps, "rejected": r.rejected,
                "residuals": r.residuals, "jacobians": r.jacobians, "products": r.products, "linear_solves": r.solves, "error": r.error,
                "energy_drift": r.energy_drift, "constraint_drift": r.constraint_drift,
            })
        })
        .collect();
    let object = json!({
        "fastbike": env!("CARGO_PKG_VERSION"), "command": "compare", "model": comparison.model, "problem": comparison.problem,
        "reference": comparison.reference, "rows": rows, "warnings": comparison.warnings,
    });
    serde_json::to_writer_pretty(&mut *out, &object)?;
    writeln!(out)
}

/// One line per row.
pub(super) fn write_csv(comparison: &Comparison, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    table.write_record([
        "backend",
        "form",
        "jacobian",
        "linear_solver",
        "rtol",
        "step_s",
        "ending",
        "wall_s",
        "spread",
        "real_time_factor",
        "steps",
        "rejected",
        "residuals",
        "jacobians",
        "products",
        "linear_solves",
        "error",
        "energy_drift",
        "constraint_drift",
    ])?;
    for r in &comparison.rows {
        let care = [r.relative_tolerance, r.step].map(csv::cell);
        let words = [r.backend.clone(), r.form.clone(), r.jacobian.to_owned(), r.linear_solver.to_owned()]
            .into_iter()
            .chain(care)
            .chain([r.ending.clone()]);
        let numbers = [r.wall, r.spread, r.real_time_factor].map(csv::cell);
        let counts = [r.steps, r.rejected, r.residuals, r.jacobians, r.products, r.solves].map(|n| n.to_string());
        let errors = [r.error, r.energy_drift, r.constraint_drift].map(csv::cell);
        table.write_record(words.chain(numbers).chain(counts).chain(errors))?;
    }
    table.flush()
}
