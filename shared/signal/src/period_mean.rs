//! The mean over a whole number of periods at the end of a window.

use super::error::{SignalError, require};

/// Relative tolerance for rounding when whole periods are counted.
const ROUNDING: f64 = 1e-9;

/// Means over intervals of equal length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledSignal<'a> {
    /// Start of the first interval `[s]`.
    pub start_s: f64,
    /// Length of an interval `[s]`, > 0.
    pub interval_s: f64,
    /// One mean for each interval, in the unit of the channel.
    pub samples: &'a [f64],
}

impl SampledSignal<'_> {
    /// Returns the end of the last interval `[s]`.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.samples.len() as f64 * self.interval_s
    }

    /// Returns the integral between two times within the history `[channel's unit · s]`.
    fn integral(&self, from_s: f64, to_s: f64) -> f64 {
        let last = self.samples.len() - 1;
        // The times are in units of intervals.
        let (from, to) = (
            (from_s - self.start_s) / self.interval_s,
            (to_s - self.start_s) / self.interval_s,
        );
        let first = (libm::floor(from) as usize).min(last);
        let mut sum = 0.0;
        for (k, x) in self.samples.iter().enumerate().skip(first) {
            let (begin, end) = ((k as f64).max(from), ((k + 1) as f64).min(to));
            if end <= begin {
                break;
            }
            sum += x * (end - begin);
        }
        sum * self.interval_s
    }
}

/// The part of a history that is averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Start `[s]`, after the transient.
    pub from_s: f64,
    /// End `[s]`, after the start.
    pub to_s: f64,
    /// Period of the oscillation `[s]`, such as from grouser to grouser, > 0; `None`: no oscillation.
    pub period_s: Option<f64>,
}

/// A mean and the number of periods that it covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodMean {
    /// The mean, in the unit of the channel.
    pub mean: f64,
    /// Number of whole periods covered; 0: the whole window, because no period is known or none fits.
    pub periods: u32,
    /// Length of time covered `[s]`.
    pub covered_s: f64,
}

/// Computes the mean over the last whole number of periods in a window.
///
/// With N the number of periods P that fit, `mean = 1/(N P) ∫ x dt` from `to − N P` to `to`; over the whole window if P
/// is unknown or longer than the window. Partial intervals count by their covered part.
///
/// # Arguments
/// - `history`: at least one sample. `window`: within the history.
///
/// # Returns
/// [`PeriodMean`]. A period that is short by less than 1e-9 of itself counts as whole.
///
/// # Errors
/// [`SignalError::Length`]: no sample. [`SignalError::OutOfBounds`]: the window leaves the history or is empty, or
/// period or interval is not above 0.
///
/// # Validity
/// An oscillation of period P cancels; if P is not a multiple of the interval dt, at most about `π A dt² / (4 N P²)` of
/// its amplitude A remains (the one partial interval is taken as constant).
///
/// # Source
/// A window that is not a multiple of the period causes an error of up to `A / (π N)`. Checked by the tests of this
/// crate, such as `a_mean_over_whole_periods_is_free_of_the_swing`.
pub fn period_mean(history: &SampledSignal<'_>, window: &Window) -> Result<PeriodMean, SignalError> {
    let Window {
        from_s,
        to_s,
        period_s,
    } = *window;
    let dt = history.interval_s;
    require(dt > 0.0, "interval_s", dt, "s", "above", 0.0)?;
    if history.samples.is_empty() {
        return Err(SignalError::Length {
            what: "samples",
            got: 0,
            needed: 1,
        });
    }
    let slack = ROUNDING * dt;
    let (start, end) = (history.start_s, history.end_s());
    require(from_s >= start - slack, "from_s", from_s, "s", "at least", start)?;
    require(to_s <= end + slack, "to_s", to_s, "s", "at most", end)?;
    require(to_s > from_s, "to_s", to_s, "s", "above", from_s)?;
    let length = to_s - from_s;
    let mut periods = 0;
    if let Some(period) = period_s {
        require(period > 0.0, "period_s", period, "s", "above", 0.0)?;
        // A count of periods beyond the range of `u32` counts as no period: such an oscillation is faster than any here.
        periods = libm::floor(length / period + ROUNDING) as u32;
    }
    let covered_s = match (periods, period_s) {
        (1.., Some(period)) => f64::from(periods) * period,
        _ => length,
    };
    let begin = (to_s - covered_s).max(start);
    let to = to_s.min(end);
    Ok(PeriodMean {
        mean: history.integral(begin, to) / (to - begin),
        periods,
        covered_s,
    })
}
