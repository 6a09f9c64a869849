//! The list of calibrations: their states, and what the study of each has found.

use std::collections::BTreeMap;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::sentence::one_line;

use super::column::cell;
use super::table::Table;
use crate::overview::StudyListItem;
use result::words::date::day;
use result::words::number;

/// Minimum width of the column of names.
const NAME: usize = 12;

/// Tabulates calibrations, one line each. The first one of a study has the day, the error and the verdict of the study.
pub fn list(statuses: &[CalibrationStatus], studies: &[StudyListItem]) -> String {
    let by_id: BTreeMap<i64, &StudyListItem> = studies.iter().map(|item| (item.id, item)).collect();
    let study = |status: &CalibrationStatus| {
        let item = *by_id.get(&status.study)?;
        (item.calibrations.first() == Some(&status.id)).then_some(item)
    };
    let names = statuses
        .iter()
        .map(|status| one_line(&status.name).chars().count());
    let table = Table::<&CalibrationStatus>::new()
        .right(4, "id", |s| s.id)
        .right(5, "study", |s| s.study)
        .apart(10, "begun", |s| {
            study(s)
                .and_then(|item| item.created_ms)
                .map_or_else(String::new, day)
        })
        .apart(names.fold(NAME, usize::max), "name", |s| one_line(&s.name))
        .left(9, "state", |s| s.state.name())
        .right(13, "error x noise", |s| study(s).map_or_else(String::new, error))
        .apart(0, "found", |s| study(s).map_or_else(String::new, found));
    let mut text = table.header();
    for status in statuses {
        text += table.line(status).trim_end();
        text += "\n";
        for remark in status
            .message
            .iter()
            .map(|message| one_line(message).into_owned())
            .chain(progress(status))
        {
            text += &format!("{:12}{remark}\n", "");
        }
    }
    text
}

/// Returns the error of a study's current model in noise standard deviations, on the holdout runs if there are any.
fn error(study: &StudyListItem) -> String {
    let of_study = study.error.as_ref();
    let of_use = of_study.and_then(|error| error.holdout.as_ref().or(error.fit.as_ref()));
    cell(of_use.and_then(|error| error.all.rmse_fixed_sigma), |sds| {
        number::significant(sds, 2)
    })
}

/// Returns what a study found: the verdict of its search, else the comparison of its models.
fn found(study: &StudyListItem) -> String {
    let verdict = study.verdict.as_ref().map(|verdict| verdict.short.as_str());
    // The numbers of a comparison follow in brackets.
    let models = study.models.as_deref().and_then(|text| text.split(" (").next());
    cell(verdict.or(models), str::to_owned)
}

/// Says how far a running calibration is.
fn progress(status: &CalibrationStatus) -> Option<String> {
    let progress = status.progress.as_ref();
    let progress = progress.filter(|_| status.state == CalibrationState::Running)?;
    let left = progress
        .remaining_s
        .map(|seconds| format!(", about {} to go", number::duration(seconds)));
    Some(format!(
        "{} evaluations, {:.0} per s{}",
        progress.evaluations,
        progress.evaluations_per_s,
        left.unwrap_or_default()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::overview::overview;

    fn status(id: i64, name: &str) -> CalibrationStatus {
        CalibrationStatus {
            id,
            name: name.into(),
            study: 1,
            experiment: 1,
            state: CalibrationState::Finished,
            message: None,
            model_kind: None,
            model_version: None,
            progress: None,
        }
    }

    #[test]
    fn a_study_has_its_day_its_error_and_its_verdict_and_columns_fit_long_names() {
        let mut item = overview(&fixture::of_a_class()).list_item(None);
        item.created_ms = Some(1_795_771_800_000);
        let first = item.calibrations[0];
        let long = "a_name_that_is_longer_than_the_column";
        let text = list(&[status(first, "sand"), status(first + 1, long)], &[item]);
        let lines: Vec<&str> = text.lines().collect();
        for words in ["2026-11-27", "sand", "finished", "slip_sinkage (P 0.68) is added"] {
            assert!(lines[1].contains(words), "{words} in\n{text}");
        }
        let state = |line: &str| line.find("finished").or(line.find("state"));
        assert_eq!(state(lines[0]), state(lines[2]), "{text}");
        assert_eq!(state(lines[1]), state(lines[2]), "{text}");
    }
}
