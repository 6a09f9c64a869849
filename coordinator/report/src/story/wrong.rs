//! The answer to "what is wrong?": the errors of a model, channel by channel.

use inference::diagnostics::chi_square_tail;
use shared::channel::Channel;
use shared::experiment::RunUse;

use super::pattern;
use crate::diagnosis::diagnostics;
use crate::flag::cause::pattern_of;
use crate::flag::interpolation::{BY_CHANCE, MIN_RUNS, RATIO};
use result::diagnostics::trends::TrendDiagnostics;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::table::errors::ErrorTable;
use result::table::fixed_sigma::{FixedSigmas, SigmaSource};
use result::table::row::{ComparisonRow, rows_of};
use result::words::data_channel::ShownUnit;
use result::words::number;

/// The errors of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Wrong {
    /// The measured channels: first those that interpolation predicts better, then by decreasing error in noise standard deviations.
    pub channels: Vec<ChannelFailure>,
    /// The same in a sentence.
    pub text: String,
}

/// The error of a channel: on the holdout runs if they measured it, else on the fitted runs.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChannelFailure {
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Use of the runs: `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Root mean square of measured minus predicted \[SI\].
    pub rmse: f64,
    /// SI unit of the channel.
    pub unit: String,
    /// The error in the noise standard deviation of the study; null if it is unknown.
    pub noise_sds: Option<f64>,
    /// Errors of model and interpolation on the same runs; null if every holdout run needs extrapolation.
    pub beside_interpolation: Option<BesideInterpolation>,
    /// Whether the model is clearly worse than interpolation on the same runs.
    pub is_beaten: bool,
    /// Conditions and direction of the errors; null without a pattern.
    pub place: Option<String>,
    /// Whether noise alone explains the error; false if it cannot be judged.
    pub is_within_noise: bool,
    /// Whether the error can be judged. It cannot if the noise is inferred together with the misfit, unless interpolation predicts
    /// better.
    pub is_judged: bool,
}

/// The errors of the model and of interpolation on the held-out runs that lie between the fitted ones.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct BesideInterpolation {
    /// Number of these runs.
    pub runs: usize,
    /// Number of the held-out runs with a prediction.
    pub of: usize,
    /// Error of the model on them \[SI\].
    pub model_rmse: f64,
    /// Error of interpolation on them \[SI\].
    pub interpolation_rmse: f64,
}

/// The inputs for judging the channels of a calibration.
struct Judge<'a> {
    rows: &'a [ComparisonRow],
    trends: Vec<TrendDiagnostics>,
    sigmas: FixedSigmas,
    /// Errors on the holdout runs, then on the fitted runs.
    errors: [(RunUse, Option<ErrorTable>); 2],
    /// Errors of the model, then of interpolation, on the rows that both predict without extrapolation.
    beside: [Option<ErrorTable>; 2],
}

impl<'a> Judge<'a> {
    fn new(study: &Study, calibration: &FinishedCalibration, rows: &'a [ComparisonRow]) -> Self {
        let table = |usage| ErrorTable::of_model(rows_of(rows, usage));
        let both = || rows_of(rows, RunUse::Holdout).filter(|r| r.is_interpolated());
        Judge {
            rows,
            trends: diagnostics(calibration, calibration.comparison()).trends,
            sigmas: study.fixed_sigmas(),
            errors: [RunUse::Holdout, RunUse::Fit].map(|usage| (usage, table(usage))),
            beside: [ErrorTable::of_model(both()), ErrorTable::of_baseline(both())],
        }
    }

    /// Returns the error of a channel; `None` if the channel is not measured or not predicted.
    fn failure(&self, channel: Channel) -> Option<ChannelFailure> {
        let measured =
            |(usage, table): &(RunUse, Option<ErrorTable>)| Some((*usage, table.as_ref()?.channel(channel)?));
        let (usage, error) = self.errors.iter().find_map(measured)?;
        let sigma = self.sigmas.get(channel);
        let noise_sds = sigma.map(|sigma| error.rmse / sigma.sd);
        let by_noise = noise_sds.and_then(|sds| {
            let runs = error.runs as f64;
            chi_square_tail(runs * sds * sds, runs)
        });
        // A noise that was inferred from the misfit contains the model's error, so it can neither explain nor show a failure.
        let is_known = sigma.is_none_or(|sigma| sigma.source != SigmaSource::Inferred);
        // Errors as small as the noise that follow a condition are not noise alone.
        let trend = pattern_of(&self.trends, channel);
        let is_noise = is_known && trend.is_none() && by_noise.is_some_and(|p| p >= BY_CHANCE);
        let beside_interpolation = self.beside_interpolation(channel, error.runs);
        let is_beaten = !is_noise
            && beside_interpolation.is_some_and(|both| {
                both.runs >= MIN_RUNS && both.model_rmse > RATIO * both.interpolation_rmse
            });
        let is_judged = is_known || is_beaten;
        let [rows, fitted] = [usage, RunUse::Fit].map(|usage| {
            let rows = rows_of(self.rows, usage).filter(|row| row.channel == channel);
            rows.collect::<Vec<&ComparisonRow>>()
        });
        let beyond = || pattern::place_beyond(&rows, &fitted);
        let place = || beyond().or(trend).or_else(|| pattern::place(&rows));
        Some(ChannelFailure {
            channel,
            usage,
            rmse: error.rmse,
            unit: channel.unit().into(),
            noise_sds,
            beside_interpolation,
            is_beaten,
            place: (is_judged && !is_noise).then(place).flatten(),
            is_within_noise: is_noise,
            is_judged,
        })
    }

    fn beside_interpolation(&self, channel: Channel, predicted_runs: usize) -> Option<BesideInterpolation> {
        let [model, interpolation] = &self.beside;
        let model = model.as_ref()?.channel(channel)?;
        let interpolation = interpolation.as_ref()?.channel(channel)?;
        Some(BesideInterpolation {
            runs: model.runs,
            of: predicted_runs,
            model_rmse: model.rmse,
            interpolation_rmse: interpolation.rmse,
        })
    }
}

impl Wrong {
    pub(super) fn new(study: &Study, calibration: &FinishedCalibration) -> Wrong {
        let rows = &calibration.comparison().rows;
        let judge = Judge::new(study, calibration, rows);
        let failures = Channel::ALL.into_iter();
        let mut channels: Vec<ChannelFailure> =
            failures.filter_map(|channel| judge.failure(channel)).collect();
        let rank = |c: &ChannelFailure| {
            let sds = c.noise_sds.unwrap_or(f64::INFINITY);
            (c.is_beaten, c.is_judged, sds)
        };
        channels.sort_by(|a, b| {
            let ((a_beaten, a_judged, a_sds), (b_beaten, b_judged, b_sds)) = (rank(a), rank(b));
            let by_kind = (b_beaten, b_judged).cmp(&(a_beaten, a_judged));
            by_kind.then(b_sds.total_cmp(&a_sds))
        });
        let text = match (channels.is_empty(), rows.is_empty()) {
            (true, true) => "there is no wheel run to compare the model with".into(),
            (true, false) => "the model predicts no run: it rejected every final draw".into(),
            (false, _) => text(&channels),
        };
        Wrong { channels, text }
    }

    /// Returns whether noise alone explains the errors of every channel; false if one cannot be judged.
    pub(super) fn is_within_noise(&self) -> bool {
        !self.channels.is_empty() && self.channels.iter().all(|channel| channel.is_within_noise)
    }
}

fn text(channels: &[ChannelFailure]) -> String {
    let (judged, open): (Vec<_>, Vec<_>) = channels.iter().partition(|c| c.is_judged);
    let (within, beyond): (Vec<_>, Vec<_>) = judged.into_iter().partition(|c| c.is_within_noise);
    let small = |c: &&ChannelFailure| {
        let sds = c
            .noise_sds
            .map(|sds| format!(", {} times the noise", number::significant(sds, 2)));
        format!("{}{}", named(c), sds.unwrap_or_default())
    };
    let small = within.iter().map(small).collect::<Vec<_>>().join("; ");
    let mut clauses: Vec<String> = beyond
        .first()
        .map(|first| clause(first, None))
        .into_iter()
        .collect();
    clauses.extend(beyond.windows(2).map(|pair| clause(pair[1], Some(pair[0]))));
    match (within.first(), beyond.is_empty()) {
        (None, _) => {}
        (Some(first), true) => {
            let runs = runs(first.usage);
            clauses.push(format!("nothing beyond the noise on {runs} ({small})"));
        }
        (Some(_), false) => clauses.push(format!("within the noise: {small}")),
    }
    if let Some(first) = open.first() {
        let names: Vec<String> = open.iter().map(|c| named(c)).collect();
        let its = if open.len() == 1 { "its" } else { "their" };
        clauses.push(format!(
            "{} on {} cannot be judged: {its} noise is inferred together with the misfit",
            number::list(&names),
            runs(first.usage)
        ));
    }
    clauses.join("; ")
}

/// Returns, for example, `sinkage 0.31 mm`.
fn named(failure: &ChannelFailure) -> String {
    format!(
        "{} {}",
        failure.channel.words(),
        size(failure.channel, failure.rmse)
    )
}

/// Describes the error of a channel, without what the previous clause already says.
fn clause(failure: &ChannelFailure, before: Option<&ChannelFailure>) -> String {
    let mut text = format!(
        "{} is off by {}",
        failure.channel.words(),
        size(failure.channel, failure.rmse)
    );
    if before.is_none_or(|before| before.usage != failure.usage) {
        text += &format!(" on {}", runs(failure.usage));
    }
    let interpolation = failure.beside_interpolation.filter(|_| failure.is_beaten);
    match (interpolation, failure.noise_sds) {
        (Some(both), _) => text += &beaten(failure.channel, both, before.is_some_and(|b| b.is_beaten)),
        (None, Some(sds)) => text += &format!(", {} times the noise", number::significant(sds, 2)),
        (None, None) => {}
    }
    match (&failure.place, before.and_then(|before| before.place.as_ref())) {
        (Some(place), Some(earlier)) if place == earlier => text += ", likewise",
        (Some(place), _) => text += &format!(": {place}"),
        (None, _) => {}
    }
    text
}

/// Describes the error of interpolation: `, where interpolation between the fitted runs has 0.31 N m`. The model's error on the same runs
/// follows if interpolation reaches fewer runs.
fn beaten(channel: Channel, both: BesideInterpolation, is_repeated: bool) -> String {
    let interpolation = size(channel, both.interpolation_rmse);
    if both.runs == both.of {
        return format!(", where interpolation between the fitted runs has {interpolation}");
    }
    let between = match is_repeated {
        false => format!("on the {} of {} that lie between fitted runs", both.runs, both.of),
        true => format!("on {} of {}", both.runs, both.of),
    };
    let model = size(channel, both.model_rmse);
    format!(", and {between} by {model} where interpolation has {interpolation}")
}

/// Formats an error, for example `11.7 N`, with the same digits wherever the error stands.
pub(crate) fn size(channel: Channel, si: f64) -> String {
    let unit = ShownUnit::new(channel);
    let decimals = if unit.factor * si < 1.0 { 2 } else { 3 };
    format!(
        "{} {}",
        number::significant(unit.factor * si, decimals),
        unit.name
    )
}

fn runs(usage: RunUse) -> &'static str {
    match usage {
        RunUse::Fit => "fitted runs",
        RunUse::Holdout => "held-out runs",
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fixture;
    use result::diagnostics::trends::TrendVariable;

    fn wrong(calibration: FinishedCalibration) -> Wrong {
        let study = Study::from(calibration);
        Wrong::new(&study, &study.lead)
    }

    #[test]
    fn a_channel_that_interpolation_predicts_better_leads_with_both_errors() {
        let wrong = wrong(fixture::with_held_out_runs(6, 8.0));
        let first = &wrong.channels[0];
        assert_eq!(
            (first.channel, first.usage),
            (Channel::DrawbarPull, RunUse::Holdout)
        );
        assert!((first.rmse - 8.0).abs() < 1e-9, "{first:?}");
        assert!(first.is_beaten, "{first:?}");
        assert_eq!(first.place.as_deref(), Some("over-predicted in every run"));
        let words = "drawbar pull is off by 8.00 N on held-out runs, where interpolation between the fitted runs has 0";
        assert!(wrong.text.starts_with(words), "{}", wrong.text);
    }

    #[test]
    fn errors_that_stand_beside_interpolation_are_on_the_runs_that_it_reaches() {
        let mut calibration = fixture::with_held_out_runs(8, 8.0);
        // Four of the runs lie beyond the fitted slips, where the model is worse.
        for &run in &calibration.spec.holdout_runs[4..] {
            Arc::make_mut(&mut calibration.spec.experiment).runs[run].slip = 0.9;
        }
        for holdout in calibration
            .predictions
            .iter_mut()
            .flat_map(|prediction| &mut prediction.holdout)
        {
            let observables = holdout.together.as_mut().unwrap();
            observables.drawbar_pull_n[4..]
                .iter_mut()
                .for_each(|pull| *pull += 72.0);
        }
        let study = Study::from(calibration);
        let wrong = Wrong::new(&study, &study.lead);
        let first = &wrong.channels[0];
        let both = first.beside_interpolation.unwrap();
        assert_eq!((both.runs, both.of), (4, 8));
        assert!((both.model_rmse - 8.0).abs() < 1e-9, "{both:?}");
        let words = "drawbar pull is off by 56.9 N on held-out runs, and on the 4 of 8 that lie between fitted runs by 8.00 N where interpolation has 0";
        assert!(wrong.text.starts_with(words), "{}", wrong.text);
        // The first number in the sentence is the one in the ledger.
        let lines = study.ledger_lines();
        let row = lines[0].rows.iter().find(|row| row.usage == RunUse::Holdout);
        let in_ledger = row.and_then(|row| row.errors.channel(Channel::DrawbarPull));
        assert!((in_ledger.unwrap().rmse - first.rmse).abs() < 1e-9);
    }

    #[test]
    fn a_channel_whose_noise_is_inferred_cannot_be_judged() {
        let wrong = wrong(fixture::with_held_out_runs(6, 0.1));
        let mut channels = wrong.channels.iter();
        let sinkage = channels.find(|c| c.channel == Channel::Sinkage).unwrap();
        assert!(!sinkage.is_judged && !sinkage.is_within_noise && sinkage.place.is_none());
        assert!(!wrong.is_within_noise());
        let words = "on fitted runs cannot be judged: its noise is inferred together with the misfit";
        let (before, _) = wrong
            .text
            .split_once(words)
            .unwrap_or_else(|| panic!("{}", wrong.text));
        let (_, sinkage) = before.rsplit_once("; sinkage ").unwrap();
        assert!(sinkage.ends_with(" mm "), "{}", wrong.text);
        assert!(
            !before.contains("mm, "),
            "no share of an inferred noise: {}",
            wrong.text
        );
    }

    #[test]
    fn an_error_in_the_noise_is_named_with_its_size_and_is_no_failure() {
        let wrong = wrong(fixture::with_held_out_runs(6, 0.1));
        let pull = wrong
            .channels
            .iter()
            .find(|c| c.channel == Channel::DrawbarPull)
            .unwrap();
        assert!(pull.is_within_noise && pull.place.is_none(), "{pull:?}");
        assert!(
            wrong.text.contains("drawbar pull 0.10 N, 0.10 times the noise"),
            "{}",
            wrong.text
        );
    }

    #[test]
    fn an_error_as_small_as_the_noise_that_follows_a_condition_is_not_noise_alone() {
        let calibration = fixture::with_held_out_runs(6, 0.1);
        let study = Study::from(calibration);
        let rows = &study.lead.comparison().rows;
        let mut judge = Judge::new(&study, &study.lead, rows);
        assert!(judge.failure(Channel::DrawbarPull).unwrap().is_within_noise);
        judge.trends = vec![TrendDiagnostics {
            channel: Channel::DrawbarPull,
            against: TrendVariable::Slip,
            unit: "N".into(),
            change: 0.3,
            change_sd: 0.05,
            share_left: 0.9,
            p: 1e-9,
        }];
        let pull = judge.failure(Channel::DrawbarPull).unwrap();
        assert!(!pull.is_within_noise, "{pull:?}");
        let place = "over-predicted at low slip and under-predicted at high slip";
        assert_eq!(pull.place.as_deref(), Some(place));
    }

    #[test]
    fn without_held_out_runs_the_fitted_ones_count() {
        let wrong = wrong(fixture::without_holdout());
        assert!(!wrong.channels.is_empty());
        assert!(
            wrong
                .channels
                .iter()
                .all(|c| c.usage == RunUse::Fit && c.beside_interpolation.is_none())
        );
        assert!(wrong.text.contains("fitted runs"), "{}", wrong.text);
    }

    #[test]
    fn a_model_that_predicts_nothing_says_so() {
        let wrong = wrong(fixture::all_rejected());
        assert!(wrong.channels.is_empty() && !wrong.is_within_noise());
        assert!(wrong.text.contains("rejected every final draw"), "{}", wrong.text);
    }
}
