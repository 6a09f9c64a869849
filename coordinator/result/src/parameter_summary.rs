//! Parameter summary: posterior and prior moments of a parameter.

use inference::diagnostics;

use crate::finished_calibration::{FinishedCalibration, prior_mean};

/// Posterior and prior of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ParameterSummary {
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// 5 % quantile.
    pub q05: f64,
    /// Median.
    pub q50: f64,
    /// 95 % quantile.
    pub q95: f64,
    /// Value in the most probable parameter vector.
    pub map: f64,
    /// Prior mean.
    pub prior_mean: Option<f64>,
    /// Prior standard deviation.
    pub prior_sd: Option<f64>,
    /// Whether q05 or q95 lies close to a bound, within 2 % of the range of the prior.
    pub at_bound: bool,
}

impl FinishedCalibration {
    /// Returns the posterior and prior moments of each parameter, in the order of the job.
    pub fn parameter_summaries(&self) -> Vec<(String, ParameterSummary)> {
        let best = self.most_probable();
        let finite = |x: f64| x.is_finite().then_some(x);
        self.spec
            .parameters
            .iter()
            .enumerate()
            .filter_map(|(i, parameter)| {
                let draws = diagnostics::summary(&self.draws(i))?;
                let summary = ParameterSummary {
                    mean: draws.mean,
                    sd: draws.sd,
                    q05: draws.q05,
                    q50: draws.q50,
                    q95: draws.q95,
                    map: best.as_ref()?.theta[i],
                    prior_mean: finite(prior_mean(&parameter.marginal)),
                    prior_sd: finite(parameter.marginal.sd()),
                    at_bound: parameter.marginal.at_bound(draws.q05, draws.q95),
                };
                Some((parameter.name.clone(), summary))
            })
            .collect()
    }
}
