//! Score a model's predictions against measurements.

use crate::log_likelihood::{LogLikelihood, NotANumber};
use crate::prior::LN_SQRT_TAU;

/// The noise of one measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sd {
    /// A known standard deviation, in the unit of the datum.
    Known(f64),
    /// An inferred standard deviation.
    Inferred {
        /// Its index in theta.
        parameter: usize,
    },
}

/// One measured value; what was not measured is not in the list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Index of the test run.
    pub run: usize,
    /// Index of the channel.
    pub channel: usize,
    /// The measured value, in the unit of the channel.
    pub value: f64,
    /// Its noise.
    pub sd: Sd,
}

/// Data or predictions that cannot be scored.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LikelihoodError {
    /// A measured value is NaN or infinite.
    #[error("measured value {value} of run {run}, channel {channel} is not finite")]
    Value {
        /// Index of the run.
        run: usize,
        /// Index of the channel.
        channel: usize,
        /// The value.
        value: f64,
    },
    /// A noise sd is not a finite number above 0.
    #[error("noise sd {value} of run {run}, channel {channel} is not a finite number above 0")]
    Noise {
        /// Index of the run.
        run: usize,
        /// Index of the channel.
        channel: usize,
        /// The sd.
        value: f64,
    },
    /// An inferred sd names a parameter that theta lacks.
    #[error("noise sd is parameter {parameter}, but theta has {dimension}")]
    MissingParameter {
        /// The index.
        parameter: usize,
        /// The length of theta.
        dimension: usize,
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
    /// The sum is NaN or plus infinity.
    #[error(transparent)]
    NotANumber(#[from] NotANumber),
}

/// Independent normal errors of known or inferred standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianLikelihood {
    data: Vec<Datum>,
}

impl GaussianLikelihood {
    /// Keeps the data in their order, which is the order of summation.
    ///
    /// # Errors
    /// [`LikelihoodError::Value`] and [`LikelihoodError::Noise`].
    pub fn new(data: Vec<Datum>) -> Result<Self, LikelihoodError> {
        for &Datum {
            run,
            channel,
            value,
            sd,
        } in &data
        {
            if !value.is_finite() {
                return Err(LikelihoodError::Value { run, channel, value });
            }
            if let Sd::Known(sd) = sd
                && !(sd.is_finite() && sd > 0.0)
            {
                return Err(LikelihoodError::Noise {
                    run,
                    channel,
                    value: sd,
                });
            }
        }
        Ok(Self { data })
    }

    /// The data, in their order.
    #[must_use]
    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    /// ln p(data | theta), normalised: comparable between noise levels and between models.
    ///
    /// `sum_i [ -ln(sqrt(2 pi) sd_i) - (y_i - m_i)^2 / (2 sd_i^2) ]`
    ///
    /// # Arguments
    /// - `predicted`: m, the model's value for (run, channel), in the unit of the channel.
    /// - `theta`: holds the inferred standard deviations, each > 0 (give them a positive prior).
    ///
    /// # Returns
    /// The sum, in nats; [`LogLikelihood::Impossible`] if a residual is so large that the sum overflows.
    ///
    /// # Errors
    /// [`LikelihoodError::Prediction`], [`LikelihoodError::Noise`], [`LikelihoodError::MissingParameter`].
    ///
    /// # Source
    /// The usual normal density. The paper's Eq. 13-15 lack the factor 1/sigma; without it an inferred sigma
    /// grows without bound and evidences of different noise models cannot be compared, so we keep it.
    /// Checked by `likelihood::hand_numbers`.
    pub fn log_likelihood(
        &self,
        predicted: impl Fn(usize, usize) -> f64,
        theta: &[f64],
    ) -> Result<LogLikelihood, LikelihoodError> {
        let values = self.data.iter().map(|datum| predicted(datum.run, datum.channel));
        self.sum(values, theta)
    }

    /// The same for predicted values in the order of the data, as the store keeps them.
    ///
    /// # Errors
    /// Those of [`GaussianLikelihood::log_likelihood`].
    pub fn log_likelihood_of(&self, values: &[f64], theta: &[f64]) -> Result<LogLikelihood, LikelihoodError> {
        self.sum(values.iter().copied(), theta)
    }

    fn sum(
        &self,
        values: impl Iterator<Item = f64>,
        theta: &[f64],
    ) -> Result<LogLikelihood, LikelihoodError> {
        let mut sum = 0.0;
        for (datum, value) in self.data.iter().zip(values) {
            let &Datum { run, channel, .. } = datum;
            let sd = datum.noise_sd(theta)?;
            if !value.is_finite() {
                return Err(LikelihoodError::Prediction { run, channel, value });
            }
            let residual = (datum.value - value) / sd;
            sum += -LN_SQRT_TAU - libm::log(sd) - 0.5 * residual * residual;
        }
        Ok(LogLikelihood::new(sum)?)
    }
}

impl Datum {
    /// The noise sd, known or in theta, above 0.
    fn noise_sd(&self, theta: &[f64]) -> Result<f64, LikelihoodError> {
        let sd = match self.sd {
            Sd::Known(sd) => sd,
            Sd::Inferred { parameter } => *theta.get(parameter).ok_or(LikelihoodError::MissingParameter {
                parameter,
                dimension: theta.len(),
            })?,
        };
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
}
