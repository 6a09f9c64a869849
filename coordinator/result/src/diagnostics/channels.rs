//! Channel diagnostics: information, misfit and coverage of each channel.

use std::collections::BTreeMap;

use inference::diagnostics::{self, ChannelSignal, PredictedDraw};
use shared::experiment::RunUse;
use statistics::ErrorSd;

use super::data_channel::fitted_channels;
use super::residuals::ResidualDiagnostics;
use crate::finished_calibration::FinishedCalibration;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::row::rows_of;
use crate::words::data_channel::DataChannel;
use crate::words::number;
use crate::words::probability::{LEVEL, p_words};

/// The diagnostics of a channel with fitted data.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChannelDiagnostics {
    /// Channel without unit; `plates` and `rings` for readings of the bevameter, `transient_sinkage` for sinkages before the steady state.
    #[schema(value_type = String)]
    pub channel: DataChannel,
    /// Unit of the standard deviations; for plates and rings they are those of the natural logarithm.
    pub unit: String,
    /// Number of fitted data.
    pub data: usize,
    /// Root mean square of the total error standard deviations: noise, discrepancy and shared errors.
    pub error_sd: Option<f64>,
    /// Root mean square of the prior predictive standard deviations: the spread that the prior allows.
    pub prior_predictive_sd: Option<f64>,
    /// Root mean square of the ratio of prior predictive to error standard deviation; below 1 a datum is less informative than the prior.
    pub information: Option<f64>,
    /// Effective number of parameters that the channel determines: the sum of its leverages.
    pub effective_parameters: Option<f64>,
    /// The misfit of the channel; null if its noise is inferred.
    pub chi_square: Option<ChiSquareTest>,
    /// Coverage of the 90 % intervals of fitted measurements.
    pub coverage90_fit: Option<CoverageCount>,
    /// Coverage of the 90 % intervals of holdout measurements.
    pub coverage90_holdout: Option<CoverageCount>,
    /// A sentence if the channel is uninformative or nearly so.
    pub silence: Option<String>,
}

/// A chi-square test of residuals.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChiSquareTest {
    /// The sum of squares of the residuals, transformed to be independent with unit variance.
    pub chi_square: f64,
    /// Number of data, which are those with known noise.
    pub data: usize,
    /// Number of data minus the effective number of parameters that they determine.
    pub degrees_of_freedom: f64,
    /// Probability of a sum at least this large; null if no degree of freedom is left.
    pub p: Option<f64>,
}

impl ChiSquareTest {
    /// Says how large the residuals are and what it means, for example `the 24 residuals are 1.7 times as large as the assumed errors ...`:
    /// the square root of chi-square over its degrees of freedom.
    pub fn words(&self) -> String {
        let (data, chi_square) = (self.data, number::significant(self.chi_square, 3));
        match self.p {
            Some(p) => format!(
                "the {data} residuals are {} times as large as expected from the assumed errors (chi-square {chi_square} with {} degrees of freedom, {}): {}",
                number::significant((self.chi_square / self.degrees_of_freedom).sqrt(), 2),
                number::significant(self.degrees_of_freedom, 3),
                p_words(p),
                judgement(p)
            ),
            None => format!(
                "the {data} residuals have a chi-square of {chi_square}, but no degree of freedom is left for a test"
            ),
        }
    }
}

/// Ratio of total to declared error up to which the sentence calls the total error the declared one.
const SAME_ERROR: f64 = 1.01;
/// Probability below which a sum is called larger than expected although it raises no flag.
const SUSPECT: f64 = 0.05;

fn judgement(p: f64) -> &'static str {
    if p < LEVEL {
        "more than the assumed errors explain"
    } else if p < SUSPECT {
        "slightly more than the assumed errors explain"
    } else if p > 1.0 - LEVEL {
        "less than expected, the assumed errors may be too large"
    } else {
        "the assumed errors explain the misfit"
    }
}

/// A count of measurements inside their intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CoverageCount {
    /// Number of measurements inside their interval.
    pub inside: usize,
    /// Number of measurements with an interval.
    pub of: usize,
    /// Lower end of the range of counts that correct intervals give 95 % of the time.
    pub expected_from: usize,
    /// Upper end of the range of counts that correct intervals give 95 % of the time.
    pub expected_to: usize,
}

impl CoverageCount {
    fn new(coverage: Coverage) -> Self {
        let [expected_from, expected_to] = coverage.expected();
        CoverageCount {
            inside: coverage.inside,
            of: coverage.total,
            expected_from,
            expected_to,
        }
    }
}

/// Returns the diagnostics of every channel that has fitted data.
pub fn channels(
    calibration: &FinishedCalibration,
    comparison: &Comparison,
    posterior: &[PredictedDraw],
    residuals: &[ResidualDiagnostics],
) -> Vec<ChannelDiagnostics> {
    let data = calibration.spec.likelihood.data();
    let signals = signals(calibration, residuals);
    let declared = |index: usize| {
        let of_channel = data.iter().filter(|d| d.channel == index);
        let sds: Option<Vec<f64>> = of_channel
            .map(|d| match d.sd {
                ErrorSd::Known(sd) => Some(sd),
                ErrorSd::Inferred { .. } => None,
            })
            .collect();
        let squares: Vec<f64> = sds?.iter().map(|sd| sd * sd).collect();
        diagnostics::mean(&squares).map(f64::sqrt)
    };
    let channel = |(index, channel): (usize, DataChannel)| {
        let rows = || residuals.iter().filter(|r| r.channel == channel);
        let count = |usage| {
            let compared =
                rows_of(&comparison.rows, usage).filter(|r| DataChannel::Wheel(r.channel) == channel);
            Coverage::count(compared).map(CoverageCount::new)
        };
        let signal = signals.get(&index);
        let row_count = rows().count();
        let squares: f64 = rows().map(|r| r.error_sd * r.error_sd).sum();
        ChannelDiagnostics {
            channel,
            unit: channel.si_unit().into(),
            data: data.iter().filter(|d| d.channel == index).count(),
            error_sd: (row_count > 0).then(|| (squares / row_count as f64).sqrt()),
            prior_predictive_sd: signal.map(|s| s.prior_sd),
            information: signal.map(|s| s.ratio),
            effective_parameters: (row_count > 0).then(|| rows().map(|r| r.leverage).sum()),
            chi_square: chi_square(calibration, posterior, |i| data[i].channel == index),
            coverage90_fit: count(RunUse::Fit),
            coverage90_holdout: count(RunUse::Holdout),
            silence: signal.and_then(|signal| silence(channel, signal, declared(index))),
        }
    };
    fitted_channels(&calibration.spec)
        .into_iter()
        .map(channel)
        .collect()
}

/// Returns the chi-square test of the data that `keep` selects by their index.
pub fn chi_square(
    calibration: &FinishedCalibration,
    posterior: &[PredictedDraw],
    keep: impl Fn(usize) -> bool,
) -> Option<ChiSquareTest> {
    // The sampler already evaluated the likelihood of these values, so an error cannot occur here.
    let found = diagnostics::chi_square(&calibration.spec.likelihood, posterior, keep).ok()??;
    Some(ChiSquareTest {
        chi_square: found.value,
        data: found.data,
        degrees_of_freedom: found.degrees_of_freedom(),
        p: found.p,
    })
}

/// Returns the prior predictive spread of each channel; empty for a fit, which has no draws from the prior.
fn signals(
    calibration: &FinishedCalibration,
    residuals: &[ResidualDiagnostics],
) -> BTreeMap<usize, ChannelSignal> {
    let prior = calibration.prior_draws().iter().filter_map(|draw| {
        Some(PredictedDraw {
            theta: draw.theta.clone(),
            values: draw.result.as_ref().ok()?.clone(),
        })
    });
    let variances: Vec<f64> = residuals.iter().map(|r| r.error_sd * r.error_sd).collect();
    diagnostics::signals(
        calibration.spec.likelihood.data(),
        &variances,
        &prior.collect::<Vec<_>>(),
    )
}

/// Returns a sentence on a channel whose error exceeds the spread that the prior allows; `None` for any other channel.
///
/// # Arguments
/// - `declared`: root mean square of the channel's declared noise; `None` if one is inferred.
fn silence(channel: DataChannel, signal: &ChannelSignal, declared: Option<f64>) -> Option<String> {
    if signal.ratio >= 1.0 {
        return None;
    }
    let shown = |sd: f64| channel.shown().size(sd);
    let total = shown(signal.error_sd);
    let error = match declared {
        None => format!("error of {total} (inferred from the misfit, with discrepancy and shared errors)"),
        Some(sd) if signal.error_sd <= SAME_ERROR * sd => format!("declared error of {total}"),
        Some(sd) => format!(
            "error, {} as declared and {total} with discrepancy and shared errors,",
            shown(sd)
        ),
    };
    let size = format!(
        "its {error} is {} times the spread that the prior allows",
        number::significant(1.0 / signal.ratio, 2)
    );
    Some(if signal.is_heard_together() {
        format!(
            "{} is nearly uninformative: {size}; only its {} rows together are more informative than the prior",
            channel.words(),
            signal.data
        )
    } else {
        format!("{} is uninformative: {size}", channel.words())
    })
}

#[cfg(test)]
mod tests {
    use shared::channel::Channel;

    use super::*;

    #[test]
    fn a_channel_that_is_drowned_says_so() {
        let signal = |data, ratio| ChannelSignal {
            data,
            prior_sd: 1.43,
            error_sd: 20.0,
            ratio,
        };
        let torque = DataChannel::Wheel(Channel::Torque);
        assert_eq!(
            silence(torque, &signal(24, 1.0 / 14.0), Some(20.0)).unwrap(),
            "torque is uninformative: its declared error of 20 N m is 14 times the spread that the prior allows"
        );
        assert_eq!(
            silence(torque, &signal(24, 1.0 / 14.0), Some(0.1)).unwrap(),
            "torque is uninformative: its error, 0.10 N m as declared and 20 N m with discrepancy and shared errors, is 14 times the spread that the prior allows"
        );
        assert_eq!(
            silence(torque, &signal(24, 0.5), None).unwrap(),
            "torque is nearly uninformative: its error of 20 N m (inferred from the misfit, with discrepancy and shared errors) is 2.0 times the spread that the prior allows; only its 24 rows together are more informative than the prior"
        );
        assert_eq!(silence(torque, &signal(24, 1.0), Some(20.0)), None);
    }

    #[test]
    fn a_chi_square_is_judged_in_words() {
        let test = |p| ChiSquareTest {
            chi_square: 61.5,
            data: 24,
            degrees_of_freedom: 21.04,
            p,
        };
        assert_eq!(
            test(Some(1e-5)).words(),
            "the 24 residuals are 1.7 times as large as expected from the assumed errors (chi-square 61.5 with 21.0 degrees of freedom, p = 1e-5): more than the assumed errors explain"
        );
        for (p, ending) in [
            (Some(0.4), "p = 0.40): the assumed errors explain the misfit"),
            (Some(0.02), "slightly more than the assumed errors explain"),
            (Some(0.999), "the assumed errors may be too large"),
            (None, "no degree of freedom is left for a test"),
        ] {
            assert!(test(p).words().ends_with(ending), "{ending}");
        }
    }
}
