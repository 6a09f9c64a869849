//! Archiving, restoring and deletion of studies, and the deletion of studies that were archived long ago.

use std::time::Duration;

use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;

/// Interval between searches for archived studies that are due for deletion.
const LOOK: Duration = Duration::from_secs(600);
/// Milliseconds of a day.
const DAY_MS: i64 = 86_400_000;

impl Service {
    /// Deletes a study with its calibrations, and with its experiments if no other study has them. Returns the calibrations.
    ///
    /// # Errors
    /// [`ServiceError::InProgress`] where one of its calibrations is not over.
    pub async fn delete_study(&self, study: i64) -> Result<Vec<i64>, ServiceError> {
        let _growing = self.growing.lock().await;
        self.delete_at_rest(study).await
    }

    /// Deletes a study while nothing can be added to it. The caller holds the lock of additions.
    async fn delete_at_rest(&self, study: i64) -> Result<Vec<i64>, ServiceError> {
        let calibrations = self.at_rest(study, "deleted").await?;
        let writer = self.store().writer();
        // An interrupted deletion leaves an archived study, which does not grow after a restart either.
        writer.archive_study(study, Some(now_ms())).await?;
        writer.delete_study(study, now_ms()).await?;
        Ok(calibrations)
    }

    /// Deletes a study that was archived before a time and still is. Returns `None` if it is not.
    async fn delete_archived(&self, study: i64, until_ms: i64) -> Result<Option<Vec<i64>>, ServiceError> {
        let _growing = self.growing.lock().await;
        let archived = self.store().reader().archived().await?;
        match archived
            .iter()
            .any(|&(id, at_ms)| id == study && at_ms <= until_ms)
        {
            true => self.delete_at_rest(study).await.map(Some),
            false => Ok(None),
        }
    }

    /// Archives a study: it is left out of the lists and no longer grows. Its results stay.
    ///
    /// # Errors
    /// The same as of [`Service::delete_study`].
    pub async fn archive_study(&self, study: i64) -> Result<(), ServiceError> {
        let _growing = self.growing.lock().await;
        self.at_rest(study, "archived").await?;
        Ok(self.store().writer().archive_study(study, Some(now_ms())).await?)
    }

    /// Restores an archived study to the lists.
    ///
    /// # Errors
    /// The same as of [`Service::delete_study`].
    pub async fn restore_study(&self, study: i64) -> Result<(), ServiceError> {
        let _growing = self.growing.lock().await;
        self.at_rest(study, "restored").await?;
        if self.store().reader().half_deleted().await?.contains(&study) {
            return Err(ServiceError::not_found("study", study));
        }
        Ok(self.store().writer().archive_study(study, None).await?)
    }

    /// Returns the calibrations of a study. Refuses a study with a calibration in the farm.
    async fn at_rest(&self, study: i64, verb: &'static str) -> Result<Vec<i64>, ServiceError> {
        let studies = self.store().reader().studies().await?;
        let stored = studies.into_iter().find(|stored| stored.id == study);
        let calibrations = stored
            .ok_or_else(|| ServiceError::not_found("study", study))?
            .calibrations;
        let (first, last) = (calibrations.iter().min(), calibrations.iter().max());
        let ids = first.copied().unwrap_or_default()..=last.copied().unwrap_or_default();
        let in_hand = self.dispatcher().statuses(ids).await?;
        match calibrations.iter().find_map(|id| in_hand.get(id)) {
            None => Ok(calibrations),
            Some(status) => Err(ServiceError::InProgress {
                study,
                calibration: status.id,
                state: status.state,
                verb,
            }),
        }
    }

    /// Refuses an archived study, which does not grow.
    pub(super) async fn check_not_archived(&self, study: i64) -> Result<(), ServiceError> {
        let archived = self.store().reader().archived().await?;
        match archived.iter().any(|&(id, _)| id == study) {
            true => Err(ServiceError::Archived(study)),
            false => Ok(()),
        }
    }

    /// Finishes deletions that an end of the service has interrupted. With a number of days, then deletes studies that were archived that
    /// long ago, until the service ends.
    pub async fn keep_tidy(&self, days: Option<u32>) {
        match self.store().reader().half_deleted().await {
            Ok(studies) => {
                for study in studies {
                    let deleted = self.delete_study(study).await.map(Some);
                    log_deletion(study, deleted, "its deletion was cut short");
                }
            }
            Err(error) => tracing::error!(%error, "failed to read the deletions"),
        }
        loop {
            let Some(days) = days else {
                return std::future::pending().await;
            };
            let until_ms = now_ms() - i64::from(days) * DAY_MS;
            let archived = self.store().reader().archived().await;
            let archived = archived.unwrap_or_else(|error| {
                tracing::error!(%error, "failed to read the archived studies");
                Vec::new()
            });
            for (study, _) in archived.into_iter().filter(|&(_, at_ms)| at_ms <= until_ms) {
                let deleted = self.delete_archived(study, until_ms).await;
                log_deletion(study, deleted, &format!("archived {days} days ago"));
            }
            tokio::time::sleep(LOOK).await;
        }
    }
}

fn log_deletion(study: i64, deleted: Result<Option<Vec<i64>>, ServiceError>, reason: &str) {
    match deleted {
        Ok(Some(calibrations)) => tracing::info!(study, ?calibrations, reason, "deleted"),
        Ok(None) => tracing::info!(study, "restored before it was deleted"),
        Err(error) => tracing::error!(study, %error, reason, "failed to delete a study"),
    }
}
