//! A validation as text.

use std::collections::BTreeMap;
use std::fmt::Write;

use shared::channel::Channel;

use super::column::cell;
use result::table::errors::ErrorTable;
use result::validation::{Judgement, Validation};
use result::words::data_channel::{ShownUnit, short_name};
use result::words::number;

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
        let (of, others) = (fixture::without_holdout(), fixture::calibration());
        let level = |run: &str| LeftOutLevel {
            name: format!("slip of {run}"),
            from: Some(0.4),
            to: Some(0.4),
            runs: vec![run.to_owned()],
        };
        let judged = ValidatedLevel::predicted(level("e"), &of, &others);
        let judgement = judged.judgement.clone().unwrap();
        let model = judgement.model.clone().unwrap();
        assert_eq!(
            (model.drawbar_pull.unwrap().runs, model.sinkage.unwrap().runs),
            (1, 1)
        );
        assert_eq!(judged.rows.len(), 2);
        assert!(model.all.rmse_fixed_sigma.is_some() && judgement.with_interval == 2);
        let pull = judgement.interpolation.clone().unwrap().drawbar_pull.unwrap();
        // Between 0.5 N at slip 0.2 and 1.5 N at 0.5; measured are 1.2 N.
        assert!(pull.rmse < 0.5 && judgement.extrapolated < 2, "{judgement:?}");
        let levels = vec![
            judged,
            ValidatedLevel::refused(level("d"), "too few repeats".into()),
        ];
        let judged = Validation::new(&of, Factor::Slip, AlgorithmName::Lm, levels);
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
        let (of, mut others) = (fixture::without_holdout(), fixture::with_refused_runs());
        // h0 is of a wheel that was never fitted.
        let place = |run: &str| others.spec.experiment.runs.iter().position(|own| own.name == run);
        let (h0, runs) = (place("h0").unwrap(), ["h0", "h1", "h2", "h3"]);
        let mut wheels = others.spec.experiment.wheels.clone();
        wheels.insert("b".into(), wheels["a"].clone());
        Arc::make_mut(&mut others.spec.experiment).wheels = wheels;
        Arc::make_mut(&mut others.spec.experiment).runs[h0].wheel = "b".into();
        let level = LeftOutLevel {
            name: "load 25.0 N".into(),
            from: Some(25.0),
            to: Some(25.0),
            runs: runs.map(str::to_owned).into(),
        };
        let judged = ValidatedLevel::predicted(level, &of, &others);
        let judgement = judged.judgement.clone().unwrap();
        let rows = |table: &Option<ErrorTable>| table.as_ref().map(|own| own.drawbar_pull.unwrap().runs);
        // Predicted are h0 and h3, interpolated h1, h2 and h3.
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
            &of,
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
