//! The average of a history by a protocol: filter, cut the transient, take the mean over whole periods.

use super::error::SignalError;
use super::low_pass::LowPass;
use super::period_mean::{PeriodMean, SampledSignal, Window, period_mean};

/// Filters a history in place, cuts its beginning, and takes the mean over the last whole number of periods.
///
/// Simulated and measured histories both come here, so that the same numbers give the same average.
///
/// # Arguments
/// - `samples`: one mean for each interval, in the unit of the channel; filtered afterwards, over their whole length.
/// - `interval_s`: length of an interval `[s]`, > 0.
/// - `filter`: for histories of `1 / interval_s`; `None`: nothing is filtered.
/// - `transient_s`: cut from the beginning `[s]`, ≥ 0, shorter than the history.
/// - `period_s`: period of what swings `[s]`; `None`: nothing does.
///
/// # Returns
/// [`PeriodMean`].
///
/// # Errors
/// As those of [`period_mean`], which has validity and source, too. Checked by `an_average_is_filter_cut_and_mean_in_this_order`.
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
