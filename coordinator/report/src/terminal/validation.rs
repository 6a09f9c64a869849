//! A validation as text: each level left out in turn.

use std::collections::BTreeMap;
use std::fmt::Write;

use shared::channel::Channel;

use super::column::cell;
use super::table::{Table, channel_title};
use result::table::errors::ErrorTable;
use result::validation::{Judgement, Validation};
use result::words::data_channel::ShownUnit;
use result::words::number;

/// Minimum width of the column of levels.
const LEVEL: usize = 24;

/// Tabulates the levels with the errors of model and interpolation, then all of them together.
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
    let mut table = Table::<Row>::new()
        .left(width, "left out", |row| row.name)
        .right(4, "runs", |row| row.runs);
    for &channel in &channels {
        let scale = ShownUnit::new(channel).factor;
        table = table.right(17, &channel_title(channel), move |row| {
            row.pair(|errors| Some(format!("{:.2}", errors.channel(channel)?.rmse * scale)))
        });
    }
    let table = table
        .right(15, "x noise", |row| {
            row.pair(|errors| errors.all.rmse_fixed_sigma.map(|sigmas| format!("{sigmas:.2}")))
        })
        .right(11, "inside", |row| match row.judgement.with_interval {
            0 => "-".into(),
            count => format!("{} of {count}", row.judgement.inside),
        });
    let mut text = format!(
        "{} with each {} left out in turn, calibrated by {} on the rest; model | interpolation\n\n{}",
        validation.name,
        validation.leave_out.name(),
        validation.algorithm.name(),
        table.header()
    );
    for level in &validation.levels {
        // A level without a judgement shows only its name and its runs.
        let row = Row {
            name: &level.level.name,
            runs: level.level.runs.len(),
            judgement: level.judgement.as_ref().unwrap_or(&validation.total),
        };
        text += &match (&level.judgement, &level.refused) {
            (Some(_), _) => table.line(row),
            (None, Some(reason)) => format!("{} {reason}\n", table.start(2, row)),
            (None, None) => table.start(2, row) + "\n",
        };
    }
    let judged = validation.levels.iter().filter(|level| level.judgement.is_some());
    text += &table.line(Row {
        name: "all",
        runs: judged.map(|level| level.level.runs.len()).sum(),
        judgement: &validation.total,
    });
    for note in notes(validation) {
        let _ = writeln!(text, "{note}");
    }
    text
}

/// A row of the table as text.
#[derive(Clone, Copy)]
struct Row<'a> {
    name: &'a str,
    runs: usize,
    judgement: &'a Judgement,
}

impl Row<'_> {
    /// Pairs a number of the model's errors with that of interpolation. The model is judged on the rows of both; without interpolation,
    /// on all its rows.
    fn pair(self, number: impl Fn(&ErrorTable) -> Option<String>) -> String {
        let judgement = self.judgement;
        let interpolation = judgement.interpolation.as_ref().and_then(&number);
        let model = match interpolation {
            Some(_) => &judgement.model_beside,
            None => &judgement.model,
        };
        let model = model.as_ref().and_then(&number);
        let [model, interpolation] = [model, interpolation].map(|words| cell(words, |words| words));
        let mark = if judgement.extrapolated > 0 { "*" } else { "" };
        format!("{model} | {interpolation}{mark}")
    }
}

/// Explains the marks, and counts the measurements that do not enter.
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fixture;
    use job::AlgorithmName;
    use result::table::errors::ErrorTable;
    use result::validation::{Factor, LeftOutLevel, ValidatedLevel, Validation};

    #[test]
    fn a_level_is_judged_by_its_own_rows_and_the_total_by_all() {
        let (whole, rest) = (fixture::without_holdout(), fixture::calibration());
        let level = |run: &str| LeftOutLevel {
            name: format!("slip of {run}"),
            from: Some(0.4),
            to: Some(0.4),
            runs: vec![run.to_owned()],
        };
        let judged = ValidatedLevel::predicted(level("e"), &whole, &rest);
        let judgement = judged.judgement.clone().unwrap();
        let model = judgement.model.clone().unwrap();
        assert_eq!(
            (model.drawbar_pull.unwrap().runs, model.sinkage.unwrap().runs),
            (1, 1)
        );
        assert_eq!(judged.rows.len(), 2);
        assert!(model.all.rmse_fixed_sigma.is_some() && judgement.with_interval == 2);
        let pull = judgement.interpolation.clone().unwrap().drawbar_pull.unwrap();
        // Interpolation lies between 0.5 N at slip 0.2 and 1.5 N at slip 0.5; the measurement is 1.2 N.
        assert!(pull.rmse < 0.5 && judgement.extrapolated < 2, "{judgement:?}");
        let levels = vec![
            judged,
            ValidatedLevel::refused(level("d"), "too few repeats".into()),
        ];
        let judged = Validation::new(&whole, Factor::Slip, AlgorithmName::Lm, levels);
        assert_eq!(judged.total, judgement);
        let text = validation(&judged);
        for words in ["slip of e", "slip of d", "too few repeats", "all", "2 of 2"] {
            assert!(text.contains(words), "{words} in {text}");
        }
        let json = serde_json::to_string(&judged).unwrap();
        let again: Validation = serde_json::from_str(&json).unwrap();
        assert_eq!(again.total, judgement);
    }

    #[test]
    fn model_and_interpolation_are_compared_on_the_rows_of_both_and_the_rest_is_counted_with_its_reason() {
        let (whole, mut rest) = (fixture::without_holdout(), fixture::with_refused_runs());
        // Run h0 has a wheel that was never fitted.
        let (h0, runs) = (fixture::position(&rest, "h0"), ["h0", "h1", "h2", "h3"]);
        let mut wheels = rest.spec.experiment.wheels.clone();
        wheels.insert("b".into(), wheels["a"].clone());
        Arc::make_mut(&mut rest.spec.experiment).wheels = wheels;
        Arc::make_mut(&mut rest.spec.experiment).runs[h0].wheel = "b".into();
        let level = LeftOutLevel {
            name: "load 25.0 N".into(),
            from: Some(25.0),
            to: Some(25.0),
            runs: runs.map(str::to_owned).into(),
        };
        let judged = ValidatedLevel::predicted(level, &whole, &rest);
        let judgement = judged.judgement.clone().unwrap();
        let rows = |table: &Option<ErrorTable>| table.as_ref().map(|table| table.drawbar_pull.unwrap().runs);
        // The model predicts h0 and h3; h1, h2 and h3 are interpolated.
        assert_eq!(
            (
                rows(&judgement.model),
                rows(&judgement.interpolation),
                rows(&judgement.model_beside)
            ),
            (Some(2), Some(1), Some(1))
        );
        assert_eq!(
            judged.not_interpolated,
            [("wheel b on soil sand has no fitted drawbar pull".to_owned(), 1)].into()
        );
        let text = validation(&Validation::new(
            &whole,
            Factor::Load,
            AlgorithmName::Lm,
            vec![judged],
        ));
        for words in [
            "both errors are over the 1 of 4 measurements that model and interpolation predict",
            "without 2 measurements of runs that the model refuses at half of the draws or more",
            "1 measurement not interpolated: wheel b on soil sand has no fitted drawbar pull",
        ] {
            assert!(text.contains(words), "{words} in {text}");
        }
    }
}
