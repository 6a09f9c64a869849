//! Parameter vectors in a column: little-endian `f64`; JSON text in rows of before migration 9.

use sqlx::{Row as _, TypeInfo, ValueRef};

use super::blob;
use super::error::StoreError;
use super::json::numbers;
use super::sql::Row;

/// Returns the parameter vector of a row, from its column `theta`.
pub(super) fn theta(row: &Row) -> Result<Vec<f64>, StoreError> {
    if let Row::Sqlite(row) = row
        && row.try_get_raw("theta")?.type_info().name() == "TEXT"
    {
        return numbers(row.try_get("theta")?);
    }
    blob::decode_values(row.try_get("theta")?)
}
