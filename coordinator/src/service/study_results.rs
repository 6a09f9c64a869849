//! The files of a study: computed once, then stored.

use shared::api::CalibrationState;

use super::error::ServiceError;
use super::finished_study::{finished_calibration, finished_study, finished_study_of};
use crate::store::{Reader, StoreError, StudyResults, Writer};
use record::CalibrationRow;
use result::{Diagnostics, StudyFile};

/// The sources that this program was built from.
const BUILD: &str = env!("GROUSER_BUILD");

/// A file of the study of a calibration, from the store where it stands there.
///
/// # Arguments
/// - `writer`: stores what had to be computed; `None` where the store is only read.
///
/// # Errors
/// As those of [`finished_study`]; [`ServiceError::NotFound`] for diagnostics of what has none.
pub async fn study_file(
    reader: &Reader,
    writer: Option<&Writer>,
    row: &CalibrationRow,
    file: StudyFile,
) -> Result<String, ServiceError> {
    let none = || ServiceError::not_found("result of calibration", row.id);
    // Before the rows: what is found out while they are read is in no stamp.
    let doubts = reader.doubts().await?;
    let rows = reader.study(row.study).await?;
    let Some(stamp) = stamp(&rows, doubts) else {
        return finished_study(reader, row).await?.file(file).ok_or_else(none);
    };
    if let Some(text) = reader.result(row.study, &file.name(), &stamp).await? {
        return Ok(text);
    }
    let study = finished_study_of(reader, row, &rows).await?;
    // What is decided but not yet begun is work to come: the study is about to grow.
    let Some(writer) = writer.filter(|_| study.state.is_final()) else {
        return study.file(file).ok_or_else(none);
    };
    let text = |file: StudyFile| Some((file.name(), study.file(file)?));
    let files: Vec<StudyFile> = study.files().collect();
    let files = if files.contains(&file) { files } else { vec![file] };
    let results = StudyResults {
        study: row.study,
        stamp,
        files: files.into_iter().filter_map(text).collect(),
    };
    let text = results.files.get(&file.name()).cloned();
    writer.keep_results(results).await?;
    text.ok_or_else(none)
}

/// The diagnostics of a finished calibration, from the store where they stand there.
///
/// # Errors
/// As those of [`finished_calibration`].
pub async fn diagnostics(
    reader: &Reader,
    writer: Option<&Writer>,
    row: &CalibrationRow,
) -> Result<Diagnostics, ServiceError> {
    let is_diagnosed = row.state == CalibrationState::Finished && !row.membership.is_search();
    if !is_diagnosed || stamp(&reader.study(row.study).await?, (0, 0)).is_none() {
        // Of what has no diagnostics this says why.
        let calibration = finished_calibration(reader, row).await?;
        return Ok(calibration.diagnostics(calibration.comparison()));
    }
    let text = study_file(reader, writer, row, StudyFile::Diagnostics(row.id)).await?;
    let corrupt = |e| StoreError::Corrupt(format!("diagnostics of calibration {}: {e}", row.id));
    Ok(serde_json::from_str(&text).map_err(corrupt)?)
}

/// A file of a finished calibration, from the store where it stands there.
///
/// # Errors
/// As those of [`finished_calibration`].
pub(super) async fn calibration_file(
    reader: &Reader,
    writer: Option<&Writer>,
    row: &CalibrationRow,
    file: StudyFile,
) -> Result<String, ServiceError> {
    if row.state != CalibrationState::Finished || row.membership.is_search() {
        // Says why there is none.
        finished_calibration(reader, row).await?;
    }
    study_file(reader, writer, row, file).await
}

/// What the files of a study are computed by and from; `None` while a member may change. What is stored of a calibration
/// that is over does not change, so its number stands for it; but workers may be found to compute wrongly later.
fn stamp(rows: &[CalibrationRow], (disputes, quarantined): (i64, i64)) -> Option<String> {
    let is_over = rows.iter().all(|row| row.state.is_final());
    let members: Vec<String> = rows
        .iter()
        .map(|row| format!("{} {}", row.id, row.state.name()))
        .collect();
    is_over.then(|| {
        format!(
            "build {BUILD}, {}; {disputes} disputes, {quarantined} quarantined",
            members.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(id: i64, state: CalibrationState) -> CalibrationRow {
        CalibrationRow {
            id,
            state,
            ..CalibrationRow::finished_sample("")
        }
    }

    #[test]
    fn a_stamp_changes_with_the_members_and_there_is_none_while_one_may_change() {
        use CalibrationState::{Failed, Finished, Paused, Running};
        let of = |states: &[CalibrationState]| {
            let members = (1..).zip(states).map(|(id, &state)| member(id, state));
            stamp(&members.collect::<Vec<_>>(), (0, 0))
        };
        let one = of(&[Finished]).unwrap();
        assert!(one.contains(BUILD));
        assert_eq!(of(&[Finished]).unwrap(), one);
        assert!(of(&[Finished, Finished]).unwrap() != one);
        assert!(of(&[Finished, Finished]) != of(&[Finished, Failed]));
        assert!(stamp(&[member(2, Finished)], (0, 0)).unwrap() != one);
        assert!(
            stamp(&[member(1, Finished)], (0, 1)).unwrap() != one,
            "a worker was found to compute wrongly"
        );
        assert_eq!(of(&[Finished, Running]), None);
        assert_eq!(of(&[Paused]), None);
    }
}
