//! The laws that joined the library: effects that every later search tries, with what the studies say of them.

use std::collections::{BTreeMap, BTreeSet};

use formula::Effect;
use shared::api::NewLibraryLaw;
use shared::experiment::{Experiment, TestRun};
use shared::file::FileError;
use shared::model::effects::read_user_effect;

use super::background::in_background;
use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;
use crate::effect::library::{LawInStudy, LibraryLaw, Standing};
use job::{ServiceEffect, check_candidate, effect_with_origin};
use record::{CalibrationRow, Discovery};
use result::discovery::law_files;
use store::{LibraryChange, LibraryRow, StoreError, StoredEffect};

impl Service {
    /// Returns the laws of the library, by name.
    ///
    /// # Errors
    /// [`ServiceError`] of the store.
    pub async fn library(&self) -> Result<Vec<LibraryLaw>, ServiceError> {
        let mut laws = Vec::new();
        for row in self.store().reader().library().await? {
            laws.extend(self.library_law(row).await?);
        }
        Ok(laws)
    }

    /// Adds a law to the library: an effect file, or a law that a search found. An effect of that name gets a new version, and evidence
    /// for another text of that name does not count for it.
    ///
    /// # Errors
    /// [`ServiceError`]: the file is malformed or has no strength, its name belongs to the catalogue, or the search found no law of this
    /// name.
    pub async fn add_to_library(
        &self,
        new: NewLibraryLaw,
        by: Option<String>,
    ) -> Result<LibraryLaw, ServiceError> {
        let (text, found_in) = match (new.text, new.calibration, new.law) {
            (Some(text), None, None) => {
                let text = match &new.name {
                    Some(name) => effect_with_origin(LAW, &text, Some(name), None)?,
                    None => text,
                };
                (text, None)
            }
            (None, Some(calibration), law) => {
                let (text, study) = self.law_of_search(calibration, law.as_deref(), new.name).await?;
                (text, Some(study))
            }
            _ => {
                let message = "a law is {\"text\": TEXT}, the text of an effect file, or {\"calibration\": ID}, whose search found it";
                return Err(ServiceError::Details(message.to_owned()));
            }
        };
        check_law(&text)?;
        let added = self.add_effect(text, by.clone()).await?;
        let rows = self.store().reader().library().await?;
        // A law that joins a second time, unchanged, was still found where it was found.
        let before = rows
            .into_iter()
            .find(|row| row.name == added.name && !added.is_new);
        let row = LibraryRow {
            name: added.name,
            added_at_ms: now_ms(),
            added_by: by,
            found_in: found_in.or(before.and_then(|row| row.found_in)),
        };
        let change = LibraryChange::Add(row.clone());
        self.store().writer().change_library(change).await?;
        let law = self.library_law(row.clone()).await?;
        law.ok_or_else(|| no_law(row.name))
    }

    /// Removes a law from the library; its effect stays in the catalogue of the service.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`] if the library has no law of this name.
    pub async fn remove_from_library(&self, name: &str) -> Result<(), ServiceError> {
        let rows = self.store().reader().library().await?;
        if !rows.iter().any(|row| row.name == name) {
            return Err(no_law(name.to_owned()));
        }
        let change = LibraryChange::Remove(name.to_owned());
        Ok(self.store().writer().change_library(change).await?)
    }

    /// Returns the files of the library, by the names that they have in a job. One that this version refuses is left out, and said in the
    /// log: it would stop every search.
    pub(super) async fn library_files(&self) -> Result<Vec<(String, String)>, ServiceError> {
        let mut files = Vec::new();
        for row in self.store().reader().library().await? {
            let Some((_, stored)) = self.user_effect(&row.name).await? else {
                continue;
            };
            if let Err(error) = check_law(&stored.text) {
                tracing::warn!(law = row.name, %error, "searches do not try a law of the library");
                continue;
            }
            let version = stored.version.version;
            let file = ServiceEffect::new(row.name.clone(), &row.name, version, stored.text);
            files.push((file.file, file.text));
        }
        Ok(files)
    }

    /// Returns the effect file of a law that the search of a calibration's model found, with its origin, and the number of the study.
    ///
    /// # Arguments
    /// - `law`: the name of its effect; without it, the law that the search claims. `name`: the name that it gets; without it, one that
    ///   laws of later searches do not have.
    async fn law_of_search(
        &self,
        calibration: i64,
        law: Option<&str>,
        name: Option<String>,
    ) -> Result<(String, i64), ServiceError> {
        let record = self.finished_search(calibration).await?;
        let row = self.calibration_row(calibration).await?;
        let files = law_files(&record);
        let stem = |file: &str| file.trim_end_matches(".toml").to_owned();
        let is_meant = |file: &str| law.is_none_or(|law| stem(file) == law);
        let meant = files.iter().find(|(file, _)| is_meant(file));
        let (file, text) = meant.ok_or_else(|| {
            let names: Vec<String> = files.iter().map(|(file, _)| stem(file)).collect();
            let there = match names.as_slice() {
                [] => "it found no law outside the library".to_owned(),
                names => format!("it found {}", names.join(", ")),
            };
            ServiceError::Details(format!(
                "the search of calibration {calibration} has no such law: {there}"
            ))
        })?;
        let study = row.study;
        let name = name.unwrap_or_else(|| format!("{}_of_study_{study}", stem(file)));
        let named = row.name.replace(['"', '\\'], " ");
        let origin = format!("found by the search of calibration {calibration} of study {study} ({named})");
        let text = effect_with_origin(LAW, text, Some(&name), Some(&origin))?;
        Ok((text, study))
    }

    /// Returns a law with its studies; `None` if its effect is gone.
    async fn library_law(&self, row: LibraryRow) -> Result<Option<LibraryLaw>, ServiceError> {
        let Some((_, stored)) = self.user_effect(&row.name).await? else {
            return Ok(None);
        };
        let studies = self.studies_of_law(&row, &stored.text).await?;
        Ok(Some(law(row, &stored)?.with_studies(studies)))
    }

    /// Returns what each study says of a law: the last of its searches that tried this text of it.
    async fn studies_of_law(&self, law: &LibraryRow, text: &str) -> Result<Vec<LawInStudy>, ServiceError> {
        let reader = self.store().reader();
        let withdrawn = reader.withdrawn().await?;
        let mut last: BTreeMap<i64, (CalibrationRow, Discovery)> = BTreeMap::new();
        for (search, record) in reader.discoveries_with(&law.name).await? {
            if withdrawn.contains(&search) || !record.effects.iter().any(|effect| effect.name == law.name) {
                continue;
            }
            let row = self.calibration_row(search).await?;
            if row.job.files.values().any(|file| file == text) {
                last.insert(row.study, (row, record));
            }
        }
        // A measurement counts once: not where it found the law, and of several studies that have it in the last one.
        let mut counted: BTreeSet<String> = BTreeSet::new();
        if let Some(study) = law.found_in {
            for row in reader.study(study).await? {
                counted.extend(self.measurements(row.experiment).await?);
            }
        }
        let mut studies = Vec::new();
        for (study, (row, record)) in last.into_iter().rev() {
            let Some(judged) = record.effects.iter().find(|effect| effect.name == law.name) else {
                continue;
            };
            let measurements = self.measurements(row.experiment).await?;
            let counts = measurements.is_disjoint(&counted);
            counted.extend(measurements);
            let searched = row.membership.parent.unwrap_or(row.id);
            let lead = reader.study(study).await?.into_iter().next();
            studies.push(LawInStudy {
                study,
                name: lead.map(|lead| lead.name).unwrap_or_default(),
                calibration: searched,
                given: record.given.clone(),
                log_bayes_factor: judged.log_bayes_factor,
                probability: judged.probability,
                parameters: judged.parameters.clone(),
                units: judged.units.clone(),
                standing: Standing::new(judged.log_bayes_factor),
                counts,
            });
        }
        studies.reverse();
        Ok(studies)
    }

    /// Returns what each run of an experiment measured, fitted or held out, with its conditions.
    async fn measurements(&self, experiment: i64) -> Result<BTreeSet<String>, ServiceError> {
        let files = self.experiment(experiment).await?;
        let read = move || Ok::<_, ServiceError>(Experiment::parse("experiment.toml", &files)?);
        let experiment = in_background(read).await?;
        let run = |run: &TestRun| {
            let conditions = [run.slip, run.wheel_load_n, run.sled_speed_m_s, run.slip_angle_deg];
            let is_measured = run.measured.iter().any(Option::is_some);
            is_measured.then(|| format!("{conditions:?} {:?}", run.measured))
        };
        Ok(experiment.runs.iter().filter_map(run).collect())
    }
}

/// Checks the file of a law that searches are to try.
fn check_law(text: &str) -> Result<(), FileError> {
    check_candidate(LAW, &read_user_effect(LAW, text)?)
}

/// Name of a law's file in messages.
const LAW: &str = "law.toml";

fn no_law(name: String) -> ServiceError {
    ServiceError::NotFound {
        what: "law of the library",
        id: name,
    }
}

/// Makes a law of its row and its file, which was validated when it was added.
fn law(row: LibraryRow, stored: &StoredEffect) -> Result<LibraryLaw, ServiceError> {
    let corrupt = |error| {
        let version = stored.version.version;
        StoreError::Corrupt(format!("effect {} version {version}: {error}", stored.name))
    };
    let effect = Effect::read(&stored.text).map_err(corrupt)?;
    Ok(LibraryLaw {
        version: stored.version.version,
        hooks: effect.hooks().map(|hook| hook.name().to_owned()).collect(),
        summary: effect.summary,
        source: effect.source,
        name: row.name,
        added_at_ms: row.added_at_ms,
        added_by: row.added_by,
        found_in: row.found_in,
        studies: Vec::new(),
        counted: 0,
        log_bayes_factor: 0.0,
    })
}
