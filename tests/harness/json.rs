//! Values in JSON documents.

use std::slice::Iter;

use serde_json::Value;

/// Returns the items of a list; none where the value is not a list.
pub fn items(value: &Value) -> Iter<'_, Value> {
    value.as_array().map(|list| list.iter()).unwrap_or_default()
}

/// Returns the number of items of a list.
#[track_caller]
pub fn item_count(value: &Value) -> usize {
    value
        .as_array()
        .unwrap_or_else(|| panic!("no list: {value}"))
        .len()
}

/// Returns a number.
#[track_caller]
pub fn float(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// Returns a whole number from 0.
#[track_caller]
pub fn whole(value: &Value) -> u64 {
    value
        .as_u64()
        .unwrap_or_else(|| panic!("no whole number: {value}"))
}

/// Returns a text; empty where the value is not a text.
pub fn word(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}
