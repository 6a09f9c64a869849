//! Errors of histories and settings.

/// What is wrong with a history or a setting. Messages are fragments that complete "failed to average: …".
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SignalError {
    /// A slice does not have the length that another one asks for.
    #[error("{what} has {got} entries, {needed} are needed")]
    Length {
        /// The slice.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length, or the least length, that it must have.
        needed: usize,
    },
    /// Times do not increase, or are no numbers.
    #[error("time {time_s} s at position {position} does not lie after {before_s} s")]
    NotIncreasing {
        /// Position of the time to blame.
        position: usize,
        /// That time `[s]`.
        time_s: f64,
        /// The time before it `[s]`.
        before_s: f64,
    },
    /// A setting lies outside its bounds.
    #[error("{name} = {value} {unit} must be {bound} {limit} {unit}")]
    OutOfBounds {
        /// The setting, which carries its unit.
        name: &'static str,
        /// The value given.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Which way the limit binds.
        bound: &'static str,
        /// The limit.
        limit: f64,
    },
}

/// Ok if `accepted`; NaN fails every comparison, so a bound written as a positive condition rejects it.
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
