//! Errors of histories and settings.

/// Why a history or a setting is refused. Messages are fragments that complete "failed to average: …".
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SignalError {
    /// A slice is too short or too long.
    #[error("{what} has {got} entries, {needed} are needed")]
    Length {
        /// Name of the slice.
        what: &'static str,
        /// Length of the slice.
        got: usize,
        /// Required length, or minimum length.
        needed: usize,
    },
    /// Times do not increase, or are not numbers.
    #[error("time {time_s} s at position {position} does not lie after {before_s} s")]
    NotIncreasing {
        /// Position of the offending time.
        position: usize,
        /// The offending time `[s]`.
        time_s: f64,
        /// The time of the sample before `[s]`.
        before_s: f64,
    },
    /// A setting lies outside its bounds.
    #[error("{name} = {value} {unit} must be {bound} {limit} {unit}")]
    OutOfBounds {
        /// Name of the setting, with its unit.
        name: &'static str,
        /// Refused value.
        value: f64,
        /// Unit of value and limit.
        unit: &'static str,
        /// Direction of the limit: `above` or `below`.
        bound: &'static str,
        /// The limit.
        limit: f64,
    },
}

/// Returns `Ok` if `accepted`; NaN fails every comparison, so a bound written as a positive condition rejects it.
pub(super) fn require(
    accepted: bool,
    name: &'static str,
    value: f64,
    unit: &'static str,
    bound: &'static str,
    limit: f64,
) -> Result<(), SignalError> {
    if accepted && value.is_finite() {
        return Ok(());
    }
    Err(SignalError::OutOfBounds {
        name,
        value,
        unit,
        bound,
        limit,
    })
}
