//! The consequences of comparing the answers of workers: confirmations, quarantine, rewinds.

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as};
use record::{EvaluationKey, Quarantine, Verified};

/// Records that a second worker has reproduced a result.
pub(super) async fn confirm(
    connection: &mut Connection,
    calibration: i64,
    evaluation: u64,
    worker: &str,
) -> Result<(), sqlx::Error> {
    query("UPDATE evaluations SET confirmed_by = ? WHERE calibration = ? AND evaluation = ?")
        .bind(worker)
        .bind(calibration)
        .bind(evaluation as i64)
        .execute(connection)
        .await
        .map(drop)
}

/// Records that a worker computes wrongly.
pub(super) async fn quarantine(
    connection: &mut Connection,
    worker: &str,
    calibration: i64,
    evaluation: u64,
) -> Result<(), sqlx::Error> {
    tracing::error!(
        target: "journal",
        worker,
        calibration,
        evaluation,
        "quarantined: it computes wrongly"
    );
    query(
        "INSERT INTO quarantine (worker, calibration, evaluation, at_ms)
         VALUES (?, ?, ?, unixepoch('subsec') * 1000) ON CONFLICT DO NOTHING",
    )
    .bind(worker)
    .bind(calibration)
    .bind(evaluation as i64)
    .execute(&mut *connection)
    .await?;
    // In unfinished calibrations, a dispute with a wrong answer is settled.
    query(
        "DELETE FROM disputes WHERE ? IN (first, second) AND calibration IN
         (SELECT id FROM calibrations WHERE state NOT IN ('finished', 'failed', 'cancelled'))",
    )
    .bind(worker)
    .execute(connection)
    .await
    .map(drop)
}

/// Deletes the unconfirmed results of a worker and all results of later rounds, because the later parameter vectors depend on them.
pub(super) async fn rewind(
    connection: &mut Connection,
    calibration: i64,
    worker: &str,
    width: usize,
) -> Result<(), sqlx::Error> {
    let (first, results): (Option<i64>, i64) = query_as(
        "SELECT min(evaluation), count(*) FROM evaluations
         WHERE calibration = ? AND worker = ? AND confirmed_by IS NULL",
    )
    .bind(calibration)
    .bind(worker)
    .fetch_one(&mut *connection)
    .await?;
    tracing::warn!(target: "journal", calibration, worker, results, "results are computed again");
    query(
        "INSERT INTO rewinds (calibration, worker, results, at_ms) VALUES (?, ?, ?, unixepoch('subsec') * 1000)
         ON CONFLICT (calibration, worker) DO UPDATE SET results = rewinds.results + excluded.results",
    )
    .bind(calibration)
    .bind(worker)
    .bind(results)
    .execute(&mut *connection)
    .await?;
    // A dispute with a wrong answer is settled.
    query("DELETE FROM disputes WHERE calibration = ?1 AND ?2 IN (first, second)")
        .bind(calibration)
        .bind(worker)
        .execute(&mut *connection)
        .await?;
    let Some(first) = first else { return Ok(()) };
    let round_end = EvaluationKey::round_end(first.unsigned_abs(), width) as i64;
    query(
        "DELETE FROM evaluations WHERE calibration = ?1
         AND (evaluation >= ?2 OR worker = ?3 AND confirmed_by IS NULL)",
    )
    .bind(calibration)
    .bind(round_end)
    .bind(worker)
    .execute(&mut *connection)
    .await?;
    // After the rewind, these numbers stand for other parameter vectors, which get new attempts.
    query(
        "INSERT INTO faults (calibration, evaluation, attempt, worker, message, at_ms)
         SELECT DISTINCT calibration, evaluation, 0, '', 'asked anew: earlier results were dropped', unixepoch('subsec') * 1000
         FROM faults WHERE calibration = ? AND evaluation >= ?",
    )
    .bind(calibration)
    .bind(round_end)
    .execute(&mut *connection)
    .await?;
    // The replay writes those rows again that still hold.
    for table in ["stages", "samples", "estimates", "discoveries", "emulators"] {
        let sql = format!("DELETE FROM {table} WHERE calibration = ?");
        query(sqlx::AssertSqlSafe(sql))
            .bind(calibration)
            .execute(&mut *connection)
            .await?;
    }
    query(
        "UPDATE calibrations SET log_evidence = NULL, log_evidence_se = NULL, equilibrated = NULL,
         evaluations = NULL, rejected = NULL,
         model_version = CASE WHEN EXISTS (SELECT 1 FROM evaluations WHERE calibration = ?1) THEN model_version END
         WHERE id = ?1",
    )
    .bind(calibration)
    .execute(connection)
    .await
    .map(drop)
}

impl Reader {
    /// Reads the workers that compute wrongly.
    pub async fn quarantine(&self) -> Result<Vec<Quarantine>, StoreError> {
        let rows: Vec<(String, i64, i64)> =
            query_as("SELECT worker, calibration, evaluation FROM quarantine ORDER BY worker")
                .fetch_all(&self.pool)
                .await?;
        let quarantine = |(worker, calibration, evaluation): (String, i64, i64)| Quarantine {
            worker,
            calibration,
            evaluation: evaluation.unsigned_abs(),
        };
        Ok(rows.into_iter().map(quarantine).collect())
    }

    /// Reads how many results of a calibration are verified. In a store of before migration 18, no result is verified.
    pub async fn verified(&self, calibration: i64) -> Result<Verified, StoreError> {
        if !self.has_table("quarantine").await? {
            // Versions before migration 18 did not verify results.
            let (results, workers): (i64, i64) = query_as(
                "SELECT count(*), count(DISTINCT worker) FROM evaluations WHERE calibration = ? AND worker <> ''",
            )
            .bind(calibration)
            .fetch_one(&self.pool)
            .await?;
            return Ok(Verified {
                results: results.unsigned_abs(),
                workers: workers.unsigned_abs(),
                ..Verified::default()
            });
        }
        let (results, confirmed, workers): (i64, i64, i64) = query_as(
            "SELECT count(*), count(nullif(confirmed_by, '')), count(DISTINCT worker) FROM evaluations
             WHERE calibration = ? AND worker <> ''",
        )
        .bind(calibration)
        .fetch_one(&self.pool)
        .await?;
        let resting = query_as(
            "SELECT q.worker, count(*) FROM quarantine q JOIN evaluations e ON e.worker = q.worker
             WHERE e.calibration = ? AND e.confirmed_by IS NULL GROUP BY q.worker ORDER BY q.worker",
        );
        let rewound = query_as("SELECT worker, results FROM rewinds WHERE calibration = ? ORDER BY worker");
        let resting: Vec<(String, i64)> = resting.bind(calibration).fetch_all(&self.pool).await?;
        let rewound: Vec<(String, i64)> = rewound.bind(calibration).fetch_all(&self.pool).await?;
        let counts =
            |rows: Vec<(String, i64)>| rows.into_iter().map(|(worker, n)| (worker, n.unsigned_abs()));
        Ok(Verified {
            results: results.unsigned_abs(),
            confirmed: confirmed.unsigned_abs(),
            workers: workers.unsigned_abs(),
            resting_on: counts(resting).collect(),
            computed_again: counts(rewound).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use record::{Fact, Fingerprint};

    use crate::fixture;

    #[tokio::test]
    async fn only_an_answer_that_differs_from_the_stored_one_changes_a_study() {
        let (_folder, store, calibration) = fixture::store().await;
        let mut sink = store.writer().sink();
        let mut store_fact = async |fact: Fact| {
            let number = sink(vec![fact]).unwrap();
            store.writer().durable(number).await.unwrap();
        };
        store_fact(Fact::Evaluated {
            calibration,
            row: fixture::row(3, "a", 7),
        })
        .await;
        let mut studies = store.writer().study_changes();
        let duplicate = |fingerprint| Fact::Duplicate {
            calibration,
            evaluation: 3,
            fingerprint: Fingerprint(fingerprint),
            worker: "b".into(),
        };
        for (fingerprint, is_change) in [(7, false), (8, true), (8, false)] {
            store_fact(duplicate(fingerprint)).await;
            assert_eq!(studies.has_changed().unwrap(), is_change, "{fingerprint}");
            studies.mark_unchanged();
        }
        store.close().await;
    }
}
