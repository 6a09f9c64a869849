//! The mean over a whole number of periods at the end of a window.

use super::error::{SignalError, require};

/// Relative amount by which rounding may keep a period from fitting once more.
const ROUNDING: f64 = 1e-9;

/// Means over intervals of equal length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledSignal<'a> {
    /// Where the first interval begins `[s]`.
    pub start_s: f64,
    /// Length of an interval `[s]`, > 0.
    pub interval_s: f64,
    /// One mean for each interval, in the unit of the channel.
    pub samples: &'a [f64],
}

impl SampledSignal<'_> {
    /// Where the last interval ends `[s]`.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.samples.len() as f64 * self.interval_s
    }

    /// Integral from one time to another `[channel's unit · s]`, both within the history.
    fn integral(&self, from_s: f64, to_s: f64) -> f64 {
        let last = self.samples.len() - 1;
        // Times in intervals.
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

/// Which part of a history counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Where it begins `[s]`: the transient lies before.
    pub from_s: f64,
    /// Where it ends `[s]`, after the beginning.
    pub to_s: f64,
    /// Period of the oscillation, such as from grouser to grouser `[s]`, > 0; `None`: no oscillation.
    pub period_s: Option<f64>,
}

/// A mean and the number of periods that it was taken over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodMean {
    /// The mean, in the unit of the channel.
    pub mean: f64,
    /// Whole periods that it covers; 0: the whole window, because no period is known or none fits.
    pub periods: u32,
    /// Length of time that it covers `[s]`.
    pub covered_s: f64,
}

/// Mean over the last whole number of periods in a window.
///
/// With N the number of periods P that fit, `mean = 1/(N P) ∫ x dt` from `to − N P` to `to`; over the whole window
/// where P is not known or longer than the window. Intervals that are cut count by the part that is covered.
///
/// # Arguments
/// - `history`: at least one sample. `window`: within the history.
///
/// # Returns
/// [`PeriodMean`]. A period that lacks less than 1e-9 of itself counts as whole.
///
/// # Errors
/// [`SignalError::Length`]: no sample. [`SignalError::OutOfBounds`]: the window leaves the history or is empty, the period
/// is not above 0, the interval is not.
///
/// # Validity
/// An oscillation of period P drops out; where P is not a multiple of the interval dt, all but about `π A dt² / (4 N P²)` of
/// its amplitude A does (the one cut interval is taken as constant).
///
/// # Source
/// A window that is no multiple of the period is off by up to `A / (π N)`. Checked by
/// `a_mean_over_whole_periods_is_free_of_the_swing` and others of that file.
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
        // More periods than the largest count are a window without any: the swing is faster than anything here.
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
