//! Archiving and deletion of studies.

use sqlx::AssertSqlSafe;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as, query_scalar};

/// Tables that have many rows for a calibration, with their keys.
const LARGE: [(&str, &str); 2] = [
    ("evaluations", "calibration, evaluation"),
    ("samples", "calibration, stage, particle"),
];
/// The number of rows of the large tables that one commit deletes. Results of workers wait no longer than for one such commit.
const PART: u64 = 1000;
/// Tables that have few rows for a calibration.
const SMALL: [&str; 8] = [
    "stages",
    "estimates",
    "discoveries",
    "emulators",
    "faults",
    "disputes",
    "rewinds",
    "repeats",
];

/// Deletes a part of the rows that belong to a study alone, and in the last part the study itself. Returns whether nothing is left.
pub(super) async fn delete_part(
    connection: &mut Connection,
    study: i64,
    now_ms: i64,
) -> Result<bool, sqlx::Error> {
    let experiments: Vec<i64> = query_scalar(
        "SELECT experiment FROM studies WHERE id = ?1
         UNION SELECT experiment FROM calibrations WHERE study = ?1 AND experiment IS NOT NULL",
    )
    .bind(study)
    .fetch_all(&mut *connection)
    .await?;
    // With the first part, the study is archived and its results are deleted. After a restart, this row shows that the deletion must
    // continue.
    query(
        "INSERT INTO deletions (study, last_calibration, last_experiment, deleted_at_ms)
         SELECT id, (SELECT coalesce(max(id), 0) FROM calibrations WHERE study = ?1), ?2, ?3 FROM studies WHERE id = ?1
         ON CONFLICT DO NOTHING",
    )
    .bind(study)
    .bind(experiments.iter().max().copied())
    .bind(now_ms)
    .execute(&mut *connection)
    .await?;
    query("UPDATE studies SET archived_at_ms = coalesce(archived_at_ms, ?2) WHERE id = ?1")
        .bind(study)
        .bind(now_ms)
        .execute(&mut *connection)
        .await?;
    let mut delete = async |rows: String| {
        let deleted = query(AssertSqlSafe(format!("DELETE FROM {rows}")));
        let deleted = deleted.bind(study).execute(&mut *connection).await?;
        Ok::<_, sqlx::Error>(deleted)
    };
    let of_study = "calibration IN (SELECT id FROM calibrations WHERE study = ?)";
    delete("results WHERE study = ?".into()).await?;
    for (table, key) in LARGE {
        let part = format!("SELECT {key} FROM {table} WHERE {of_study} LIMIT {PART}");
        if delete(format!("{table} WHERE ({key}) IN ({part})")).await? > 0 {
            return Ok(false);
        }
    }
    for table in SMALL {
        delete(format!("{table} WHERE {of_study}")).await?;
    }
    delete("calibrations WHERE study = ?".into()).await?;
    delete("studies WHERE id = ?".into()).await?;
    for experiment in experiments {
        query(
            "DELETE FROM experiments WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM studies WHERE experiment = ?1)
             AND NOT EXISTS (SELECT 1 FROM calibrations WHERE experiment = ?1)",
        )
        .bind(experiment)
        .execute(&mut *connection)
        .await?;
    }
    Ok(true)
}

/// Archives a study at a time; without a time, restores it.
pub(super) async fn archive(
    connection: &mut Connection,
    study: i64,
    at_ms: Option<i64>,
) -> Result<(), sqlx::Error> {
    query("UPDATE studies SET archived_at_ms = ? WHERE id = ?")
        .bind(at_ms)
        .bind(study)
        .execute(connection)
        .await
        .map(drop)
}

impl Reader {
    /// Reads the studies that are deleted in part. A store of before migration 15 has none.
    pub async fn half_deleted(&self) -> Result<Vec<i64>, StoreError> {
        if !self.has_table("deletions").await? {
            return Ok(Vec::new());
        }
        let studies = query_scalar("SELECT study FROM deletions WHERE study IN (SELECT id FROM studies)");
        Ok(studies.fetch_all(&self.pool).await?)
    }

    /// Reads the archived studies with the times at which they were archived `[ms since 1970]`. A store of before migration 15 has none.
    pub async fn archived(&self) -> Result<Vec<(i64, i64)>, StoreError> {
        // The column was added by the same migration.
        if !self.has_table("deletions").await? {
            return Ok(Vec::new());
        }
        let archived = query_as("SELECT id, archived_at_ms FROM studies WHERE archived_at_ms IS NOT NULL")
            .fetch_all(&self.pool)
            .await?;
        Ok(archived)
    }
}
