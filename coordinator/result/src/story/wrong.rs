//! What a model gets wrong, channel by channel.

use inference::diagnostics::chi_square_tail;
use shared::channel::Channel;
use shared::experiment::RunUse;

use super::pattern;
use crate::finished_calibration::FinishedCalibration;
use crate::flag::interpolation::{BY_CHANCE, LEAST_RUNS, RATIO};
use crate::study::Study;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::SigmaSource;
use crate::table::row::rows_of;
use crate::words::data_channel::ShownUnit;
use crate::words::number;

/// The errors of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Wrong {
    /// The measured channels: first those that interpolation predicts better, then by error in noise sds, the worst first.
    pub channels: Vec<ChannelFailure>,
    /// The same in a sentence.
    pub text: String,
}

/// The error of a channel: on held-out runs where it is measured there, else on fitted runs.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChannelFailure {
    /// Channel without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Root mean square of measured minus predicted \[SI\].
    pub rmse: f64,
    /// SI unit.
    pub unit: String,
    /// The error in the noise sd that all calibrations of the study are measured by; null where none is known.
    pub noise_sds: Option<f64>,
    /// Error of interpolation between the fitted runs, where it need not extrapolate \[SI\]; null where it has no value.
    pub interpolation_rmse: Option<f64>,
    /// The model's error over that of interpolation on the same runs, where the model is clearly worse; null elsewhere.
    pub times_worse: Option<f64>,
    /// Where it fails and in which direction; null where no pattern stands out.
    pub place: Option<String>,
    /// Whether noise alone explains the error.
    pub is_within_noise: bool,
}

impl Wrong {
    pub(super) fn of(study: &Study, calibration: &FinishedCalibration) -> Wrong {
        let comparison = calibration.comparison();
        let trends = calibration.diagnostics(comparison).trends;
        let sigmas = study.fixed_sigmas();
        let table = |usage| ErrorTable::of_model(rows_of(&comparison.rows, usage));
        let tables = [RunUse::Holdout, RunUse::Fit].map(|usage| (usage, table(usage)));
        let both = || rows_of(&comparison.rows, RunUse::Holdout).filter(|r| r.is_interpolated());
        let (beside, interpolation) = (ErrorTable::of_model(both()), ErrorTable::of_baseline(both()));
        let failure = |channel: Channel| {
            let measured = |(usage, table): &(RunUse, Option<ErrorTable>)| {
                Some((*usage, table.as_ref()?.channel(channel)?))
            };
            let (usage, error) = tables.iter().find_map(measured)?;
            let sigma = sigmas.get(channel);
            let noise_sds = sigma.map(|sigma| error.rmse / sigma.sd);
            let by_noise = noise_sds.and_then(|sds| {
                let runs = error.runs as f64;
                chi_square_tail(runs * sds * sds, runs)
            });
            let is_noise = by_noise.is_some_and(|p| p >= BY_CHANCE);
            let baseline = interpolation.as_ref().and_then(|table| table.channel(channel));
            let own = beside.as_ref().and_then(|table| table.channel(channel));
            // An inferred noise is the model's own error, and no excuse.
            let is_excused = is_noise && sigma.is_some_and(|s| s.source != SigmaSource::Inferred);
            let times_worse = own
                .zip(baseline)
                .filter(|(own, _)| own.runs >= LEAST_RUNS && !is_excused)
                .map(|(own, baseline)| own.rmse / baseline.rmse)
                .filter(|&ratio| ratio > RATIO);
            let is_within_noise = is_noise && times_worse.is_none();
            let rows: Vec<_> = rows_of(&comparison.rows, usage)
                .filter(|row| row.channel == channel)
                .collect();
            Some(ChannelFailure {
                channel,
                usage,
                rmse: error.rmse,
                unit: channel.unit().into(),
                noise_sds,
                interpolation_rmse: baseline.map(|error| error.rmse),
                times_worse,
                place: (!is_within_noise)
                    .then(|| pattern::of(channel, &rows, &trends))
                    .flatten(),
                is_within_noise,
            })
        };
        let mut channels: Vec<ChannelFailure> = Channel::ALL.into_iter().filter_map(failure).collect();
        let rank = |c: &ChannelFailure| (c.times_worse.is_some(), c.noise_sds.unwrap_or(f64::INFINITY));
        channels.sort_by(|a, b| {
            let ((a_beaten, a_sds), (b_beaten, b_sds)) = (rank(a), rank(b));
            b_beaten.cmp(&a_beaten).then(b_sds.total_cmp(&a_sds))
        });
        let text = match (channels.is_empty(), comparison.rows.is_empty()) {
            (true, true) => "there is no wheel run to compare the model with".into(),
            (true, false) => "the model predicts no run: it rejected every final draw".into(),
            (false, _) => text(&channels),
        };
        Wrong { channels, text }
    }

    /// Whether noise alone explains the errors of every channel.
    pub(super) fn is_within_noise(&self) -> bool {
        !self.channels.is_empty() && self.channels.iter().all(|channel| channel.is_within_noise)
    }
}

fn text(channels: &[ChannelFailure]) -> String {
    let (within, beyond): (Vec<_>, Vec<_>) = channels.iter().partition(|c| c.is_within_noise);
    let small = |c: &&ChannelFailure| {
        let sds = c
            .noise_sds
            .map(|sds| format!(", {} times the noise", number::significant(sds, 2)));
        format!(
            "{} {}{}",
            c.channel.words(),
            size(c.channel, c.rmse),
            sds.unwrap_or_default()
        )
    };
    let small: Vec<String> = within.iter().map(small).collect();
    let Some(first) = beyond.first() else {
        let runs = runs(channels[0].usage);
        return format!("nothing beyond the noise on {runs} ({})", small.join("; "));
    };
    let mut clauses = vec![clause(first, None)];
    clauses.extend(beyond.windows(2).map(|pair| clause(pair[1], Some(pair[0]))));
    if !small.is_empty() {
        clauses.push(format!("within the noise: {}", small.join("; ")));
    }
    clauses.join("; ")
}

/// The error of a channel in words, without what the clause before has said.
fn clause(failure: &ChannelFailure, before: Option<&ChannelFailure>) -> String {
    let mut text = format!(
        "{} is off by {}",
        failure.channel.words(),
        size(failure.channel, failure.rmse)
    );
    if before.is_none_or(|before| before.usage != failure.usage) {
        text += &format!(" on {}", runs(failure.usage));
    }
    match (failure.times_worse, failure.interpolation_rmse, failure.noise_sds) {
        (Some(ratio), Some(rmse), _) => {
            text += &format!(
                ", {} times the {} of interpolation between the fitted runs",
                number::significant(ratio, 2),
                size(failure.channel, rmse)
            );
        }
        (_, _, Some(sds)) => text += &format!(", {} times the noise", number::significant(sds, 2)),
        _ => {}
    }
    match (&failure.place, before.and_then(|before| before.place.as_ref())) {
        (Some(place), Some(said)) if place == said => text += ", likewise",
        (Some(place), _) => text += &format!(": {place}"),
        (None, _) => {}
    }
    text
}

/// `11.7 N`.
fn size(channel: Channel, si: f64) -> String {
    let unit = ShownUnit::of(channel);
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
    use super::*;
    use crate::fixture;

    fn wrong(calibration: FinishedCalibration) -> Wrong {
        let study = Study::from(calibration);
        Wrong::of(&study, &study.lead)
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
        assert!(first.times_worse.is_some_and(|ratio| ratio > RATIO), "{first:?}");
        assert_eq!(first.place.as_deref(), Some("over-predicted in every run"));
        for words in [
            "drawbar pull is off by 8.00 N on held-out runs",
            "of interpolation",
        ] {
            assert!(
                wrong.text.starts_with("drawbar pull") && wrong.text.contains(words),
                "{}",
                wrong.text
            );
        }
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
    fn without_held_out_runs_the_fitted_ones_count() {
        let wrong = wrong(fixture::without_holdout());
        assert!(!wrong.channels.is_empty());
        assert!(
            wrong
                .channels
                .iter()
                .all(|c| c.usage == RunUse::Fit && c.interpolation_rmse.is_none())
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
