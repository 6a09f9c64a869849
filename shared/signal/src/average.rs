//! The average of a history by a protocol: filter, cut the transient, take the mean over whole periods.

use super::error::SignalError;
use super::low_pass::LowPass;
use super::period_mean::{PeriodMean, SampledSignal, Window, period_mean};

/// Filters a history in place, cuts its beginning, and takes the mean over the last whole number of periods.
///
/// Simulated and measured histories share this function, so that the same numbers give the same average.
///
/// # Arguments
/// - `samples`: one mean for each interval, in the unit of the channel; filtered in place over their whole length.
/// - `interval_s`: length of an interval `[s]`, > 0.
/// - `filter`: for histories of rate `1 / interval_s`; `None`: no filter.
/// - `transient_s`: cut from the beginning `[s]`, ≥ 0, shorter than the history.
/// - `period_s`: period of the oscillation `[s]`; `None`: no oscillation.
///
/// # Errors
/// As for [`period_mean`], which also states validity and source. Checked by `an_average_is_filter_cut_and_mean_in_this_order`.
pub fn average(
    samples: &mut [f64],
    interval_s: f64,
    filter: Option<&LowPass>,
    transient_s: f64,
    period_s: Option<f64>,
) -> Result<PeriodMean, SignalError> {
    if let Some(filter) = filter {
        filter.apply(samples);
    }
    let history = SampledSignal {
        start_s: 0.0,
        interval_s,
        samples,
    };
    let window = Window {
        from_s: transient_s,
        to_s: history.end_s(),
        period_s,
    };
    period_mean(&history, &window)
}
