//! The next step of a study and the searches of its calibrations, from the store.

use shared::api::CalibrationState;

use super::error::ServiceError;
use super::handle::Service;
use super::stored_calibration::has_posterior;
use crate::study::{Lineage, StudyFindings, StudyStep, next_step};
use job::{Apply, Job};
use record::{CalibrationRow, Discovery};
use store::Reader;

impl Service {
    /// Determines the next step of a study.
    ///
    /// # Errors
    /// [`ServiceError`] where a member cannot be read.
    pub async fn next_step(&self, study: i64) -> Result<Option<StudyStep>, ServiceError> {
        let reader = self.store().reader();
        let (rows, withdrawn) = reader.members_and_withdrawn(study).await?;
        next_step_from(&reader, &rows, &withdrawn).await
    }

    /// Reads the record of the search for an effect that the model of a calibration lacks.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`] if there is no search, [`ServiceError::Control`] if it is not finished.
    pub async fn finished_search(&self, id: i64) -> Result<Discovery, ServiceError> {
        let reader = self.store().reader();
        let row = self.calibration_row(id).await?;
        let none = || ServiceError::not_found("search for a missing effect of calibration", id);
        let study = reader.study(row.study).await?;
        let search = Lineage::new(&study).search_of(id).ok_or_else(none)?;
        if search.state != CalibrationState::Finished {
            return Err(ServiceError::not_finished(search));
        }
        reader.discovery(search.id).await?.ok_or_else(none)
    }
}

/// Determines the next step of a study with these members, from which others were taken back.
pub(super) async fn next_step_from(
    reader: &Reader,
    rows: &[CalibrationRow],
    withdrawn: &[CalibrationRow],
) -> Result<Option<StudyStep>, ServiceError> {
    let Some(lead) = rows.first() else { return Ok(None) };
    let settings = Job::parse("job.toml", &lead.job.toml)?.discovery;
    if settings.apply == Apply::Off || rows.iter().any(|row| row.state != CalibrationState::Finished) {
        return Ok(None);
    }
    let mut findings = StudyFindings::default();
    for row in rows {
        if row.membership.is_search() {
            let record = reader.discovery(row.id).await?;
            findings.searches.extend(record.map(|record| (row.id, record)));
        } else if has_posterior(reader, row).await? {
            findings.ledger.insert(row.id);
        }
    }
    Ok(next_step(settings, rows, withdrawn, &findings))
}
