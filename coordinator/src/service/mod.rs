//! Store and farm together: submit, recover, control, grow.
//!
//! # Layout
//! - `load`: what is read from the store.
//! - `growth`: what is added to a study that is there.

mod growth;
pub mod load;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use shared::api::{CalibrationCreated, CalibrationState, CalibrationStatus, NewCalibration, NewExperiment};
use shared::exchange::{ExchangeRequest, ExchangeResponse};
use shared::file::{FileError, FileSet};

use crate::calibration::{BeginError, Calibration, Identity};
use crate::farm::dispatch::{Dispatcher, Stopped};
use crate::farm::{Control, ControlError, Farm};
use crate::store::{NewCalibrationRow, NewStudy, Store, StoreError, StudyIds};
use job::{EffectsChanged, Job, Method, Spec, point_job};
use record::CalibrationRow;

/// A lease lasts so long without renewal `[ms]`.
pub const LEASE_MS: u64 = 15_000;
/// So many facts may wait for the store before the service asks for patience.
const BACKLOG: u64 = 200_000;

/// Why the service cannot do what it is asked.
#[derive(Debug, thiserror::Error)]
pub enum ServiceError {
    /// A file is malformed.
    #[error(transparent)]
    File(#[from] FileError),
    /// A calibration cannot begin.
    #[error(transparent)]
    Begin(#[from] BeginError),
    /// The effects are not those that the calibration was computed with.
    #[error(transparent)]
    Effects(#[from] EffectsChanged),
    /// A search has nothing to extend, and no search of its own.
    #[error("calibration {0} is a search for a missing effect: name the calibration that it searches")]
    Search(i64),
    /// No such thing.
    #[error("there is no {what} {id}")]
    NotFound {
        /// What was asked for.
        what: &'static str,
        /// Its id.
        id: String,
    },
    /// The command does not fit.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The store fails.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The operating system refuses a thread.
    #[error("the thread of the farm: {0}")]
    Thread(std::io::Error),
    /// The coordinator is going down.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// More facts wait than the store takes.
    #[error("{0} facts wait to be stored; try again in a second")]
    Busy(u64),
}

/// Store and farm together; clones are cheap.
#[derive(Debug, Clone)]
pub struct Service {
    store: Store,
    dispatcher: Dispatcher,
    left_alone: Arc<BTreeMap<i64, String>>,
    /// Held by whoever adds to a study: each sees what the one before has added.
    growing: Arc<tokio::sync::Mutex<()>>,
}

impl Service {
    /// Opens the store and takes up every calibration that is not over.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn open(path: &str, lease_ms: u64) -> Result<Service, ServiceError> {
        let store = Store::open(path, now_ms()).await?;
        let farm = Farm::new(store.epochs(), lease_ms);
        let dispatcher = Dispatcher::start(farm, store.writer().sink()).map_err(ServiceError::Thread)?;
        let mut service = Service {
            store,
            dispatcher,
            left_alone: Arc::default(),
            growing: Arc::default(),
        };
        service.left_alone = Arc::new(service.recover().await?);
        Ok(service)
    }

    /// Ends farm and writer; everything told so far is stored.
    pub async fn close(&self) {
        self.dispatcher.stop();
        self.store.close().await;
    }

    /// Why this version cannot take up a stored calibration, if it cannot.
    pub fn left_alone(&self, id: i64) -> Option<&str> {
        self.left_alone.get(&id).map(String::as_str)
    }

    /// The store.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// The farm's thread.
    pub fn dispatcher(&self) -> &Dispatcher {
        &self.dispatcher
    }

    /// Takes up what is not over; returns what this version cannot take up, with the reason. Nothing is written
    /// of those: another version may be able to.
    async fn recover(&self) -> Result<BTreeMap<i64, String>, ServiceError> {
        let mut left_alone = BTreeMap::new();
        let reader = self.store.reader();
        for id in reader.unfinished().await? {
            let row = self.calibration_row(id).await?;
            // One calibration that this version cannot take up must not keep the others waiting.
            let spec = match self.spec_of(&row).await {
                Ok(spec) => Arc::new(spec),
                Err(error) => {
                    left_alone.insert(id, error.to_string());
                    continue;
                }
            };
            let fitted = matches!(spec.method, Method::Fit(_) | Method::Discover { .. })
                || spec.method.has_metamodel();
            let stored = reader.stored(id, fitted).await?;
            let evaluations = stored.evaluations.len();
            let identity = Identity {
                id,
                name: row.name.clone(),
                study: row.study,
                experiment: row.experiment,
            };
            let (job, experiment) = (row.job.clone(), self.experiment(row.experiment).await?);
            // Replaying is seconds of CPU for a long calibration: not on the async runtime.
            let replayed = tokio::task::spawn_blocking(move || {
                let mut calibration = Calibration::of(identity, spec, &job, &experiment)?;
                let facts = calibration.replay(stored).map_err(|e| e.to_string());
                Ok::<_, ServiceError>((calibration, facts))
            })
            .await
            .map_err(|_| Stopped)?;
            let (calibration, facts) = replayed?;
            let facts = match facts {
                Ok(facts) => facts,
                Err(reason) => {
                    left_alone.insert(id, reason);
                    continue;
                }
            };
            tracing::info!(
                id,
                name = row.name,
                evaluations,
                state = calibration.state.name(),
                "taken up again"
            );
            self.dispatcher.add(calibration, facts).await?;
        }
        for (id, reason) in &left_alone {
            tracing::error!(id, reason, "left alone: this version cannot take it up");
        }
        Ok(left_alone)
    }

    /// Stores an experiment after validating it; its id.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn add_experiment(&self, new: NewExperiment) -> Result<i64, ServiceError> {
        let files = FileSet {
            toml: new.toml,
            files: new.files,
        };
        shared::experiment::Experiment::parse("experiment.toml", &files)?;
        let json = file_json(&files.files);
        Ok(self
            .store
            .writer()
            .add_experiment(files.toml, json, now_ms())
            .await?)
    }

    /// Stores a calibration after validating it, with the point estimates that its job asks for, and takes them in hand.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn add_calibration(&self, new: NewCalibration) -> Result<CalibrationCreated, ServiceError> {
        let experiment = self.store.reader().experiment(new.experiment).await?;
        let experiment = experiment.ok_or_else(|| ServiceError::NotFound {
            what: "experiment",
            id: new.experiment.to_string(),
        })?;
        let name = new.name.unwrap_or_else(|| "calibration".into());
        let job = FileSet {
            toml: new.toml,
            files: new.files,
        };
        // The samplers are built once before anything is stored: what they refuse leaves nothing half-written.
        let trial = Identity {
            id: 0,
            name,
            study: 0,
            experiment: new.experiment,
        };
        // Reading a stranger's files and drawing a large population from the prior is CPU work: not on the async
        // runtime.
        let members = tokio::task::spawn_blocking(move || members(&trial, &job, &experiment.files));
        let members = members.await.map_err(|_| Stopped)??;
        let row = |(calibration, job): &(Calibration, FileSet)| NewCalibrationRow {
            name: calibration.identity.name.clone(),
            toml: job.toml.clone(),
            files: file_json(&job.files),
        };
        let study = NewStudy {
            experiment: new.experiment,
            calibrations: members.iter().map(row).collect(),
            now_ms: now_ms(),
        };
        let StudyIds { study, calibrations } = self.store.writer().add_study(study).await?;
        for ((mut calibration, _), &id) in members.into_iter().zip(&calibrations) {
            (calibration.identity.id, calibration.identity.study) = (id, study);
            self.dispatcher.add(calibration, Vec::new()).await?;
        }
        let (id, point_estimates) = calibrations.split_first().expect("a study begins with its job");
        Ok(CalibrationCreated {
            id: *id,
            study,
            point_estimates: point_estimates.to_vec(),
        })
    }

    /// A stored calibration.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`] and others.
    pub async fn calibration_row(&self, id: i64) -> Result<CalibrationRow, ServiceError> {
        let row = self.store.reader().calibration(id).await?;
        row.ok_or_else(|| ServiceError::NotFound {
            what: "calibration",
            id: id.to_string(),
        })
    }

    /// The specification of a stored calibration.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn spec_of(&self, row: &CalibrationRow) -> Result<Spec, ServiceError> {
        load::spec_of(&self.store.reader(), row).await
    }

    /// Where a calibration stands.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn status(&self, id: i64) -> Result<CalibrationStatus, ServiceError> {
        if let Some(status) = self.dispatcher.status(id).await? {
            return Ok(status);
        }
        let row = self.calibration_row(id).await?;
        Ok(self.stored_status(&row))
    }

    fn stored_status(&self, row: &CalibrationRow) -> CalibrationStatus {
        let mut status = load::stored_status(row);
        if let Some(reason) = self.left_alone(row.id) {
            status.message = Some(format!("cannot go on with this version: {reason}"));
        }
        status
    }

    /// Where every calibration stands, oldest first.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn list(&self) -> Result<Vec<CalibrationStatus>, ServiceError> {
        let mut in_hand = self.dispatcher.statuses().await?;
        let rows = self.store.reader().calibrations().await?;
        let status =
            |row: &CalibrationRow| in_hand.remove(&row.id).unwrap_or_else(|| self.stored_status(row));
        Ok(rows.iter().map(status).collect())
    }

    /// Carries out a user's command; the answer is durable.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn control(&self, id: i64, control: Control) -> Result<CalibrationState, ServiceError> {
        match self.dispatcher.control(id, control).await? {
            Ok((state, fact)) => {
                self.store.writer().durable(fact).await?;
                Ok(state)
            }
            Err(ControlError::NotInProgress(_)) => {
                let state = self.calibration_row(id).await?.state;
                let verb = match control {
                    Control::Cancel => "cancelled",
                    Control::Pause => "paused",
                    Control::Resume => "resumed",
                };
                Err(ControlError::WrongState { id, state, verb }.into())
            }
            Err(error) => Err(error.into()),
        }
    }

    /// A worker's exchange; the answer is given when its results are durable.
    ///
    /// # Errors
    /// [`ServiceError`].
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

/// The calibrations that a job begins its study with, each with its own job: the job itself, then the point estimates
/// that it asks for.
fn members(
    identity: &Identity,
    job: &FileSet,
    experiment: &FileSet,
) -> Result<Vec<(Calibration, FileSet)>, ServiceError> {
    let file = "job.toml";
    let parsed = Job::parse(file, &job.toml)?;
    parsed.check_files(file, &job.files)?;
    let spec = Spec::of(file, parsed, &job.files, "experiment.toml", experiment)?;
    if matches!(spec.method, Method::Discover { .. }) {
        let message = "[sampler] algorithm = \"discovery\" is a search that a study runs by itself: say apply = \"ask\" or \"auto\" under [discovery]";
        return Err(FileError::whole(file, message).into());
    }
    let point_estimates = spec.point_estimates.clone();
    let mut members = vec![(Calibration::new(identity.clone(), Arc::new(spec))?, job.clone())];
    for method in &point_estimates {
        let job = FileSet {
            toml: point_job(file, &job.toml, method)?,
            files: job.files.clone(),
        };
        let spec = Spec::new(file, &job, "experiment.toml", experiment)?;
        let identity = Identity {
            name: format!("{} ({})", identity.name, method.name()),
            ..identity.clone()
        };
        members.push((Calibration::new(identity, Arc::new(spec))?, job));
    }
    Ok(members)
}

fn file_json(files: &BTreeMap<String, String>) -> String {
    serde_json::to_string(files).expect("text has a JSON form")
}

/// Wall-clock time, for the record alone: nothing is decided by it.
pub fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}
