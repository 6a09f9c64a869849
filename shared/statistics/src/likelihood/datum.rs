//! One measured value and its noise, and the errors of data and predictions.

use crate::log_likelihood::NotANumber;

/// The standard deviation of an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ErrorSd {
    /// A known standard deviation, in the unit of the datum.
    Known(f64),
    /// An inferred standard deviation.
    Inferred {
        /// Index of the sd in theta.
        parameter: usize,
    },
}

/// One measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Index of the test run.
    pub run: usize,
    /// Index of the channel.
    pub channel: usize,
    /// The measured value, in the unit of the channel.
    pub value: f64,
    /// Noise sd of the datum.
    pub sd: ErrorSd,
}

/// Why data or predictions cannot be scored.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LikelihoodError {
    /// A measured value is NaN or infinite.
    #[error("measured value {value} of run {run}, channel {channel} is not finite")]
    Value {
        /// Index of the run.
        run: usize,
        /// Index of the channel.
        channel: usize,
        /// The refused value.
        value: f64,
    },
    /// A noise sd is not a finite number above 0.
    #[error("noise sd {value} of run {run}, channel {channel} is not a finite number above 0")]
    Noise {
        /// Index of the run.
        run: usize,
        /// Index of the channel.
        channel: usize,
        /// The refused sd.
        value: f64,
    },
    /// An inferred sd names a parameter that theta lacks.
    #[error("noise sd is parameter {parameter}, but theta has {dimension}")]
    MissingParameter {
        /// Index of the parameter in theta.
        parameter: usize,
        /// The length of theta.
        dimension: usize,
    },
    /// A model without the parameter of an inferred sd or correlation length was requested.
    #[error("parameter {parameter} is the sd or correlation length of an error and cannot be left out")]
    DroppedSd {
        /// Index of the parameter in theta.
        parameter: usize,
    },
    /// A predicted value is NaN or infinite.
    #[error("prediction {value} of run {run}, channel {channel} is not finite")]
    Prediction {
        /// Index of the run.
        run: usize,
        /// Index of the channel.
        channel: usize,
        /// The prediction.
        value: f64,
    },
    /// The number of predicted values is wrong.
    #[error("{given} predicted values, {expected} are expected")]
    Length {
        /// The number by [`Likelihood::values`](super::Likelihood::values).
        expected: usize,
        /// Number of values that were given.
        given: usize,
    },
    /// A number of the error model is outside its bounds.
    #[error("{name} = {value} is not {bound}")]
    Setting {
        /// Name of the refused number.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// The requirement, in words.
        bound: &'static str,
    },
    /// The number of coordinates or distances of an autocorrelated error is wrong.
    #[error("{given} coordinates or distances of an autocorrelated error, {expected} are expected")]
    Distances {
        /// Number of its data.
        expected: usize,
        /// Number of coordinates or distances that were given.
        given: usize,
    },
    /// A common error names a datum that does not exist, or one twice.
    #[error("a common error names datum {datum} of {data}, or names it twice")]
    Membership {
        /// Index of the datum.
        datum: usize,
        /// The number of data.
        data: usize,
    },
    /// A common error is the discrepancy of a group that does not exist.
    #[error("a common error names the discrepancy of group {group} of {groups}")]
    Group {
        /// Index of the group.
        group: usize,
        /// The number of groups.
        groups: usize,
    },
    /// The sum is NaN or plus infinity.
    #[error(transparent)]
    NotANumber(#[from] NotANumber),
}

impl ErrorSd {
    /// Returns the index in theta of an inferred sd; `None` for a known one.
    #[must_use]
    pub fn parameter(self) -> Option<usize> {
        match self {
            ErrorSd::Known(_) => None,
            ErrorSd::Inferred { parameter } => Some(parameter),
        }
    }

    /// Returns the value, known or in theta.
    ///
    /// # Panics
    /// If theta lacks the parameter. A vector that the likelihood has scored has all.
    pub fn at(self, theta: &[f64]) -> f64 {
        match self {
            ErrorSd::Known(sd) => sd,
            ErrorSd::Inferred { parameter } => theta[parameter],
        }
    }

    /// Returns the value, known or in theta.
    pub(super) fn value(self, theta: &[f64]) -> Result<f64, LikelihoodError> {
        match self {
            ErrorSd::Known(sd) => Ok(sd),
            ErrorSd::Inferred { parameter } => {
                theta
                    .get(parameter)
                    .copied()
                    .ok_or(LikelihoodError::MissingParameter {
                        parameter,
                        dimension: theta.len(),
                    })
            }
        }
    }
}

impl Datum {
    /// Returns the noise sd, known or in theta, > 0.
    pub(super) fn noise_sd(&self, theta: &[f64]) -> Result<f64, LikelihoodError> {
        let sd = self.sd.value(theta)?;
        if sd.is_finite() && sd > 0.0 {
            Ok(sd)
        } else {
            Err(LikelihoodError::Noise {
                run: self.run,
                channel: self.channel,
                value: sd,
            })
        }
    }

    /// Checks the measured value and its known sd.
    pub(super) fn check(&self) -> Result<(), LikelihoodError> {
        let &Self {
            run, channel, value, ..
        } = self;
        if !value.is_finite() {
            return Err(LikelihoodError::Value { run, channel, value });
        }
        match self.sd {
            ErrorSd::Known(_) => self.noise_sd(&[]).map(drop),
            ErrorSd::Inferred { .. } => Ok(()),
        }
    }

    pub(super) fn check_prediction(&self, value: f64) -> Result<(), LikelihoodError> {
        let &Self { run, channel, .. } = self;
        if value.is_finite() {
            Ok(())
        } else {
            Err(LikelihoodError::Prediction { run, channel, value })
        }
    }
}
