//! A validation as text.

use std::collections::BTreeMap;
use std::fmt::Write;

use shared::channel::Channel;

use super::column::cell;
use crate::table::errors::ErrorTable;
use crate::validation::{Judgement, Validation};
use crate::words::data_channel::{ShownUnit, short_name};
use crate::words::number;

/// Least width of the column of levels.
const LEVEL: usize = 24;

/// The levels with the errors of model and interpolation, then all of them together.
pub fn validation(validation: &Validation) -> String {
    let is_measured = |channel: &Channel| {
        let mut rows = validation.levels.iter().flat_map(|level| &level.rows);
        rows.any(|row| row.channel == *channel)
    };
    let channels: Vec<Channel> = Channel::ALL.into_iter().filter(is_measured).collect();
    let names = validation
        .levels
        .iter()
        .map(|level| level.level.name.chars().count());
    let width = names.fold(LEVEL, usize::max);
    let mut text = format!(
        "{} with each {} left out in turn, calibrated by {} on the rest; model | interpolation\n\n{:<width$} {:>4}",
        validation.name,
        validation.leave_out.name(),
        validation.algorithm.name(),
        "left out",
        "runs"
    );
    for &channel in &channels {
        let unit = ShownUnit::of(channel);
        let _ = write!(text, " {:>17}", format!("{} {}", short_name(channel), unit.name));
    }
    let _ = writeln!(text, " {:>15} {:>11}", "x noise", "inside");
    for level in &validation.levels {
        let _ = write!(text, "{:<width$} {:>4}", level.level.name, level.level.runs.len());
        text += &match (&level.judgement, &level.refused) {
            (Some(judgement), _) => line(judgement, &channels),
            (None, Some(reason)) => format!(" {reason}\n"),
            (None, None) => "\n".into(),
        };
    }
    let judged = validation.levels.iter().filter(|level| level.judgement.is_some());
    let runs: usize = judged.map(|level| level.level.runs.len()).sum();
    let _ = write!(text, "{:<width$} {runs:>4}", "all");
    text += &line(&validation.total, &channels);
    for note in notes(validation) {
        let _ = writeln!(text, "{note}");
    }
    text
}

fn line(judgement: &Judgement, channels: &[Channel]) -> String {
    let interpolation = judgement.interpolation.as_ref();
    let mark = if judgement.extrapolated > 0 { "*" } else { "" };
    let pair = |of: &dyn Fn(&ErrorTable) -> Option<String>| {
        let (interpolation, beside) = (
            interpolation.and_then(of),
            judgement.model_beside.as_ref().and_then(of),
        );
        // Where nothing is interpolated, the model stands alone.
        let model = match interpolation {
            Some(_) => beside,
            None => judgement.model.as_ref().and_then(of),
        };
        let [model, interpolation] = [model, interpolation].map(|words| cell(words, |words| words));
        format!("{model} | {interpolation}{mark}")
    };
    let mut text = String::new();
    for &channel in channels {
        let scale = ShownUnit::of(channel).factor;
        let rmse = |table: &ErrorTable| Some(format!("{:.2}", table.channel(channel)?.rmse * scale));
        let _ = write!(text, " {:>17}", pair(&rmse));
    }
    let sigmas = |table: &ErrorTable| table.all.rmse_fixed_sigma.map(|sigmas| format!("{sigmas:.2}"));
    let inside = match judgement.with_interval {
        0 => "-".into(),
        of => format!("{} of {of}", judgement.inside),
    };
    let _ = writeln!(text, " {:>15} {inside:>11}", pair(&sigmas));
    text
}

/// What the marks mean, and what does not count.
fn notes(validation: &Validation) -> Vec<String> {
    let total = &validation.total;
    let mut notes = Vec::new();
    if total.extrapolated > 0 {
        notes.push(format!(
            "*: interpolation extrapolates, {} in all",
            number::count(total.extrapolated, "measurement")
        ));
    }
    let rows = || validation.levels.iter().flat_map(|level| &level.rows);
    let (all, both) = (
        rows().count(),
        rows()
            .filter(|row| row.predicted.is_some() && row.interpolated.is_some())
            .count(),
    );
    if (1..all).contains(&both) {
        notes.push(format!(
            "where there are two, both errors are over the {both} of {} that model and interpolation predict",
            number::count(all, "measurement")
        ));
    }
    let refused = total.model.as_ref().map_or(0, |model| model.all.unpredicted);
    if refused > 0 {
        notes.push(format!(
            "without {} of runs that the model refuses at half of the draws or more",
            number::count(refused, "measurement")
        ));
    }
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for (reason, count) in validation.levels.iter().flat_map(|level| &level.not_interpolated) {
        *reasons.entry(reason).or_default() += count;
    }
    notes.extend(reasons.into_iter().map(|(reason, count)| {
        format!(
            "{} not interpolated: {reason}",
            number::count(count, "measurement")
        )
    }));
    notes
}
