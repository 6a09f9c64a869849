//! The shapes that keys have.

use serde_json::{Map, Value, json};

/// A shape under the words that an editor shows.
pub(super) fn said(mut shape: Value, words: &str) -> Value {
    if let Some(shape) = shape.as_object_mut() {
        shape.insert("description".to_owned(), json!(words));
    }
    shape
}

/// A shape with the value that holds where the key is absent.
pub(super) fn usual(mut shape: Value, value: impl serde::Serialize) -> Value {
    if let Some(shape) = shape.as_object_mut() {
        shape.insert("default".to_owned(), json!(value));
    }
    shape
}

pub(super) fn text(words: &str) -> Value {
    said(json!({ "type": "string" }), words)
}

pub(super) fn flag(words: &str) -> Value {
    said(json!({ "type": "boolean" }), words)
}

/// A number within bounds; infinite ones are none.
pub(super) fn number(words: &str, lower: f64, upper: f64) -> Value {
    let mut shape = json!({ "type": "number" });
    for (key, bound) in [("minimum", lower), ("maximum", upper)] {
        if bound.is_finite() {
            shape[key] = json!(bound);
        }
    }
    said(shape, words)
}

pub(super) fn above(words: &str, bound: f64) -> Value {
    said(json!({ "type": "number", "exclusiveMinimum": bound }), words)
}

pub(super) fn whole(words: &str, least: u64, most: Option<u64>) -> Value {
    let mut shape = json!({ "type": "integer", "minimum": least });
    if let Some(most) = most {
        shape["maximum"] = json!(most);
    }
    said(shape, words)
}

/// One of several words.
pub(super) fn one_of<'a>(words: &str, known: impl IntoIterator<Item = &'a str>) -> Value {
    let known: Vec<&str> = known.into_iter().collect();
    said(json!({ "type": "string", "enum": known }), words)
}

/// One of several shapes.
pub(super) fn either(words: &str, shapes: Vec<Value>) -> Value {
    said(json!({ "anyOf": shapes }), words)
}

pub(super) fn list(words: &str, of: Value) -> Value {
    said(
        json!({ "type": "array", "items": of, "uniqueItems": true }),
        words,
    )
}

/// Two numbers.
pub(super) fn pair(words: &str) -> Value {
    let shape = json!({
        "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2
    });
    said(shape, words)
}

/// A table with these keys and no other.
pub(super) fn table<K: Into<String>>(words: &str, keys: impl IntoIterator<Item = (K, Value)>) -> Value {
    let keys: Map<String, Value> = keys.into_iter().map(|(key, shape)| (key.into(), shape)).collect();
    let shape = json!({ "type": "object", "properties": keys, "additionalProperties": false });
    said(shape, words)
}

/// A table whose keys are names of the user's choice.
pub(super) fn named(words: &str, of: Value) -> Value {
    said(json!({ "type": "object", "additionalProperties": of }), words)
}

/// A table that lacks none of these keys.
pub(super) fn needing(mut table: Value, keys: &[&str]) -> Value {
    table["required"] = json!(keys);
    table
}
