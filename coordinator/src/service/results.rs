//! The files of studies and calibrations: computed when somebody asks for them, then kept under a stamp.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde_json::value::RawValue;
use shared::api::CalibrationState;

use super::error::ServiceError;
use super::finished_study::{check_finished, finished_calibration, finished_study};
use super::handle::Service;
use record::CalibrationRow;
use report::study_file::{files, overview_files};
use report::{CalibrationFile, StudyFile, StudyOverview};
use result::FinishedCalibration;
use store::{StoreError, StudyResults};

/// Digest of the sources that this program was built from.
const BUILD: &str = env!("GROUSER_BUILD");

impl Service {
    /// A finished calibration.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`]; [`ServiceError::Control`] where it is not finished; [`ServiceError::Search`] for a search;
    /// [`ServiceError::Effects`] where this program has other effects; others where the store cannot be read.
    pub async fn finished_calibration(&self, id: i64) -> Result<FinishedCalibration, ServiceError> {
        finished_calibration(&self.store().reader(), &self.calibration_row(id).await?).await
    }

    /// A file of a finished calibration.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`].
    pub async fn calibration_file(&self, id: i64, file: CalibrationFile) -> Result<String, ServiceError> {
        let reader = self.store().reader();
        let row = self.calibration_row(id).await?;
        check_finished(&row)?;
        let (stamp, rows) = self.stamped_members(row.study).await?;
        let name = file.name(id);
        if let Some(text) = self.results.text(row.study, &name, &stamp.to_string()).await? {
            return Ok(text);
        }
        let text = file.text(&finished_calibration(&reader, &row).await?);
        if are_over(&rows) {
            self.keep(row.study, stamp, [(name, text.clone())].into()).await?;
        }
        Ok(text)
    }

    /// The flags of a finished calibration, as they stand in its diagnostics.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`]; [`StoreError::Corrupt`] where the stored text is none of diagnostics.
    pub async fn flags(&self, id: i64) -> Result<String, ServiceError> {
        flags_text(
            id,
            &self.calibration_file(id, CalibrationFile::Diagnostics).await?,
        )
    }

    /// A file of the study of a calibration.
    ///
    /// # Errors
    /// The same as of [`Service::finished_calibration`], where nothing of the study is finished.
    pub async fn study_file(&self, id: i64, file: StudyFile) -> Result<String, ServiceError> {
        let row = self.calibration_row(id).await?;
        if let StudyFile::Figures(_) = file {
            check_finished(&row)?;
        }
        let (stamp, rows) = self.stamped_members(row.study).await?;
        self.text_of_study(&row, &rows, stamp, file).await
    }

    /// A file of a study, from the results that are kept, else computed. A study that is over gets all its files at once, because they
    /// are made from the same tables.
    pub(super) async fn text_of_study(
        &self,
        row: &CalibrationRow,
        rows: &[CalibrationRow],
        stamp: Stamp,
        file: StudyFile,
    ) -> Result<String, ServiceError> {
        let name = file.name();
        if let Some(text) = self.results.text(row.study, &name, &stamp.to_string()).await? {
            return Ok(text);
        }
        let study = finished_study(&self.store().reader(), row, rows).await?;
        // A step that is decided but not begun is work to come: the study is about to grow.
        let is_over = are_over(rows) && study.state.is_final();
        let is_of_list = matches!(file, StudyFile::Overview | StudyFile::ListItem);
        let computed = match () {
            () if is_over && file.is_of_every_study() && !self.store().is_read_only() => files(&study),
            () if is_of_list => overview_files(&report::overview::overview(&study)),
            () => {
                let text = report::study_file::file(&study, file);
                let text = text.ok_or_else(|| ServiceError::not_found("result of calibration", row.id))?;
                [(name.clone(), text)].into()
            }
        };
        let text = computed[&name].clone();
        if is_over || is_of_list {
            self.keep(row.study, stamp, computed).await?;
        }
        Ok(text)
    }

    /// Keeps an overview of a study, and its line in the list.
    pub(super) async fn keep_overview(
        &self,
        overview: &StudyOverview,
        stamp: Stamp,
    ) -> Result<(), ServiceError> {
        self.keep(overview.id, stamp, overview_files(overview)).await
    }

    async fn keep(
        &self,
        study: i64,
        stamp: Stamp,
        files: BTreeMap<String, String>,
    ) -> Result<(), ServiceError> {
        let stamp = stamp.to_string();
        Ok(self.results.keep(StudyResults { study, stamp, files }).await?)
    }

    /// The members of a study, with the stamp of what is computed from them. Doubts are read first: one that arises while the members
    /// are read is not in the stamp, so that what is computed counts as out of date.
    pub(super) async fn stamped_members(
        &self,
        study: i64,
    ) -> Result<(Stamp, Vec<CalibrationRow>), ServiceError> {
        let doubts = self.store().reader().doubts().await?;
        let rows = self.store().reader().study(study).await?;
        let members = members_stamp(rows.iter().map(|row| (row.id, row.state)));
        Ok((Stamp { members, doubts }, rows))
    }
}

/// Names everything that the results of a study depend on: the build of this program, the members, the doubts about workers. The facts of a
/// calibration that is over do not change, so its number stands for them; but workers may be found to compute wrongly later.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Stamp {
    members: String,
    /// Disputes and quarantined workers.
    doubts: (i64, i64),
}

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Stamp { members, doubts } = self;
        write!(f, "{members}; {} disputes, {} quarantined", doubts.0, doubts.1)
    }
}

/// The part of a stamp that the members of a study determine: those that are over, and the number of all.
pub(super) fn members_stamp(members: impl Iterator<Item = (i64, CalibrationState)>) -> String {
    let (mut stamp, mut count) = (format!("build {BUILD}"), 0);
    for (id, state) in members {
        count += 1;
        if state.is_final() {
            stamp += &format!(", {id} {}", state.name());
        }
    }
    format!("{stamp} of {count}")
}

/// Whether a text was computed from these members, whatever has been found out about workers since.
pub(super) fn is_of_members(stamp: &str, members: &str) -> bool {
    stamp.split(';').next() == Some(members)
}

fn are_over(rows: &[CalibrationRow]) -> bool {
    rows.iter().all(|row| row.state.is_final())
}

/// The flags among the diagnostics of a calibration, as JSON.
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

    #[test]
    fn a_stamp_changes_with_the_members_that_are_over_and_with_the_doubts() {
        use CalibrationState::{Failed, Finished, Paused, Running};
        let stamp = |states: &[CalibrationState]| members_stamp((1..).zip(states.iter().copied()));
        let one = stamp(&[Finished]);
        assert!(one.contains(BUILD));
        assert_eq!(stamp(&[Finished]), one);
        assert!(stamp(&[Finished, Finished]) != one);
        assert!(stamp(&[Finished, Finished]) != stamp(&[Finished, Failed]));
        assert!(members_stamp([(2, Finished)].into_iter()) != one);
        assert!(stamp(&[Finished, Running]) != one, "it has grown");
        assert_eq!(stamp(&[Finished, Running]), stamp(&[Finished, Paused]));
        let with_doubts = |doubts| {
            Stamp {
                members: one.clone(),
                doubts,
            }
            .to_string()
        };
        assert!(
            with_doubts((0, 1)) != with_doubts((0, 0)),
            "a worker was found to compute wrongly"
        );
        assert!(is_of_members(&with_doubts((3, 1)), &one));
        assert!(!is_of_members(&with_doubts((0, 0)), &stamp(&[Failed])));
    }
}
