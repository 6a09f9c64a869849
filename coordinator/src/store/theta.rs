//! Parameter vectors in a column: little-endian `f64`; JSON text in what was stored before migration 9.

use sqlx::sqlite::SqliteRow;
use sqlx::{Row, TypeInfo, ValueRef};

use super::blob;
use super::error::StoreError;
use super::json::numbers;

/// The parameter vector of a row, from its column `theta`.
pub(super) fn theta(row: &SqliteRow) -> Result<Vec<f64>, StoreError> {
    let value = row.try_get_raw("theta")?;
    if value.type_info().name() == "TEXT" {
        return numbers(row.try_get("theta")?);
    }
    blob::decode_values(row.try_get("theta")?)
}
