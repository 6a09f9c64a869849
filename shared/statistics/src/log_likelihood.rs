//! A log-likelihood: a finite number, or impossible.

/// The logarithm of p(data | theta).
///
/// [`LogLikelihood::new`] refuses NaN and plus infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogLikelihood {
    /// A finite value, in nats.
    Finite(Nats),
    /// The model rejected the parameter vector: the data have probability zero.
    Impossible,
}

/// A finite number of nats; only [`LogLikelihood::new`] makes one.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Nats(f64);

impl Nats {
    /// Returns the finite number.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A log-likelihood was NaN or plus infinity.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("log-likelihood {value} is neither finite nor minus infinity")]
pub struct NotANumber {
    /// The refused value.
    pub value: f64,
}

impl LogLikelihood {
    /// Accepts a finite number, and minus infinity as [`LogLikelihood::Impossible`].
    ///
    /// # Errors
    /// [`NotANumber`] for NaN and plus infinity.
    pub fn new(value: f64) -> Result<Self, NotANumber> {
        if value.is_finite() {
            Ok(Self::Finite(Nats(value)))
        } else if value < 0.0 {
            Ok(Self::Impossible)
        } else {
            Err(NotANumber { value })
        }
    }

    /// Returns the number; minus infinity for [`LogLikelihood::Impossible`].
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Finite(nats) => nats.0,
            Self::Impossible => f64::NEG_INFINITY,
        }
    }

    /// Returns whether the model rejected the parameter vector.
    #[must_use]
    pub fn is_impossible(self) -> bool {
        matches!(self, Self::Impossible)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_plus_infinity_are_refused() {
        assert!(LogLikelihood::new(f64::NAN).is_err());
        assert!(LogLikelihood::new(f64::INFINITY).is_err());
        assert_eq!(
            LogLikelihood::new(f64::NEG_INFINITY),
            Ok(LogLikelihood::Impossible)
        );
        assert_eq!(LogLikelihood::new(-2.5).map(LogLikelihood::value), Ok(-2.5));
    }
}
