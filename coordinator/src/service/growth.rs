//! Additions to a study: extensions, further runs, searches, and the next steps of a study.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::api::{CalibrationCreated, RunsAdded};
use shared::experiment::Experiment;
use shared::file::FileSet;

use super::clock::now_ms;
use super::compared_models::passed_over;
use super::error::ServiceError;
use super::handle::Service;
use super::stored_calibration::has_posterior;
use super::study_step::{next_step_of, search_of};
use crate::calibration::{Calibration, CalibrationIdentity};
use crate::farm::dispatch::Stopped;
use crate::missing_effect::candidate::extended;
use crate::store::NewCalibrationRow;
use crate::study::StudyStep;
use job::{Spec, continued_job, discovery_job, is_discovery, without_effects};
use record::CalibrationRow;
use record::Extension;
use record::effect_of;

/// How job and experiment are called in messages.
const FILES: [&str; 2] = ["job.toml", "experiment.toml"];

impl Service {
    /// Adds a calibration to the study of another: its job with an effect more; one that is there already is meant.
    ///
    /// # Errors
    /// [`ServiceError`]: the effect is unknown, or stands there already.
    pub async fn extend(&self, id: i64, extension: Extension) -> Result<CalibrationCreated, ServiceError> {
        let _growing = self.growing.lock().await;
        let extension = self.of_own_effect(extension).await?;
        self.extended(id, &extension).await
    }

    async fn extended(&self, id: i64, extension: &Extension) -> Result<CalibrationCreated, ServiceError> {
        use shared::api::CalibrationState::{Cancelled, Failed};
        let row = self.searchable(id).await?;
        let job = extended(FILES[0], &row.job, &[extension])?;
        let job = continued_job(FILES[0], &job)?;
        let name = match extension {
            Extension::OnWheel { wheel, .. } => format!("{}+{}.{wheel}", row.name, effect_of(extension)),
            _ => format!("{}+{}", row.name, effect_of(extension)),
        };
        // The same model on the same measurements is one calibration, unless it ended without a result.
        let members = self.store().reader().study(row.study).await?;
        let same = members.iter().find(|member| {
            let is_over = matches!(member.state, Failed | Cancelled);
            member.experiment == row.experiment && member.job == job && !is_over
        });
        match same {
            Some(member) => Ok(CalibrationCreated {
                id: member.id,
                study: member.study,
                point_estimates: Vec::new(),
            }),
            None => self.add_member(&row, row.experiment, name, job).await,
        }
    }

    /// Adds measurements to a study: an experiment with the rows of a CSV more, and the job of a calibration on it, of the last of
    /// its ledger where none is named.
    ///
    /// # Errors
    /// [`ServiceError`]: a row is malformed, or its run stands there already.
    pub async fn add_runs(
        &self,
        study: i64,
        csv: String,
        calibration: Option<i64>,
    ) -> Result<RunsAdded, ServiceError> {
        let _growing = self.growing.lock().await;
        let rows = self.store().reader().study(study).await?;
        let (mut ledger, mut beside) = (None, None);
        let passed_over = passed_over(&rows)?;
        let meant = |row: &&CalibrationRow| match calibration {
            Some(id) => id == row.id,
            None => !passed_over.contains(&row.id),
        };
        for row in rows
            .iter()
            .filter(|row| !is_discovery(&row.job.toml))
            .filter(meant)
        {
            let spec = self.spec_of(row).await?;
            match has_posterior(&self.store().reader(), row, &spec).await? {
                true => ledger = Some(row),
                false => beside = Some(row),
            }
        }
        let (Some(last), Some(newest)) = (ledger.or(beside), rows.last()) else {
            return Err(ServiceError::not_found("study", study));
        };
        let experiment = self.experiment(newest.experiment).await?;
        let enlarged =
            tokio::task::spawn_blocking(move || Experiment::with_runs(FILES[1], &experiment, &csv));
        let (enlarged, runs) = enlarged.await.map_err(|_| Stopped)??;
        let job = continued_job(FILES[0], &last.job)?;
        // Refused before anything is stored.
        let name = format!("{} ({runs} runs)", last.name);
        let member = self.prepared(last, 0, name, job, enlarged.clone()).await?;
        let experiment = self.store().writer().add_experiment(enlarged, now_ms()).await?;
        let created = self.take_in(member, experiment).await?;
        Ok(RunsAdded {
            id: created.id,
            study,
            experiment,
        })
    }

    /// Adds the search of a calibration's model for a missing effect; one that is there already, unless it ended without a
    /// record, is meant.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn discover(&self, id: i64) -> Result<CalibrationCreated, ServiceError> {
        let _growing = self.growing.lock().await;
        self.searched(id).await
    }

    async fn searched(&self, id: i64) -> Result<CalibrationCreated, ServiceError> {
        use shared::api::CalibrationState::{Cancelled, Failed};
        let row = self.searchable(id).await?;
        match search_of(&self.store().reader(), &row).await? {
            Some(search) if !matches!(search.state, Failed | Cancelled) => Ok(CalibrationCreated {
                id: search.id,
                study: search.study,
                point_estimates: Vec::new(),
            }),
            _ => {
                let job = discovery_job(FILES[0], &row.job)?;
                let name = format!("{} (discovery)", row.name);
                self.add_member(&row, row.experiment, name, job).await
            }
        }
    }

    /// Takes the next step of a study; whether there was one.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn advance(&self, study: i64) -> Result<bool, ServiceError> {
        let _growing = self.growing.lock().await;
        let Some(step) = next_step_of(&self.store().reader(), study).await? else {
            return Ok(false);
        };
        match step {
            StudyStep::Search(id) => self.searched(id).await?,
            StudyStep::Extend(id, extension) => self.extended(id, &extension).await?,
            StudyStep::Drop(id, effects) => {
                let row = self.calibration_row(id).await?;
                let job = without_effects(FILES[0], &row.job, &effects)?;
                let name = format!("{}-{}", row.name, effects.join("-"));
                self.add_member(&row, row.experiment, name, job).await?
            }
        };
        Ok(true)
    }

    /// Extends studies by their next steps until the service ends.
    pub async fn keep_growing(&self) {
        // Members of each study when it was last seen to have no next step.
        let mut at_rest: BTreeMap<i64, i64> = BTreeMap::new();
        let mut changes = self.study_changes();
        loop {
            changes.next().await;
            let settled = match self.store().reader().settled_studies().await {
                Ok(settled) => settled,
                Err(error) => {
                    tracing::error!(%error, "failed to read the studies");
                    changes.look_again();
                    continue;
                }
            };
            for (study, members) in settled {
                if at_rest.get(&study) == Some(&members) {
                    continue;
                }
                match self.advance(study).await {
                    Ok(true) => changes.look_again(),
                    Ok(false) => drop(at_rest.insert(study, members)),
                    Err(error) => {
                        tracing::error!(study, %error, "failed to extend the study");
                        at_rest.insert(study, members);
                    }
                }
            }
        }
    }

    /// A calibration that can be extended and searched.
    pub(super) async fn searchable(&self, id: i64) -> Result<CalibrationRow, ServiceError> {
        let row = self.calibration_row(id).await?;
        match is_discovery(&row.job.toml) {
            true => Err(ServiceError::Search(id)),
            false => Ok(row),
        }
    }

    /// Stores a calibration beside another of its study, and takes it in hand.
    async fn add_member(
        &self,
        beside: &CalibrationRow,
        experiment: i64,
        name: String,
        job: FileSet,
    ) -> Result<CalibrationCreated, ServiceError> {
        let files = self.experiment(experiment).await?;
        let member = self.prepared(beside, experiment, name, job, files).await?;
        self.take_in(member, experiment).await
    }

    /// A calibration of the study of another, validated but not stored.
    async fn prepared(
        &self,
        beside: &CalibrationRow,
        experiment: i64,
        name: String,
        job: FileSet,
        files: FileSet,
    ) -> Result<(Calibration, FileSet), ServiceError> {
        self.check_not_archived(beside.study).await?;
        let identity = CalibrationIdentity {
            id: 0,
            name,
            study: beside.study,
            experiment,
        };
        let member = tokio::task::spawn_blocking(move || {
            let spec = Spec::new(FILES[0], &job, FILES[1], &files)?;
            let calibration = Calibration::of(identity, Arc::new(spec), &job, &files)?;
            Ok::<_, ServiceError>((calibration, job))
        });
        member.await.map_err(|_| Stopped)?
    }

    async fn take_in(
        &self,
        (mut calibration, job): (Calibration, FileSet),
        experiment: i64,
    ) -> Result<CalibrationCreated, ServiceError> {
        let identity = &mut calibration.identity;
        let row = NewCalibrationRow {
            name: identity.name.clone(),
            job,
        };
        let study = identity.study;
        let id = self
            .store()
            .writer()
            .add_member(study, experiment, row, now_ms())
            .await?;
        (identity.id, identity.experiment) = (id, experiment);
        self.take_in_hand(calibration).await?;
        Ok(CalibrationCreated {
            id,
            study,
            point_estimates: Vec::new(),
        })
    }
}
