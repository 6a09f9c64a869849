//! The incremental weights of a pool for the next tempering exponent.

/// Incremental weights exp(step (l - max l)), relative to the largest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weights {
    /// Each in [0, 1]; at least one is 1.
    pub(crate) relative: Vec<f64>,
    /// ln of the mean weight: the increment of the log-evidence.
    pub(crate) log_mean: f64,
    /// Coefficient of variation of the weights.
    pub(crate) cov: f64,
}

impl Weights {
    /// Computes the weights of finite log-likelihoods for a step of the exponent, 0 < `step` <= 1.
    pub(crate) fn new(log_likelihoods: &[f64], step: f64) -> Self {
        let max = log_likelihoods
            .iter()
            .fold(f64::NEG_INFINITY, |max, &l| max.max(l));
        let relative: Vec<f64> = log_likelihoods
            .iter()
            .map(|l| libm::exp(step * (l - max)))
            .collect();
        let mean = relative.iter().sum::<f64>() / relative.len() as f64;
        let log_mean = step * max + libm::log(mean);
        let cov = crate::diagnostics::weight_cov(&relative);
        Self {
            relative,
            log_mean,
            cov,
        }
    }

    pub(crate) fn normalised(&self) -> Vec<f64> {
        let sum: f64 = self.relative.iter().sum();
        self.relative.iter().map(|w| w / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn huge_log_likelihoods_do_not_overflow() {
        let weights = Weights::new(&[-1e6, -1e6 + libm::log(3.0)], 1.0);
        // Mean of e^-1e6 and 3 e^-1e6.
        assert!((weights.log_mean - (-1e6 + libm::log(2.0))).abs() < 1e-9);
        assert!((weights.cov - 0.5).abs() < 1e-9);
        assert_eq!(weights.relative[1].to_bits(), 1.0_f64.to_bits());
    }
}
