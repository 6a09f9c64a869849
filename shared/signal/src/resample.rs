//! Resampling of steps of uneven length into intervals of equal length.

use super::error::{SignalError, require};

/// Relative tolerance for rounding when whole intervals are counted.
const ROUNDING: f64 = 1e-9;

/// Returns the number of whole intervals between the first and the last edge.
///
/// # Arguments
/// - `edges_s`: `[s]`, increasing. `interval_s`: `[s]`, > 0.
///
/// # Returns
/// `floor((t_end − t_0) / interval)`, where a last interval that is short by less than 1e-9 of itself counts as whole;
/// 0 with fewer than two edges.
pub fn intervals(edges_s: &[f64], interval_s: f64) -> usize {
    match edges_s {
        [first, .., last] => libm::floor((last - first) / interval_s + ROUNDING) as usize,
        _ => 0,
    }
}

/// Computes time-weighted means of a step function over intervals of equal length.
///
/// The value of step i holds from `edges_s[i]` to `edges_s[i + 1]`. With `t_0` the first edge, interval k reaches from
/// `t_0 + k dt` to `t_0 + (k + 1) dt` and gets `(1/dt) ∫ value dt`. The rest behind the last whole interval is left
/// out; nothing is extrapolated.
///
/// # Arguments
/// - `edges_s`: ends of the steps `[s]`, increasing, one more than there are values.
/// - `values`: one for each step, in the unit of the channel.
/// - `interval_s`: dt `[s]`, > 0, such as [`INTERVAL_S`](super::INTERVAL_S); longer or shorter than the steps.
/// - `out`: at least as long as the number of whole intervals ([`intervals`]).
///
/// # Returns
/// The number of means written at the beginning of `out`; the rest is unchanged.
///
/// # Errors
/// [`SignalError::Length`], [`SignalError::NotIncreasing`], [`SignalError::OutOfBounds`] for dt.
///
/// # Validity
/// Exact for a step function: the means times dt add up to its integral, to rounding.
///
/// Checked by the tests of this crate, such as `means_over_intervals_keep_the_integral`.
pub fn resample(
    edges_s: &[f64],
    values: &[f64],
    interval_s: f64,
    out: &mut [f64],
) -> Result<usize, SignalError> {
    require(interval_s > 0.0, "interval_s", interval_s, "s", "above", 0.0)?;
    if edges_s.len() != values.len() + 1 {
        return Err(SignalError::Length {
            what: "edges_s",
            got: edges_s.len(),
            needed: values.len() + 1,
        });
    }
    for (i, pair) in edges_s.windows(2).enumerate() {
        let ordered = pair[1] > pair[0] && pair[1].is_finite() && pair[0].is_finite();
        if !ordered {
            return Err(SignalError::NotIncreasing {
                position: i + 1,
                time_s: pair[1],
                before_s: pair[0],
            });
        }
    }
    let count = intervals(edges_s, interval_s);
    if out.len() < count {
        return Err(SignalError::Length {
            what: "out",
            got: out.len(),
            needed: count,
        });
    }
    let mut step = 0;
    for (k, mean) in out[..count].iter_mut().enumerate() {
        // A product instead of a running sum: the edges of the intervals do not drift.
        let from = edges_s[0] + k as f64 * interval_s;
        let to = edges_s[0] + (k + 1) as f64 * interval_s;
        let mut area = 0.0;
        let mut at = from;
        // The last step also covers rounding beyond its end.
        while step + 1 < values.len() && edges_s[step + 1] <= to {
            area += values[step] * (edges_s[step + 1] - at);
            at = edges_s[step + 1];
            step += 1;
        }
        area += values[step] * (to - at);
        *mean = area / interval_s;
    }
    Ok(count)
}
