//! The likelihood of a model whose predictions scatter about a smooth function of its parameters.

use super::datum::{ErrorSd, LikelihoodError};
use super::error_model::Likelihood;

impl Likelihood {
    /// Adds the scatter of the model to every known noise: `sd^2 + s^2`.
    ///
    /// An inferred noise sd includes the model's scatter already.
    ///
    /// # Arguments
    /// - `sds`: s of each channel by its index, in the unit of the channel; 0 for channels beyond.
    ///
    /// # Errors
    /// [`LikelihoodError::Noise`] where s is not a finite number.
    pub fn with_numerical_noise(&self, sds: &[f64]) -> Result<Likelihood, LikelihoodError> {
        let mut data = self.data.clone();
        for datum in &mut data {
            if let ErrorSd::Known(sd) = datum.sd {
                let scatter = sds.get(datum.channel).copied().unwrap_or(0.0);
                datum.sd = ErrorSd::Known((sd * sd + scatter * scatter).sqrt());
            }
        }
        Self::with_common(data, self.law, self.common.clone(), self.discrepancies.clone())
    }
}
