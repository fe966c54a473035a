//! Quantities that can be read but probably do not mean what they say.

use super::Mistake;
use super::message::dimension_of;
use super::walk::walk;
use crate::description::document::About;
use crate::description::finding::Finding;
use crate::description::quantity::suspicion;
use serde_json::Value;

/// Every doubt about a value, each once.
pub(super) fn doubts(root: &Value, value: &Value) -> Vec<Mistake> {
    let mut found: Vec<Mistake> = Vec::new();
    walk(root, value, &mut |met| {
        let doubt = dimension_of(met.schema).and_then(|dimension| suspicion(met.value, dimension));
        let Some(doubt) = doubt else { return true };
        if !found.iter().any(|m| m.pointer == met.pointer) {
            found.push(Mistake::at(met.pointer, About::Value, Finding::warning("suspicious_unit", doubt)));
        }
        false
    });
    found
}
