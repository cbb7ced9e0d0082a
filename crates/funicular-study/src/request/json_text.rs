//! JSON of requests, in which no key of an object is there twice.

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use std::fmt;

/// Value of a text in JSON.
///
/// # Errors
/// A text that is not JSON, or a key that is there twice: `serde_json` alone would take the last one.
pub(super) fn value(text: &[u8]) -> serde_json::Result<Value> {
    let mut source = serde_json::Deserializer::from_slice(text);
    let value = Unique.deserialize(&mut source)?;
    source.end()?;
    Ok(value)
}

/// Reader of a value whose keys are unique.
struct Unique;

impl<'de> DeserializeSeed<'de> for Unique {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<Value, D::Error> {
        source.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Unique {
    type Value = Value;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("a number is not finite"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut all = Vec::new();
        while let Some(item) = items.next_element_seed(Self)? {
            all.push(item);
        }
        Ok(all.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut all = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if all.contains_key(&key) {
                return Err(A::Error::custom(format_args!(
                    "the key `{}` is there twice: keep one of them",
                    shown(&key)
                )));
            }
            let value = entries.next_value_seed(Self)?;
            all.insert(key, value);
        }
        Ok(all.into())
    }
}

/// First letters of a key, without control characters.
fn shown(key: &str) -> String {
    key.chars().filter(|c| !c.is_control()).take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_that_of_serde_json() {
        for text in [
            "null",
            " [1, -2, 1e300, 0.1, 18446744073709551615, \"a\\u00e9\", true, {}] ",
            "{\"a\": {\"b\": [null, {\"a\": 1}]}, \"b\": false}",
        ] {
            let expected: Value = serde_json::from_str(text).unwrap();
            assert_eq!(value(text.as_bytes()).unwrap(), expected);
        }
        for text in ["", "{", "{} x", "[1,]", "1e999", "nul"] {
            assert!(value(text.as_bytes()).is_err() && serde_json::from_str::<Value>(text).is_err(), "{text}");
        }
        // Deep nesting is refused as by `serde_json`, and does not end the process.
        assert!(value("[".repeat(100_000).as_bytes()).unwrap_err().to_string().contains("recursion limit"));
    }

    #[test]
    fn a_key_that_is_there_twice_is_refused_at_any_depth() {
        for text in ["{\"pose\": 1, \"pose\": 2}", "{\"a\": [{\"pose\": null, \"b\": 2, \"pose\": null}]}"] {
            let said = value(text.as_bytes()).unwrap_err().to_string();
            assert!(said.starts_with("the key `pose` is there twice") && said.contains("line 1 column"), "{said}");
        }
    }
}
