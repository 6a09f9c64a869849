//! A finished calibration with everything that the store has of it: the input of all results.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use inference::{EmulatorRecord, Particle};
use job::Spec;
use record::{CalibrationRow, Dispute, EstimateRow, Prediction, PriorDraw, Repeats, StageRow, Verified};
use shared::outcome::SimulatedHistory;
use statistics::{LogLikelihood, Marginal};

use crate::table::comparison::Comparison;
use crate::table::interpolation::Interpolations;

/// The kind of result that a calibration ends with.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// A sample of the posterior.
    Sampled(SampledPosterior),
    /// Draws of the normal approximation about a fit.
    Approximated {
        /// The most probable parameters.
        mode: EstimateRow,
        /// The equally weighted draws.
        draws: Vec<Particle>,
    },
    /// The most probable parameters only.
    Estimated(EstimateRow),
}

/// A sample of the posterior with the history of the sampler.
#[derive(Debug, Clone)]
pub struct SampledPosterior {
    /// The equally weighted draws.
    pub draws: Vec<Particle>,
    /// The draws from the prior, then the populations at the end of each stage but the last.
    pub populations: Vec<Vec<Particle>>,
    /// The draws from the prior with the model's predictions or rejections.
    pub prior_draws: Vec<PriorDraw>,
    /// Stages of the sampler.
    pub stages: Vec<StageRow>,
}

impl Outcome {
    /// Chooses the kind of outcome from the stored parts.
    ///
    /// # Arguments
    /// - `estimate`: the most probable parameters of a fit.
    /// - `sampled`: the draws of a sampler with its stages, or the draws of a normal approximation.
    pub fn new(estimate: Option<EstimateRow>, sampled: SampledPosterior) -> Self {
        match estimate {
            None => Outcome::Sampled(sampled),
            Some(estimate) if sampled.draws.is_empty() => Outcome::Estimated(estimate),
            Some(mode) => Outcome::Approximated {
                mode,
                draws: sampled.draws,
            },
        }
    }
}

/// A finished calibration.
#[derive(Debug, Clone)]
pub struct FinishedCalibration {
    /// Row of the calibration in the store.
    pub row: CalibrationRow,
    /// Specification of the calibration.
    pub spec: Spec,
    /// Name of its experiment.
    pub experiment: String,
    /// Result of the algorithm.
    pub outcome: Outcome,
    /// What the sampler found about its emulator; `None` without one.
    pub emulator: Option<EmulatorRecord>,
    /// Predictions of the fitted measurements at the draw with the highest likelihood.
    pub likeliest_values: Option<Vec<f64>>,
    /// The final draws, simulated on every run. The first is the most probable particle; for a fit it is the only one.
    pub predictions: Vec<Prediction>,
    /// Simulated history of each fitted run at the draw with the highest likelihood; `None` for a model without time.
    pub simulated_histories: Option<Vec<SimulatedHistory>>,
    /// Number of parameter vectors that the model rejected, by kind.
    pub rejections: BTreeMap<String, u64>,
    /// Number of failed leases by message.
    pub faults: BTreeMap<String, u64>,
    /// Number of evaluations that were given up after faults.
    pub given_up: u64,
    /// Evaluations with two different results.
    pub disputes: Vec<Dispute>,
    /// Numbers of results that second workers verified.
    pub verified: Verified,
    /// Differences between the answers of an external model to repeated questions.
    pub repeats: Repeats,
    /// The holdout measurements interpolated from the fitted ones, computed on demand.
    pub interpolations: OnceLock<Interpolations>,
    /// Model against measurement, computed on demand, because the intervals of many runs and draws are expensive.
    pub comparison: OnceLock<Comparison>,
}

impl FinishedCalibration {
    /// Names of the effects of its model.
    pub fn effects(&self) -> Vec<String> {
        let effects = &self.spec.fit_variant.effects;
        effects.iter().map(|effect| effect.name.clone()).collect()
    }

    /// Returns the equally weighted draws of the posterior or of its normal approximation; empty for a fit without draws.
    pub fn posterior(&self) -> &[Particle] {
        match &self.outcome {
            Outcome::Sampled(sampled) => &sampled.draws,
            Outcome::Approximated { draws, .. } => draws,
            Outcome::Estimated(_) => &[],
        }
    }

    /// Returns the point estimate; `None` if there are draws of the posterior.
    pub fn estimate(&self) -> Option<&EstimateRow> {
        match &self.outcome {
            Outcome::Estimated(estimate) => Some(estimate),
            Outcome::Sampled(_) | Outcome::Approximated { .. } => None,
        }
    }

    /// Returns the fit about which the draws are a normal approximation.
    pub fn approximated(&self) -> Option<&EstimateRow> {
        match &self.outcome {
            Outcome::Approximated { mode, .. } => Some(mode),
            Outcome::Sampled(_) | Outcome::Estimated(_) => None,
        }
    }

    /// Returns the most probable parameters of a fit, with or without draws about them.
    pub fn mode(&self) -> Option<&EstimateRow> {
        self.estimate().or(self.approximated())
    }

    fn sampled(&self) -> Option<&SampledPosterior> {
        match &self.outcome {
            Outcome::Sampled(sampled) => Some(sampled),
            Outcome::Approximated { .. } | Outcome::Estimated(_) => None,
        }
    }

    /// Returns the stages of the sampler; empty for a fit.
    pub fn stages(&self) -> &[StageRow] {
        self.sampled().map_or(&[], |sampled| &sampled.stages)
    }

    /// Returns the draws from the prior, then the populations at the end of each stage but the last; empty for a fit.
    pub fn populations(&self) -> &[Vec<Particle>] {
        self.sampled().map_or(&[], |sampled| &sampled.populations)
    }

    /// Returns the draws from the prior that the sampler began with; empty for a fit.
    pub fn prior_draws(&self) -> &[PriorDraw] {
        self.sampled().map_or(&[], |sampled| &sampled.prior_draws)
    }

    /// Returns the draw with the highest likelihood; of equal draws, the first.
    pub fn likeliest(&self) -> Option<&Particle> {
        likeliest(self.posterior())
    }

    /// Returns the predictions that results are computed from: the equally weighted draws without the most probable particle, which is
    /// not a random draw. A fit has its one point.
    pub fn predictive_draws(&self) -> &[Prediction] {
        let first = usize::from(self.estimate().is_none()).min(self.predictions.len());
        &self.predictions[first..]
    }

    /// Returns the most probable parameters: the mode of a fit with draws, else the particle with the highest product of likelihood and
    /// prior, the first of equal ones.
    pub fn most_probable(&self) -> Option<Particle> {
        if let Some(mode) = self.approximated() {
            return Some(Particle {
                theta: mode.theta.clone(),
                log_likelihood: LogLikelihood::new(mode.log_likelihood).ok()?,
                log_prior: mode.log_prior,
            });
        }
        let score = |p: &Particle| p.log_likelihood.value() + p.log_prior;
        let best = |a, b| if score(b) > score(a) { b } else { a };
        self.posterior().iter().reduce(best).cloned()
    }

    /// Returns the draws of one parameter.
    pub fn draws(&self, parameter: usize) -> Vec<f64> {
        self.posterior().iter().map(|s| s.theta[parameter]).collect()
    }
}

/// Returns the draws from the prior as the sampler's first population, with their log-likelihoods.
pub fn first_population(spec: &Spec, draws: &[PriorDraw]) -> Vec<Particle> {
    let prior = spec.prior();
    let score = |draw: &PriorDraw| {
        let values = draw.result.as_ref().ok()?;
        spec.likelihood.log_likelihood(values, &draw.theta).ok()
    };
    let particle = |draw: &PriorDraw| Particle {
        theta: draw.theta.clone(),
        log_likelihood: score(draw).unwrap_or(LogLikelihood::Impossible),
        log_prior: prior.log_density(&draw.theta),
    };
    draws.iter().map(particle).collect()
}

/// Returns the draw with the highest likelihood; of equal draws, the first.
pub fn likeliest(draws: &[Particle]) -> Option<&Particle> {
    let score = |p: &Particle| p.log_likelihood.value();
    let best = draws
        .iter()
        .reduce(|best, p| if score(p) > score(best) { p } else { best });
    best.filter(|p| !p.log_likelihood.is_impossible())
}

/// Returns the mean of a prior. Numerical integration gives a symmetric prior a mean that differs from 0 by rounding, which is set to 0.
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
        let shown = |mean| prior_mean(&Marginal::new(Distribution::Normal { mean, sd: 0.2 }, None).unwrap());
        assert_eq!(shown(0.0).to_bits(), 0.0_f64.to_bits());
        assert!((shown(1e-6) - 1e-6).abs() < 1e-15);
    }
}
