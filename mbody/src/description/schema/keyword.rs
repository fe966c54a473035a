//! The keyword `quantity`: a text must be a number with a unit of one dimension, within the bounds that stand beside it.

use crate::description::expression::formula;
use crate::description::quantity::{Bounds, Dimension, QuantityError, parse_quantity};
use jsonschema::paths::Location;
use jsonschema::{Keyword, ValidationError};
use serde_json::{Map, Value};

struct QuantityKeyword {
    dimension: &'static Dimension,
    bounds: Bounds,
}

/// Prepares the keyword; `parent` is the schema in which it stands.
pub(super) fn compile<'a>(
    parent: &'a Map<String, Value>,
    unit: &'a Value,
    _: Location,
) -> Result<Box<dyn for<'i> Keyword<'i>>, ValidationError<'a>> {
    match unit.as_str().and_then(Dimension::of_unit) {
        Some(dimension) => Ok(Box::new(QuantityKeyword { dimension, bounds: Bounds::of_schema(parent) })),
        None => Err(ValidationError::schema(format!("no dimension is shown in {unit}"))),
    }
}

/// What is wrong with a text that stands for a quantity. Numbers are left to the standard keywords.
pub(super) fn judge_text(value: &Value, dimension: &'static Dimension, bounds: &Bounds) -> Option<QuantityError> {
    // a formula has a value only where the parameters have theirs
    let text = value.as_str().filter(|text| formula(text).is_none())?;
    match parse_quantity(text, dimension) {
        Ok(si) => bounds.violated_by(si, dimension).map(|bound| QuantityError::OutOfRange { text: text.trim().to_string(), bound }),
        Err(error) => Some(error),
    }
}

impl<'i> Keyword<'i> for QuantityKeyword {
    fn validate(&self, instance: &'i Value) -> Result<(), ValidationError<'i>> {
        match judge_text(instance, self.dimension, &self.bounds) {
            Some(error) => Err(ValidationError::custom(error.to_string())),
            None => Ok(()),
        }
    }

    fn is_valid(&self, instance: &'i Value) -> bool {
        judge_text(instance, self.dimension, &self.bounds).is_none()
    }
}
