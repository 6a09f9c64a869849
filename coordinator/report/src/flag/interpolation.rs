//! Channels in which interpolation without physics predicts held-out runs better than the model.

use inference::diagnostics::chi_square_tail;
use shared::channel::Channel;
use shared::experiment::RunUse;

use result::flag::{Flag, FlagKind};
use result::study::Study;
use result::table::errors::ErrorTable;
use result::table::fixed_sigma::SigmaSource;
use result::table::row::rows_of;
use result::words::data_channel::{DataChannel, ShownUnit};
use result::words::number;

/// Error of the model over that of interpolation from which it is clearly larger: beyond the scatter of two root mean squares
/// over a few runs, each known to 1 / sqrt(2n) of itself.
pub(crate) const RATIO: f64 = 1.5;
/// Least held-out runs in which both have a value.
pub(crate) const MIN_RUNS: usize = 4;
/// Probability of so large an error by noise alone below which noise is no excuse.
pub(crate) const BY_CHANCE: f64 = 0.01;

/// Flags of the current model, on the held-out runs where interpolation need not extrapolate.
///
/// A perfect model errs by the noise alone, interpolation by the noise of its own points besides. So a model that errs by more
/// than the noise explains, and by half as much again as interpolation, misses what the fitted measurements show.
pub(crate) fn interpolation_beats(study: &Study) -> Vec<Flag> {
    let Some(current) = study.current() else {
        return Vec::new();
    };
    let comparison = current.comparison();
    let both = || rows_of(&comparison.rows, RunUse::Holdout).filter(|r| r.is_interpolated());
    let (Some(model), Some(baseline)) = (ErrorTable::of_model(both()), ErrorTable::of_baseline(both()))
    else {
        return Vec::new();
    };
    let sigmas = study.fixed_sigmas();
    let flag = |channel: Channel| {
        let (model, baseline) = (model.channel(channel)?, baseline.channel(channel)?);
        let sigma = sigmas.get(channel)?;
        let (runs, in_sigmas) = (model.runs as f64, model.rmse / sigma.sd);
        let by_noise = chi_square_tail(runs * in_sigmas * in_sigmas, runs)?;
        // An inferred noise is the model's own error: no excuse, and no news.
        let noise = Some(sigma).filter(|sigma| sigma.source != SigmaSource::Inferred);
        let is_excused = noise.is_some() && by_noise >= BY_CHANCE;
        if model.runs < MIN_RUNS || model.rmse <= RATIO * baseline.rmse || is_excused {
            return None;
        }
        let noise = noise.map(|sigma| sigma.sd);
        let unit = ShownUnit::new(channel);
        let text = format!(
            "interpolation between the fitted measurements predicts {} better than the model: {} against {} on {} of held-out runs{}: the model misses something that the measurements show",
            channel.words(),
            unit.size(baseline.rmse),
            unit.size(model.rmse),
            number::count(model.runs, "measurement"),
            noise.map_or(String::new(), |sd| format!(
                ", where the noise is {}",
                unit.size(sd)
            ))
        );
        Some(Flag {
            channel: Some(DataChannel::Wheel(channel)),
            p: noise.map(|_| by_noise),
            ..Flag::plain(FlagKind::InterpolationBeats, text)
        })
    };
    Channel::ALL.into_iter().filter_map(flag).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use result::finished_calibration::FinishedCalibration;

    /// A calibration with six held-out runs, whose pull the model misses by this much `[N]`.
    fn missed_by(error: f64) -> Study {
        let calibration = fixture::with_held_out_runs(6, error);
        Study::from(calibration)
    }

    #[test]
    fn a_model_beaten_beyond_the_noise_is_flagged_with_both_errors() {
        let flags = interpolation_beats(&missed_by(5.0));
        assert_eq!(flags.len(), 1);
        assert_eq!(flags[0].kind, FlagKind::InterpolationBeats);
        assert!(
            flags[0]
                .text
                .contains("predicts drawbar pull better than the model: ")
                && flags[0].text.contains(
                    " N against 5.0 N on 6 measurements of held-out runs, where the noise is 1.0 N"
                ),
            "{}",
            flags[0].text
        );
    }

    #[test]
    fn an_error_that_noise_explains_is_not() {
        assert!(interpolation_beats(&missed_by(1.0)).is_empty());
        let without: FinishedCalibration = fixture::without_holdout();
        assert!(interpolation_beats(&Study::from(without)).is_empty());
    }
}
