//! Colors of human output, and when there are none.

use anstyle::{AnsiColor, Style};
use std::ffi::OsStr;
use std::io::IsTerminal;

/// Styles by meaning; the default has no color at all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Palette {
    /// Titles and column names.
    pub heading: Style,
    /// Units, descriptions, signs.
    pub faint: Style,
    /// A goal that was reached.
    pub good: Style,
    /// A physical limit.
    pub caution: Style,
    /// A failure.
    pub bad: Style,
}

impl Palette {
    /// No color.
    pub fn plain() -> Self {
        Self::default()
    }

    /// The colors of a terminal.
    pub fn colored() -> Self {
        Self {
            heading: Style::new().bold(),
            faint: Style::new().dimmed(),
            good: AnsiColor::Green.on_default(),
            caution: AnsiColor::Yellow.on_default(),
            bad: AnsiColor::Red.on_default(),
        }
    }

    /// The palette for standard output: colored on a terminal, unless `NO_COLOR` is set and not empty (<https://no-color.org>).
    pub fn for_stdout() -> Self {
        Self::choose(std::io::stdout().is_terminal(), std::env::var_os("NO_COLOR").as_deref())
    }

    /// The palette for standard error, by the same rule.
    pub fn for_stderr() -> Self {
        Self::choose(std::io::stderr().is_terminal(), std::env::var_os("NO_COLOR").as_deref())
    }

    fn choose(terminal: bool, no_color: Option<&OsStr>) -> Self {
        if terminal && no_color.is_none_or(OsStr::is_empty) { Self::colored() } else { Self::plain() }
    }
}

/// `text` in `style`.
pub(super) fn styled(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn color_needs_a_terminal_and_no_objection() {
        assert_eq!(Palette::choose(true, None), Palette::colored());
        assert_eq!(Palette::choose(true, Some(OsStr::new(""))), Palette::colored());
        assert_eq!(Palette::choose(true, Some(OsStr::new("1"))), Palette::plain());
        assert_eq!(Palette::choose(false, None), Palette::plain());
    }

    #[test]
    fn plain_text_has_no_escape_codes() {
        assert_eq!(styled(Palette::plain().bad, "x"), "x");
        assert_eq!(styled(Palette::colored().bad, "x"), "\u{1b}[31mx\u{1b}[0m");
    }
}
