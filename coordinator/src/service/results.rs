//! The results of studies and calibrations as texts: computed on request, then kept under a stamp.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;
use shared::api::{CalibrationState, NewDecision};

use super::background::in_background;
use super::error::ServiceError;
use super::finished_study::{check_finished, finished_calibration, finished_study};
use super::handle::Service;
use super::predictions::{current_decision, current_grid};
use super::stored_calibration::FILES;
use job::Job;
use prediction::DecisionAnswer;
use record::CalibrationRow;
use report::document::ReportPredictions;
use report::study_file::{decision_name, files, grid_name, overview_files};
use report::{CalibrationFile, StudyFile, StudyOverview};
use result::{FinishedCalibration, Study};
use store::{Stamp, StoreError, StudyResults};

/// The digest of the sources of this program.
const BUILD: &str = env!("GROUSER_BUILD");

impl Service {
    /// Loads a finished calibration.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`]; [`ServiceError::Control`] if it is not finished; [`ServiceError::Search`] for a search;
    /// [`ServiceError::Effects`] if this program has other effects; others if the store cannot be read.
    pub async fn finished_calibration(&self, id: i64) -> Result<FinishedCalibration, ServiceError> {
        finished_calibration(&self.store().reader(), &self.calibration_row(id).await?).await
    }

    /// Returns a file of a finished calibration.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`].
    pub async fn calibration_file(&self, id: i64, file: CalibrationFile) -> Result<String, ServiceError> {
        let reader = self.store().reader();
        let row = self.calibration_row(id).await?;
        check_finished(&row)?;
        let (stamp, rows) = self.stamped_members(row.study).await?;
        let name = file.name(id);
        if let Some(text) = self.results.text(row.study, &name, &stamp).await? {
            return Ok(text);
        }
        let text = file.text(&finished_calibration(&reader, &row).await?);
        if are_over(&rows) {
            self.keep(row.study, stamp, [(name, text.clone())].into()).await?;
        }
        Ok(text)
    }

    /// Returns the flags of a finished calibration, as in its diagnostics.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`]; [`StoreError::Corrupt`] if the stored text does not contain diagnostics.
    pub async fn flags(&self, id: i64) -> Result<String, ServiceError> {
        flags_text(
            id,
            &self.calibration_file(id, CalibrationFile::Diagnostics).await?,
        )
    }

    /// Returns a file of the study of a calibration.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`], if no calibration of the study is finished.
    pub async fn study_file(&self, id: i64, file: StudyFile) -> Result<String, ServiceError> {
        let row = self.calibration_row(id).await?;
        if let StudyFile::Figures(_) = file {
            check_finished(&row)?;
        }
        let (stamp, rows) = self.stamped_members(row.study).await?;
        self.text_of_study(&row, &rows, stamp, file).await
    }

    /// Returns a file of a study, kept or computed. For a finished study all files are computed at once, because they are made from the
    /// same tables.
    pub(super) async fn text_of_study(
        &self,
        row: &CalibrationRow,
        rows: &[CalibrationRow],
        stamp: Stamp,
        file: StudyFile,
    ) -> Result<String, ServiceError> {
        let name = file.name();
        let decisions = match file {
            StudyFile::Report => self.kept_decisions(rows, &stamp).await?,
            _ => Vec::new(),
        };
        // A report that has a decision is not kept, because another may be asked for at any time.
        let is_kept = decisions.is_empty();
        if is_kept && let Some(text) = self.results.text(row.study, &name, &stamp).await? {
            return Ok(text);
        }
        let study = finished_study(&self.store().reader(), row, rows).await?;
        // The next step of a study is unfinished work, although it has not begun: the study is about to grow.
        let is_over = are_over(rows) && study.state.is_final();
        let is_of_list = matches!(file, StudyFile::Overview | StudyFile::ListItem);
        let is_whole = is_over && file.is_of_every_study() && !self.store().is_read_only();
        // A report has a megabyte of modules, so that it is computed where somebody asks for it.
        let (study, predictions) = match file {
            StudyFile::Report => {
                in_background(move || {
                    let carried = carried(&study, decisions);
                    Ok::<_, ServiceError>((study, carried))
                })
                .await?
            }
            _ => (study, ReportPredictions::default()),
        };
        let computed = match () {
            () if is_whole => files(&study),
            () if is_of_list => overview_files(&report::overview::overview(&study)),
            () => {
                let text = report::study_file::file(&study, &predictions, file);
                let text = text.ok_or_else(|| ServiceError::not_found("result of calibration", row.id))?;
                [(name.clone(), text)].into()
            }
        };
        let text = computed[&name].clone();
        if is_kept && (is_over || is_of_list) {
            self.keep(row.study, stamp, computed).await?;
        }
        Ok(text)
    }

    /// Keeps the overview of a study, and its line in the list.
    pub(super) async fn keep_overview(
        &self,
        overview: &StudyOverview,
        stamp: Stamp,
    ) -> Result<(), ServiceError> {
        self.keep(overview.id, stamp, overview_files(overview)).await
    }

    /// Returns the predictions of a finished calibration over a grid of conditions, as JSON.
    ///
    /// # Errors
    /// The same as of [`Service::predict`].
    pub async fn prediction_grid(&self, id: i64) -> Result<String, ServiceError> {
        let row = self.calibration_row(id).await?;
        let (stamp, rows) = self.stamped_members(row.study).await?;
        let name = grid_name(id);
        if let Some(text) = self.results.text(row.study, &name, &stamp).await? {
            return Ok(text);
        }
        let text = self.computed_grid(id).await?;
        if are_over(&rows) {
            self.keep(row.study, stamp, [(name, text.clone())].into()).await?;
        }
        Ok(text)
    }

    /// Returns the decision that was asked for last, or that the job states, as JSON: `null` where there is none.
    ///
    /// # Errors
    /// The same as of [`Service::decide`].
    pub async fn decision(&self, id: i64) -> Result<String, ServiceError> {
        let row = self.calibration_row(id).await?;
        check_finished(&row)?;
        let (stamp, _) = self.stamped_members(row.study).await?;
        if let Some(text) = self.results.text(row.study, &decision_name(id), &stamp).await? {
            return Ok(text);
        }
        let answer = match Job::parse(FILES[0], &row.job.toml)?.decision {
            Some(_) => Some(self.decide(id, NewDecision::default()).await?),
            None => None,
        };
        Ok(serde_json::to_string(&answer).expect("results have a JSON form"))
    }

    /// Keeps a decision in the place of that which was asked for before.
    pub(super) async fn keep_decision(
        &self,
        row: &CalibrationRow,
        stamp: Stamp,
        answer: &DecisionAnswer,
    ) -> Result<(), ServiceError> {
        let text = serde_json::to_string(answer).expect("results have a JSON form");
        self.keep(row.study, stamp, [(decision_name(row.id), text)].into())
            .await
    }

    /// Returns the decisions that are kept of the calibrations of a study.
    async fn kept_decisions(
        &self,
        rows: &[CalibrationRow],
        stamp: &Stamp,
    ) -> Result<Vec<DecisionAnswer>, ServiceError> {
        let mut decisions = Vec::new();
        for row in rows {
            let text = self
                .results
                .text(row.study, &decision_name(row.id), stamp)
                .await?;
            // A form that this program does not know is computed again where it is asked for.
            decisions.extend(text.and_then(|text| serde_json::from_str(&text).ok()));
        }
        Ok(decisions)
    }

    async fn keep(
        &self,
        study: i64,
        stamp: Stamp,
        files: BTreeMap<String, String>,
    ) -> Result<(), ServiceError> {
        Ok(self.results.keep(StudyResults { study, stamp, files }).await?)
    }

    /// Reads the members of a study, with the stamp of results that are computed from them.
    pub(super) async fn stamped_members(
        &self,
        study: i64,
    ) -> Result<(Stamp, Vec<CalibrationRow>), ServiceError> {
        Ok(self.store().reader().stamped_study(study, BUILD).await?)
    }
}

/// Returns the part of a stamp of this program that the members of a study determine.
pub(super) fn members_stamp(members: impl Iterator<Item = (i64, CalibrationState)>) -> String {
    store::members_stamp(BUILD, members)
}

/// Returns what a report carries of conditions that nobody measured: the current model's grid, the decisions that are kept, and that of the
/// current model's job.
fn carried(study: &Study, mut decisions: Vec<DecisionAnswer>) -> ReportPredictions {
    let current = study.current().map(|current| current.row.id);
    if !decisions.iter().any(|kept| Some(kept.calibration) == current) {
        decisions.extend(current_decision(study));
    }
    ReportPredictions {
        grids: current_grid(study),
        decisions,
    }
}

fn are_over(rows: &[CalibrationRow]) -> bool {
    rows.iter().all(|row| row.state.is_final())
}

/// Returns the flags among the diagnostics of a calibration, as JSON.
fn flags_text(id: i64, diagnostics: &str) -> Result<String, ServiceError> {
    #[derive(Deserialize)]
    struct Flagged<'a> {
        #[serde(borrow)]
        flags: &'a RawValue,
    }
    let corrupt = |error| StoreError::Corrupt(format!("diagnostics of calibration {id}: {error}"));
    let flagged: Flagged<'_> = serde_json::from_str(diagnostics).map_err(corrupt)?;
    Ok(flagged.flags.get().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_the_part_of_the_diagnostics_as_it_stands_there() {
        let text = r#"{"sampler": null, "flags": [{"kind": "a", "numbers": [1.50]}], "findings": []}"#;
        assert_eq!(
            flags_text(1, text).unwrap(),
            r#"[{"kind": "a", "numbers": [1.50]}]"#
        );
        assert!(
            flags_text(1, "{}")
                .unwrap_err()
                .to_string()
                .contains("missing field `flags`")
        );
    }
}
