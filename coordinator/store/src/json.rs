//! Values as JSON text in a column.

use std::collections::BTreeMap;

use super::error::StoreError;

/// Encodes values as JSON. Every finite `f64` is read back to the bit.
pub(super) fn json<T: serde::Serialize + ?Sized>(values: &T) -> String {
    serde_json::to_string(values).expect("numbers have a JSON form")
}

/// Reads the numbers of a JSON array.
pub(super) fn numbers(json: &str) -> Result<Vec<f64>, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("parameter vector {json}: {e}")))
}

/// Reads a JSON object of texts by the names of their files.
pub(super) fn file_map(json: &str) -> Result<BTreeMap<String, String>, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("files: {e}")))
}
