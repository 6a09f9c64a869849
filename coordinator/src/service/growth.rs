//! Additions to a study: extensions, further runs, searches, and the next steps of a study.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::api::{CalibrationCreated, RunsAdded};
use shared::experiment::Experiment;
use shared::file::FileSet;

use super::background::in_background;
use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;
use super::stored_calibration::{FILES, has_posterior};
use super::submission::role_of;
use crate::study::{Lineage, StudyStep, most_probable};
use farm::calibration::{Calibration, CalibrationIdentity};
use job::{Job, Spec, continued_job, effect_name, with_candidates, without_effects};
use record::{CalibrationRow, Change, Extension, Membership, addition_name};
use search::candidate::extended;
use store::NewCalibrationRow;

impl Service {
    /// Adds a calibration to the study of another, with one more effect in its job. If the study has such a calibration already, the answer
    /// names it.
    ///
    /// # Errors
    /// [`ServiceError`]: the effect is unknown, or the job has it already.
    pub async fn extend(&self, id: i64, extension: Extension) -> Result<CalibrationCreated, ServiceError> {
        let _growing = self.growing.lock().await;
        let extension = match self.candidate_in_file(id, &extension).await? {
            Some(candidate) => candidate,
            None => self.with_user_effect(extension).await?,
        };
        self.extended(id, &extension).await
    }

    /// Returns the effect that the search of a calibration's model tried as a file; `None` if it tried none of this name.
    async fn candidate_in_file(
        &self,
        id: i64,
        extension: &Extension,
    ) -> Result<Option<Extension>, ServiceError> {
        let Extension::Effect(named) = extension else {
            return Ok(None);
        };
        let row = self.calibration_row(id).await?;
        let rows = self.store().reader().study(row.study).await?;
        let Some(search) = Lineage::new(&rows).search_of(id) else {
            return Ok(None);
        };
        let mut files = search.job.files.iter();
        let candidate = files.find(|(_, text)| effect_name(text).as_deref() == Some(named.as_str()));
        Ok(candidate.map(|(name, text)| Extension::File {
            name: name.clone(),
            text: text.clone(),
        }))
    }

    async fn extended(&self, id: i64, extension: &Extension) -> Result<CalibrationCreated, ServiceError> {
        let row = self.searchable(id).await?;
        let change = Change::Add(extension.clone());
        let rows = self.store().reader().study(row.study).await?;
        if let Some(member) = Lineage::new(&rows).existing(id, &change) {
            self.take_in_again(&rows, member.id).await?;
            return Ok(created(member));
        }
        let job = extended(FILES[0], &row.job, &[extension])?;
        let job = continued_job(FILES[0], &job)?;
        let name = format!("{}+{}", row.name, addition_name(extension));
        self.add_member(&row, change, row.experiment, name, job).await
    }

    /// Adds measurements to a study: an experiment with further rows of CSV, and a calibration on it with the job of the given calibration,
    /// or of the last one of the ledger.
    ///
    /// # Errors
    /// [`ServiceError`]: a row is malformed, or its run exists already.
    pub async fn add_runs(
        &self,
        study: i64,
        csv: String,
        calibration: Option<i64>,
    ) -> Result<RunsAdded, ServiceError> {
        let _growing = self.growing.lock().await;
        let (rows, _) = self.store().reader().members_and_withdrawn(study).await?;
        let (mut ledger, mut beside) = (None, None);
        let passed_over = passed_over(&rows);
        let is_candidate = |row: &&CalibrationRow| match calibration {
            Some(id) => id == row.id,
            None => !passed_over.contains(&row.id),
        };
        for row in Lineage::new(&rows).calibrations().filter(is_candidate) {
            match has_posterior(&self.store().reader(), row).await? {
                true => ledger = Some(row),
                false => beside = Some(row),
            }
        }
        let (Some(last), Some(newest)) = (ledger.or(beside), rows.last()) else {
            return Err(ServiceError::not_found("study", study));
        };
        let experiment = self.experiment(newest.experiment).await?;
        let enlarge = move || Ok::<_, ServiceError>(Experiment::with_runs(FILES[1], &experiment, &csv)?);
        let (enlarged, runs) = in_background(enlarge).await?;
        let job = continued_job(FILES[0], &last.job)?;
        // The job is validated before anything is stored.
        let name = format!("{} ({runs} runs)", last.name);
        let change = Some(Change::Runs(runs));
        let member = self
            .prepared(last, change, 0, name, job, enlarged.clone())
            .await?;
        let experiment = self.store().writer().add_experiment(enlarged, now_ms()).await?;
        let created = self.take_in(member, experiment).await?;
        Ok(RunsAdded {
            id: created.id,
            study,
            experiment,
        })
    }

    /// Adds the search of a calibration's model for a missing effect. If the study has this search already, the answer names it, unless it
    /// ended without a record.
    pub async fn discover(&self, id: i64) -> Result<CalibrationCreated, ServiceError> {
        let _growing = self.growing.lock().await;
        self.searched(id).await
    }

    async fn searched(&self, id: i64) -> Result<CalibrationCreated, ServiceError> {
        use shared::api::CalibrationState::{Cancelled, Failed};
        let row = self.searchable(id).await?;
        let rows = self.store().reader().study(row.study).await?;
        match Lineage::new(&rows).search_of(id) {
            Some(search) if !matches!(search.state, Failed | Cancelled) => Ok(created(search)),
            _ => {
                let job = continued_job(FILES[0], &row.job)?;
                let job = with_candidates(FILES[0], &job, &self.library_files().await?)?;
                let name = format!("{} (discovery)", row.name);
                let files = self.experiment(row.experiment).await?;
                let search = self
                    .prepared(&row, None, row.experiment, name, job, files)
                    .await?;
                self.take_in(search, row.experiment).await
            }
        }
    }

    /// Takes the next step of a study, and returns whether there was one.
    pub async fn advance(&self, study: i64) -> Result<bool, ServiceError> {
        let _growing = self.growing.lock().await;
        let Some(step) = self.next_step(study).await? else {
            return Ok(false);
        };
        match step {
            StudyStep::Search(id) => self.searched(id).await?,
            StudyStep::Extend(id, extension) => self.extended(id, &extension).await?,
            StudyStep::Drop(id, effects) => {
                let row = self.calibration_row(id).await?;
                let job = without_effects(FILES[0], &row.job, &effects)?;
                let name = format!("{}-{}", row.name, effects.join("-"));
                self.add_member(&row, Change::Drop(effects), row.experiment, name, job)
                    .await?
            }
        };
        Ok(true)
    }

    /// Extends studies by their next steps until the service ends.
    pub async fn keep_growing(&self) {
        // The number of members of each study when it last had no next step.
        let mut at_rest: BTreeMap<i64, i64> = BTreeMap::new();
        let mut changes = self.study_changes();
        loop {
            changes.next().await;
            let finished = match self.store().reader().finished_studies().await {
                Ok(finished) => finished,
                Err(error) => {
                    tracing::error!(%error, "failed to read the studies");
                    changes.look_again();
                    continue;
                }
            };
            for (study, members) in finished {
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

    /// Reads a calibration that can be extended and searched.
    pub(super) async fn searchable(&self, id: i64) -> Result<CalibrationRow, ServiceError> {
        let row = self.calibration_row(id).await?;
        match row.membership.is_search() {
            true => Err(ServiceError::Search(id)),
            false => Ok(row),
        }
    }

    /// Stores a calibration that differs from its parent by a change, and gives it to the farm.
    async fn add_member(
        &self,
        parent: &CalibrationRow,
        change: Change,
        experiment: i64,
        name: String,
        job: FileSet,
    ) -> Result<CalibrationCreated, ServiceError> {
        let files = self.experiment(experiment).await?;
        let member = self
            .prepared(parent, Some(change), experiment, name, job, files)
            .await?;
        self.take_in(member, experiment).await
    }

    /// Validates, without storing, a calibration that differs from its parent by a change, or the search of its parent's model.
    async fn prepared(
        &self,
        parent: &CalibrationRow,
        change: Option<Change>,
        experiment: i64,
        name: String,
        job: FileSet,
        files: FileSet,
    ) -> Result<(Calibration, NewCalibrationRow), ServiceError> {
        self.check_not_archived(parent.study).await?;
        let identity = CalibrationIdentity {
            id: 0,
            name: name.clone(),
            study: parent.study,
            experiment,
        };
        let parent = parent.id;
        let member = in_background(move || {
            let [job_name, experiment_name] = FILES;
            let value = Job::read(job_name, &job)?;
            let (value, membership) = match change {
                None => (value.into_search(), Membership::search_of(parent)),
                Some(change) => {
                    let role = role_of(&value.algorithm);
                    (value, Membership::changed(role, parent, change))
                }
            };
            let measured = Arc::new(Experiment::parse(experiment_name, &files)?);
            let spec = Spec::from_values(job_name, value, experiment_name, measured)?;
            let calibration = Calibration::from_files(identity, Arc::new(spec), &job, &files)?;
            let row = NewCalibrationRow {
                membership,
                name,
                job,
            };
            Ok::<_, ServiceError>((calibration, row))
        });
        member.await
    }

    async fn take_in(
        &self,
        (mut calibration, row): (Calibration, NewCalibrationRow),
        experiment: i64,
    ) -> Result<CalibrationCreated, ServiceError> {
        let identity = &mut calibration.identity;
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

/// Makes the answer for an existing calibration, which is the same as for a new one.
fn created(row: &CalibrationRow) -> CalibrationCreated {
    CalibrationCreated {
        id: row.id,
        study: row.study,
        point_estimates: Vec::new(),
    }
}

/// Returns the compared models with which a study does not continue: all but the one with the largest evidence.
fn passed_over(rows: &[CalibrationRow]) -> Vec<i64> {
    let compared = Lineage::new(rows).compared();
    let best = most_probable(compared.iter().map(|row| row.log_evidence));
    let ids = compared.iter().map(|row| row.id).enumerate();
    let losing = ids.filter(|(number, _)| compared.len() > 1 && Some(*number) != best);
    losing.map(|(_, id)| id).collect()
}
