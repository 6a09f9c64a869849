//! Flags of channels in which interpolation without physics predicts holdout runs better than the model.

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

/// Ratio of the model's error to that of interpolation above which it is significantly larger. Each root mean square over n runs has the
/// relative standard error 1 / sqrt(2n).
pub(crate) const RATIO: f64 = 1.5;
/// Minimum number of holdout runs that both predict.
pub(crate) const MIN_RUNS: usize = 4;
/// Significance level: if the probability of an error at least this large under noise only is smaller, noise does not explain it.
pub(crate) const BY_CHANCE: f64 = 0.01;

/// Returns a flag for each channel of the current model that interpolation predicts better, on the holdout runs where it need not
/// extrapolate.
///
/// The error of a perfect model is the noise; that of interpolation also includes the noise of the fitted points. A model whose error
/// exceeds the noise significantly, and that of interpolation by half, misses something that the fitted measurements show.
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
        // A noise that was inferred from the misfit contains the model's error, so it cannot explain that error.
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

    /// Returns a calibration with six holdout runs, whose pull the model misses by `error` `[N]`.
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
