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
use result::table::ledger::{LedgerLine, LedgerRow};
use result::words::data_channel::ShownUnit;
use result::words::number;

/// Minimum width of the column of models.
const MODEL: usize = 20;
/// Maximum number of rows of a brief ledger, without that of interpolation.
const BRIEF: usize = 3;
/// Name of the line of the current model's corrected predictions.
const CORRECTED: &str = "current, corrected";
/// Name of the line of the combined predictions.
const COMBINED: &str = "all, combined";
/// Name of the line of interpolation without a model.
const INTERPOLATION: &str = "interpolation";

/// Returns the ledger of a study, with the combined predictions of all models and the noise that errors are measured in; empty if no
/// calibration is in the ledger.
pub(super) fn ledger(study: &Study) -> String {
    let combined = combined_summary(study, &study.fixed_sigmas());
    let combined = combined
        .filter(|summary| summary.models > 1)
        .and_then(|summary| summary.holdout);
    let current = study.current().map(FinishedCalibration::comparison);
    let corrected = current.and_then(|comparison| comparison.corrected_holdout.as_ref());
    let lines = study.ledger_lines();
    let text = table(
        study,
        &lines,
        &[(CORRECTED, corrected), (COMBINED, combined.as_ref())],
    );
    match text.is_empty() {
        true => text,
        false => text + &labelled("noise:", &study.fixed_sigmas().words()),
    }
}

/// Returns the ledger in few lines: of a long one, the first and the last model, on the holdout runs if there are any.
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
    table(study, &lines, &[])
}

/// Tabulates lines of the ledger, with further `predictions` of the holdout runs by their names.
fn table(study: &Study, lines: &[LedgerLine], predictions: &[(&str, Option<&ErrorTable>)]) -> String {
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
        .left(width, "root mean sq. error", |row| row.model)
        .left(8, "runs", |row| usage_words(row.usage));
    for &channel in &channels {
        table = table.right(10, &channel_title(channel), move |row| {
            cell(row.errors.channel(channel), |error| {
                let mark = if row.worse.contains(&channel) { "*" } else { "" };
                format!("{mark}{:.2}", error.rmse * ShownUnit::new(channel).factor)
            })
        });
    }
    let table = table
        .right(7, "x noise", |row| {
            cell(row.errors.all.rmse_fixed_sigma, |s| format!("{s:.2}"))
        })
        .right(9, "inside", |row| {
            cell(row.coverage, |c| format!("{} of {}", c.inside, c.total))
        });
    let mut text = table.header();
    for line in lines {
        let models = std::iter::once(line.model.as_str()).chain(std::iter::repeat(""));
        text.extend(
            models
                .zip(&line.rows)
                .map(|(model, row)| table.line(Row::fitted(model, row))),
        );
    }
    let current = study.current().map(FinishedCalibration::comparison);
    let interpolated = current.and_then(|comparison| comparison.baseline_holdout.as_ref());
    for (name, errors) in predictions.iter().copied().chain([(INTERPOLATION, interpolated)]) {
        if let Some(errors) = errors {
            text += &table.start(2 + channels.len(), Row::held_out(name, errors));
            let _ = match errors.all.unpredicted {
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
    usage: RunUse,
    errors: &'a ErrorTable,
    worse: &'a [Channel],
    coverage: Option<&'a Coverage>,
}

impl<'a> Row<'a> {
    /// Returns the row of a calibration.
    fn fitted(model: &'a str, row: &'a LedgerRow) -> Self {
        Row {
            model,
            usage: row.usage,
            errors: &row.errors,
            worse: &row.worse,
            coverage: row.coverage.as_ref(),
        }
    }

    /// Returns the row of another prediction of the holdout runs.
    fn held_out(model: &'a str, errors: &'a ErrorTable) -> Self {
        Row {
            model,
            usage: RunUse::Holdout,
            errors,
            worse: &[],
            coverage: None,
        }
    }
}

fn usage_words(usage: RunUse) -> &'static str {
    match usage {
        RunUse::Fit => "fit",
        RunUse::Holdout => "held out",
    }
}
