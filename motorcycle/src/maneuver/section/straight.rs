//! Straight on.

use super::{Layout, SectionDescription};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::description::quantity::{NonNegativeQuantity, dimension::Length};
use schemars::JsonSchema;
use serde::Deserialize;

/// Straight on.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Straight {
    /// Length of the section.
    length: NonNegativeQuantity<Length>,
}

impl SectionDescription for Straight {
    const KIND: &'static str = "straight";
    const ABOUT: &'static str = "straight on";
    const EXAMPLE: &'static str = "{ length: 50 m }";
    fn lay(self, path: &mut Layout, _: &dyn Library) -> Result<(), Findings> {
        path.straight(self.length.si());
        Ok(())
    }
}
