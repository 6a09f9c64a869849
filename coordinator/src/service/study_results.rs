//! The files of a study: computed once, then stored.

use serde::Deserialize;
use serde_json::value::RawValue;
use shared::api::CalibrationState;

use super::error::ServiceError;
use super::finished_study::{finished_calibration, finished_study, finished_study_of};
use record::CalibrationRow;
use report::StudyFile;
use result::Diagnostics;
use store::{Reader, StoreError, StudyResults, Writer};

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
        return report::study_file::file(&finished_study(reader, row).await?, file).ok_or_else(none);
    };
    if let Some(text) = reader.result(row.study, &file.name(), &stamp).await? {
        return Ok(text);
    }
    let study = finished_study_of(reader, row, &rows).await?;
    // What is decided but not yet begun is work to come: the study is about to grow.
    let Some(writer) = writer.filter(|_| study.state.is_final()) else {
        return report::study_file::file(&study, file).ok_or_else(none);
    };
    let text = |file: StudyFile| Some((file.name(), report::study_file::file(&study, file)?));
    let files: Vec<StudyFile> = report::study_file::files(&study).collect();
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

/// The diagnostics of a finished calibration as JSON, from the store where they stand there.
///
/// # Errors
/// As those of [`finished_calibration`].
pub(super) async fn diagnostics_text(
    reader: &Reader,
    writer: Option<&Writer>,
    row: &CalibrationRow,
) -> Result<String, ServiceError> {
    let is_diagnosed = row.state == CalibrationState::Finished && !row.membership.is_search();
    if is_diagnosed && stamp(&reader.study(row.study).await?, (0, 0)).is_some() {
        return study_file(reader, writer, row, StudyFile::Diagnostics(row.id)).await;
    }
    // Of what has no diagnostics this says why.
    let calibration = finished_calibration(reader, row).await?;
    let diagnostics = report::diagnosis::diagnostics(&calibration, calibration.comparison());
    Ok(serde_json::to_string(&diagnostics).expect("results have a JSON form"))
}

/// The flags among the diagnostics of a calibration, as JSON.
///
/// # Errors
/// [`StoreError::Corrupt`] where the text is none of diagnostics.
pub(super) fn flags_text(id: i64, diagnostics: &str) -> Result<String, ServiceError> {
    #[derive(Deserialize)]
    struct Flagged<'a> {
        #[serde(borrow)]
        flags: &'a RawValue,
    }
    let flagged: Flagged<'_> = serde_json::from_str(diagnostics).map_err(|e| corrupt(id, &e))?;
    Ok(flagged.flags.get().to_owned())
}

/// The diagnostics of a finished calibration in a folder, from its store where they stand there.
///
/// # Errors
/// As those of [`finished_calibration`].
pub async fn diagnostics(reader: &Reader, row: &CalibrationRow) -> Result<Diagnostics, ServiceError> {
    let text = diagnostics_text(reader, None, row).await?;
    serde_json::from_str(&text).map_err(|e| corrupt(row.id, &e))
}

fn corrupt(id: i64, error: &serde_json::Error) -> ServiceError {
    StoreError::Corrupt(format!("diagnostics of calibration {id}: {error}")).into()
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
    use record::{Membership, Role};

    use super::*;

    fn member(id: i64, state: CalibrationState) -> CalibrationRow {
        CalibrationRow {
            state,
            ..CalibrationRow::finished(id, Membership::submitted(Role::Sample))
        }
    }

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
