//! The written station: text as typed, read into values that know their units and their place in the file.
//!
//! Nothing here opens a path: text is handed down by a [`Library`]. Whatever is wrong is reported as [`finding::Findings`], several at
//! once, each with file, line and path.

pub(crate) mod composition;
pub mod document;
pub mod expression;
pub mod finding;
mod nearest;
pub mod parameter;
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

    /// The name by which [`Library::text`] knows what a text called `within` calls `name`: names are relative to the text in which they stand.
    fn resolve(&self, name: &str, within: &str) -> String {
        beside(within, name)
    }
}

/// The path of `name` as seen from the folder of the text `within`, without detours: `name` of `parts/a.yaml` is `parts/name`.
pub fn beside(within: &str, name: &str) -> String {
    if name.starts_with('/') {
        return name.to_owned();
    }
    let folder = within.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut steps: Vec<&str> = Vec::new();
    for step in folder.split('/').filter(|_| !folder.is_empty()).chain(name.split('/')) {
        match (step, steps.last()) {
            (".", _) => {}
            ("..", Some(last)) if !matches!(*last, ".." | "") => drop(steps.pop()),
            _ => steps.push(step),
        }
    }
    steps.join("/")
}

/// A library as seen from one of its texts: names are those that stand in it.
pub struct SeenFrom<'a> {
    /// The library.
    pub library: &'a dyn Library,
    /// Name of the text.
    pub within: String,
}

impl Library for SeenFrom<'_> {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        self.library.text(&self.library.resolve(name, &self.within))
    }

    fn resolve(&self, name: &str, within: &str) -> String {
        self.library.resolve(name, within)
    }
}

/// A library of one text under any name: what was never a file.
#[derive(Clone, Copy, Debug)]
pub struct OneText<'a>(pub &'a str);

impl Library for OneText<'_> {
    fn text(&self, _: &str) -> Option<Cow<'_, str>> {
        Some(Cow::Borrowed(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::beside;

    #[test]
    fn names_are_relative_to_the_text_in_which_they_stand() {
        for (within, name, found) in [
            ("model.yaml", "tree.urdf", "tree.urdf"),
            ("parts/front.yaml", "front.urdf", "parts/front.urdf"),
            ("vehicles/a/a.yaml", "../../parts/./front.yaml", "parts/front.yaml"),
            ("a.yaml", "../b.yaml", "../b.yaml"),
            ("../x/a.yaml", "../b.yaml", "../b.yaml"),
            ("/x/a.yaml", "b.yaml", "/x/b.yaml"),
            ("x/a.yaml", "/b.yaml", "/b.yaml"),
        ] {
            assert_eq!(beside(within, name), found, "{name} in {within}");
        }
    }
}
