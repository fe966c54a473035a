//! Numbers with units: `58 kN/m`, `24 deg`, `108km/h`, `80 %`. A bare number is SI, angles in radians.

mod bound;
pub mod dimension;
mod error;
pub(in crate::description) mod parse;
pub(in crate::description) mod unit;

pub use bound::{Any, AtLeastZero, Bounds, Fraction, Positive, Range};
pub use dimension::{Dimension, Dimensioned};
pub use error::QuantityError;
pub use unit::{ALL as UNITS, Unit};

use error::{shown, usual_mistake};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use serde_json::Value;
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::marker::PhantomData;

/// Name of the schema keyword that states the unit, and thereby the dimension, of an entry.
pub const KEYWORD: &str = "quantity";

/// Value in SI of a number with an optional unit, for instance from the command line.
///
/// # Errors
/// The text is no number, its unit is unknown, or it measures something else than `dimension`.
pub fn parse_quantity(text: &str, dimension: &'static Dimension) -> Result<f64, QuantityError> {
    let parsed = parse::parse(text)?;
    match parsed.unit {
        Some(found) if !dimension.accepts(found) => Err(QuantityError::WrongDimension {
            text: shown(text),
            found: dimension::describe(found),
            expected: dimension,
            hint: usual_mistake(found, dimension),
        }),
        _ => Ok(parsed.value),
    }
}

/// Value in SI of an entry that is a number or a text; `None` for anything else.
pub fn judge(value: &Value, dimension: &'static Dimension) -> Option<Result<f64, QuantityError>> {
    match value {
        Value::Number(n) => n.as_f64().map(Ok),
        Value::String(text) => Some(parse_quantity(text, dimension)),
        _ => None,
    }
}

/// A doubt about a number in radians: an angle of more than a turn was probably meant in degrees.
pub fn suspicion(value: &Value, dimension: &Dimension) -> Option<String> {
    let given = match value {
        Value::Number(n) => n.as_f64()?,
        Value::String(text) => parse::parse(text).ok().filter(|p| p.unit.is_none() || text.trim_end().ends_with("rad"))?.value,
        _ => return None,
    };
    let turns = given.abs() / TAU;
    (dimension.unit == "rad" && turns > 1.0).then(|| format!("{given} rad is {turns:.1} turns; did you mean `{given} deg`?"))
}

/// A quantity of one dimension within one range, kept in SI.
///
/// Reads a number (SI) or a text with a unit; writes a number. Its JSON Schema states the unit under [`KEYWORD`] and the bounds in SI
/// under the standard keywords; the schema check holds texts to both.
pub struct Quantity<D, R = Any>(f64, PhantomData<(D, R)>);

/// A quantity greater than zero.
pub type PositiveQuantity<D> = Quantity<D, Positive>;
/// A quantity that is not negative.
pub type NonNegativeQuantity<D> = Quantity<D, AtLeastZero>;

impl<D: Dimensioned, R: Range> Quantity<D, R> {
    /// A quantity of the given value in SI.
    ///
    /// # Errors
    /// The value is not finite or out of range.
    pub fn new(value: f64) -> Result<Self, QuantityError> {
        Self::checked(value, || value.to_string())
    }

    fn checked(value: f64, text: impl Fn() -> String) -> Result<Self, QuantityError> {
        if !value.is_finite() {
            return Err(QuantityError::NotFinite { text: text() });
        }
        match R::BOUNDS.violated_by(value, D::DIMENSION) {
            Some(bound) => Err(QuantityError::OutOfRange { text: text(), bound }),
            None => Ok(Self(value, PhantomData)),
        }
    }

    /// Value in SI.
    pub fn si(self) -> f64 {
        self.0
    }
}

impl<D, R> Clone for Quantity<D, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, R> Copy for Quantity<D, R> {}

impl<D, R> PartialEq for Quantity<D, R> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<D: Dimensioned, R> fmt::Debug for Quantity<D, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.0, D::DIMENSION.unit)
    }
}

impl<D: Dimensioned, R> fmt::Display for Quantity<D, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

impl<D, R> From<Quantity<D, R>> for f64 {
    fn from(quantity: Quantity<D, R>) -> Self {
        quantity.0
    }
}

impl<D, R> Serialize for Quantity<D, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<'de, D: Dimensioned, R: Range> Deserialize<'de> for Quantity<D, R> {
    fn deserialize<T: Deserializer<'de>>(deserializer: T) -> Result<Self, T::Error> {
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

struct Reader<D, R>(PhantomData<(D, R)>);

impl<D: Dimensioned, R: Range> de::Visitor<'_> for Reader<D, R> {
    type Value = Quantity<D, R>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", D::DIMENSION)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
        Quantity::new(value).map_err(E::custom)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
        let value = parse_quantity(text, D::DIMENSION).map_err(E::custom)?;
        Quantity::checked(value, || shown(text)).map_err(E::custom)
    }
}

impl<D: Dimensioned, R: Range> JsonSchema for Quantity<D, R> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Quantity in {}", D::DIMENSION.unit).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": ["number", "string"] });
        schema.insert(KEYWORD.to_string(), D::DIMENSION.unit.into());
        for (keyword, bound) in R::BOUNDS.keywords() {
            schema.insert(keyword.to_string(), bound.into());
        }
        schema
    }
}

#[cfg(test)]
mod tests;
