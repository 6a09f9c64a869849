//! Rows of new studies, calibrations and evaluations.

use shared::file::FileSet;
use sqlx::{QueryBuilder, Sqlite, SqliteConnection};

use super::blob;
use super::json::json;
use record::fact::{EvaluationRow, Kept};

/// Most rows in one statement; SQLite takes 32,766 parameters.
const ROWS: usize = 1000;

/// A study to store, with the calibrations that it begins with: all of them, or none.
#[derive(Debug, Clone)]
pub struct NewStudy {
    /// The experiment that it is about.
    pub experiment: i64,
    /// Its calibrations.
    pub calibrations: Vec<NewCalibrationRow>,
    /// Where pauses and ends are posted to.
    pub webhook: Option<String>,
    /// Now.
    pub now_ms: i64,
}

/// Ids of a new study and its calibrations, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyIds {
    /// The study.
    pub study: i64,
    /// Its calibrations.
    pub calibrations: Vec<i64>,
}

/// A calibration to store.
#[derive(Debug, Clone)]
pub struct NewCalibrationRow {
    /// Name for lists.
    pub name: String,
    /// The job with the files it names.
    pub job: FileSet,
}

/// Inserts an experiment; its id.
pub(super) async fn insert_experiment(
    connection: &mut SqliteConnection,
    files: FileSet,
    now_ms: i64,
) -> Result<i64, sqlx::Error> {
    sqlx::query_scalar(
        "INSERT INTO experiments (id, toml, files, created_at_ms)
         VALUES (1 + max((SELECT coalesce(max(id), 0) FROM experiments),
                         (SELECT coalesce(max(last_experiment), 0) FROM deletions)), ?, ?, ?) RETURNING id",
    )
    .bind(files.toml)
    .bind(json(&files.files))
    .bind(now_ms)
    .fetch_one(connection)
    .await
}

/// Inserts a study with its first calibrations.
pub(super) async fn insert_study(
    connection: &mut SqliteConnection,
    new: NewStudy,
) -> Result<StudyIds, sqlx::Error> {
    let study: i64 = sqlx::query_scalar(
        "INSERT INTO studies (id, experiment, webhook)
         VALUES (1 + max((SELECT coalesce(max(id), 0) FROM studies),
                         (SELECT coalesce(max(study), 0) FROM deletions)), ?, ?) RETURNING id",
    )
    .bind(new.experiment)
    .bind(new.webhook)
    .fetch_one(&mut *connection)
    .await?;
    let mut calibrations = Vec::new();
    for row in new.calibrations {
        let id = insert_calibration(connection, study, None, row, new.now_ms).await?;
        calibrations.push(id);
    }
    Ok(StudyIds { study, calibrations })
}

/// Inserts a calibration, on the experiment of its study where none is named.
pub(super) async fn insert_calibration(
    connection: &mut SqliteConnection,
    study: i64,
    experiment: Option<i64>,
    row: NewCalibrationRow,
    now_ms: i64,
) -> Result<i64, sqlx::Error> {
    sqlx::query_scalar(
        "INSERT INTO calibrations (id, study, experiment, name, toml, files, state, created_at_ms, seal_key)
         VALUES (1 + max((SELECT coalesce(max(id), 0) FROM calibrations),
                         (SELECT coalesce(max(last_calibration), 0) FROM deletions)),
                 ?1, nullif(?2, (SELECT experiment FROM studies WHERE id = ?1)), ?3, ?4, ?5, 'queued', ?6, randomblob(16))
         RETURNING id",
    )
    .bind(study)
    .bind(experiment)
    .bind(row.name)
    .bind(row.job.toml)
    .bind(json(&row.job.files))
    .bind(now_ms)
    .fetch_one(connection)
    .await
}

/// Inserts evaluations, many rows to a statement: SQLite through sqlx costs by the statement.
pub(super) async fn insert_evaluations(
    connection: &mut SqliteConnection,
    rows: &mut Vec<(i64, EvaluationRow)>,
) -> Result<(), sqlx::Error> {
    // By their numbers: pages are filled one after the other.
    rows.sort_by_key(|(calibration, row)| (*calibration, row.evaluation));
    while !rows.is_empty() {
        let part = rows.drain(..rows.len().min(ROWS));
        let mut query: QueryBuilder<Sqlite> = QueryBuilder::new(
            "INSERT OR IGNORE INTO evaluations
             (calibration, evaluation, theta, log_likelihood, rejection, fitted, observables, fingerprint, worker, subchain, coarse) ",
        );
        query.push_values(part, |mut values, (calibration, row)| {
            let (rejection, fitted, observables) = match row.kept {
                Kept::Rejected(rejection) => (Some(rejection), None, None),
                Kept::Scored => (None, Some(Vec::new()), None),
                Kept::Fitted(values) => (None, Some(blob::encode(&values)), None),
                Kept::Whole(observables) => (None, None, Some(blob::encode_whole(&observables))),
            };
            values
                .push_bind(calibration)
                .push_bind(row.evaluation as i64)
                .push_bind(blob::encode(&row.theta))
                .push_bind(row.log_likelihood)
                .push_bind(rejection)
                .push_bind(fitted)
                .push_bind(observables)
                .push_bind(row.fingerprint.0)
                .push_bind(row.worker)
                .push_bind(row.end.as_ref().map(json))
                .push_bind(row.coarse.as_deref().map(blob::encode));
        });
        query.build().persistent(false).execute(&mut *connection).await?;
    }
    Ok(())
}
