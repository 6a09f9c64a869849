//! What a restart needs of an unfinished calibration.

use std::collections::BTreeMap;

use shared::api::CalibrationState;
use sqlx::Row;
use statistics::SubchainEnd;

use super::blob;
use super::error::StoreError;
use super::json::numbers;
use super::reader::Reader;
use record::{Stored, StoredEvaluation};

impl Reader {
    /// Ids of the calibrations that are not over, oldest first.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn unfinished(&self) -> Result<Vec<i64>, StoreError> {
        let ids = sqlx::query_scalar(
            "SELECT id FROM calibrations WHERE state NOT IN ('finished', 'failed', 'cancelled') ORDER BY id",
        )
        .fetch_all(&self.pool)
        .await?;
        Ok(ids)
    }

    /// Everything a replay needs; with `fitted`, also the models' values, which a fit is told and a metamodel
    /// learns from.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn stored(&self, calibration: i64, fitted: bool) -> Result<Stored, StoreError> {
        let row = sqlx::query("SELECT state, message, model_version, busy_ms FROM calibrations WHERE id = ?")
            .bind(calibration)
            .fetch_one(&self.pool)
            .await?;
        let evaluations = sqlx::query(
            "SELECT evaluation, theta, log_likelihood, rejection IS NOT NULL AS rejected,
             CASE WHEN ?2 THEN fitted END AS fitted, CASE WHEN ?2 THEN coarse END AS coarse, subchain
             FROM evaluations WHERE calibration = ?1",
        )
        .bind(calibration)
        .bind(fitted)
        .fetch_all(&self.pool)
        .await?;
        let evaluations: Result<BTreeMap<_, _>, StoreError> = evaluations
            .iter()
            .map(|row| {
                let number = row.get::<i64, _>("evaluation").unsigned_abs();
                let values = |column: &str| {
                    let bytes: Option<&[u8]> = row.get(column);
                    bytes.map(blob::decode_values).transpose()
                };
                let end: Option<&str> = row.get("subchain");
                let stored = StoredEvaluation {
                    theta: numbers(row.get("theta"))?,
                    log_likelihood: row.get("log_likelihood"),
                    rejected: row.get("rejected"),
                    fitted: values("fitted")?,
                    coarse: values("coarse")?,
                    end: end.map(subchain_end).transpose()?,
                };
                Ok((number, stored))
            })
            .collect();
        let faults = sqlx::query(
            "SELECT evaluation, attempt AS n, max(id) FROM faults WHERE calibration = ? GROUP BY evaluation",
        )
        .bind(calibration)
        .fetch_all(&self.pool)
        .await?;
        let failed = faults
            .iter()
            .map(|row| {
                (
                    row.get::<i64, _>("evaluation").unsigned_abs(),
                    row.get::<u32, _>("n"),
                )
            })
            .collect();
        let state: String = row.get("state");
        Ok(Stored {
            state: CalibrationState::from_name(&state),
            message: row.get("message"),
            model_version: row.get("model_version"),
            busy_ms: row.get::<i64, _>("busy_ms").unsigned_abs(),
            evaluations: evaluations?,
            failed,
        })
    }
}

fn subchain_end(json: &str) -> Result<SubchainEnd, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("subchain {json}: {e}")))
}
