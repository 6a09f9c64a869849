//! What was added to a study, taken back: the study is as if it had never been added, and its results are kept.

use record::{CalibrationRow, Change, StudyDetails};

use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;
use crate::study::Lineage;
use farm::Control;

impl Service {
    /// Takes a calibration that was added to a study out of it, with all that follows from it; what is not over is cancelled. Returns the
    /// study and what was taken out. Adding the same to the same calibration again takes in the addition, with its point estimates and
    /// searches, without computing it anew; what else followed from it stays out.
    ///
    /// # Errors
    /// [`ServiceError::Submitted`] for a calibration that the study began with.
    pub async fn withdraw(&self, id: i64) -> Result<(i64, Vec<i64>), ServiceError> {
        let _growing = self.growing.lock().await;
        let row = self.calibration_row(id).await?;
        if !is_addition(&row) {
            return Err(ServiceError::Submitted(id));
        }
        let rows = self.store().reader().study(row.study).await?;
        let members: Vec<&CalibrationRow> = Lineage::new(&rows).from(id).collect();
        for member in members.iter().filter(|member| !member.state.is_final()) {
            self.control(member.id, Control::Cancel).await?;
        }
        let ids: Vec<i64> = members.iter().map(|member| member.id).collect();
        self.store()
            .writer()
            .withdraw(ids.clone(), Some(now_ms()))
            .await?;
        Ok((row.study, ids))
    }

    /// Takes a calibration in again, with the point estimates and the searches of its model that did not end without a result.
    pub(super) async fn take_in_again(&self, rows: &[CalibrationRow], id: i64) -> Result<(), ServiceError> {
        use shared::api::CalibrationState::{Cancelled, Failed};
        if !self.store().reader().withdrawn().await?.contains(&id) {
            return Ok(());
        }
        let lineage = Lineage::new(rows);
        let own = |row: &&CalibrationRow| {
            let searched = row.membership.parent.filter(|_| row.membership.is_search());
            let is_of_model = lineage.model_of(searched.unwrap_or(row.id)) == lineage.model_of(id);
            is_of_model && !matches!(row.state, Failed | Cancelled)
        };
        let ids = rows.iter().filter(own).map(|row| row.id).collect();
        Ok(self.store().writer().withdraw(ids, None).await?)
    }

    /// Keeps what people say of a study.
    ///
    /// # Errors
    /// [`ServiceError::Details`] with what is wrong; [`ServiceError::NotFound`].
    pub async fn describe_study(&self, study: i64, details: StudyDetails) -> Result<(), ServiceError> {
        if let Some(fault) = details.fault() {
            return Err(ServiceError::Details(fault));
        }
        let studies = self.store().reader().studies().await?;
        if !studies.iter().any(|stored| stored.id == study) {
            return Err(ServiceError::not_found("study", study));
        }
        Ok(self.store().writer().describe_study(study, details).await?)
    }
}

/// Returns whether a calibration was added to its study, by a person or by the study itself.
fn is_addition(row: &CalibrationRow) -> bool {
    matches!(
        row.membership.change,
        Some(Change::Add(_) | Change::Drop(_) | Change::Runs(_))
    )
}
