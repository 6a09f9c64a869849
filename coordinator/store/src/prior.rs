//! Queries for the draws from the prior and for failed leases.

use std::collections::BTreeMap;

use super::blob;
use super::checksum::EVALUATIONS;
use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Row, query, query_scalar};
use super::theta::theta;
use record::{Dispute, PriorDraw, RejectionReason};

impl Reader {
    /// Reads the draws of a sampler's first round, which are draws from the prior.
    ///
    /// # Arguments
    /// - `count`: the number of draws.
    pub async fn prior_draws(&self, calibration: i64, count: usize) -> Result<Vec<PriorDraw>, StoreError> {
        let rows = query(
            "SELECT e.*,
               (SELECT count(*) FROM faults f
                WHERE f.calibration = e.calibration AND f.evaluation = e.evaluation AND f.attempt > 0) AS faults
             FROM evaluations e WHERE e.calibration = ? AND e.evaluation < ? ORDER BY e.evaluation",
        )
        .bind(calibration)
        .bind(count as i64)
        .fetch_all(&self.pool)
        .await?;
        rows.iter()
            .map(|row| {
                EVALUATIONS.verify(row)?;
                Ok(PriorDraw {
                    theta: theta(row)?,
                    result: match row.get::<Option<String>>("rejection") {
                        Some(reason) => Err(RejectionReason(reason)),
                        None => Ok(blob::decode_values(row.get("fitted"))?),
                    },
                    faults: row.get::<i64>("faults").unsigned_abs(),
                })
            })
            .collect()
    }

    /// Reads how often leases failed, by message.
    pub async fn faults(&self, calibration: i64) -> Result<BTreeMap<String, u64>, StoreError> {
        let rows = query(
            "SELECT message, count(*) AS n FROM faults WHERE calibration = ? AND attempt > 0 GROUP BY message",
        )
        .bind(calibration)
        .fetch_all(&self.pool)
        .await?;
        Ok(rows
            .iter()
            .map(|row| (row.get("message"), row.get::<i64>("n").unsigned_abs()))
            .collect())
    }

    /// Reads the number of evaluations that were given up after faults.
    pub async fn given_up(&self, calibration: i64) -> Result<u64, StoreError> {
        let count: i64 =
            query_scalar("SELECT count(*) FROM evaluations WHERE calibration = ? AND worker = ''")
                .bind(calibration)
                .fetch_one(&self.pool)
                .await?;
        Ok(count.unsigned_abs())
    }

    /// Reads the evaluations that have two different answers, in order. A store of before migration 12 has none.
    pub async fn disputes(&self, calibration: i64) -> Result<Vec<Dispute>, StoreError> {
        if !self.has_table("disputes").await? {
            return Ok(Vec::new());
        }
        let rows = query(
            "SELECT evaluation, first, second FROM disputes WHERE calibration = ? ORDER BY evaluation, second",
        )
        .bind(calibration)
        .fetch_all(&self.pool)
        .await?;
        let dispute = |row: &Row| Dispute {
            evaluation: row.get::<i64>("evaluation").unsigned_abs(),
            first: row.get("first"),
            second: row.get("second"),
        };
        Ok(rows.iter().map(dispute).collect())
    }
}
