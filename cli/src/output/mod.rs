//! What a command prints: one report, several formats.
//!
//! | format | for | units | angles |
//! |---|---|---|---|
//! | `table` | reading | stated beside every value | deg |
//! | `json` | programs, see the command line contract | SI, stated in `units` | rad |
//! | `csv` | spreadsheets and data frames | SI | rad |

mod axes;
pub mod comfort;
pub mod comparison;
mod csv;
pub mod handling;
mod history;
mod json;
pub mod linear;
mod mat;
pub mod modes;
mod npz;
pub mod number;
mod palette;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
mod progress;
mod report;
pub mod responses;
pub mod rider;
#[cfg(test)]
mod sample;
pub mod setup;
mod table;
pub mod tire;
mod units;
mod versus;

pub use axes::Axes;
pub use history::{History, Kept, Outcome, Recording, Tape, unreadable};
pub use palette::Palette;
pub use progress::Progress;
pub use report::{Beside, Given, Point, Report, Variant};
pub use units::{Angles, Shown, small};

use std::io;

/// A format of standard output.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Name after `--format`.
    pub name: &'static str,
    /// One sentence for the help.
    pub about: &'static str,
    /// Writes a report.
    pub write: Writer<Report>,
    /// Writes a motion over time.
    pub write_history: Writer<History>,
    /// Writes a comparison of methods.
    pub write_comparison: Writer<comparison::Comparison>,
    /// Writes the curves of a tire.
    pub write_tire: Writer<tire::TireCurves>,
    /// Writes the setup of a vehicle.
    pub write_setup: Writer<setup::SetupReport>,
}

/// Writes a result in one format.
pub type Writer<R> = fn(&R, &Options, &mut dyn io::Write) -> io::Result<()>;

/// What a command found out, before it becomes text.
pub trait Results: Sized {
    /// The same with all values referred to `axes`.
    #[must_use]
    fn in_axes(self, axes: Axes) -> Self;
    /// What a format writes it with.
    fn writer(kind: &Kind) -> Writer<Self>;
    /// What the reader should know beside the results.
    fn warnings(&self) -> &[String];
    /// The recording, where it is one.
    fn recording(&self) -> Option<&History> {
        None
    }
    /// How much work it was, for the run folder.
    fn statistics(&self) -> serde_json::Value;
    /// Whether the goal was reached; of several points, one is enough.
    fn reached(&self) -> bool;
}

/// The formats; the first is the default.
pub const KINDS: &[Kind] = &[table::KIND, json::KIND, csv::KIND];

/// The format with this name.
pub fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// How a report is presented to a reader; formats for programs ignore it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Colors.
    pub palette: Palette,
    /// Unit of angles.
    pub angles: Angles,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_writes_every_report() {
        for kind in KINDS {
            assert_eq!(super::kind(kind.name).map(|k| k.about), Some(kind.about));
            for report in [sample::corner(), sample::sweep(), sample::nothing()] {
                let mut text = Vec::new();
                (kind.write)(&report, &Options::default(), &mut text).expect("memory takes everything");
                let text = String::from_utf8(text).expect("text");
                assert!(text.ends_with('\n') && !text.contains("NaN"), "{}: {text}", kind.name);
            }
        }
        assert!(super::kind("xml").is_none());
    }
}
