//! The information of a channel: whether its prior predictive spread is large enough, compared with its errors.

use std::collections::BTreeMap;

use super::moments::mean_and_sd;
use super::predicted_draw::PredictedDraw;
use statistics::likelihood::Datum;

/// The prior predictive spread of a channel against its errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelSignal {
    /// Number of data of the channel.
    pub data: usize,
    /// Root mean square over the data of the prior predictive standard deviation [unit of the channel].
    pub prior_sd: f64,
    /// Root mean square of the errors' standard deviations [unit of the channel].
    pub error_sd: f64,
    /// Root mean square of the ratio of both; below 1 a datum holds less information than the prior.
    pub ratio: f64,
}

impl ChannelSignal {
    /// Returns whether all data of the channel together, as independent measurements of one quantity, would hold as much
    /// information as the prior.
    #[must_use]
    pub fn is_heard_together(&self) -> bool {
        self.ratio * (self.data as f64).sqrt() >= 1.0
    }
}

/// Returns the signal of every channel that has data; empty with fewer than two draws.
///
/// # Arguments
/// - `error_variances`: the variance of each datum, as [`Likelihood::error_variances`](statistics::Likelihood::error_variances)
///   gives it.
/// - `prior_draws`: predictions at draws from the prior that the model accepted.
///
/// Checked by `diagnostics::the_signal_of_a_linear_model_is_its_slope`.
#[must_use]
pub fn signals(
    data: &[Datum],
    error_variances: &[f64],
    prior_draws: &[PredictedDraw],
) -> BTreeMap<usize, ChannelSignal> {
    let mut sums: BTreeMap<usize, [f64; 4]> = BTreeMap::new();
    if prior_draws.len() < 2 {
        return BTreeMap::new();
    }
    for (i, (datum, error)) in data.iter().zip(error_variances).enumerate() {
        let values: Vec<f64> = prior_draws.iter().map(|draw| draw.values[i]).collect();
        let Some((_, sd)) = mean_and_sd(&values) else {
            continue;
        };
        let sum = sums.entry(datum.channel).or_default();
        for (total, term) in sum.iter_mut().zip([1.0, sd * sd, *error, sd * sd / error]) {
            *total += term;
        }
    }
    sums.into_iter()
        .map(|(channel, [count, prior, error, ratio])| {
            let rms = |sum: f64| (sum / count).sqrt();
            let signal = ChannelSignal {
                data: count as usize,
                prior_sd: rms(prior),
                error_sd: rms(error),
                ratio: rms(ratio),
            };
            (channel, signal)
        })
        .collect()
}
