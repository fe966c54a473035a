//! Findings as text, in color where that helps.

use crate::output::Palette;
use analyses::ExpressionError;
use analyses::trim::TrimError;
use mbody::description::finding::{Finding, Findings, Part, Severity};
use std::fmt::Write;

/// All findings, errors first where they stand first in the files; notes only where there is nothing worse.
pub fn findings(findings: &Findings, palette: Palette) -> String {
    let mut text = String::new();
    let worse = findings.iter().any(|f| f.severity != Severity::Note);
    for finding in findings.iter().filter(|f| !worse || f.severity != Severity::Note) {
        let written = finding.render(&mut |part, words| {
            let style = match part {
                Part::Severity(Severity::Error) => palette.bad,
                Part::Severity(_) => palette.caution,
                _ => anstyle::Style::new(),
            };
            write!(text, "{style}{words}{style:#}")
        });
        if written.is_ok() {
            text.push('\n');
        }
    }
    text.push_str(&findings.summary());
    text.push('\n');
    text
}

/// Why a trim has no unique answer, as a finding with advice.
pub fn trim(error: &TrimError) -> Finding {
    let (code, hint) = match error {
        TrimError::UnknownSignal { .. } | TrimError::Expression(ExpressionError::UnknownSignal { .. }) => {
            ("unknown_signal", Some("`fastbike info MODEL` lists the signals"))
        }
        TrimError::Expression(_) => ("bad_formula", Some("a formula is written like `0.4 * front_brake.torque`")),
        TrimError::OutputRole { .. } => ("wrong_role", Some("`--given SIGNAL=VALUE` makes it a condition")),
        TrimError::Tie { .. } => ("wrong_role", None),
        TrimError::Count { unknowns, equations, .. } if unknowns < equations => {
            ("contradictory", Some("leave something open with `--free SIGNAL`"))
        }
        TrimError::Count { .. } | TrimError::Undetermined { .. } => {
            ("undetermined", Some("give one of them with `--given SIGNAL=VALUE`, or leave less open"))
        }
        TrimError::Contradictory { .. } | TrimError::Conflict { .. } => {
            ("contradictory", Some("leave something open with `--free SIGNAL`, or give less"))
        }
        TrimError::NotFinite { .. } => ("not_finite", None),
    };
    let text = error.to_string();
    let message = text.strip_prefix(code).and_then(|t| t.strip_prefix(": ")).unwrap_or(&text);
    Finding::error(code, message).with_hint_from(hint.map(str::to_owned))
}
