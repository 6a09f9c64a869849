//! The error ledger as text: a table with a line for each model.

use std::fmt::Write;

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::column::{cell, labelled};
use super::table::{Table, channel_title};
use crate::summary::study::combined_summary;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::table::coverage::Coverage;
use result::table::errors::ErrorTable;
use result::table::holdout_errors::HoldoutErrors;
use result::table::ledger::{LedgerLine, LedgerRow};
use result::words::data_channel::ShownUnit;
use result::words::number;

/// Minimum width of the column of models.
const MODEL: usize = 20;
/// Maximum number of rows of a brief ledger, without that of interpolation.
const BRIEF: usize = 3;
/// Ratio of the errors of two groups above which they are different.
const DIFFERENT: f64 = 2.0;
/// Name of the line of the current model's corrected predictions.
const CORRECTED: &str = "current, corrected";
/// Name of the line of the combined predictions.
const COMBINED: &str = "all, combined";
/// Name of the line of interpolation without a model.
const INTERPOLATION: &str = "interpolation";

/// Returns the ledger of a study, with the combined predictions of all models and the noise that errors are measured in; empty if no
/// calibration is in the ledger.
pub(super) fn ledger(study: &Study) -> String {
    let combined = combined_summary(study, &study.fixed_sigmas()).filter(|summary| summary.models > 1);
    let current = study.current().map(FinishedCalibration::comparison);
    let corrected = current.map(|comparison| Prediction {
        name: CORRECTED,
        errors: comparison.corrected_holdout.clone(),
        groups: HoldoutErrors::of_corrected(comparison.rows.iter()),
    });
    let combined = combined.map(|summary| Prediction {
        name: COMBINED,
        errors: summary.holdout,
        groups: HoldoutErrors::of_combined(study.combined().iter()),
    });
    let lines = study.ledger_lines();
    let text = table(study, &lines, corrected.into_iter().chain(combined).collect());
    match text.is_empty() {
        true => text,
        false => text + &labelled("noise:", &study.fixed_sigmas().words()),
    }
}

/// Returns the ledger in few lines: of a long one, the first and the last model, on the holdout runs if there are any; the groups of the
/// holdout runs of the last model and of interpolation if the model's errors differ between them.
pub(super) fn brief_ledger(study: &Study) -> String {
    let mut lines = study.ledger_lines();
    let rows = |lines: &[LedgerLine]| lines.iter().map(|line| line.rows.len()).sum::<usize>();
    if rows(&lines) > BRIEF {
        let mut all = lines.iter().flat_map(|line| &line.rows);
        let has_holdout = all.any(|row| row.usage == RunUse::Holdout);
        let shown = if has_holdout { RunUse::Holdout } else { RunUse::Fit };
        lines
            .iter_mut()
            .for_each(|line| line.rows.retain(|row| row.usage == shown));
    }
    if rows(&lines) > BRIEF {
        lines.drain(1..lines.len() - 1);
        // A mark compares a line with one that is left out.
        let mut all = lines.iter_mut().flat_map(|line| &mut line.rows);
        all.by_ref().for_each(|row| row.worse.clear());
    }
    if let Some((last, before)) = lines.split_last_mut() {
        before.iter_mut().for_each(clear_groups);
        if !last.rows.iter().any(|row| differ(&row.groups)) {
            clear_groups(last);
        }
    }
    table(study, &lines, Vec::new())
}

fn clear_groups(line: &mut LedgerLine) {
    line.rows.iter_mut().for_each(|row| row.groups.clear());
}

/// Returns whether one error of all groups would mislead: the errors in noise standard deviations differ by more than a factor of 2, or nothing
/// of a group is predicted.
fn differ(groups: &[HoldoutErrors]) -> bool {
    let error = |group: &HoldoutErrors| group.errors.as_ref()?.all.rmse_fixed_sigma;
    let errors: Option<Vec<f64>> = groups.iter().map(error).collect();
    errors.is_none_or(|errors| {
        let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
        errors.iter().any(|error| *error > DIFFERENT * least)
    })
}

/// Another prediction of the holdout runs than that of a model.
struct Prediction {
    name: &'static str,
    /// Errors; `None` without a prediction.
    errors: Option<ErrorTable>,
    groups: Vec<HoldoutErrors>,
}

/// Tabulates lines of the ledger, with further `predictions` of the holdout runs. The groups of the holdout runs stand below each line if
/// there are several.
fn table(study: &Study, lines: &[LedgerLine], mut predictions: Vec<Prediction>) -> String {
    let measured = |channel: &Channel| {
        let mut rows = lines.iter().flat_map(|line| &line.rows);
        rows.any(|row| row.errors.channel(*channel).is_some())
    };
    let channels: Vec<Channel> = Channel::ALL.into_iter().filter(measured).collect();
    if channels.is_empty() {
        return String::new();
    }
    let width = lines
        .iter()
        .map(|line| line.model.chars().count())
        .fold(MODEL, usize::max);
    let mut table = Table::<Row>::new()
        .left(width, "root mean sq. error", |row| match row.runs {
            Runs::Used(_) => row.model.to_owned(),
            Runs::Count(_) => format!("  {}", row.model),
        })
        .left(8, "runs", |row| row.runs.words());
    for &channel in &channels {
        table = table.right(10, &channel_title(channel), move |row| {
            cell(row.errors.and_then(|errors| errors.channel(channel)), |error| {
                let mark = if row.worse.contains(&channel) { "*" } else { "" };
                format!("{mark}{:.2}", error.rmse * ShownUnit::new(channel).factor)
            })
        });
    }
    let table = table
        .right(7, "x noise", |row| {
            cell(row.errors.and_then(|errors| errors.all.rmse_fixed_sigma), |s| {
                format!("{s:.2}")
            })
        })
        .right(9, "inside", |row| {
            cell(row.coverage, |c| format!("{} of {}", c.inside, c.total))
        });
    let mut text = table.header();
    for line in lines {
        let models = std::iter::once(line.model.as_str()).chain(std::iter::repeat(""));
        for (model, row) in models.zip(&line.rows) {
            text += &table.line(Row::fitted(model, row));
            let groups = several(&row.groups).iter();
            text.extend(groups.map(|group| table.line(Row::group(group, group.coverage.as_ref()))));
        }
    }
    let is_grouped = lines
        .iter()
        .flat_map(|line| &line.rows)
        .any(|row| row.groups.len() > 1);
    predictions.extend(study.current().map(|calibration| {
        let comparison = calibration.comparison();
        Prediction {
            name: INTERPOLATION,
            errors: comparison.baseline_holdout.clone(),
            groups: HoldoutErrors::of_baseline(comparison.rows.iter()),
        }
    }));
    for prediction in &predictions {
        let Some(errors) = &prediction.errors else {
            continue;
        };
        let groups = several(&prediction.groups).iter().filter(|_| is_grouped);
        let rows = groups.map(|group| (Row::group(group, None), group.errors.as_ref()));
        for (row, errors) in [(Row::held_out(prediction.name, errors), Some(errors))]
            .into_iter()
            .chain(rows)
        {
            text += &table.start(2 + channels.len(), row);
            let _ = match errors.map_or(0, |errors| errors.all.unpredicted) {
                0 => writeln!(text),
                unpredicted => writeln!(text, "  without {}", number::count(unpredicted, "measurement")),
            };
        }
    }
    let mut rows = lines.iter().flat_map(|line| &line.rows);
    if rows.any(|row| !row.worse.is_empty()) {
        let _ = writeln!(text, "*: worse than in the model above");
    }
    let mut rows = lines.iter().flat_map(|line| &line.rows);
    if rows.any(LedgerRow::is_inside_by_width) {
        let _ = writeln!(
            text,
            "inside: the intervals are as wide as the error, so this supports no model"
        );
    }
    text
}

/// A row of the ledger as text.
#[derive(Clone, Copy)]
struct Row<'a> {
    model: &'a str,
    runs: Runs,
    /// Errors; `None` if nothing is predicted.
    errors: Option<&'a ErrorTable>,
    worse: &'a [Channel],
    coverage: Option<&'a Coverage>,
}

impl<'a> Row<'a> {
    /// Returns the row of a calibration.
    fn fitted(model: &'a str, row: &'a LedgerRow) -> Self {
        Row {
            model,
            runs: Runs::Used(row.usage),
            errors: Some(&row.errors),
            worse: &row.worse,
            coverage: row.coverage.as_ref(),
        }
    }

    /// Returns the row of another prediction of the holdout runs.
    fn held_out(model: &'a str, errors: &'a ErrorTable) -> Self {
        Row {
            model,
            runs: Runs::Used(RunUse::Holdout),
            errors: Some(errors),
            worse: &[],
            coverage: None,
        }
    }

    /// Returns the row of a group of the holdout runs.
    fn group(group: &'a HoldoutErrors, coverage: Option<&'a Coverage>) -> Self {
        Row {
            model: group.group.words(),
            runs: Runs::Count(group.runs),
            errors: group.errors.as_ref(),
            worse: &[],
            coverage,
        }
    }
}

/// The runs that a row is about.
#[derive(Clone, Copy)]
enum Runs {
    /// The fitted or the holdout runs.
    Used(RunUse),
    /// A number of holdout runs.
    Count(usize),
}

impl Runs {
    fn words(self) -> String {
        match self {
            Runs::Used(RunUse::Fit) => "fit".into(),
            Runs::Used(RunUse::Holdout) => "held out".into(),
            Runs::Count(count) => number::count(count, "run"),
        }
    }
}

/// Returns groups of holdout runs to show: none if all runs are in one.
fn several(groups: &[HoldoutErrors]) -> &[HoldoutErrors] {
    if groups.len() > 1 { groups } else { &[] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use result::table::holdout_group::HoldoutGroup;

    /// Returns the first words and the number of runs of each line.
    fn lines(text: &str) -> Vec<(String, String)> {
        let column = |line: &str, from: usize, to: usize| {
            let cell: String = line.chars().skip(from).take(to - from).collect();
            cell.trim_end().to_owned()
        };
        let lines = text.lines().take_while(|line| !line.starts_with("noise:"));
        let cells = |line| (column(line, 0, MODEL), column(line, MODEL + 1, MODEL + 9));
        lines.skip(1).map(cells).collect()
    }

    #[test]
    fn held_out_runs_in_several_groups_have_a_row_for_each_below_every_prediction() {
        let study = Study::from(fixture::with_smooth_misfit());
        let held_out = |name: &str| (name.to_owned(), "held out".to_owned());
        let groups = [
            ("  between levels".to_owned(), "2 runs".to_owned()),
            ("  beyond".to_owned(), "1 run".to_owned()),
        ];
        let model = [("base".to_owned(), "fit".to_owned()), held_out("")];
        let mut expected = [model.as_slice(), &groups].concat();
        for name in [CORRECTED, INTERPOLATION] {
            expected.extend([held_out(name)].iter().chain(&groups).cloned());
        }
        assert_eq!(lines(&ledger(&study)), expected);
        // The errors of the groups are those of their rows.
        let text = ledger(&study);
        for group in [HoldoutGroup::BetweenLevels, HoldoutGroup::Beyond] {
            let rows = study.lead.comparison().rows.iter();
            let of_group =
                rows.filter(|row| row.holdout_group == Some(group) && row.channel == Channel::DrawbarPull);
            let squares: Vec<f64> = of_group
                .map(|row| (row.measured - row.predicted.unwrap()).powi(2))
                .collect();
            let error = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            assert!(text.contains(&format!(" {error:.2} ")), "{error} in {text}");
        }
        // The errors of the groups are of one size: the brief ledger has them in one.
        let in_brief = |study: &Study| {
            let lines = lines(&brief_ledger(study));
            lines.iter().filter(|line| groups.contains(line)).count()
        };
        assert_eq!(in_brief(&study), 0);
        let mut study = Study::from(fixture::with_smooth_misfit());
        for prediction in &mut study.lead.predictions {
            let together = &mut prediction.holdout.as_mut().unwrap().together;
            let observables = together.as_mut().unwrap();
            observables.drawbar_pull_n[2] += 50.0;
        }
        assert_eq!(in_brief(&study), 4);
    }

    #[test]
    fn held_out_runs_of_one_group_have_no_further_row() {
        let text = ledger(&Study::from(fixture::calibration()));
        assert!(text.contains("held out") && !text.contains("levels"), "{text}");
    }
}
