//! The tempered posterior that an emulator predicts.

use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

use super::emulator::Emulator;
use crate::tmcmc::Particle;

/// Sd of the tempered log-likelihood, in nats, above which distrust lowers it.
const TRUSTED_SD: f64 = 3.0;

/// Largest nats by which distrust lowers the tempered log-likelihood of parameters that the target holds nevertheless.
const MAX_PENALTY: f64 = 1.0;

/// Sds by which an optimistic log-likelihood exceeds the emulated one.
const OPTIMISM: f64 = 2.0;

/// The emulated likelihood of a parameter vector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EmulatedScore {
    /// ln p(data | theta) of the predicted outputs.
    pub(crate) log_likelihood: f64,
    /// Its sd, from the sd of the predicted outputs.
    pub(crate) sd: f64,
    /// ln of the probability that the model accepts theta.
    pub(crate) log_acceptance: f64,
}

impl EmulatedScore {
    /// Returns ln of the tempered likelihood, lowered where the emulator is not trusted: far from the training points its
    /// predictions may be of any size.
    pub(crate) fn value(&self, exponent: f64) -> f64 {
        exponent * self.log_likelihood + self.log_acceptance - self.penalty(exponent)
    }

    /// Returns the largest tempered log-likelihood that would be no surprise.
    pub(crate) fn optimistic(&self, exponent: f64) -> f64 {
        exponent * (self.log_likelihood + OPTIMISM * self.sd) + self.log_acceptance
    }

    /// Returns whether the emulator is trusted at an exponent: distrust lowers the tempered likelihood little.
    pub(crate) fn is_trusted(&self, exponent: f64) -> bool {
        self.penalty(exponent) <= MAX_PENALTY
    }

    fn penalty(&self, exponent: f64) -> f64 {
        let excess = (exponent * self.sd - TRUSTED_SD).max(0.0);
        0.5 * excess * excess
    }
}

/// The emulated posterior of a prior and a likelihood.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EmulatedTarget<'a> {
    pub(crate) prior: &'a Prior,
    pub(crate) likelihood: &'a Likelihood,
    pub(crate) emulator: &'a Emulator,
}

impl EmulatedTarget<'_> {
    /// Returns the emulated likelihood.
    ///
    /// With r the residuals and s the sd of a predicted output, both in noise sds, and k the share of the noise in the variance of a
    /// datum, 1 where the job has no discrepancy, the log-likelihood has an error of about
    /// `s |k r| + s^2 / 2 sum k`. Checked by `emulated::a_model_that_misses_its_data_is_emulated_with_a_discrepancy`.
    pub(crate) fn score(&self, theta: &[f64]) -> EmulatedScore {
        let predicted = self.emulator.predict(self.prior, theta);
        let outputs = &predicted.outputs;
        let scored = self.likelihood.log_likelihood(outputs, theta);
        // Parameters without a variance have no likelihood either.
        let variances = match self.likelihood.has_discrepancy() {
            true => self.likelihood.error_variances(outputs, theta).ok(),
            false => None,
        };
        let (mut squares, mut shares) = (0.0, 0.0);
        for (i, (datum, y)) in self.likelihood.data().iter().zip(outputs).enumerate() {
            let noise_sd = datum.sd.at(theta);
            let share = variances
                .as_ref()
                .map_or(1.0, |variances| noise_sd * noise_sd / variances[i]);
            let residual = share * (datum.value - y) / noise_sd;
            squares += residual * residual;
            shares += share;
        }
        EmulatedScore {
            log_likelihood: scored.map_or(f64::NEG_INFINITY, LogLikelihood::value),
            sd: predicted.sd * (squares.sqrt() + 0.5 * predicted.sd * shares),
            log_acceptance: libm::log(predicted.acceptance),
        }
    }

    /// Returns the particle of an emulated likelihood.
    pub(crate) fn particle(&self, theta: &[f64], score: &EmulatedScore) -> Particle {
        Particle {
            theta: theta.to_vec(),
            log_likelihood: log_likelihood(score.log_likelihood),
            log_prior: self.prior.log_density(theta),
        }
    }
}

/// Makes a log-likelihood; what is no number is impossible.
pub(crate) fn log_likelihood(value: f64) -> LogLikelihood {
    LogLikelihood::new(value).unwrap_or(LogLikelihood::Impossible)
}
