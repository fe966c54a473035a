//! A level road.

use super::{Relief, ReliefDescription};
use mbody::description::Library;
use mbody::description::finding::Findings;
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// A level road.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Flat {}

impl ReliefDescription for Flat {
    const KIND: &'static str = "flat";
    const ABOUT: &'static str = "a level road";
    const EXAMPLE: &'static str = "{}";
    fn relief(self, _: &dyn Library) -> Result<Option<Arc<dyn Relief>>, Findings> {
        Ok(None)
    }
}
