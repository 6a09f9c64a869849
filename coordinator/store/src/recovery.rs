//! Queries for the rows that a restart needs to resume a calibration.

use std::collections::BTreeMap;

use shared::api::CalibrationState;

use super::blob;
use super::checksum::EVALUATIONS;
use super::error::StoreError;
use super::observables;
use super::reader::Reader;
use super::sql::{Row, query, query_scalar};
use super::theta::theta;
use record::{EvaluationRow, Fingerprint, Kept, PREDICTIONS_FROM, SealKey, Stored};

/// The number of evaluations that one statement reads. A long calibration has hundreds of thousands.
const PAGE: usize = 2_000;

impl Reader {
    /// Reads the ids of the calibrations that are not over, oldest first.
    pub async fn unfinished(&self) -> Result<Vec<i64>, StoreError> {
        let ids = query_scalar(
            "SELECT id FROM calibrations WHERE state NOT IN ('finished', 'failed', 'cancelled') ORDER BY id",
        )
        .fetch_all(&self.pool)
        .await?;
        Ok(ids)
    }

    /// Reads the key that seals the leases of a calibration.
    ///
    /// # Errors
    /// [`StoreError`]; [`StoreError::Corrupt`] where the key does not have 16 bytes.
    pub async fn seal_key(&self, calibration: i64) -> Result<SealKey, StoreError> {
        let key: Option<Vec<u8>> = query_scalar("SELECT seal_key FROM calibrations WHERE id = ?")
            .bind(calibration)
            .fetch_one(&self.pool)
            .await?;
        let bytes = key.and_then(|key| key.try_into().ok());
        let corrupt = || {
            StoreError::Corrupt(format!(
                "the seal key of calibration {calibration} is not 16 bytes"
            ))
        };
        bytes.map(SealKey).ok_or_else(corrupt)
    }

    /// Reads everything that a replay needs. With `fitted`, this includes the predicted values that an engine is told, and the whole
    /// results of draws that may be the posterior as they are.
    pub async fn stored(&self, calibration: i64, fitted: bool) -> Result<Stored, StoreError> {
        // All statements see one state of the store, because results may be dropped meanwhile.
        let mut view = self.pool.view().await?;
        let row = query(
            "SELECT state, message, model_version, busy_ms,
             EXISTS (SELECT 1 FROM rewinds WHERE calibration = ?1 AND results > 0) AS is_rewound,
             EXISTS (SELECT 1 FROM rewinds WHERE calibration = ?1) AS is_doubted
             FROM calibrations WHERE id = ?1",
        )
        .bind(calibration)
        .fetch_one(&mut view)
        .await?;
        let (mut evaluations, mut confirmed) = (BTreeMap::new(), BTreeMap::new());
        loop {
            let after = evaluations
                .last_key_value()
                .map_or(-1, |(&number, _)| number as i64);
            let rows = query(
                "SELECT * FROM evaluations WHERE calibration = ?1 AND evaluation > ?2 ORDER BY evaluation LIMIT ?3",
            )
            .bind(calibration)
            .bind(after)
            .bind(PAGE as i64)
            .fetch_all(&mut view)
            .await?;
            for row in &rows {
                let number = row.try_get::<i64>("evaluation")?.unsigned_abs();
                let named = |error: StoreError| {
                    error.within(&format!("calibration {calibration}, evaluation {number}"))
                };
                evaluations.insert(number, evaluation_row(number, row, fitted).map_err(named)?);
                // Before migration 18, a mark without a name stood for what cannot be compared.
                let confirmed_by: Option<String> = row.try_get("confirmed_by")?;
                if let Some(worker) = confirmed_by.filter(|worker| !worker.is_empty()) {
                    confirmed.insert(number, worker);
                }
            }
            if rows.len() < PAGE {
                break;
            }
        }
        let faults =
            query("SELECT evaluation, attempt, worker FROM faults WHERE calibration = ? ORDER BY id")
                .bind(calibration)
                .fetch_all(&mut view)
                .await?;
        view.close().await?;
        let mut failed: BTreeMap<u64, Vec<String>> = BTreeMap::new();
        for fault in &faults {
            let workers = failed
                .entry(fault.try_get::<i64>("evaluation")?.unsigned_abs())
                .or_default();
            match fault.try_get::<i64>("attempt")? {
                // a user granted new attempts
                0 => workers.clear(),
                _ => workers.push(fault.try_get("worker")?),
            }
        }
        failed.retain(|_, workers| !workers.is_empty());
        Ok(Stored {
            state: CalibrationState::from_name(row.try_get("state")?),
            message: row.try_get("message")?,
            model_version: row.try_get("model_version")?,
            busy_ms: row.try_get::<i64>("busy_ms")?.unsigned_abs(),
            evaluations,
            confirmed,
            is_rewound: row.try_get("is_rewound")?,
            is_doubted: row.try_get("is_doubted")?,
            failed,
        })
    }
}

fn evaluation_row(evaluation: u64, row: &Row, with_fitted: bool) -> Result<EvaluationRow, StoreError> {
    EVALUATIONS.verify(row)?;
    let fitted: Option<&[u8]> = row.try_get("fitted")?;
    let fitted = fitted
        .filter(|_| with_fitted)
        .map(blob::decode_values)
        .transpose()?;
    let is_sampled = evaluation < PREDICTIONS_FROM;
    let whole: Option<&[u8]> = row.try_get("observables")?;
    let whole = whole
        .filter(|_| with_fitted && is_sampled)
        .map(observables::decode)
        .transpose()?;
    let rejection: Option<String> = row.try_get("rejection")?;
    Ok(EvaluationRow {
        evaluation,
        theta: theta(row)?,
        log_likelihood: row.try_get("log_likelihood")?,
        kept: match (rejection, whole, fitted.filter(|values| !values.is_empty())) {
            (Some(reason), ..) => Kept::Rejected(reason),
            (None, Some(whole), _) => Kept::Whole(Box::new(whole)),
            (None, None, Some(values)) => Kept::Fitted(values),
            (None, None, None) => Kept::Scored,
        },
        worker: row.try_get("worker")?,
        fingerprint: Fingerprint(row.try_get("fingerprint")?),
    })
}

#[cfg(test)]
mod tests {
    use record::{Fact, HOLDOUT_RUNS_FROM};
    use shared::outcome::Observables;

    use super::*;
    use crate::fixture;

    fn row(evaluation: u64, theta: Vec<f64>, kept: Kept) -> EvaluationRow {
        EvaluationRow {
            evaluation,
            theta,
            log_likelihood: (!matches!(kept, Kept::Rejected(_))).then_some(-0.1 * evaluation as f64),
            kept,
            fingerprint: Fingerprint(-1),
            worker: "worker".into(),
        }
    }

    #[tokio::test]
    async fn every_evaluation_comes_back_to_the_bit_from_several_pages_and_in_both_forms_of_theta() {
        let (_folder, store, calibration) = fixture::store().await;
        let theta = |number: u64| vec![f64::from_bits(0x3fb9_9999_9999_999a + number), -0.0, 1e-300];
        let kept = |number: u64| match number % 4 {
            0 => Kept::Scored,
            1 => Kept::Fitted(vec![number as f64, 0.1]),
            2 => Kept::Whole(Box::new(Observables {
                sinkage_m: vec![number as f64, 0.1],
                ..Observables::default()
            })),
            _ => Kept::Rejected("no_support: condition 0: toy".into()),
        };
        let last = PAGE as u64 + 7;
        // They arrive in any order.
        let facts = (0..=last).rev().map(|number| Fact::Evaluated {
            calibration,
            row: row(number, theta(number), kept(number)),
        });
        let fact = (store.writer().sink())(facts.collect()).unwrap();
        store.writer().durable(fact).await.unwrap();
        query(
            "INSERT INTO evaluations (calibration, evaluation, theta, log_likelihood, fitted, fingerprint, worker)
             VALUES (?, ?, '[0.1,1e-300]', -1.5, x'', 0, 'older')",
        )
        .bind(calibration)
        .bind(last as i64 + 1)
        .execute(&store.reader.pool)
        .await
        .unwrap();
        let stored = store
            .reader()
            .stored(calibration, true)
            .await
            .unwrap()
            .evaluations;
        assert_eq!(stored.len() as u64, last + 2);
        let bits = |theta: &[f64]| theta.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        for (&number, evaluation) in stored.iter().take(last as usize + 1) {
            assert_eq!(bits(&evaluation.theta), bits(&theta(number)));
            assert_eq!(evaluation.kept, kept(number));
        }
        assert_eq!(bits(&stored[&(last + 1)].theta), bits(&[0.1, 1e-300]));
        store.close().await;
    }

    #[tokio::test]
    async fn refusals_of_final_draws_are_not_counted_as_parameter_vectors() {
        let (_folder, store, calibration) = fixture::store().await;
        let rejected = || Kept::Rejected("no_support: condition 0: toy".into());
        let numbers = [4, PREDICTIONS_FROM + 1, HOLDOUT_RUNS_FROM + 3];
        let facts = numbers.map(|number| Fact::Evaluated {
            calibration,
            row: row(number, vec![0.1], rejected()),
        });
        let fact = (store.writer().sink())(facts.into()).unwrap();
        store.writer().durable(fact).await.unwrap();
        let refused = store.reader().rejections(calibration).await.unwrap();
        assert_eq!(refused, [("no_support".to_owned(), 1)].into());
        store.close().await;
    }
}
