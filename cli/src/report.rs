//! Findings as text, in color where that helps.

use crate::output::Palette;
use mbody::description::finding::{Findings, Part, Severity};
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
