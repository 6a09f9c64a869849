//! Studies that are archived or deleted.

use sqlx::{AssertSqlSafe, SqliteConnection};

use super::error::StoreError;
use super::reader::Reader;

/// Tables with rows of a calibration.
const OF_CALIBRATION: [&str; 7] = [
    "evaluations",
    "samples",
    "stages",
    "estimates",
    "discoveries",
    "faults",
    "disputes",
];

/// Deletes a study with all that belongs to it alone.
pub(super) async fn delete(
    connection: &mut SqliteConnection,
    study: i64,
    now_ms: i64,
) -> Result<(), sqlx::Error> {
    let experiments: Vec<i64> = sqlx::query_scalar(
        "SELECT experiment FROM studies WHERE id = ?1
         UNION SELECT experiment FROM calibrations WHERE study = ?1 AND experiment IS NOT NULL",
    )
    .bind(study)
    .fetch_all(&mut *connection)
    .await?;
    sqlx::query(
        "INSERT INTO deletions (study, last_calibration, last_experiment, deleted_at_ms)
         SELECT ?1, coalesce(max(id), 0), ?2, ?3 FROM calibrations WHERE study = ?1",
    )
    .bind(study)
    .bind(experiments.iter().max())
    .bind(now_ms)
    .execute(&mut *connection)
    .await?;
    let of_calibration = OF_CALIBRATION.map(|table| {
        format!("DELETE FROM {table} WHERE calibration IN (SELECT id FROM calibrations WHERE study = ?)")
    });
    let of_study = [
        "results WHERE study",
        "calibrations WHERE study",
        "studies WHERE id",
    ];
    let of_study = of_study.map(|rows| format!("DELETE FROM {rows} = ?"));
    for statement in of_calibration.into_iter().chain(of_study) {
        sqlx::query(AssertSqlSafe(statement))
            .bind(study)
            .execute(&mut *connection)
            .await?;
    }
    for experiment in experiments {
        sqlx::query(
            "DELETE FROM experiments WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM studies WHERE experiment = ?1)
             AND NOT EXISTS (SELECT 1 FROM calibrations WHERE experiment = ?1)",
        )
        .bind(experiment)
        .execute(&mut *connection)
        .await?;
    }
    Ok(())
}

/// Archives a study at a time, or takes it back where none is given.
pub(super) async fn archive(
    connection: &mut SqliteConnection,
    study: i64,
    at_ms: Option<i64>,
) -> Result<(), sqlx::Error> {
    sqlx::query("UPDATE studies SET archived_at_ms = ? WHERE id = ?")
        .bind(at_ms)
        .bind(study)
        .execute(connection)
        .await
        .map(drop)
}

impl Reader {
    /// Archived studies with the times at which they were archived `[ms since 1970]`. A store of before migration 15, which only
    /// reading leaves as it is, has none.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn archived(&self) -> Result<Vec<(i64, i64)>, StoreError> {
        let column = "SELECT count(*) FROM pragma_table_info('studies') WHERE name = 'archived_at_ms'";
        let there: i64 = sqlx::query_scalar(column).fetch_one(&self.pool).await?;
        if there == 0 {
            return Ok(Vec::new());
        }
        let archived =
            sqlx::query_as("SELECT id, archived_at_ms FROM studies WHERE archived_at_ms IS NOT NULL")
                .fetch_all(&self.pool)
                .await?;
        Ok(archived)
    }
}
