//! The error ledger as text.

use std::fmt::Write;

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::column::{cell, labelled};
use crate::summary::study::combined_summary;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::table::errors::ErrorTable;
use result::table::ledger::LedgerRow;
use result::words::data_channel::{ShownUnit, short_name};
use result::words::number;

/// Least width of the column of models.
const MODEL: usize = 20;
/// The line of the current model with what it misses in the fitted conditions.
const CORRECTED: &str = "current, corrected";
/// The line of what all models predict together.
const COMBINED: &str = "all, combined";
/// The line of what no model predicts.
const INTERPOLATION: &str = "interpolation";

/// The ledger of a study, with what all models predict together and the noise that errors are measured by; nothing without a
/// calibration in it.
pub(super) fn ledger(study: &Study) -> String {
    let combined = combined_summary(study, &study.fixed_sigmas());
    let combined = combined.filter(|own| own.models > 1).and_then(|own| own.holdout);
    let current = study.current().map(FinishedCalibration::comparison);
    let corrected = current.and_then(|own| own.corrected_holdout.as_ref());
    let text = table(study, &[(CORRECTED, corrected), (COMBINED, combined.as_ref())]);
    match text.is_empty() {
        true => text,
        false => text + &labelled("noise:", &study.fixed_sigmas().words()),
    }
}

/// The ledger of a study: its models, and interpolation.
pub(super) fn brief_ledger(study: &Study) -> String {
    table(study, &[])
}

/// - `predictions`: others of the held-out runs, with their names.
fn table(study: &Study, predictions: &[(&str, Option<&ErrorTable>)]) -> String {
    let lines = study.ledger_lines();
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
    let mut text = format!("{:<width$} {:<8}", "root mean sq. error", "runs");
    for &channel in &channels {
        let unit = ShownUnit::of(channel);
        let _ = write!(text, " {:>10}", format!("{} {}", short_name(channel), unit.name));
    }
    let _ = writeln!(text, " {:>7} {:>9}", "x noise", "inside");
    for line in &lines {
        for (i, row) in line.rows.iter().enumerate() {
            let model = if i == 0 { line.model.as_str() } else { "" };
            let _ = writeln!(text, "{model:<width$} {}", ledger_row(row, &channels));
        }
    }
    let current = study.current().map(FinishedCalibration::comparison);
    let interpolated = current.and_then(|own| own.baseline_holdout.as_ref());
    for (name, errors) in predictions.iter().copied().chain([(INTERPOLATION, interpolated)]) {
        if let Some(errors) = errors {
            let cells = cells(errors, &channels, &[]);
            let _ = write!(text, "{name:<width$} {:<8}{cells}", usage(RunUse::Holdout));
            let _ = match errors.all.unpredicted {
                0 => writeln!(text),
                others => writeln!(text, "  without {}", number::count(others, "measurement")),
            };
        }
    }
    if lines
        .iter()
        .flat_map(|line| &line.rows)
        .any(|row| !row.worse.is_empty())
    {
        let _ = writeln!(text, "*: worse than in the model above");
    }
    text
}

fn usage(usage: RunUse) -> &'static str {
    match usage {
        RunUse::Fit => "fit",
        RunUse::Holdout => "held out",
    }
}

fn ledger_row(row: &LedgerRow, channels: &[Channel]) -> String {
    let sigmas = cell(row.errors.all.rmse_fixed_sigma, |s| format!("{s:.2}"));
    let inside = cell(row.coverage.as_ref(), |c| format!("{} of {}", c.inside, c.of));
    let cells = cells(&row.errors, channels, &row.worse);
    format!("{:<8}{cells} {sigmas:>7} {inside:>9}", usage(row.usage))
}

fn cells(errors: &ErrorTable, channels: &[Channel], worse: &[Channel]) -> String {
    let cells = channels.iter().map(|channel| {
        let error = cell(errors.channel(*channel), |error| {
            let mark = if worse.contains(channel) { "*" } else { "" };
            format!("{mark}{:.2}", error.rmse * ShownUnit::of(*channel).factor)
        });
        format!(" {error:>10}")
    });
    cells.collect()
}
