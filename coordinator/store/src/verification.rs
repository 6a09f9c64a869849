//! The consequences of comparing the answers of workers: confirmations, quarantine, rewinds.

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as};
use record::{EvaluationKey, Quarantine, Verified};

/// Returns a condition: the name in one column is that of a worker in another column, or of all workers of its token, which ends with a
/// slash.
fn includes(name: &str, worker: &str) -> String {
    format!(
        "({worker} = {name} OR substr({name}, length({name})) = '/' AND substr({worker}, 1, length({name})) = {name})"
    )
}

/// Returns a condition: a worker computes wrongly.
fn is_quarantined(worker: &str) -> String {
    let includes = includes("wrong.worker", worker);
    format!("EXISTS (SELECT 1 FROM quarantine wrong WHERE {includes})")
}

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
    let is_settled = format!("({} OR {})", includes("?1", "first"), includes("?1", "second"));
    let delete = format!(
        "DELETE FROM disputes WHERE {is_settled} AND calibration IN
         (SELECT id FROM calibrations WHERE state NOT IN ('finished', 'failed', 'cancelled'))"
    );
    query(sqlx::AssertSqlSafe(delete))
        .bind(worker)
        .execute(connection)
        .await
        .map(drop)
}

/// Withdraws the confirmations of a worker that computes wrongly. Deletes the results that rest on this worker and earlier such workers
/// alone, and all results of later rounds, because the later parameter vectors depend on them.
pub(super) async fn rewind(
    connection: &mut Connection,
    calibration: i64,
    worker: &str,
    width: usize,
) -> Result<(), sqlx::Error> {
    let withdraw = format!(
        "UPDATE evaluations SET confirmed_by = NULL WHERE calibration = ?1 AND {}",
        includes("?2", "confirmed_by")
    );
    query(sqlx::AssertSqlSafe(withdraw))
        .bind(calibration)
        .bind(worker)
        .execute(&mut *connection)
        .await?;
    let rests = format!(
        "confirmed_by IS NULL AND ({} OR {})",
        includes("?2", "evaluations.worker"),
        is_quarantined("evaluations.worker")
    );
    let find =
        format!("SELECT min(evaluation), count(*) FROM evaluations WHERE calibration = ?1 AND {rests}");
    let (first, results): (Option<i64>, i64) = query_as(sqlx::AssertSqlSafe(find))
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
    let settle = format!(
        "DELETE FROM disputes WHERE calibration = ?1 AND ({} OR {})",
        includes("?2", "first"),
        includes("?2", "second")
    );
    query(sqlx::AssertSqlSafe(settle))
        .bind(calibration)
        .bind(worker)
        .execute(&mut *connection)
        .await?;
    let Some(first) = first else { return Ok(()) };
    let round_end = EvaluationKey::round_end(first.unsigned_abs(), width) as i64;
    let delete = format!("DELETE FROM evaluations WHERE calibration = ?1 AND (evaluation >= ?3 OR {rests})");
    query(sqlx::AssertSqlSafe(delete))
        .bind(calibration)
        .bind(worker)
        .bind(round_end)
        .execute(&mut *connection)
        .await?;
    begin_anew(connection, calibration, round_end).await
}

/// Drops all results of a calibration, and pins it to another version of the equations.
pub(super) async fn repin(
    connection: &mut Connection,
    calibration: i64,
    version: &str,
) -> Result<(), sqlx::Error> {
    tracing::warn!(target: "journal", calibration, version, "its operator has chosen the version of the equations");
    for table in ["evaluations", "disputes"] {
        let sql = format!("DELETE FROM {table} WHERE calibration = ?");
        query(sqlx::AssertSqlSafe(sql))
            .bind(calibration)
            .execute(&mut *connection)
            .await?;
    }
    begin_anew(connection, calibration, 0).await?;
    query("UPDATE calibrations SET model_version = ? WHERE id = ?")
        .bind(version)
        .bind(calibration)
        .execute(connection)
        .await
        .map(drop)
}

/// Drops what follows from results of a calibration that are dropped. Evaluations from a number on get new attempts.
async fn begin_anew(connection: &mut Connection, calibration: i64, from: i64) -> Result<(), sqlx::Error> {
    // After the rewind, these numbers stand for other parameter vectors, which get new attempts.
    query(
        "INSERT INTO faults (calibration, evaluation, attempt, worker, message, at_ms)
         SELECT DISTINCT calibration, evaluation, 0, '', 'asked anew: earlier results were dropped', unixepoch('subsec') * 1000
         FROM faults WHERE calibration = ? AND evaluation >= ?",
    )
    .bind(calibration)
    .bind(from)
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
        let (by_wrong, from_wrong) = (is_quarantined("e.confirmed_by"), is_quarantined("e.worker"));
        let count = format!(
            "SELECT count(*),
             count(CASE WHEN e.confirmed_by <> '' AND NOT {by_wrong} AND NOT {from_wrong} THEN 1 END),
             count(DISTINCT e.worker) FROM evaluations e WHERE e.calibration = ? AND e.worker <> ''"
        );
        let (results, confirmed, workers): (i64, i64, i64) = query_as(sqlx::AssertSqlSafe(count))
            .bind(calibration)
            .fetch_one(&self.pool)
            .await?;
        let resting = format!(
            "SELECT q.worker, count(*) FROM quarantine q JOIN evaluations e ON {}
             WHERE e.calibration = ? AND (e.confirmed_by IS NULL OR {by_wrong})
             GROUP BY q.worker ORDER BY q.worker",
            includes("q.worker", "e.worker")
        );
        let resting = query_as(sqlx::AssertSqlSafe(resting));
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
    async fn what_a_worker_has_confirmed_rests_on_others_or_goes_once_it_computes_wrongly() {
        let (_folder, store, calibration) = fixture::store().await;
        let sink = std::cell::RefCell::new(store.writer().sink());
        let store_fact = async |fact: Fact| {
            let number = (sink.borrow_mut())(vec![fact]).unwrap();
            store.writer().durable(number).await.unwrap();
        };
        let confirmed = |evaluation: u64, worker: &str| Fact::Confirmed {
            calibration,
            evaluation,
            worker: worker.into(),
        };
        let convicted = async |worker: &str| {
            store_fact(Fact::Rewound {
                calibration,
                worker: worker.into(),
                width: 100,
            })
            .await;
            store_fact(Fact::Quarantined {
                worker: worker.into(),
                calibration,
                evaluation: 0,
            })
            .await;
            let stored = store.reader().stored(calibration, false).await.unwrap();
            let rows: Vec<(u64, Option<String>)> = stored
                .evaluations
                .keys()
                .map(|&row| (row, stored.confirmed.get(&row).cloned()))
                .collect();
            let verified = store.reader().verified(calibration).await.unwrap();
            assert!(
                stored.is_doubted && verified.resting_on.is_empty(),
                "{verified:?}"
            );
            (rows, verified.confirmed)
        };
        // Computed by one liar and confirmed by another, by an honest worker, or by nobody; and the other way round.
        for (evaluation, worker, confirmed_by) in [
            (0, "lab/1", Some("liar")),
            (1, "lab/2", Some("honest")),
            (2, "honest", Some("lab/1")),
            (3, "honest", None),
            (4, "liar", Some("lab/2")),
            (5, "lab-2/1", None),
        ] {
            let row = fixture::row(evaluation, worker, 7);
            store_fact(Fact::Evaluated { calibration, row }).await;
            if let Some(worker) = confirmed_by {
                store_fact(confirmed(evaluation, worker)).await;
            }
        }
        let by = |worker: &str| Some(worker.to_owned());
        let (rows, confirmed) = convicted("liar").await;
        let expected = [
            (0, None),
            (1, by("honest")),
            (2, by("lab/1")),
            (3, None),
            (4, by("lab/2")),
            (5, None),
        ];
        assert_eq!((rows.as_slice(), confirmed), (expected.as_slice(), 2));
        // All workers of a token.
        let (rows, confirmed) = convicted("lab/").await;
        let expected = [(1, by("honest")), (2, None), (3, None), (5, None)];
        assert_eq!((rows.as_slice(), confirmed), (expected.as_slice(), 0));
        store.close().await;
    }

    #[tokio::test]
    async fn a_version_that_the_operator_chooses_drops_every_row_and_stays() {
        let (_folder, store, calibration) = fixture::store().await;
        let mut sink = store.writer().sink();
        let row = |evaluation| Fact::Evaluated {
            calibration,
            row: fixture::row(evaluation, "liar", 7),
        };
        let (invented, chosen) = ("invented-1".to_owned(), "scm-7".to_owned());
        let pinned = Fact::ModelVersion {
            calibration,
            version: invented,
        };
        let repinned = Fact::Repinned {
            calibration,
            version: chosen.clone(),
        };
        let number = sink(vec![pinned, row(0), row(1), repinned]).unwrap();
        store.writer().durable(number).await.unwrap();
        let stored = store.reader().stored(calibration, false).await.unwrap();
        assert!(stored.evaluations.is_empty());
        assert_eq!(stored.model_version, Some(chosen));
        store.close().await;
    }

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
