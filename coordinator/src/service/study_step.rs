//! The next step of a study and the searches of its calibrations, from what is stored.

use shared::api::CalibrationState;

use super::error::ServiceError;
use super::stored_calibration::{has_posterior, spec_of};
use crate::store::Reader;
use crate::study::{StudyMember, StudyRole, StudyStep, next_step};
use job::{Apply, JobFile, discovery_job, is_discovery};
use record::{CalibrationRow, Discovery};

/// The next step of a study.
///
/// # Errors
/// [`ServiceError`] where a member cannot be read.
pub async fn next_step_of(reader: &Reader, study: i64) -> Result<Option<StudyStep>, ServiceError> {
    next_step_from(reader, &reader.study(study).await?).await
}

/// The same from members that were read: a member that joins meanwhile is no part of the answer.
///
/// # Errors
/// As those of [`next_step_of`].
pub(super) async fn next_step_from(
    reader: &Reader,
    rows: &[CalibrationRow],
) -> Result<Option<StudyStep>, ServiceError> {
    let Some(lead) = rows.first() else { return Ok(None) };
    let job = JobFile::parse("job.toml", &lead.job.toml)?;
    let settings = job.discovery;
    // Most studies grow by their users alone, and reading every member's files is work.
    if settings.apply == Apply::Off || rows.iter().any(|row| row.state != CalibrationState::Finished) {
        return Ok(None);
    }
    let mut members = Vec::new();
    for row in rows {
        members.push(StudyMember {
            id: row.id,
            state: row.state,
            part: part(reader, row, rows).await?,
        });
    }
    Ok(next_step(settings, job.models, &members))
}

async fn part(
    reader: &Reader,
    row: &CalibrationRow,
    study: &[CalibrationRow],
) -> Result<StudyRole, ServiceError> {
    if is_discovery(&row.job.toml) {
        return Ok(StudyRole::Search(reader.discovery(row.id).await?.map(Box::new)));
    }
    let spec = spec_of(reader, row).await?;
    Ok(match has_posterior(reader, row, &spec).await? {
        true => StudyRole::Ledger {
            effects: spec
                .fit_variant
                .effects
                .iter()
                .map(|e| e.name.clone())
                .chain(spec.freed())
                .collect(),
            search: find_search(row, study)?.map(|row| row.id),
            log_evidence: row.log_evidence,
        },
        false => StudyRole::Beside,
    })
}

/// The search of a calibration's model among the members of its study; of several, which can only be where one failed, the
/// last. A search is its own.
fn find_search<'a>(
    row: &'a CalibrationRow,
    study: &'a [CalibrationRow],
) -> Result<Option<&'a CalibrationRow>, ServiceError> {
    if is_discovery(&row.job.toml) {
        return Ok(Some(row));
    }
    for other in study.iter().rev() {
        if is_search_of(other, row)? {
            return Ok(Some(other));
        }
    }
    Ok(None)
}

/// Whether a calibration is the search of the model of another.
pub(super) fn is_search_of(search: &CalibrationRow, row: &CalibrationRow) -> Result<bool, ServiceError> {
    Ok(search.experiment == row.experiment && search.job == discovery_job("job.toml", &row.job)?)
}

/// The search of a calibration's model, if there is one.
///
/// # Errors
/// [`ServiceError`].
pub(super) async fn search_of(
    reader: &Reader,
    row: &CalibrationRow,
) -> Result<Option<CalibrationRow>, ServiceError> {
    let study = reader.study(row.study).await?;
    Ok(find_search(row, &study)?.cloned())
}

/// What the search of a calibration's model found.
///
/// # Errors
/// [`ServiceError::NotFound`] where none was asked for, [`ServiceError::Control`] where it is not finished.
pub async fn finished_search(reader: &Reader, row: &CalibrationRow) -> Result<Discovery, ServiceError> {
    let none = || ServiceError::not_found("search for a missing effect of calibration", row.id);
    let search = search_of(reader, row).await?.ok_or_else(none)?;
    if search.state != CalibrationState::Finished {
        return Err(ServiceError::not_finished(&search));
    }
    reader.discovery(search.id).await?.ok_or_else(none)
}
