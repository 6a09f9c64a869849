//! Rows of new studies, calibrations and evaluations.

use shared::file::FileSet;

use super::blob;
use super::checksum::EVALUATIONS;
use super::json::json;
use super::observables;
use super::sql::{Conflict, Connection, insert, query_scalar};
use record::Membership;
use record::fact::{EvaluationRow, Kept};

/// The largest number of rows in one statement; SQLite takes 32,766 parameters, PostgreSQL 65,535.
const ROWS: usize = 1000;

/// A study to store, with its first calibrations. Either all of them are stored or none.
#[derive(Debug, Clone)]
pub struct NewStudy {
    /// The experiment that it is about.
    pub experiment: i64,
    /// Calibrations of the study.
    pub calibrations: Vec<NewCalibrationRow>,
    /// The address that pauses and ends are posted to, if the user gave one.
    pub webhook: Option<String>,
    /// Time of the insertion, in milliseconds since 1970.
    pub now_ms: i64,
}

/// Ids of a new study and its calibrations, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyIds {
    /// Id of the study.
    pub study: i64,
    /// Ids of the study's calibrations.
    pub calibrations: Vec<i64>,
}

/// A calibration to store.
#[derive(Debug, Clone)]
pub struct NewCalibrationRow {
    /// Place of the calibration in the study. For the first calibrations of a new study, the store fills in the parent, which is the
    /// first calibration of the study.
    pub membership: Membership,
    /// Name for lists.
    pub name: String,
    /// The job with the files it names.
    pub job: FileSet,
}

/// Inserts an experiment. Returns its id.
pub(super) async fn insert_experiment(
    connection: &mut Connection,
    files: FileSet,
    now_ms: i64,
) -> Result<i64, sqlx::Error> {
    query_scalar(
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
    connection: &mut Connection,
    new: NewStudy,
) -> Result<StudyIds, sqlx::Error> {
    let study: i64 = query_scalar(
        "INSERT INTO studies (id, experiment, webhook)
         VALUES (1 + max((SELECT coalesce(max(id), 0) FROM studies),
                         (SELECT coalesce(max(study), 0) FROM deletions)), ?, ?) RETURNING id",
    )
    .bind(new.experiment)
    .bind(new.webhook)
    .fetch_one(&mut *connection)
    .await?;
    let mut calibrations = Vec::new();
    for mut row in new.calibrations {
        row.membership.parent = calibrations.first().copied();
        let id = insert_calibration(connection, study, None, row, new.now_ms).await?;
        calibrations.push(id);
    }
    Ok(StudyIds { study, calibrations })
}

/// Inserts a calibration. Without an experiment of its own, it belongs to the experiment of its study.
pub(super) async fn insert_calibration(
    connection: &mut Connection,
    study: i64,
    experiment: Option<i64>,
    row: NewCalibrationRow,
    now_ms: i64,
) -> Result<i64, sqlx::Error> {
    query_scalar(
        "INSERT INTO calibrations
         (id, study, experiment, name, toml, files, state, created_at_ms, seal_key, role, parent, change)
         VALUES (1 + max((SELECT coalesce(max(id), 0) FROM calibrations),
                         (SELECT coalesce(max(last_calibration), 0) FROM deletions)),
                 ?1, nullif(?2, (SELECT experiment FROM studies WHERE id = ?1)), ?3, ?4, ?5, 'queued', ?6, randomblob(16), ?7, ?8, ?9)
         RETURNING id",
    )
    .bind(study)
    .bind(experiment)
    .bind(row.name)
    .bind(row.job.toml)
    .bind(json(&row.job.files))
    .bind(now_ms)
    .bind(row.membership.role.name())
    .bind(row.membership.parent)
    .bind(row.membership.change.as_ref().map(json))
    .fetch_one(connection)
    .await
}

/// Inserts evaluations, many rows in one statement, because the cost of SQLite through sqlx is a cost for each statement.
pub(super) async fn insert_evaluations(
    connection: &mut Connection,
    rows: &mut Vec<(i64, EvaluationRow)>,
) -> Result<(), sqlx::Error> {
    // Sorted rows fill the pages of the table one after the other.
    rows.sort_by_key(|(calibration, row)| (*calibration, row.evaluation));
    while !rows.is_empty() {
        let part = rows.drain(..rows.len().min(ROWS));
        let rows = part.map(|(calibration, row)| {
            let (rejection, fitted, observables) = match row.kept {
                Kept::Rejected(rejection) => (Some(rejection), None, None),
                Kept::Scored => (None, Some(Vec::new()), None),
                Kept::Fitted(values) => (None, Some(blob::encode(&values)), None),
                Kept::Whole(observables) => (None, None, Some(observables::encode(&observables))),
            };
            EVALUATIONS.sealed(vec![
                calibration.into(),
                (row.evaluation as i64).into(),
                blob::encode(&row.theta).into(),
                row.log_likelihood.into(),
                rejection.into(),
                fitted.into(),
                observables.into(),
                row.fingerprint.0.into(),
                row.worker.into(),
            ])
        });
        insert(
            "evaluations",
            &EVALUATIONS.names(),
            rows.collect(),
            &Conflict::Keep,
        )
        .execute(&mut *connection)
        .await?;
    }
    Ok(())
}
