//! The service: store and farm together, for lists, status, control and results of calibrations.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::exchange::{ExchangeRequest, ExchangeResponse};
use shared::file::FileSet;

use super::campaign::Campaigns;
use super::clock::now_ms;
use super::error::ServiceError;
use super::farm_settings::{FarmSettings, LEASE_MS};
use super::recovery::{recover, rewind};
use super::result_cache::ResultCache;
use super::stored_calibration;
use crate::webhook::WebhookHosts;
use farm::calibration::{Calibration, VerificationRule};
use farm::dispatch::Dispatcher;
use farm::{Control, ControlError, Farm};
use job::Spec;
use record::CalibrationRow;
use store::{IdPage, ListedCalibration, Store, StoreError};

/// The number of facts waiting for the store above which workers must wait.
const BACKLOG: u64 = 200_000;

/// Store and farm together; clones are cheap.
#[derive(Debug, Clone)]
pub struct Service {
    store: Store,
    dispatcher: Dispatcher,
    rule: VerificationRule,
    left_alone: Arc<BTreeMap<i64, String>>,
    pub(super) webhook_hosts: WebhookHosts,
    pub(super) results: ResultCache,
    pub(super) campaigns: Campaigns,
    /// A lock that a task holds while it adds to a study, so that it sees all earlier additions.
    pub(super) growing: Arc<tokio::sync::Mutex<()>>,
}

impl Service {
    /// Opens the store and resumes every calibration that is not over.
    pub async fn open(path: &str, settings: FarmSettings) -> Result<Service, ServiceError> {
        let store = Store::open(path, now_ms()).await?;
        let farm = Farm::new(store.epoch(), settings.lease_ms).with_rule(settings.rule.clone());
        let farm = farm.with_quarantine(store.reader().quarantine().await?);
        let (dispatcher, rewinds) =
            Dispatcher::start(farm, store.writer().sink()).map_err(ServiceError::Thread)?;
        let left_alone = Arc::new(recover(&store, &dispatcher, &settings.rule).await?);
        let rewind = rewind(store.clone(), dispatcher.clone(), rewinds, settings.rule.clone());
        tokio::spawn(rewind);
        let results = ResultCache::new(&store);
        Ok(Service {
            store,
            dispatcher,
            rule: settings.rule,
            left_alone,
            webhook_hosts: WebhookHosts::default(),
            results,
            campaigns: Campaigns::default(),
            growing: Arc::default(),
        })
    }

    /// Sets the hosts that web hooks may be posted to.
    #[must_use]
    pub fn with_webhook_hosts(self, hosts: Vec<String>) -> Service {
        Service {
            webhook_hosts: WebhookHosts(hosts),
            ..self
        }
    }

    /// Opens the store for reading alone. No calibration is in progress, and every write is refused.
    pub async fn open_read_only(path: &str) -> Result<Service, ServiceError> {
        let store = Store::open_read_only(path).await?;
        let farm = Farm::new(store.epoch(), LEASE_MS);
        let (dispatcher, _) = Dispatcher::start(farm, store.writer().sink()).map_err(ServiceError::Thread)?;
        let results = ResultCache::new(&store);
        Ok(Service {
            store,
            dispatcher,
            rule: VerificationRule::default(),
            left_alone: Arc::default(),
            webhook_hosts: WebhookHosts::default(),
            results,
            campaigns: Campaigns::default(),
            growing: Arc::default(),
        })
    }

    /// Ends farm and writer after all facts so far are stored.
    pub async fn close(&self) {
        self.dispatcher.stop();
        self.store.close().await;
    }

    /// Returns the reason why a stored calibration could not be resumed.
    pub fn left_alone(&self, id: i64) -> Option<&str> {
        self.left_alone.get(&id).map(String::as_str)
    }

    /// Returns the number of calibrations that could not be resumed.
    pub fn count_left_alone(&self) -> usize {
        self.left_alone.len()
    }

    pub fn store(&self) -> &Store {
        &self.store
    }

    pub fn dispatcher(&self) -> &Dispatcher {
        &self.dispatcher
    }

    /// Gives a stored calibration to the farm.
    pub(super) async fn take_in_hand(&self, calibration: Calibration) -> Result<(), ServiceError> {
        let key = self.store.reader().seal_key(calibration.identity.id).await?;
        let calibration = calibration.verified(&self.rule, key);
        Ok(self.dispatcher.add(calibration, key, Vec::new()).await?)
    }

    pub async fn calibration_row(&self, id: i64) -> Result<CalibrationRow, ServiceError> {
        stored_calibration::calibration_row(&self.store.reader(), id).await
    }

    /// Returns the specification of a stored calibration.
    pub async fn spec_of(&self, row: &CalibrationRow) -> Result<Spec, ServiceError> {
        stored_calibration::spec_of(&self.store.reader(), row).await
    }

    pub async fn experiment(&self, id: i64) -> Result<FileSet, ServiceError> {
        stored_calibration::experiment_files(&self.store.reader(), id).await
    }

    pub async fn status(&self, id: i64) -> Result<CalibrationStatus, ServiceError> {
        if let Some(status) = self.dispatcher.status(id).await? {
            return Ok(status);
        }
        let row = self.store.reader().calibration(id).await.transpose();
        let row = row.ok_or_else(|| ServiceError::not_found("calibration", id))?;
        Ok(self.stored_status(id, &row))
    }

    fn stored_status(&self, id: i64, row: &Result<CalibrationRow, StoreError>) -> CalibrationStatus {
        let mut status = stored_calibration::stored_status(id, row);
        if let Some(reason) = self.left_alone(id) {
            status.state = CalibrationState::Paused;
            status.message = Some(format!("cannot be resumed: {reason}"));
        }
        status
    }

    /// Returns the states of calibrations, oldest first; those of archived studies on request.
    pub async fn list(
        &self,
        with_archived: bool,
        page: IdPage,
    ) -> Result<Vec<CalibrationStatus>, ServiceError> {
        let reader = self.store.reader();
        let hidden: BTreeSet<i64> = match with_archived {
            true => BTreeSet::new(),
            false => reader
                .archived()
                .await?
                .into_iter()
                .map(|(study, _)| study)
                .collect(),
        };
        let mut listed = Vec::new();
        let mut rest = Some(page);
        // Those of archived studies are in the way of a full page.
        while let Some(part) = rest {
            let rows = reader.calibrations(part).await?;
            let last = rows.last().filter(|_| rows.len() as i64 == part.limit);
            let last = last.map(|&(id, _)| id);
            let shown = self.statuses(rows).await?.into_iter();
            listed.extend(shown.filter(|status| !hidden.contains(&status.study)));
            rest = last.and_then(|last| page.rest(last, listed.len()));
        }
        listed.truncate(usize::try_from(page.limit).unwrap_or(usize::MAX));
        Ok(listed)
    }

    /// Returns the states of stored calibrations, which are in the order of their ids.
    ///
    /// A row that was read before the farm is asked is stale where its calibration has ended in between: it is read again.
    pub(super) async fn statuses(
        &self,
        mut rows: Vec<ListedCalibration>,
    ) -> Result<Vec<CalibrationStatus>, ServiceError> {
        let (Some((first, _)), Some((last, _))) = (rows.first(), rows.last()) else {
            return Ok(Vec::new());
        };
        let mut in_hand = self.dispatcher.statuses(*first..=*last).await?;
        for (id, row) in &mut rows {
            let id = *id;
            let is_over = row.as_ref().is_ok_and(|row| row.state.is_final());
            if !is_over
                && !in_hand.contains_key(&id)
                && self.left_alone(id).is_none()
                && let Some(read) = self.store.reader().calibration(id).await.transpose()
            {
                *row = read;
            }
        }
        let status = |(id, row): &ListedCalibration| {
            let in_hand = in_hand.remove(id);
            in_hand.unwrap_or_else(|| self.stored_status(*id, row))
        };
        Ok(rows.iter().map(status).collect())
    }

    /// Executes a user's command, and answers when its effect is stored.
    pub async fn control(&self, id: i64, control: Control) -> Result<CalibrationState, ServiceError> {
        match self.dispatcher.control(id, control.clone()).await? {
            Ok((state, fact)) => {
                self.store.writer().durable(fact).await?;
                Ok(state)
            }
            Err(ControlError::NotInProgress(_)) => {
                if let Some(reason) = self.left_alone(id) {
                    let reason = reason.to_owned();
                    return Err(ServiceError::LeftAlone { id, reason });
                }
                let state = self.calibration_row(id).await?.state;
                let verb = match control {
                    Control::Cancel => "cancelled",
                    Control::Pause => "paused",
                    Control::Resume { .. } | Control::ComputeWith(_) => "resumed",
                };
                Err(ControlError::WrongState { id, state, verb }.into())
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Takes the results of a worker and gives it leases, and answers when the results are stored.
    pub async fn exchange(&self, request: ExchangeRequest) -> Result<ExchangeResponse, ServiceError> {
        let backlog = self.store.writer().backlog();
        if backlog > BACKLOG {
            return Err(ServiceError::Busy(backlog));
        }
        let (response, fact) = self.dispatcher.exchange(request).await?;
        self.store.writer().durable(fact).await?;
        Ok(response)
    }
}

#[cfg(test)]
mod tests {
    use shared::api::{NewCalibration, NewExperiment};

    use super::*;
    use crate::example::EXAMPLES;

    #[tokio::test]
    async fn a_row_that_was_read_before_its_calibration_ended_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("grouser.db").display().to_string();
        let settings = FarmSettings {
            lease_ms: LEASE_MS,
            rule: VerificationRule::default(),
        };
        let service = Service::open(&store, settings).await.unwrap();
        let example = EXAMPLES[1];
        let text_of = |&(name, text): &(&str, &str)| (name.to_owned(), text.to_owned());
        let experiment = NewExperiment {
            toml: example.experiment.1.into(),
            files: example.files.iter().map(text_of).collect(),
        };
        let new = NewCalibration {
            experiment: service.add_experiment(experiment).await.unwrap(),
            toml: example.job.1.into(),
            files: BTreeMap::new(),
            name: None,
            webhook: None,
        };
        let id = service.add_calibration(new).await.unwrap().id;
        let rows = service.store().reader().calibrations(IdPage::ALL).await.unwrap();
        service.control(id, Control::Cancel).await.unwrap();
        let listed = service.statuses(rows).await.unwrap();
        let cancelled = listed.iter().find(|status| status.id == id).unwrap();
        assert_eq!(cancelled.state, CalibrationState::Cancelled);
        service.close().await;
    }
}
