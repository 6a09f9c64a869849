//! A finished calibration with everything that the store kept of it.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use job::Spec;
use record::{
    CalibrationRow, Dispute, EstimateRow, Prediction, PriorDraw, Repeats, Sample, StageRow, Subchains,
    Verified,
};
use shared::outcome::SimulatedHistory;
use statistics::Marginal;

use crate::table::comparison::Comparison;
use crate::table::interpolation::Interpolations;

/// A finished calibration.
#[derive(Debug)]
pub struct FinishedCalibration {
    /// Its row in the store.
    pub row: CalibrationRow,
    /// Its specification.
    pub spec: Spec,
    /// Name of its experiment.
    pub experiment: String,
    /// Its stages.
    pub stages: Vec<StageRow>,
    /// The point estimate; `None` where there are draws of the posterior.
    pub estimate: Option<EstimateRow>,
    /// The fit about which the draws are those of a normal approximation; `None` where the posterior was sampled.
    pub approximated: Option<EstimateRow>,
    /// The equally weighted draws of the posterior, of a fit those of its normal approximation; empty of a fit without one.
    pub posterior: Vec<Sample>,
    /// The draws from the prior, then the populations at the end of the stages before the last; none of a fit.
    pub populations: Vec<Vec<Sample>>,
    /// The model's values of the fitted measurements at the draw of the highest likelihood.
    pub likeliest_values: Option<Vec<f64>>,
    /// The final draws, simulated on every run; the first is the most probable particle, of a fit the only one.
    pub predictions: Vec<Prediction>,
    /// Simulated history of each fitted run at the likeliest parameters; `None` of a model without time.
    pub simulated_histories: Option<Vec<SimulatedHistory>>,
    /// Number of rejected parameter vectors of the sampler or the fit, by kind.
    pub rejections: BTreeMap<String, u64>,
    /// Counts of a metamodel; `None` without one.
    pub subchains: Option<Subchains>,
    /// The draws from the prior that a sampler began with; none of a fit.
    pub prior_draws: Vec<PriorDraw>,
    /// Number of failed leases by message.
    pub faults: BTreeMap<String, u64>,
    /// Number of evaluations that were given up after faults.
    pub given_up: u64,
    /// Evaluations that were answered in two ways.
    pub disputes: Vec<Dispute>,
    /// How far the results are verified by second workers.
    pub verified: Verified,
    /// How a model that is not ours answered what it was asked twice.
    pub repeats: Repeats,
    /// The held-out measurements as interpolated from the fitted ones, once somebody asks.
    pub interpolations: OnceLock<Interpolations>,
    /// Model against measurement, once somebody asks: the intervals of many runs and draws are dear.
    pub comparison: OnceLock<Comparison>,
}

impl FinishedCalibration {
    /// Names of the effects of its model.
    pub fn effects(&self) -> Vec<String> {
        let effects = &self.spec.fit_variant.effects;
        effects.iter().map(|effect| effect.name.clone()).collect()
    }

    /// The draw of the highest likelihood; the first of equals.
    pub fn likeliest(&self) -> Option<&Sample> {
        likeliest(&self.posterior)
    }

    /// The predictions that results are made from: equally weighted draws, without the most probable particle, which is
    /// no random draw; of a fit, its one point.
    pub fn predictive_draws(&self) -> &[Prediction] {
        let first = usize::from(self.estimate.is_none()).min(self.predictions.len());
        &self.predictions[first..]
    }

    /// The most probable parameters: those that a fit found, else those of the particle of the highest likelihood times prior,
    /// the first of equals.
    pub fn most_probable(&self) -> Option<Sample> {
        if let Some(mode) = &self.approximated {
            return Some(Sample {
                theta: mode.theta.clone(),
                log_likelihood: Some(mode.log_likelihood),
                log_prior: mode.log_prior,
            });
        }
        let score = |s: &Sample| s.log_likelihood.unwrap_or(f64::NEG_INFINITY) + s.log_prior;
        self.posterior
            .iter()
            .reduce(|best, s| if score(s) > score(best) { s } else { best })
            .cloned()
    }

    /// The draws of one parameter.
    pub fn draws(&self, parameter: usize) -> Vec<f64> {
        self.posterior.iter().map(|s| s.theta[parameter]).collect()
    }
}

/// The population that a sampler begins with.
pub fn first_population(spec: &Spec, draws: &[PriorDraw]) -> Vec<Sample> {
    let prior = spec.prior();
    let score = |draw: &PriorDraw| {
        let values = draw.result.as_ref().ok()?;
        let scored = spec.likelihood.log_likelihood(values, &draw.theta).ok()?;
        Some(scored.value()).filter(|value| value.is_finite())
    };
    let sample = |draw: &PriorDraw| Sample {
        theta: draw.theta.clone(),
        log_likelihood: score(draw),
        log_prior: prior.log_density(&draw.theta),
    };
    draws.iter().map(sample).collect()
}

/// The draw of the highest likelihood; the first of equals.
pub fn likeliest(draws: &[Sample]) -> Option<&Sample> {
    let score = |s: &Sample| s.log_likelihood.unwrap_or(f64::NEG_INFINITY);
    let best = draws
        .iter()
        .reduce(|best, s| if score(s) > score(best) { s } else { best });
    best.filter(|s| s.log_likelihood.is_some())
}

/// The mean of a prior; that of a symmetric one is integrated to zero but for rounding, which is not shown.
pub fn prior_mean(marginal: &Marginal) -> f64 {
    let mean = marginal.mean();
    if mean.abs() < 1e-12 * marginal.sd() {
        0.0
    } else {
        mean
    }
}

#[cfg(test)]
mod tests {
    use statistics::Distribution;

    use super::*;

    #[test]
    fn a_prior_about_zero_has_the_mean_zero() {
        let of = |mean| prior_mean(&Marginal::new(Distribution::Normal { mean, sd: 0.2 }, None).unwrap());
        assert_eq!(of(0.0).to_bits(), 0.0_f64.to_bits());
        assert!((of(1e-6) - 1e-6).abs() < 1e-15);
    }
}
