//! The written station: text as typed, read into values that know their units and their place in the file.
//!
//! Nothing here opens a path: text is handed down by a [`Library`]. Whatever is wrong is reported as [`finding::Findings`], several at
//! once, each with file, line and path.

pub mod document;
pub mod finding;
mod nearest;
pub mod quantity;
pub mod schema;
pub mod urdf;

use std::borrow::Cow;

/// Where descriptions, tables and included files come from, by name.
///
/// The command line implements it over bundled files and the disk; tests over a map.
pub trait Library {
    /// The text called `name`, or `None` where there is no such text.
    fn text(&self, name: &str) -> Option<Cow<'_, str>>;
}

/// A library of one text under any name: what was never a file.
#[derive(Clone, Copy, Debug)]
pub struct OneText<'a>(pub &'a str);

impl Library for OneText<'_> {
    fn text(&self, _: &str) -> Option<Cow<'_, str>> {
        Some(Cow::Borrowed(self.0))
    }
}
