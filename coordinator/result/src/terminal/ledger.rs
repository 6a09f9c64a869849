//! The error ledger as text.

use std::fmt::Write;

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::column::cell;
use crate::study::Study;
use crate::table::ledger::{LedgerLine, LedgerRow};
use crate::words::data_channel::{ShownUnit, short_name};

/// Least width of the column of models.
const MODEL: usize = 24;

/// The ledger of a study, with a line on the noise that errors are measured by; nothing without a calibration in it.
pub(super) fn ledger(study: &Study) -> String {
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
    let mut text = format!("\n{:<width$} {:<8}", "error ledger", "runs");
    for &channel in &channels {
        let unit = ShownUnit::of(channel);
        let _ = write!(text, " {:>14}", format!("{} {}", short_name(channel), unit.name));
    }
    let _ = writeln!(text, " {:>10} {:>9} {:>12}", "noise sds", "inside", "ln evidence");
    for line in &lines {
        for (i, row) in line.rows.iter().enumerate() {
            let _ = writeln!(text, "{}", ledger_row(line, row, i == 0, &channels, width));
        }
    }
    let _ = writeln!(
        text,
        "root mean square errors; noise sds, equal for all lines: {}",
        study.fixed_sigmas().words()
    );
    text
}

fn ledger_row(line: &LedgerLine, row: &LedgerRow, first: bool, channels: &[Channel], width: usize) -> String {
    let usage = match row.usage {
        RunUse::Fit => "fit",
        RunUse::Holdout => "held out",
    };
    let mut text = format!("{:<width$} {usage:<8}", if first { &line.model } else { "" });
    for channel in channels {
        let error = cell(row.errors.channel(*channel), |error| {
            let mark = if row.worse.contains(channel) { "worse " } else { "" };
            format!("{mark}{:.2}", error.rmse * ShownUnit::of(*channel).factor)
        });
        let _ = write!(text, " {error:>14}");
    }
    let sigmas = cell(row.errors.all.rmse_fixed_sigma, |s| format!("{s:.2}"));
    let inside = cell(row.coverage.as_ref(), |c| format!("{} of {}", c.inside, c.of));
    let evidence = match (first, line.calibration.row.log_evidence) {
        (true, Some(z)) => format!("{z:.2}"),
        _ => String::new(),
    };
    let _ = write!(text, " {sigmas:>10} {inside:>9} {evidence:>12}");
    if first && line.calibration.approximated.is_some() {
        text.push_str("  normal approximation");
    }
    text.trim_end().to_owned()
}
