//! The distributions of priors, and the checks of their numbers.

use super::error::PriorError;

/// A univariate distribution before truncation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Constant density between two ends.
    Uniform {
        /// Lower end.
        lower: f64,
        /// Upper end.
        upper: f64,
    },
    /// Constant density of ln x between two positive ends.
    Loguniform {
        /// Lower end, above 0.
        lower: f64,
        /// Upper end.
        upper: f64,
    },
    /// The normal distribution.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, above 0.
        sd: f64,
    },
    /// ln x is normal with mean ln `median` and standard deviation ln `factor`.
    Lognormal {
        /// Median, above 0.
        median: f64,
        /// Factor of one standard deviation, above 1.
        factor: f64,
    },
    /// The absolute value of a normal variable with mean 0.
    HalfNormal {
        /// Standard deviation of the normal variable, above 0.
        scale: f64,
    },
}

impl Distribution {
    /// Checks that the numbers describe a distribution.
    pub(super) fn check(&self) -> Result<(), PriorError> {
        match *self {
            Self::Uniform { lower, upper } => interval(lower, upper),
            Self::Loguniform { lower, upper } => {
                interval(lower, upper)?;
                above("lower", lower, 0.0)
            }
            Self::Normal { mean, sd } => {
                finite("mean", mean)?;
                above("sd", sd, 0.0)
            }
            Self::Lognormal { median, factor } => {
                above("median", median, 0.0)?;
                above("factor", factor, 1.0)
            }
            Self::HalfNormal { scale } => above("scale", scale, 0.0),
        }
    }

    /// Returns the interval outside which the density is zero.
    #[must_use]
    pub fn support(&self) -> (f64, f64) {
        match *self {
            Self::Uniform { lower, upper } | Self::Loguniform { lower, upper } => (lower, upper),
            Self::Normal { .. } => (f64::NEG_INFINITY, f64::INFINITY),
            Self::Lognormal { .. } | Self::HalfNormal { .. } => (0.0, f64::INFINITY),
        }
    }
}

/// Refuses NaN and infinities.
fn finite(name: &'static str, value: f64) -> Result<(), PriorError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(PriorError::NotFinite { name, value })
    }
}

/// Refuses a number that is not finite or not above a bound.
fn above(name: &'static str, value: f64, bound: f64) -> Result<(), PriorError> {
    finite(name, value)?;
    if value > bound {
        Ok(())
    } else {
        Err(PriorError::TooSmall { name, value, bound })
    }
}

/// Refuses an interval without a finite, positive width.
fn interval(lower: f64, upper: f64) -> Result<(), PriorError> {
    finite("lower", lower)?;
    finite("upper", upper)?;
    ordered(lower, upper)?;
    finite("width", upper - lower)
}

/// Refuses ends that are not in order; an infinite end means no truncation on its side.
pub(super) fn ordered(lower: f64, upper: f64) -> Result<(), PriorError> {
    if lower < upper {
        Ok(())
    } else {
        Err(PriorError::EmptyInterval { lower, upper })
    }
}
