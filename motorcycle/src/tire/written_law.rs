//! Laws from outside: a crate adds its friction law to the written forms of the tire.
//!
//! `TireWith<Extended<MyParameters>>` is the tire with one more entry under `law`; registered under the same name it takes the place of
//! the standard one (`Kinds::with`). Several laws nest: `Extended<B, Extended<A>>`. See ADR 29; `tests/external_element` is a crate that does it.

use super::invalid::InvalidTireData;
use super::law::{AnyTireLaw, TireLaw};
use super::law_description::{LawDescription, NamedLaw, Place};
use mbody::description::Library;
use mbody::description::finding::{Finding, Findings};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};
use std::borrow::Cow;

/// What may stand under `law` of a tire.
pub trait WrittenLaw: DeserializeOwned + JsonSchema {
    /// The law at a place. Findings without a file are about an entry of the tire: `law`.
    ///
    /// # Errors
    /// `None` where there are errors among the findings.
    fn named(self, place: &Place, library: &dyn Library, findings: &mut Findings) -> Option<NamedLaw>;
}

impl WrittenLaw for LawDescription {
    fn named(self, place: &Place, library: &dyn Library, findings: &mut Findings) -> Option<NamedLaw> {
        self.law(place, library, findings)
    }
}

/// Parameters of a friction law of another crate.
pub trait LawParameters: DeserializeOwned + JsonSchema {
    /// Name of the entry.
    const KIND: &'static str;
    /// One sentence.
    const ABOUT: &'static str;
    /// The law.
    type Law: TireLaw;
    /// The law with these parameters.
    ///
    /// # Errors
    /// Parameters that are no tire.
    fn law(self) -> Result<Self::Law, InvalidTireData>;
}

/// The laws of `Base`, and that of the parameters `P`.
#[derive(Debug)]
pub enum Extended<P, Base = LawDescription> {
    /// The law that was added.
    Added(P),
    /// One of those that were there.
    Base(Base),
}

impl<'de, P: LawParameters, Base: WrittenLaw> Deserialize<'de> for Extended<P, Base> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut value = Value::deserialize(deserializer)?;
        let added = value.as_object_mut().filter(|o| o.len() == 1).and_then(|o| o.get_mut(P::KIND)).map(Value::take);
        match added {
            Some(parameters) => serde_json::from_value(parameters).map(Self::Added).map_err(D::Error::custom),
            None => serde_json::from_value(value).map(Self::Base).map_err(D::Error::custom),
        }
    }
}

impl<P: LawParameters, Base: WrittenLaw> JsonSchema for Extended<P, Base> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}With{}", Base::schema_name(), P::schema_name()).into()
    }

    /// One more choice beside those of the base.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Base::json_schema(generator);
        let parameters = generator.subschema_for::<P>();
        let entry = json!({
            "type": "object", "description": P::ABOUT, "properties": { P::KIND: parameters }, "required": [P::KIND],
            "additionalProperties": false
        });
        if let Some(choices) = schema.get_mut("oneOf").and_then(Value::as_array_mut) {
            choices.push(entry);
        }
        schema
    }
}

impl<P: LawParameters, Base: WrittenLaw> WrittenLaw for Extended<P, Base> {
    fn named(self, place: &Place, library: &dyn Library, findings: &mut Findings) -> Option<NamedLaw> {
        let parameters = match self {
            Self::Base(base) => return base.named(place, library, findings),
            Self::Added(parameters) => parameters,
        };
        match parameters.law() {
            Ok(law) => Some(NamedLaw { law: AnyTireLaw::new(law), kind: P::KIND, file: None }),
            Err(error) => {
                findings.push(Finding::error("invalid_tire_data", error.to_string()).at_path("law"));
                None
            }
        }
    }
}
